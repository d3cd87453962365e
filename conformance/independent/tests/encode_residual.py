# SPDX-License-Identifier: MIT
"""Writes residual images (gvc.md 6.6, 6.7.5), to test the decoder with both predictors."""

import os
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import numpy as np  # noqa: E402

from gvcdec.predict import Gradient, LeastSquares  # noqa: E402
from gvcdec.rangecoder import MANTISSA, SIGN  # noqa: E402
from gvcdec.residual import Magnitudes, context  # noqa: E402


class RangeEncoder:
    """6.7.5: low is kept as one great number of `scaled` bytes behind the first four."""

    def __init__(self):
        self.low, self.scaled, self.R = 0, 0, 0xFFFFFFFF
        self.z, self.n = [16384] * (SIGN + 9), [0] * (SIGN + 9)

    def put(self, bit, B):
        if bit:
            self.low += B
            self.R -= B
        else:
            self.R = B
        while self.R < 1 << 24:
            self.low <<= 8
            self.R <<= 8
            self.scaled += 1

    def bit(self, m, bit):
        z, n = self.z[m], min(self.n[m] + 1, 6)
        self.n[m] = n
        self.put(bit, (self.R >> 15) * z)
        self.z[m] = z - (z >> n) if bit else z + (32768 - z >> n)

    def residual(self, e, a, g):
        v = abs(e) + 1
        n = v.bit_length() - 1
        for i in range(n):
            self.bit(15 * a + i, 1)
        if n < 15:
            self.bit(15 * a + n, 0)
        for i in range(n):
            bit = v >> n - 1 - i & 1
            if i < 3:
                self.bit(MANTISSA + 8 * n + (v >> n - i), bit)
            else:
                self.put(bit, self.R >> 1)
        if e:
            self.bit(SIGN + g, int(e < 0))

    def bytes(self):
        return self.low.to_bytes(4 + self.scaled, "big")


def encode(codes, P, predictor, reference):
    """Residual image of codes [3, S, S] with the codes P of the frame before."""
    S = codes.shape[1]
    P = P if reference else np.zeros_like(codes)
    model = (LeastSquares if predictor else Gradient)(P, S)
    coder, sizes = RangeEncoder(), Magnitudes(S)
    for y in range(S):
        model.begin_row(y)
        for x in range(S):
            expected, now = model.expect(x), codes[:, y, x].tolist()
            extra = g = 0
            for k in range(3):
                e = (now[k] - expected[k] + 32768) % 65536 - 32768
                coder.residual(e, context(sizes.sum(k, x) + extra, k), g)
                sizes.rows[0][k][x + 2] = abs(e)
                extra += 2 * abs(e)
                sign = 0 if e == 0 else 1 if e > 0 else 2
                g = 3 * g + sign if k else sign
            model.store(x, now)
        model.end_row()
        sizes.next_row()
    return bytes([predictor, reference]) + struct.pack(">H", S) + coder.bytes()
