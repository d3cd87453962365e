# SPDX-License-Identifier: MIT
"""From codes of a chart to welded codes, faces, positions and digest (gvc.md 9, 10.3)."""

import struct

import numpy as np


def welded_codes(codes, weld):
    """Codes of the vertices, int64 [V, 3], of codes [3, S, S] (9.2.1)."""
    flat = codes.reshape(3, -1)
    border = np.asarray(weld.border_vertex)
    vertices, index = np.unique(border, return_inverse=True)
    k = np.bincount(index)
    result = np.empty((weld.V, 3), dtype=np.int64)
    for c in range(3):
        result[:, c] = flat[c][weld.first]
        # Sums stay below 2^53, so the binary64 numbers of bincount are exact (9.2.2).
        s = np.bincount(index, weights=flat[c][weld.border].astype(np.float64)).astype(np.int64)
        result[vertices, c] = (2 * s + k) // (2 * k)
    return result


def through_bd(welded, weld):
    """bool [S-1, S-1]: whether the diagonal of a square is bd (9.3.2)."""
    S, v, folds = weld.S, weld.vertex, weld.folds
    a, b, c, d = v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]
    length = [np.zeros((S - 1, S - 1), dtype=np.int64) for _ in range(2)]
    for k in range(3):
        code = welded[:, k]
        length[0] += (code[a] - code[c]) ** 2
        length[1] += (code[b] - code[d]) ** 2
    bd = length[0] > length[1]
    bd[folds[:-1, 1:] | folds[1:, :-1]] = True
    bd[folds[:-1, :-1] | folds[1:, 1:]] = False
    bd[0, 0] = bd[-1, -1] = False
    bd[0, -1] = bd[-1, 0] = True
    return bd


def faces_of(welded, weld):
    """Faces of a chart, int32 [2 (S-1)^2, 3], vertices counted from 0 (9.3.1)."""
    S, v = weld.S, weld.vertex
    a, b, c, d = v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]
    bd = through_bd(welded, weld)
    faces = np.empty((S - 1, S - 1, 6), dtype=np.int32)
    faces[..., 0] = a
    faces[..., 1] = b
    faces[..., 2] = np.where(bd, d, c)
    faces[..., 3] = np.where(bd, b, a)
    faces[..., 4] = c
    faces[..., 5] = d
    return faces.reshape(-1, 3)


def positions_of(welded, chart):
    """Positions, float32 [V, 3] (9.5.1): product, sum and result rounded one by one."""
    product = welded.astype(np.float64) * np.float64(chart.step)
    return (product + np.array(chart.origin, dtype=np.float64)).astype(np.float32)


def add_digest(digest, welded, faces):
    """Put a chart into a SHA-256 object (10.3.1)."""
    digest.update(struct.pack(">II", len(welded), len(faces)))
    digest.update(welded.astype(">u2").tobytes())
    digest.update(faces.astype(">u4").tobytes())
