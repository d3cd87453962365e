# SPDX-License-Identifier: MIT
"""Expected codes of residual images: gradient (gvc.md 6.8) and least squares (6.9)."""
import math

import numpy

CODE_AT = [(-1, 0), (0, -1), (-1, -1), (1, -1), (-2, 0), (0, -2), (2, -1)]
BEFORE_AT = [(-1, 0), (0, -1), (-1, -1), (1, -1), (1, 0), (0, 1), (1, 1), (-1, 1), (-2, 0), (0, -2), (2, -1)]


def _clamp(value):
    return min(max(value, 0), 65535)


class Gradient:
    """6.8. codes: the image so far, P: the reference, both int64 [3][S][S]."""

    def __init__(self, codes, reference):
        self.codes, self.reference = codes, reference

    def expect(self, x, y):
        """The three expected codes."""
        return [self._one(k, x, y) for k in range(3)]

    def _d(self, k, x, y):
        return int(self.codes[k, y, x] - self.reference[k, y, x])

    def _one(self, k, x, y):
        if x == 0 and y == 0:
            q = 0
        elif y == 0:
            q = self._d(k, x - 1, 0)
        elif x == 0:
            q = self._d(k, 0, y - 1)
        else:
            w, n, c = self._d(k, x - 1, y), self._d(k, x, y - 1), self._d(k, x - 1, y - 1)
            q = min(w, n) if c >= max(w, n) else max(w, n) if c <= min(w, n) else w + n - c
        return _clamp(int(self.reference[k, y, x]) + q)

    def learn(self, x, y):
        """The codes of the sample are known: nothing to note."""


def _half(table):
    """Division by 2 towards 0."""
    return (table + (table < 0)) >> 1


class LeastSquares:
    """6.9. Sums are arrays [19][18], of which only the entries of 6.9.2 are used."""

    def __init__(self, codes, reference):
        self.codes, self.reference = codes, reference
        self.size = codes.shape[1]
        self.column = numpy.zeros((self.size, 19, 18), numpy.int64)  # A[x]
        self.row = [None] * self.size  # V_x
        self.left = numpy.zeros((19, 18), numpy.int64)  # L

    def _terms(self, x, y):
        """r[k][0 .. 17] of 6.9.1."""
        last = self.size - 1
        own = []
        for dx, dy in CODE_AT:
            cx, cy = min(max(x + dx, 0), last), min(max(y + dy, 0), last)
            if (cy, cx) >= (y, x):
                cx, cy = (x - 1, y) if x else (0, y - 1)
            own.append((cx, cy))
        there = [(min(max(x + dx, 0), last), min(max(y + dy, 0), last)) for dx, dy in BEFORE_AT]
        r = numpy.empty((3, 18), numpy.int64)
        if x == 0 and y == 0:
            r[:, :7] = 0
        else:
            r[:, :7] = self.codes[:, [c[1] for c in own], [c[0] for c in own]]
            r[:, :7] -= self.reference[:, y, x][:, None]
        r[:, 7:] = self.reference[:, [c[1] for c in there], [c[0] for c in there]] - self.reference[:, y, x][:, None]
        return r

    def expect(self, x, y):
        """The three expected codes (6.9.3, 6.9.6)."""
        if x == 0:
            self.left[:] = 0
        self.terms = self._terms(x, y)
        w = weights(self.column[x] + self.left)
        out = []
        for k in range(3):
            s = 0.0
            for i in range(18):
                s = s + w[i] * float(self.terms[k, i])
            out.append(_clamp(math.floor((float(self.reference[k, y, x]) + s) + 0.5)))
        return out

    def learn(self, x, y):
        """The codes of the sample are known (6.9.3), and at the end of a row 6.9.4."""
        r, t = self.terms, self.codes[:, y, x] - self.reference[:, y, x]
        v = numpy.zeros((19, 18), numpy.int64)
        v[:18] = numpy.tril(65536 * (r.T @ r))
        v[18] = 65536 * (t @ r)
        self.column[x] = self.column[x] + self.left + v
        self.left = _half(self.left + v)
        self.row[x] = v
        if x == self.size - 1:
            total = numpy.zeros((19, 18), numpy.int64)
            for i in range(self.size - 1, -1, -1):
                self.column[i] = _half(self.column[i] + total)
                total = _half(total + self.row[i])


def weights(sums):
    """6.9.5: each operation of binary64 rounded by itself (numpy does products and differences one after the other)."""
    a = sums.astype(numpy.float64)
    for i in range(18):
        a[i, i] = a[i, i] + (a[i, i] / 65536 + 65536)
    for j in range(18):
        v = 1.0 / a[j, j]
        c = a[j + 1:, j].copy()
        a[j + 1:, j] = c * v
        product = numpy.outer(c, a[j + 1:18, j])
        a[j + 1:, j + 1:] = a[j + 1:, j + 1:] - product
    w = [float(value) for value in a[18]]
    rows = a.tolist()
    for i in range(17, 0, -1):
        for k in range(i):
            w[k] = w[k] - rows[i][k] * w[i]
    return w
