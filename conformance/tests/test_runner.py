# SPDX-License-Identifier: MIT
"""The runner passes a decoder that does all it must, and fails one for each single thing it does not."""
import copy
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
sys.path.insert(0, HERE)
import fake_decoder  # noqa: E402
from runner import ply  # noqa: E402

# What the decoder does with each vector, when all is well.
PLANS = {
    "core/good": {"decode": {"frames": {"0": 1, "1": 2}}, "preview": {"frames": {"0": 5, "1": 6}}, "verify": {}},
    "extended/gap": {"decode": {"frames": {"0": 1}, "say": "1 of 2 frames lost"}, "verify": {}},
    "invalid/corrupt": {"decode": {"frames": {"0": 3}, "status": 1}, "verify": {"status": 1}},
    "invalid/later": {"decode": {"status": 3}, "verify": {"status": 3}},
    "invalid/either": {"decode": {"status": 3}, "verify": {"status": 3}},
    "invalid/digest": {"decode": {"frames": {"0": 3}}, "verify": {"status": 1}}}


def mesh(height):
    """The hash of the fake decoder's mesh."""
    with tempfile.TemporaryDirectory() as folder:
        fake_decoder.write_ply(folder + "/x.ply", height)
        return ply.mesh_hash(folder + "/x.ply")


def frames(plan):
    """What the manifest says of frames."""
    return [{"frame": int(f), "mesh": mesh(h)} for f, h in plan.get("frames", {}).items()]


def manifest():
    """The manifest that PLANS fulfil."""
    out = []
    for name, plan in PLANS.items():
        category = name.split("/")[0]
        entry = {"name": name, "file": name + ".gvc", "category": category, "features": ["some"], "about": "a test",
                 "clauses": [], "profile": "lossy"}
        if category == "invalid":
            entry["error"] = {"later": "unsupported", "either": "any"}.get(name.split("/")[1], "corrupt")
            entry["good"] = frames(plan["decode"])
        else:
            entry["level"], entry["frames"] = 2, frames(plan["decode"])
        out.append(entry)
    out[0]["profile"], out[0]["preview"] = "preview", frames(PLANS["core/good"]["preview"])
    out[1]["missing"] = [1]
    out[5]["checks"] = "whole file"
    return {"vectors": out}


class Set:
    """A conformance set in a folder of its own."""

    def __init__(self, folder):
        self.folder, self.plans, self.manifest = folder, copy.deepcopy(PLANS), manifest()
        self.after = lambda folder: None
        self.timeout = "60"

    def entry(self, name):
        """The entry of a vector."""
        return next(e for e in self.manifest["vectors"] if e["name"] == name)

    def keep_changed(self):
        """Leaves out vectors where nothing was changed but the first, to be quicker."""
        before = manifest()["vectors"]
        self.manifest["vectors"] = [e for i, e in enumerate(self.manifest["vectors"])
                                    if i == 0 or e != before[i] or self.plans[e["name"]] != PLANS[e["name"]]]

    def run(self, *options, commands=("decoder", "preview", "verify")):
        """Writes the set, runs the runner, gives exit status and output."""
        for entry in self.manifest["vectors"]:
            data = json.dumps(self.plans[entry["name"]]).encode()
            entry.setdefault("sha256", hashlib.sha256(data).hexdigest())
            path = os.path.join(self.folder, entry["file"])
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as stream:
                stream.write(data)
        with open(self.folder + "/manifest.json", "w", encoding="utf-8") as stream:
            json.dump(self.manifest, stream)
        self.after(self.folder)
        fake = "%s -I -S %s %%s {in} {out}" % (sys.executable, os.path.join(HERE, "fake_decoder.py"))
        keys = {"decoder": "decode", "preview": "preview", "verify": "verify"}
        line = [w for c in commands for w in ("--" + c, fake % keys[c])]
        done = subprocess.run([sys.executable, os.path.join(HERE, "..", "run"), "--manifest", self.folder + "/manifest.json",
                               "--timeout", self.timeout, "--status", "corrupt=1", "--status", "unsupported=3", "-j2", *line, *options],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        return done.returncode, done.stdout


def other_mesh(key, name="core/good"):
    """A change: another mesh is expected."""
    def change(s):
        s.entry(name)[key][-1]["mesh"] = mesh(77)
    return change


def plan(name, command="decode", **fields):
    """A change: the decoder does something else."""
    def change(s):
        s.plans[name][command].update(fields)
    return change


def add_frame(s):
    """A change: one more frame is expected."""
    s.entry("core/good")["frames"].append({"frame": 2, "mesh": mesh(1)})


def rename(s):
    """A change: a file of another name than the manifest's stands in a folder."""
    s.after = lambda folder: os.rename(folder + "/core/good.gvc", folder + "/core/other.gvc")


def unlisted(s):
    """A change: a file that the manifest does not name."""
    def put(folder):
        with open(folder + "/core/more.gvc", "wb") as stream:
            stream.write(b"x")
    s.after = put


def too_slow(s):
    """A change: the decoder does not come to an end."""
    s.plans["invalid/corrupt"]["decode"]["sleep"] = 60
    s.timeout = "2"


def put_entry(name, key, value):
    """A change of the manifest."""
    def change(s):
        s.entry(name)[key] = value
    return change


# Each of these by itself must make the runner fail, and say something that has the word in it.
CHANGES = {
    "mesh": (other_mesh("frames"), "another mesh"), "preview mesh": (other_mesh("preview"), "preview: frame 1 is another mesh"),
    "frame missing": (plan("core/good", frames={"0": 1}), "was not written"), "frame expected": (add_frame, "was not written"),
    "frame more": (plan("core/good", frames={"0": 1, "1": 2, "2": 3}), "must not be there"),
    "file more": (plan("core/good", files=["log.txt"]), "must not be there"),
    "file no mesh": (plan("core/good", files=["000001.ply"]), "not a PLY"),
    "frame of the gap": (plan("extended/gap", frames={"0": 1, "1": 2}), "must not be there"),
    "silent gap": (plan("extended/gap", say=""), "12.8.2"),
    "good refused": (plan("core/good", status=1), "refused"), "preview refused": (plan("core/good", "preview", status=1), "preview: refused"),
    "verify refuses": (plan("core/good", "verify", status=1), "verify: refused"),
    "bad accepted": (plan("invalid/corrupt", status=0), "accepted"),
    "other class": (plan("invalid/corrupt", status=3), "was wanted"), "class expected": (
        put_entry("invalid/corrupt", "error", "unsupported"), "was wanted"),
    "unsupported called corrupt": (plan("invalid/later", status=1), "was wanted"),
    "class of neither": (plan("invalid/either", status=2), "of no class"),
    "bad frame handed out": (plan("invalid/corrupt", frames={"0": 4}), "not good"),
    "frame too many": (plan("invalid/corrupt", frames={"0": 3, "1": 3}), "not good"),
    "good frame expected": (other_mesh("good", "invalid/corrupt"), "not good"),
    "whole file accepted": (plan("invalid/digest", "verify", status=0), "accepted"),
    "sha256": (put_entry("core/good", "sha256", 64 * "0"), "wrong SHA-256"), "file missing": (rename, "No such file"),
    "unlisted": (unlisted, "not in the manifest"), "crash": (plan("invalid/corrupt", signal="SIGSEGV"), "signal 11"),
    "crash of a shell": (plan("invalid/corrupt", status=139), "139"), "time-out": (too_slow, "not done after"),
    "sanitizer": (plan("invalid/corrupt", say="==1==ERROR: AddressSanitizer: heap-buffer-overflow"), "sanitizer")}


class RunnerTest(unittest.TestCase):
    """Runs the runner on small sets."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.set = Set(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_passes(self):
        """All is as it must be."""
        status, text = self.set.run()
        self.assertEqual(status, 0, text)
        self.assertIn("6 passed, 0 failed, 0 skipped", text)

    def test_each_change_fails(self):
        """Each change by itself is noticed."""
        for name, (change, word) in CHANGES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                one = Set(folder)
                change(one)
                one.keep_changed()
                status, text = one.run()
                self.assertEqual(status, 1, text)
                self.assertIn(word, text)

    def test_skipped(self):
        """What is left out is not passed over in silence."""
        for options in ({"commands": ("decoder", "verify")}, {"commands": ("decoder", "preview")}):
            status, text = self.set.run(**options)
            self.assertEqual(status, 3, text)
            self.assertIn("SKIPPED", text)
        status, text = self.set.run("--only", "core/*")
        self.assertEqual(status, 3, text)
        self.assertIn("5 skipped", text)

    def test_claims(self):
        """Files beyond the profiles claimed must be refused, those above the level may be."""
        status, text = self.set.run("--profiles", "lossy")
        self.assertEqual(status, 1, text)
        self.assertIn("core/good: accepted", text)
        self.set.plans["core/good"]["decode"] = {"status": 3}
        self.assertEqual(self.set.run("--profiles", "lossy")[0], 1)  # the SHA-256 is that of the file before
        self.set.entry("core/good").pop("sha256")
        self.assertEqual(self.set.run("--profiles", "lossy")[0], 0)
        self.set.plans["core/good"]["decode"] = {"status": 1, "frames": {"0": 1}}
        self.set.entry("core/good").pop("sha256")
        self.assertEqual(self.set.run("--level", "1")[0], 0)
        self.assertEqual(self.set.run("--level", "2")[0], 1)
        self.set.plans["core/good"]["decode"] = {"status": 1, "frames": {"0": 99}}
        self.set.entry("core/good").pop("sha256")
        self.assertEqual(self.set.run("--level", "1")[0], 1)

    def test_usage(self):
        """Wrong usage has its own exit status."""
        for options in (("--status", "corrupt=0"), ("--status", "other=1"), ("--profiles", "all"), ("--decoder", "x {in}")):
            self.assertEqual(self.set.run(*options)[0], 2)


if __name__ == "__main__":
    unittest.main()
