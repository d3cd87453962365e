#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The whole conformance set: run_vectors.py [FOLDER].  Exit status 0 if all is as it must be.

Files in core/ and extended/ must be decoded with status 0, those in invalid/ refused with 1 or 3.
"""

import glob
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.environ.get("GVC_VECTORS", os.path.join(HERE, "..", ".."))
DECODER = os.path.join(HERE, "..", "gvc_decode.py")
ALLOWED = {"core": (0,), "extended": (0,), "invalid": (1, 3)}


def status_of(path):
    """(exit status, last line of messages) of the decoder."""
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([sys.executable, DECODER, path, out], stderr=subprocess.PIPE,
                              stdout=subprocess.PIPE, check=False)
    return done.returncode, done.stderr.decode("utf-8", "replace").strip()


def main(folder):
    """Run all files, two at a time."""
    bad = 0
    with ThreadPoolExecutor(2) as pool:
        for kind, allowed in ALLOWED.items():
            paths = sorted(glob.glob(os.path.join(folder, kind, "*.gvc")))
            counts = {}
            for path, (status, line) in zip(paths, pool.map(status_of, paths)):
                counts[status] = counts.get(status, 0) + 1
                if status not in allowed:
                    bad += 1
                    print(f"BAD {kind}/{os.path.basename(path)}: {status} {line}")
            print(f"{kind}: {len(paths)} files, by status: {sorted(counts.items())}")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main(*(sys.argv[1:] or [FOLDER])))
