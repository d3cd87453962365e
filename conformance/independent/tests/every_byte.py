#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Every changed byte and every cut of a file must be refused (10.2, 10.4): every_byte.py FILE."""

import sys

from run_tests import decode_bytes


def main(path):
    """Prints what is not refused, and how often each status came out."""
    with open(path, "rb") as file:
        data = file.read()
    found = {}
    for i in range(len(data)):
        changed = data[:i] + bytes([data[i] ^ 1 << i % 8]) + data[i + 1:]
        for what, forged in (("changed", changed), ("cut", data[:i])):
            status = decode_bytes(forged)[0]
            found[what, status] = found.get((what, status), 0) + 1
            if status not in (1, 3, 4):
                print(what, hex(i), status)
    print(found)


if __name__ == "__main__":
    main(sys.argv[1])
