# SPDX-License-Identifier: MIT
"""Writes OpenEXR images of codes (gvc.md 6.5), with each compression."""

import struct
import zlib

import numpy as np

NONE, RLE, ZIPS, ZIP = 0, 1, 2, 3


def channels(*names, kind=1, sampling=1):
    """Value of the attribute `channels`."""
    return b"".join(n + b"\0" + struct.pack("<iIii", kind, 0, sampling, sampling)
                    for n in names) + b"\0"


SIX = (b"X", b"X.lo", b"Y", b"Y.lo", b"Z", b"Z.lo")


def attributes(S, compression=ZIP):
    """[[name, type, value]] of a header."""
    window = struct.pack("<4i", 0, 0, S - 1, S - 1)
    return [[b"channels", b"chlist", channels(*SIX)],
            [b"compression", b"compression", bytes([compression])],
            [b"dataWindow", b"box2i", window], [b"displayWindow", b"box2i", window],
            [b"gvcOrigin", b"v3d", struct.pack("<3d", 0, 0, 0)],
            [b"gvcStep", b"double", struct.pack("<d", 1)],
            [b"gvcTime", b"double", struct.pack("<d", 0)],
            [b"gvcVersion", b"int", bytes(4)],
            [b"lineOrder", b"lineOrder", b"\0"],
            [b"pixelAspectRatio", b"float", struct.pack("<f", 1)],
            [b"screenWindowCenter", b"v2f", bytes(8)],
            [b"screenWindowWidth", b"float", struct.pack("<f", 1)]]


def header_bytes(start, items):
    """Header with its first eight bytes `start`."""
    return start + b"".join(n + b"\0" + t + b"\0" + struct.pack("<i", len(v)) + v
                            for n, t, v in items) + b"\0"


def run_lengths(data):
    """RLE of 6.5.2.2."""
    out, at = b"", 0
    while at < len(data):
        run = 1
        while at + run < len(data) and data[at + run] == data[at] and run < 128:
            run += 1
        if run > 2:
            out += bytes([run - 1, data[at]])
        else:
            run = min(100, len(data) - at)
            out += bytes([256 - run]) + data[at:at + run]
        at += run
    return out


def pack(raw, compression):
    """Size and bytes of a chunk (6.5.2.2)."""
    out = raw
    if compression != NONE:
        mixed = raw[0::2] + raw[1::2]
        mixed = mixed[:1] + bytes((b - a + 128) & 255 for a, b in zip(mixed, mixed[1:]))
        out = run_lengths(mixed) if compression == RLE else zlib.compress(mixed)
        if len(out) >= len(raw):
            out = raw
    return struct.pack("<i", len(out)) + out


def file_bytes(head, pixels, S, compression):
    """A file of a header and the bytes of its pixels [S][6][S]."""
    lines, row = 16 if compression == ZIP else 1, 12 * S
    chunks = [struct.pack("<i", y) + pack(pixels[y * row:(y + lines) * row], compression)
              for y in range(0, S, lines)]
    offsets, place = [], len(head) + 8 * len(chunks)
    for chunk in chunks:
        offsets.append(place)
        place += len(chunk)
    return head + struct.pack(f"<{len(offsets)}Q", *offsets) + b"".join(chunks)


def write_exr(codes, compression=ZIP):
    """OpenEXR file of codes [3, S, S]."""
    S = codes.shape[1]
    pixels = np.empty((S, 6, S), dtype="<u2")
    high = (codes // 32 / 2048).astype(np.float16).view(np.uint16)
    pixels[:, 0::2] = high.transpose(1, 0, 2)
    pixels[:, 1::2] = (0x3800 + codes % 32).transpose(1, 0, 2)
    head = header_bytes(b"\x76\x2f\x31\x01\2\0\0\0", attributes(S, compression))
    return file_bytes(head, pixels.tobytes(), S, compression)
