# SPDX-License-Identifier: MIT
"""Predictors of residual images (gvc.md 6.8, 6.9).

Both have: begin_row(y), expect(x): the three expected codes, store(x, codes), end_row(),
codes(): int64 [3, S, S].
"""

import math

import numpy as np

CODE = ((-1, 0), (0, -1), (-1, -1), (1, -1), (-2, 0), (0, -2), (2, -1))
BEFORE = ((-1, 0), (0, -1), (-1, -1), (1, -1), (1, 0), (0, 1), (1, 1), (-1, 1), (-2, 0), (0, -2),
          (2, -1))
T = 18  # row of sums that belongs to the codes themselves


class Gradient:
    """6.8."""

    def __init__(self, P, S):
        self.S = S
        self.P = P
        self.result = np.zeros((3, S, S), dtype=np.int64)
        self.d = [[0] * S for _ in range(3)]
        self.above = None

    def begin_row(self, y):
        """Row y begins."""
        self.y = y
        self.above = self.d if y else None
        self.d = [[0] * self.S for _ in range(3)]
        self.p = self.P[:, y].tolist()
        self.row = [[0] * self.S for _ in range(3)]

    def expect(self, x):
        """Expected codes at column x (6.8.1)."""
        return [min(max(self.p[k][x] + self.gradient(k, x), 0), 65535) for k in range(3)]

    def gradient(self, k, x):
        """q of 6.8.1."""
        if self.above is None:
            return self.d[k][x - 1] if x else 0
        N = self.above[k][x]
        if x == 0:
            return N
        W, C = self.d[k][x - 1], self.above[k][x - 1]
        if C >= max(W, N):
            return min(W, N)
        if C <= min(W, N):
            return max(W, N)
        return W + N - C

    def store(self, x, codes):
        """Take the codes found at column x."""
        for k in range(3):
            self.row[k][x] = codes[k]
            self.d[k][x] = codes[k] - self.p[k][x]

    def end_row(self):
        """The row is over."""
        self.result[:, self.y] = self.row

    def codes(self):
        """All codes."""
        return self.result


def half(values):
    """Division by 2 rounded towards 0 (6.9.2), of integers below 2^53 in binary64."""
    return np.trunc(values * 0.5)


def clamped(y, S, terms):
    """int64 [S, len(terms)] rows and columns of neighbours of row y, clamped to the image."""
    dx, dy = np.array(terms).T
    return (np.clip(np.arange(S)[:, None] + dx, 0, S - 1),
            np.broadcast_to(np.clip(y + dy, 0, S - 1), (S, len(terms))))


def neighbours(y, S):
    """Places of the eighteen terms of each sample of row y (6.9.1), int64 [S, 18].

    Places 0 to S*S - 1 are samples of `code`, those from S*S on are of P.
    """
    x = np.arange(S)[:, None]
    column, row = clamped(y, S, CODE)
    place = row * S + column
    instead = np.where(x > 0, y * S + x - 1, max(y - 1, 0) * S)
    code = np.where(place < y * S + x, place, instead)
    column, row = clamped(y, S, BEFORE)
    return np.concatenate([code, S * S + row * S + column], axis=1)


def weights(M):
    """The eighteen weights of sums M, float64 [19, 19] (lower triangle), by 6.9.5.

    Every elementwise operation of numpy is rounded by itself, so the order within one step j
    does not matter.  The upper triangle is never read.
    """
    a = M.copy()
    diagonal = a.ravel()[::20][:T]
    diagonal += diagonal / 65536 + 65536
    for j in range(T):
        c = a[j + 1:, j]
        scaled = c * (1 / a[j, j])
        a[j + 1:, j + 1:T] -= c[:, None] * scaled[:-1]
        a[j + 1:, j] = scaled
    w = a[T, :T].copy()
    for i in range(T - 1, 0, -1):
        w[:i] -= a[i, :i] * w[i]
    return w


class LeastSquares:
    """6.9.  Sums are kept as float64 [19, 19]: integers below 2^53 are exact in it."""

    def __init__(self, P, S):
        self.S = S
        # code and P side by side, so that terms are one indexed read.
        self.both = np.concatenate([np.zeros((3, S * S)), P.reshape(3, -1)], axis=1)
        self.A = np.zeros((S, T + 1, T + 1))
        self.V = np.zeros((S, T + 1, T + 1))
        self.r = np.zeros((3, T + 1))

    def begin_row(self, y):
        """Row y begins: L is 0 (6.9.2)."""
        self.y = y
        self.L = np.zeros((T + 1, T + 1))
        self.places = neighbours(y, self.S)

    def expect(self, x):
        """Expected codes at column x (6.9.1, 6.9.6)."""
        at = self.y * self.S + x
        p = self.both[:, self.S * self.S + at]
        r = self.r
        r[:, :T] = self.both.take(self.places[x], axis=1)
        r[:, :T] -= p[:, None]
        if at == 0:
            r[:, :len(CODE)] = 0
        self.p, self.at = p, at
        self.M = self.A[x] + self.L
        products = weights(self.M) * r[:, :T]
        # accumulate() adds strictly one by one, as 6.9.6 wants it.
        s = np.add.accumulate(products, axis=1)[:, -1]
        return [min(max(math.floor(v), 0), 65535) for v in (p + s + 0.5).tolist()]

    def store(self, x, codes):
        """Take the codes found at column x into the sums (6.9.3)."""
        self.both[:, self.at] = codes
        self.r[:, T] = self.both[:, self.at] - self.p
        V = self.V[x]
        np.matmul(self.r.T, self.r, out=V)  # integers below 2^53: exact in any order
        V *= 65536
        np.add(self.M, V, out=self.A[x])
        self.L = half(self.L + V)

    def end_row(self):
        """The row is over (6.9.4)."""
        sum_ = np.zeros((T + 1, T + 1))
        for x in range(self.S - 1, -1, -1):
            self.A[x] = half(self.A[x] + sum_)
            sum_ = half(sum_ + self.V[x])

    def codes(self):
        """All codes."""
        return self.both[:, :self.S * self.S].astype(np.int64).reshape(3, self.S, self.S)
