#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Forged files and what the decoder must say of them: run_tests.py [-v].  Exit status 0 or 1.

GVC_VECTORS names the folder with core/example.gvc; without it that of the repository is taken.
"""

import importlib
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import samples  # noqa: E402
from forge import Parts  # noqa: E402
from gvcdec.container import GvcFile, check_count  # noqa: E402
from gvcdec.errors import Refusal  # noqa: E402
from gvcdec.frames import decode  # noqa: E402

GROUPS = ("cases_head", "cases_index", "cases_fragment", "cases_record", "cases_parameters",
          "cases_video", "cases_exact", "cases_good")


def decode_bytes(data):
    """(status, clause, line) of a file held in memory."""
    try:
        file = GvcFile(memoryview(data))
        frames = sum(1 for _ in decode(file, False))
        check_count(file)
        return 0, "", f"{frames} frames"
    except Refusal as refusal:
        return refusal.status, refusal.clause, refusal.line("file")


def main():
    """Run all cases; number of wrong ones decides the status."""
    files = samples.all_files()
    bad = total = 0
    for name, data in files.items():
        found = decode_bytes(data)
        total += 1
        if found[0]:
            bad += 1
            print(f"BAD {name} as it is: {found[2]}")
    for group in GROUPS:
        for name, base, status, clause, change in importlib.import_module(group).CASES:
            parts = Parts(files[base])
            data = change(parts)
            found = decode_bytes(parts.build() if data is None else data)
            total += 1
            right = found[0] == status and (not clause or found[1] == clause)
            bad += not right
            if not right or "-v" in sys.argv:
                print(f"{'ok ' if right else 'BAD'} {name}: wanted {status} {clause}, "
                      f"found {found[0]} {found[1]}: {found[2]}")
    print(f"{total} cases, {bad} wrong")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
