# SPDX-License-Identifier: MIT
"""What the generator computes is what the specification gives as examples, and what other decoders make of it."""
import os
import sys
import unittest
import zlib

import numpy

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from gvcmake import content, deflate, exr, pictures, residual, surface, zstd  # noqa: E402
from gvcmake.bits import BitWriter, escape  # noqa: E402
from gvcmake.boxes import crc32  # noqa: E402
from gvcmake.h264 import Stream  # noqa: E402
from gvcmake.shape import varint  # noqa: E402
from gvcmake.tables import chart  # noqa: E402


class SpecificationTest(unittest.TestCase):
    """Examples of gvc.md."""

    def test_numbers(self):
        """2.4, 10."""
        self.assertEqual((varint(300), varint(0)), (b"\xac\x02", b"\0"))
        self.assertEqual(crc32(b"123456789"), 0xCBF43926)

    def test_weld(self):
        """8.3, 8.4.2 and 8.5."""
        vertex, fold = surface.weld(16, 4, (30,), (0, 1))
        self.assertEqual(vertex[0].tolist(), [0, 1, 2, 3, 4, 3, 2, 1, 0, 5, 6, 7, 8, 9, 10, 11])
        self.assertEqual(vertex[1].tolist(), [5] + list(range(12, 26)) + [26])
        self.assertEqual(vertex.max() + 1, 227)
        self.assertEqual(numpy.argwhere(fold).tolist(), [[0, 4], [15, 11]])
        sets = surface.border_sets(16, 8, [9, 10, 11], [0, 1, 2, 3, 4, 5])
        self.assertEqual({sets[p] for p in (8, 26, 46)}, {sets[8]})
        torus = surface.border_sets(16, 0, [15, 15], [0, 2, 1, 3])
        self.assertEqual({torus[p] for p in (0, 15, 30, 45)}, {0})

    def test_annex_b(self):
        """The sides of the file in Annex B."""
        steps, sides = (2, 4, 5, 6, 2, 7, 8), (0, 4, 5, 2, 3, 6, 7, 1, 8, 10, 11, 12, 13, 9)
        vertex, fold = surface.weld(18, 16, steps, sides)
        self.assertEqual(vertex[0].tolist(), [0, 1, 2, 3, 4, 5, 6, 5, 4, 3, 2, 1, 0, 7, 8, 9, 10, 11])
        self.assertEqual(vertex[1].tolist(), [7] + list(range(12, 29)))
        self.assertEqual(vertex.max() + 1, 291)
        columns, rows = surface.border_pixels(18)
        self.assertEqual([p for p in range(68) if fold[rows[p], columns[p]]], [6, 23, 32, 42, 59])

    def test_codes(self):
        """9.2.3 and 9.5.1, with the numbers of Annex B."""
        for codes, mean in (([32704, 32896], 32800), ([32704, 32704, 32768], 32725)):
            vertex = numpy.zeros((1, len(codes)), int)
            self.assertEqual(surface.welded_codes(vertex, numpy.array([[codes]] * 3))[0].tolist(), [mean] * 3)
        origin = (-0.79130279294174111, -0.031389622290808883, -0.79866144432019071)
        found = surface.positions(numpy.array([[28768, 23168, 32416]]), origin, 2.7005239007157232e-05)
        self.assertEqual(found.tolist(), numpy.array([[-0.014416077, 0.5942677, 0.076740384]], numpy.float32).tolist())

    def test_halves(self):
        """6.5.4."""
        for code, bits in ((0, (0, 0x3800)), (65535, (0x3BFF, 0x381F)), (32768, (0x3800, 0x3800)), (33, (0x1000, 0x3801))):
            found = exr.halves(numpy.full((3, 1, 1), code, numpy.uint16))
            self.assertEqual((int(found[0, 0, 0]), int(found[1, 0, 0])), bits)


class RangeDecoder:
    """6.7.1 to 6.7.4, to read back what the encoder writes."""

    def __init__(self, data):
        self.range, self.d, self.rest = (1 << 32) - 1, int.from_bytes(data[:4], "big"), data[4:]

    def _read(self, bound):
        bit = self.d >= bound
        self.d, self.range = (self.d - bound, self.range - bound) if bit else (self.d, bound)
        while self.range < 1 << 24:
            self.range, self.d, self.rest = self.range << 8, self.d << 8 | self.rest[0], self.rest[1:]
        return int(bit)

    def bit(self, model):
        """A bit with a model."""
        bit = self._read((self.range >> 15) * model[0])
        model[1] = min(model[1] + 1, 6)
        model[0] += -(model[0] >> model[1]) if bit else (32768 - model[0]) >> model[1]
        return bit

    def even(self):
        """A bit of even odds."""
        return self._read(self.range >> 1)


class CodersTest(unittest.TestCase):
    """Coders against decoders."""

    def test_range_coder(self):
        """What was written is read, and nothing is left."""
        lcg, coder, one, other = content.Lcg(1), residual.RangeEncoder(), [16384, 0], [16384, 0]
        bits = [int(lcg.below(9) == 0) for _ in range(3000)]
        for i, bit in enumerate(bits):
            coder.even(bit) if i % 7 == 0 else coder.bit(one, bit)
        decoder = RangeDecoder(coder.bytes())
        found = [decoder.even() if i % 7 == 0 else decoder.bit(other) for i in range(len(bits))]
        self.assertEqual(found, bits)
        self.assertEqual((decoder.d, decoder.rest), (0, b""))

    def test_deflate(self):
        """zlib reads what is written."""
        lcg = content.Lcg(2)
        for limit in (1, 2, 40, 256):
            data = bytes(lcg.below(limit) for _ in range(5000)) + b"abcabcabc" * 40
            self.assertEqual(zlib.decompress(deflate.compress(data)), data)

    def test_xxh64(self):
        """Known values."""
        self.assertEqual(zstd.xxh64(b""), 0xEF46DB3751D8E999)
        self.assertEqual(zstd.xxh64(b"abc"), 0x44BC2CF5AD770999)

    def test_h264_bits(self):
        """Codes of 9.1 of ISO/IEC 14496-10, and 7.4.1."""
        b = BitWriter()
        for value in (0, 1, 2, 3, 7):
            b.ue(value)
        for value in (1, -1, 2):
            b.se(value)
        self.assertEqual("".join(b.parts), "1" "010" "011" "00100" "0001000" "010" "011" "00100")
        self.assertEqual(escape(b"\0\0\0\0\0\1\0\0\4"), b"\0\0\3\0\0\3\0\1\0\0\4")

    def test_prediction(self):
        """Intra_16x16 from a ramp goes on with the ramp; from nothing it is 512."""
        stream = Stream(32, 32)
        ramp = numpy.add.outer(4 * numpy.arange(32), 8 * numpy.arange(32)).astype(numpy.uint16)
        mbs = [pictures.pcm(ramp, stream, at) for at in range(3)] + [("intra", 3)]
        self.assertTrue((pictures.reconstruct(stream, mbs) == ramp).all())
        self.assertTrue((pictures.reconstruct(stream, [("intra", 2)] * 4) == 512).all())


class TablesTest(unittest.TestCase):
    """Charts that vectors use keep the rules of 8.2."""

    def test_genus(self):
        """8.5."""
        for genus in range(5):
            c = chart(16, (0,), genus)
            border = len(set(surface.border_sets(16, c.start, c.steps, c.sides)))
            self.assertEqual((31 - border) // 2, genus)
            self.assertEqual(len(c.nodes), len(c.edges) + 1 - 2 * genus)
            self.assertEqual(sum(c.steps), 30)


if __name__ == "__main__":
    unittest.main()
