# SPDX-License-Identifier: MIT
"""zlib streams (RFC 1950, 1951) with fixed codes, made the same way for ever: no version of zlib changes a byte."""
import functools
import struct
import zlib

LENGTHS = [3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115, 131, 163, 195, 227]
DISTANCES = [1, 2, 3, 4, 5, 7, 9, 13, 17, 25, 33, 49, 65, 97, 129, 193, 257, 385, 513, 769, 1025, 1537, 2049, 3073, 4097,
             6145, 8193, 12289, 16385, 24577]


class _Bits:
    """Bits, the least significant one of a byte first."""

    def __init__(self):
        self.value, self.count = 0, 0

    def put(self, value, count):
        self.value |= value << self.count
        self.count += count

    def code(self, value, count):
        """A Huffman code: its most significant bit first."""
        self.put(int(format(value, "0%db" % count)[::-1], 2), count)


def _symbol(bits, value):
    """A literal or length symbol in the fixed code (RFC 1951, 3.2.6)."""
    if value < 144:
        bits.code(0x30 + value, 8)
    elif value < 256:
        bits.code(0x190 + value - 144, 9)
    elif value < 280:
        bits.code(value - 256, 7)
    else:
        bits.code(0xC0 + value - 280, 8)


def _match(bits, length, distance):
    """A length from 3 to 257 and a distance (RFC 1951, 3.2.5)."""
    n = max(i for i, least in enumerate(LENGTHS) if least <= length)
    _symbol(bits, 257 + n)
    bits.put(length - LENGTHS[n], 0 if n < 8 else n // 4 - 1)
    d = max(i for i, least in enumerate(DISTANCES) if least <= distance)
    bits.code(d, 5)
    bits.put(distance - DISTANCES[d], 0 if d < 4 else d // 2 - 1)


@functools.lru_cache(maxsize=256)
def compress(data):
    """A zlib stream of one block: at each place the latest match of three bytes and more is taken."""
    bits, latest, at = _Bits(), {}, 0
    bits.put(3, 3)  # last block, fixed codes
    while at < len(data):
        key = data[at:at + 3]
        before, length = latest.get(key), 0
        if before is not None and len(key) == 3 and at - before <= 32768:
            while length < 257 and at + length < len(data) and data[before + length] == data[at + length]:
                length += 1
            _match(bits, length, at - before)
        else:
            length = 1
            _symbol(bits, data[at])
        for i in range(at, at + length):
            latest[data[i:i + 3]] = i
        at += length
    _symbol(bits, 256)
    return b"\x78\x01" + bits.value.to_bytes((bits.count + 7) // 8, "little") + struct.pack(">I", zlib.adler32(data))
