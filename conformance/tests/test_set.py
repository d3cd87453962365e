# SPDX-License-Identifier: MIT
"""generate --check and matrix --check notice what they are for."""
import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SPEC = """# A format

### 4.3 File head

| box | count | constraint | |
|---|---|---|---|
| `ftyp` | 1 | 4.3.1 | R |
| `mvhd` | 1 | | W |

**4.3.1** A decoder MUST reject
what is wrong.

**4.3.2** Something informative.

### 8.2 Rules

**8.2.1** A decoder MUST reject a table unless

1. this
2. that

**9.1** Writers MUST NOT lie.

```
this MUST be code
```
"""
VECTORS = [("core/a", ["4.3.1", "4.3 ftyp", "4.3.2"]), ("invalid/b", ["8.2.1", "8.2(1)", "8.2(2)"])]
UNTESTED = {"9.1": "binds writers only"}


class MatrixTest(unittest.TestCase):
    """The program matrix on a small specification."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def _matrix(self, *options, spec=SPEC, vectors=None, untested=None):
        path = self.folder.name
        entries = [{"name": n, "category": n.split("/")[0], "clauses": c} for n, c in (vectors or VECTORS)]
        for name, text in (("spec.md", spec), ("manifest.json", json.dumps({"vectors": entries})),
                           ("untested.json", json.dumps(UNTESTED if untested is None else untested))):
            with open(os.path.join(path, name), "w", encoding="utf-8") as stream:
                stream.write(text)
        done = subprocess.run([sys.executable, FOLDER + "/matrix", "--spec", path + "/spec.md", "--folder", path, *options],
                              stdout=subprocess.PIPE, text=True, check=False)
        return done.returncode, done.stdout

    def test_good(self):
        """Written, and then not stale."""
        self.assertEqual(self._matrix("--check")[0], 1)
        self.assertEqual(self._matrix(), (0, "6 requirements, 1 of them not tried by vectors\n"))
        self.assertEqual(self._matrix("--check")[0], 0)
        with open(self.folder.name + "/matrix.md", encoding="utf-8") as stream:
            self.assertIn("| 8.2(2) | that | invalid/b |", stream.read())

    def test_problems(self):
        """Each thing that can be wrong."""
        cases = {"9.1 is covered by no vector": {"untested": {}},
                 "8.2(2) is covered by no vector": {"vectors": [VECTORS[0], ("invalid/b", ["8.2.1", "8.2(1)"])]},
                 "4.3 ftyp is covered by no vector": {"vectors": [("core/a", ["4.3.1"]), VECTORS[1]]},
                 "9.1 is tried by vectors": {"vectors": VECTORS + [("core/c", ["9.1"])]},
                 "7.7 is named by core/c": {"vectors": VECTORS + [("core/c", ["7.7"])]},
                 "4.3.2 is in untested.json": {"untested": {**UNTESTED, "4.3.2": "why"}},
                 "9.1 has no reason": {"untested": {"9.1": " "}},
                 "MUST outside of a clause": {"spec": SPEC + "\n## 10 More\n\nThis MUST be.\n"}}
        for word, change in cases.items():
            with self.subTest(word):
                self._matrix(**change)
                status, text = self._matrix("--check", **change)
                self.assertEqual(status, 1)
                self.assertIn(word, text)

    def test_stale(self):
        """A vector more makes the table stale."""
        self._matrix()
        status, text = self._matrix("--check", vectors=VECTORS + [("core/c", ["4.3.1"])])
        self.assertEqual(status, 1)
        self.assertIn("stale", text)


class GenerateTest(unittest.TestCase):
    """What generate --check compares."""

    def test_differences(self):
        """A file that is missing, differs, or does not belong."""
        loader = importlib.machinery.SourceFileLoader("generate", FOLDER + "/generate")
        generate = importlib.util.module_from_spec(importlib.util.spec_from_loader("generate", loader))
        loader.exec_module(generate)
        wanted = {"core/a.gvc": b"one", "invalid/b.gvc": b"two", "manifest.json": b"{}"}
        with tempfile.TemporaryDirectory() as folder:
            generate.HERE = folder
            self.assertEqual(len(generate.differences(wanted)), 3)
            generate.write(wanted)
            self.assertEqual(generate.differences(wanted), [])
            changed = dict(wanted, **{"core/a.gvc": b"One"})
            self.assertEqual(generate.differences(changed), ["core/a.gvc differs"])
            self.assertEqual(generate.differences({k: v for k, v in wanted.items() if k[0] != "c"}),
                             ["core/a.gvc is not made by this program"])
            generate.write({k: v for k, v in wanted.items() if k[0] != "c"})
            self.assertEqual(generate.differences(wanted), ["core/a.gvc is missing"])


if __name__ == "__main__":
    unittest.main()
