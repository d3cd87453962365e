# SPDX-License-Identifier: MIT
"""Zstandard frames of raw and RLE blocks (RFC 8878), which any version of this program writes alike."""
import struct

MAGIC = struct.pack("<I", 0xFD2FB528)
BLOCK = 1 << 17


def frame_header(size):
    """Single segment, content size stated, no checksum, no dictionary (RFC 8878 3.1.1.1)."""
    if size < 256:
        return MAGIC + bytes([0x20, size])
    if size < 65536 + 256:
        return MAGIC + b"\x60" + struct.pack("<H", size - 256)
    return MAGIC + b"\xa0" + struct.pack("<I", size)


def long_header(size):
    """Single segment, content size in eight bytes."""
    return MAGIC + b"\xe0" + struct.pack("<Q", size)


def window_header(size):
    """A window descriptor (1 kB), content size in four bytes."""
    return MAGIC + b"\x80\x00" + struct.pack("<I", size)


def block(kind, size, content, last):
    """One block: kind 0 raw, 1 RLE (RFC 8878 3.1.1.2)."""
    return struct.pack("<I", size << 3 | kind << 1 | last)[:3] + content


def raw(data, header=None):
    """A frame that holds `data` in raw blocks."""
    parts = [data[i:i + BLOCK] for i in range(0, len(data), BLOCK)] or [b""]
    out = frame_header(len(data)) if header is None else header
    return out + b"".join(block(0, len(p), p, i == len(parts) - 1) for i, p in enumerate(parts))


def runs(data):
    """A frame that holds runs of four and more equal bytes as RLE blocks, the rest in raw ones."""
    pieces, at = [], 0
    while at < len(data):
        end = at
        while end < len(data) and data[end] == data[at]:
            end += 1
        if end - at >= 4 or not pieces or pieces[-1][0] == 1:
            pieces.append([1 if end - at >= 4 else 0, data[at:end]])
        else:
            pieces[-1][1] += data[at:end]
        at = end
    out = frame_header(len(data))
    for i, (kind, content) in enumerate(pieces):
        out += block(kind, len(content), content[:1] if kind else content, i == len(pieces) - 1)
    return out


def without_content_size(data):
    """A frame with a window descriptor instead of the content size."""
    return raw(data, MAGIC + b"\x00\x58")


def with_dictionary(data):
    """A frame that names dictionary 1."""
    return raw(data, MAGIC + b"\x21\x01" + bytes([len(data)]))


def checksummed(data):
    """A frame of raw blocks that ends in its checksum, the low half of XXH64."""
    out = bytearray(raw(data))
    out[4] |= 4
    return bytes(out) + struct.pack("<I", xxh64(data) & 0xFFFFFFFF)


P1, P2, P3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9
P4, P5, MASK = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5, (1 << 64) - 1


def _rotate(x, n):
    return (x << n | x >> (64 - n)) & MASK


def _round(acc, lane):
    return _rotate((acc + lane * P2) & MASK, 31) * P1 & MASK


def xxh64(data):
    """XXH64 with seed 0."""
    at, count = 0, len(data)
    h = P5
    if count >= 32:
        v = [(P1 + P2) & MASK, P2, 0, -P1 & MASK]
        while at + 32 <= count:
            v = [_round(a, lane) for a, lane in zip(v, struct.unpack_from("<4Q", data, at))]
            at += 32
        h = sum(_rotate(a, n) for a, n in zip(v, (1, 7, 12, 18))) & MASK
        for a in v:
            h = ((h ^ _round(0, a)) * P1 + P4) & MASK
    h = (h + count) & MASK
    while at + 8 <= count:
        h = (_rotate(h ^ _round(0, struct.unpack_from("<Q", data, at)[0]), 27) * P1 + P4) & MASK
        at += 8
    if at + 4 <= count:
        h = (_rotate(h ^ struct.unpack_from("<I", data, at)[0] * P1 & MASK, 23) * P2 + P3) & MASK
        at += 4
    for byte in data[at:]:
        h = _rotate(h ^ byte * P5 & MASK, 11) * P1 & MASK
    h = (h ^ h >> 33) * P2 & MASK
    h = (h ^ h >> 29) * P3 & MASK
    return h ^ h >> 32
