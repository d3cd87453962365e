# SPDX-License-Identifier: MIT
"""What a decoder must do with a vector, and whether it did."""
import concurrent.futures
import os
import re
import shlex
import signal
import subprocess
import tempfile
from dataclasses import dataclass

from . import ply

CLASSES = ("corrupt", "unsupported")
PROFILES = ("lossy", "lossless", "preview")
FRAME = re.compile(r"(\d{6,})\.ply$")
SANITIZER = re.compile(rb"ERROR: \w*Sanitizer|runtime error:")


@dataclass
class Commands:
    """Commands with {in} and {out}; statuses: exit status of each class of refusal that is to be compared; what the
    decoder claims: profiles (14.5) and a level (13.4)."""
    decoder: str
    preview: str
    verify: str
    statuses: dict
    timeout: float
    profiles: tuple = PROFILES
    level: int = 6


@dataclass
class Result:
    """failures: reasons, empty if it passed. skipped: checks for which there was no command."""
    vector: dict
    failures: list
    skipped: list


@dataclass
class Outcome:
    """How a command ended. frames: mesh hash, or what is wrong, of each frame written."""
    status: int
    frames: dict
    told: bytes
    problem: str = None


def parse_statuses(texts):
    """["corrupt=1", ...] as a dictionary."""
    out = {}
    for text in texts:
        name, _, number = text.partition("=")
        if name not in CLASSES or not number.isdigit() or not 1 <= int(number) <= 125:
            raise ValueError("--status takes corrupt=N or unsupported=N, N from 1 to 125: " + text)
        out[name] = int(number)
    return out


def _command(text, path, out):
    return [w.replace("{in}", path).replace("{out}", out) for w in shlex.split(text)]


def _run(text, path, out, timeout):
    """Runs a command in a session of its own, so that nothing it started outlives the time limit."""
    with tempfile.TemporaryFile() as told:
        process = subprocess.Popen(_command(text, path, out), stdin=subprocess.DEVNULL, stdout=told,
                                   stderr=subprocess.STDOUT, start_new_session=True)
        try:
            process.wait(timeout)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            return None, b""
        told.seek(0)
        return process.returncode, told.read(1 << 16)


def _frames(folder):
    frames = {}
    for name in sorted(os.listdir(folder)):
        match = FRAME.match(name)
        if not match or name != "%06d.ply" % int(match[1]):
            frames[name] = "a file that is no frame"
            continue
        try:
            frames[int(match[1])] = ply.mesh_hash(os.path.join(folder, name))
        except (OSError, ValueError) as error:
            frames[int(match[1])] = str(error)
    return frames


def run_command(text, path, timeout):
    """Runs a command of the contract and reads what it wrote."""
    with tempfile.TemporaryDirectory(prefix="gvc-conformance-") as folder:
        try:
            status, told = _run(text, path, folder, timeout)
        except OSError as error:
            return Outcome(0, {}, b"", "cannot run the command: %s" % error)
        outcome = Outcome(status, {}, told)
        if status is None:
            outcome.problem = "not done after %g seconds" % timeout
        elif status < 0:
            outcome.problem = "died by signal %d" % -status
        elif status > 125:
            outcome.problem = "exit status %d: a shell's or a signal's" % status
        elif SANITIZER.search(told):
            outcome.problem = "a sanitizer reports an error"
        else:
            outcome.frames = _frames(folder)
        return outcome


def judge_good(vector, frames, outcome):
    """A valid file: all of `frames`, no others, exit status 0, and word of frames that are stated missing."""
    failures = []
    if outcome.status != 0:
        failures.append("refused: exit status %d" % outcome.status)
    wanted = {f["frame"]: f["mesh"] for f in frames}
    for number, mesh in wanted.items():
        if number not in outcome.frames:
            failures.append("frame %d was not written" % number)
        elif outcome.frames[number] != mesh:
            failures.append("frame %d is another mesh than it must be: %s" % (number, outcome.frames[number][:64]))
    failures += ["frame %s must not be there" % n for n in outcome.frames if n not in wanted]
    if vector.get("missing") and not outcome.told.strip():
        failures.append("nothing is told of the frames that are missing (12.8.2)")
    return failures


def judge_bad(vector, outcome, statuses):
    """A file to be refused: non-zero exit status, the right one if that is known, and no frame but good ones."""
    failures, wanted = [], statuses.get(vector["error"])
    if outcome.status == 0:
        failures.append("accepted")
    elif wanted is not None and outcome.status != wanted:
        failures.append("exit status %d, %d was wanted (%s)" % (outcome.status, wanted, vector["error"]))
    elif vector["error"] == "any" and len(statuses) == len(CLASSES) and outcome.status not in statuses.values():
        failures.append("exit status %d is that of no class" % outcome.status)
    good = {f["frame"]: f["mesh"] for f in vector["good"]}
    for number, mesh in outcome.frames.items():
        if good.get(number) != mesh:
            failures.append("frame %s was handed out, which is not good" % number)
    return failures


def judge_beyond(vector, outcome):
    """A valid file of a greater level than is claimed: decoded, or refused without a wrong frame."""
    if outcome.status == 0:
        return judge_good(vector, vector["frames"], outcome)
    return judge_bad({"error": "any", "good": vector["frames"]}, outcome, {})


def checks(vector, commands):
    """What is to be run for a vector: name of the command, and what judges how it ended."""
    statuses = commands.statuses
    if vector["profile"] not in commands.profiles:
        error = "any" if vector["category"] == "invalid" else "unsupported"
        return [("decoder", lambda o: judge_bad({"error": error, "good": []}, o, statuses))]
    if vector["category"] == "invalid":
        by = {"whole file": "verify", "preview": "preview"}.get(vector.get("checks"), "decoder")
        return [(by, lambda o: judge_bad(vector, o, statuses))]
    if vector["level"] > commands.level:
        return [("decoder", lambda o: judge_beyond(vector, o))]
    jobs = [("decoder", lambda o: judge_good(vector, vector["frames"], o))]
    if "preview" in vector:
        jobs.append(("preview", lambda o: judge_good(vector, vector["preview"], o)))
    if commands.verify:
        jobs.append(("verify", lambda o: ["refused: exit status %d" % o.status] if o.status else []))
    return jobs


def judge(vector, commands):
    """All checks of one vector."""
    failures, skipped = [], []
    for name, check in checks(vector, commands):
        command = getattr(commands, name)
        if not command:
            skipped.append(name)
            continue
        outcome = run_command(command, vector["path"], commands.timeout)
        reasons = [outcome.problem] if outcome.problem else check(outcome)
        failures += [reason if name == "decoder" else name + ": " + reason for reason in reasons]
    return Result(vector, failures, skipped)


def run_all(vectors, commands, count):
    """Judges all, `count` at a time; results in the order of the vectors."""
    vectors = [v for v in vectors if os.path.exists(v["path"])]
    with concurrent.futures.ThreadPoolExecutor(max(1, count)) as pool:
        return list(pool.map(lambda v: judge(v, commands), vectors))
