# SPDX-License-Identifier: MIT
"""A decoder for tests of the runner: its files say in JSON what to do with them."""
import json
import os
import signal
import struct
import sys
import time


def write_ply(path, height):
    """A triangle at some height."""
    points = struct.pack("<9f", 0, 0, height, 1, 0, height, 0, 1, height)
    head = ("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n")
    with open(path, "wb") as stream:
        stream.write(head.encode() + points + struct.pack("<B3i", 3, 0, 1, 2))


def main():
    """fake_decoder.py KEY IN [OUT]: does what IN says under KEY."""
    with open(sys.argv[2], encoding="utf-8") as stream:
        plan = json.load(stream)[sys.argv[1]]
    for frame, height in plan.get("frames", {}).items():
        write_ply(os.path.join(sys.argv[3], "%06d.ply" % int(frame)), height)
    for name in plan.get("files", []):
        with open(os.path.join(sys.argv[3], name), "wb") as stream:
            stream.write(b"something else")
    print(plan.get("say", ""))
    if "signal" in plan:
        os.kill(os.getpid(), getattr(signal, plan["signal"]))
    time.sleep(plan.get("sleep", 0))
    return plan.get("status", 0)


if __name__ == "__main__":
    sys.exit(main())
