# SPDX-License-Identifier: MIT
"""Residual images (gvc.md 6.6)."""

import numpy as np

from .errors import Damaged, Unsupported
from .predict import Gradient, LeastSquares
from .rangecoder import RangeDecoder

HEADER = 4


def context(m, k):
    """a of 6.6.6 from the weighted sum m of magnitudes for component k."""
    m = 8 * m // (8 + 2 * k)
    if m < 4:
        return m
    b = m.bit_length()
    return 4 * (b - 2) + (m >> b - 3) % 4


class Magnitudes:
    """|r(k, x, y)| of the rows read so far: lists with two zeros before and one behind."""

    def __init__(self, S):
        self.rows = [[[0] * (S + 3) for _ in range(3)] for _ in range(3)]  # y, y - 1, y - 2

    def next_row(self):
        """The next row begins."""
        last = self.rows.pop()
        for row in last:
            row[:] = [0] * len(row)
        self.rows.insert(0, last)

    def sum(self, k, x):
        """Weighted sum of 6.6.6 without the components of the same sample."""
        here, above, top = (row[k] for row in self.rows)
        x += 2
        return (2 * (here[x - 1] + above[x]) + above[x - 1] + above[x + 1] + here[x - 2] + top[x])


def read_sample(coder, sizes, x):
    """The three residuals of a sample (6.6.4 to 6.6.6)."""
    here = sizes.rows[0]
    result, extra, g = [], 0, 0
    for k in range(3):
        e = coder.residual(context(sizes.sum(k, x) + extra, k), g)
        result.append(e)
        here[k][x + 2] = abs(e)
        extra += 2 * abs(e)
        sign = 0 if e == 0 else 1 if e > 0 else 2
        g = 3 * g + sign if k else sign
    return result


def read_residual(image, S, before):
    """Codes, int64 [3, S, S], of a residual image; before: codes of the frame before."""
    if len(image) < HEADER:
        raise Damaged("6.6.1", "residual image ends early")
    predictor, reference = image[0], image[1]
    if predictor > 1 or reference > 1:
        raise Unsupported("6.6.2", f"residual image with predictor {predictor}, "
                                   f"reference {reference}")
    size = int.from_bytes(image[2:4], "big")
    if size != S:
        raise Damaged("6.6.2", f"residual image of size {size}, the chart has {S}")
    P = before if reference else np.zeros((3, S, S), dtype=np.int64)
    model = (LeastSquares if predictor else Gradient)(P, S)
    coder, sizes = RangeDecoder(image[HEADER:]), Magnitudes(S)
    for y in range(S):
        model.begin_row(y)
        for x in range(S):
            expected = model.expect(x)
            e = read_sample(coder, sizes, x)
            model.store(x, [(p + r) & 0xFFFF for p, r in zip(expected, e)])
        model.end_row()
        sizes.next_row()
    coder.check_end()
    return model.codes()
