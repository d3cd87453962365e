#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Decode a gvc file to PLY files: gvc_decode.py [--preview] IN OUT_FOLDER."""

import mmap
import os
import sys

from gvcdec.container import GvcFile, check_count
from gvcdec.errors import Refusal
from gvcdec.frames import decode
from gvcdec.ply import write_ply

USAGE = "usage: gvc_decode.py [--preview] IN OUT_FOLDER"


def open_file(path):
    """Bytes of a file, as a memoryview."""
    with open(path, "rb") as source:
        if os.fstat(source.fileno()).st_size == 0:
            return memoryview(b"")
        return memoryview(mmap.mmap(source.fileno(), 0, access=mmap.ACCESS_READ))


def run(path, folder, preview):
    """Decode path into folder; returns the exit status."""
    file = GvcFile(open_file(path))
    if preview and not file.head.preview:
        print(f"{path}: no previews: the file has not both tracks (6.4.1)", file=sys.stderr)
        return 2
    for first, count in file.gaps:
        print(f"{path}: frames {first} to {first + count - 1} are missing (12.8)", file=sys.stderr)
    os.makedirs(folder, exist_ok=True)
    for number, parts in decode(file, preview):
        write_ply(os.path.join(folder, f"{number:06d}.ply"), parts)
    check_count(file)
    return 0


def main(arguments):
    """Exit status: 0 good, 1 damaged, 2 usage, 3 unsupported, 4 limit, 5 internal error."""
    preview = "--preview" in arguments
    names = [a for a in arguments if a != "--preview"]
    if len(names) != 2 or any(n.startswith("--") for n in names):
        print(USAGE, file=sys.stderr)
        return 2
    try:
        return run(names[0], names[1], preview)
    except Refusal as refusal:
        print(refusal.line(names[0]), file=sys.stderr)
        return refusal.status
    except OSError as error:
        print(f"{names[0]}: {error}", file=sys.stderr)
        return 2
    except MemoryError:
        print(f"{names[0]}: limit: clause 13.3: not enough memory", file=sys.stderr)
        return 4
    except Exception as error:  # pylint: disable=broad-except
        print(f"{names[0]}: internal error: {type(error).__name__}: {error}", file=sys.stderr)
        return 5


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
