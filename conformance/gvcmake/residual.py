# SPDX-License-Identifier: MIT
"""Residual images: gvc.md 6.6 and the range encoder that follows from 6.7."""
import struct

import numpy

from .predict import Gradient, LeastSquares

GRADIENT, LEAST_SQUARES = 0, 1


class RangeEncoder:
    """6.7.5. `low` is one whole number of any length, so that no carry needs care."""

    def __init__(self):
        self.low, self.range, self.shifts = 0, (1 << 32) - 1, 0

    def _put(self, bit, bound):
        if bit:
            self.low += bound
            self.range -= bound
        else:
            self.range = bound
        while self.range < 1 << 24:
            self.range <<= 8
            self.low <<= 8
            self.shifts += 1

    def bit(self, model, bit):
        """A bit with a model [z, n] (6.7.3)."""
        self._put(bit, (self.range >> 15) * model[0])
        model[1] = min(model[1] + 1, 6)
        if bit:
            model[0] -= model[0] >> model[1]
        else:
            model[0] += (32768 - model[0]) >> model[1]

    def even(self, bit):
        """A bit of even odds (6.7.4)."""
        self._put(bit, self.range >> 1)

    def bytes(self):
        """All that was written."""
        return self.low.to_bytes(4 + self.shifts, "big")


def _models(*shape):
    if not shape:
        return [16384, 0]
    return [_models(*shape[1:]) for _ in range(shape[0])]


def _sign(value):
    return 0 if value == 0 else 1 if value > 0 else 2


class Residuals:
    """Writes residuals with the models of 6.6.4."""

    def __init__(self, size):
        self.coder = RangeEncoder()
        self.size_models, self.value_models, self.sign_models = _models(72, 15), _models(16, 8), _models(9)
        self.seen = numpy.zeros((3, size + 2, size + 3), numpy.int64)  # |r|, with a border of zeros

    def _context(self, k, x, y, known):
        """a of 6.6.6."""
        r = self.seen[k]
        m = int(2 * r[y + 2, x + 1] + 2 * r[y + 1, x + 2] + r[y + 1, x + 1] + r[y + 1, x + 3] + r[y + 2, x] + r[y, x + 2])
        m = 8 * (m + 2 * sum(abs(e) for e in known)) // (8 + 2 * k)
        if m < 4:
            return m
        b = m.bit_length()
        return 4 * (b - 2) + (m >> (b - 3)) % 4

    def put(self, k, x, y, e, known):
        """Residual e of component k; `known` are those of the components before."""
        u = abs(e)
        v = u + 1
        n = v.bit_length() - 1
        models = self.size_models[self._context(k, x, y, known)]
        for i in range(n):
            self.coder.bit(models[i], 1)
        if n < 15:
            self.coder.bit(models[n], 0)
        for i in range(n):
            bit = v >> (n - 1 - i) & 1
            if i < 3:
                self.coder.bit(self.value_models[n][v >> (n - i)], bit)
            else:
                self.coder.even(bit)
        if u:
            g = 0 if k == 0 else _sign(known[0]) if k == 1 else 3 * _sign(known[0]) + _sign(known[1])
            self.coder.bit(self.sign_models[g], 1 if e < 0 else 0)
        self.seen[k, y + 2, x + 2] = u


_made = {}


def encode(codes, before=None, predictor=GRADIENT):
    """A residual image as below, which is kept, for many vectors have the same."""
    key = (codes.tobytes(), None if before is None else before.tobytes(), predictor)
    if key not in _made:
        _made[key] = encode_spoiled(codes, before, predictor)
    return _made[key]


def encode_spoiled(codes, before=None, predictor=GRADIENT, spoil=None):
    """A residual image of codes [3][S][S]; before: the codes of the frame before, or None for reference 0.

    spoil(k, x, y, e) may give another residual to be written than the right one.
    """
    size = codes.shape[1]
    codes = codes.astype(numpy.int64)
    reference = numpy.zeros_like(codes) if before is None else before.astype(numpy.int64)
    predict = (Gradient, LeastSquares)[predictor](codes, reference)
    out = Residuals(size)
    for y in range(size):
        for x in range(size):
            expected, known = predict.expect(x, y), []
            for k in range(3):
                e = (int(codes[k, y, x]) - expected[k] + 32768) % 65536 - 32768
                e = spoil(k, x, y, e) if spoil else e
                out.put(k, x, y, e, known)
                known.append(e)
            predict.learn(x, y)
    return bytes([predictor, 0 if before is None else 1]) + struct.pack(">H", size) + out.coder.bytes()
