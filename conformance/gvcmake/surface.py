# SPDX-License-Identifier: MIT
"""From side tables and codes to meshes: gvc.md clauses 8, 9 and 10.3, by arrays."""
import functools
import hashlib
import struct

import numpy


def border_pixels(size):
    """Columns and rows of the border positions 0 ... P-1 (8.1.1)."""
    last, run = size - 1, numpy.arange(size - 1)
    zero, full = numpy.zeros(size - 1, int), numpy.full(size - 1, last)
    return numpy.concatenate([run, full, last - run, zero]), numpy.concatenate([zero, run, full, last - run])


def begins(steps, sides, start):
    """Where the forward and the reversed side of each edge begin (8.1.2), not taken modulo P."""
    begin = [[None, None] for _ in steps]
    at = start
    for side in sides:
        begin[side >> 1][side & 1] = at
        at += steps[side >> 1]
    return begin


def border_sets(size, start, steps, sides):
    """The least border position of the vertex of each border position (8.1.3)."""
    count = 4 * (size - 1)
    parent = list(range(count))

    def find(p):
        while parent[p] != p:
            parent[p] = parent[parent[p]]
            p = parent[p]
        return p

    for (forward, backward), n in zip(begins(steps, sides, start), steps):
        for j in range(n + 1):
            a, b = find((forward + j) % count), find((backward + n - j) % count)
            parent[max(a, b)] = min(a, b)
    return [find(p) for p in range(count)]


@functools.lru_cache(maxsize=64)
def weld(size, start, steps, sides):
    """Vertex numbers of all samples as an array [row][column] (8.4.1), and the folds as one of bool (9.3.2)."""
    sets = numpy.array(border_sets(size, start, steps, sides))
    columns, rows = border_pixels(size)
    key = numpy.arange(size * size).reshape(size, size)
    key[rows, columns] = size * size + sets
    _, first, inverse = numpy.unique(key, return_index=True, return_inverse=True)
    rank = numpy.empty(len(first), numpy.int64)
    rank[numpy.argsort(first)] = numpy.arange(len(first))
    fold = numpy.zeros((size, size), bool)
    fold[rows, columns] = numpy.roll(sets, 1) == numpy.roll(sets, -1)
    return rank[inverse.reshape(-1)].reshape(size, size), fold


def welded_codes(vertex, codes):
    """The code of each vertex: mean of its samples, half rounded up (9.2.1). An array [V][3]."""
    flat = vertex.reshape(-1)
    count = numpy.bincount(flat)
    out = numpy.empty((len(count), 3), numpy.int64)
    for k in range(3):
        total = numpy.bincount(flat, weights=codes[k].reshape(-1).astype(float)).astype(numpy.int64)
        out[:, k] = (2 * total + count) // (2 * count)
    return out


def diagonals(vertex, fold, welded):
    """Whether the diagonal of each square is ac (9.3.2)."""
    fa, fb, fc, fd = fold[:-1, :-1], fold[:-1, 1:], fold[1:, 1:], fold[1:, :-1]
    codes = [welded[:, k][vertex] for k in range(3)]
    ac = sum((u[:-1, :-1] - u[1:, 1:]) ** 2 for u in codes) <= sum((u[:-1, 1:] - u[1:, :-1]) ** 2 for u in codes)
    ac = numpy.where(fa | fc, True, numpy.where(fb | fd, False, ac))
    ac[0, 0] = ac[-1, -1] = True
    ac[0, -1] = ac[-1, 0] = False
    return ac


def faces(vertex, fold, welded):
    """Faces in their order (9.3.1), an array [F][3]."""
    ac = diagonals(vertex, fold, welded).reshape(-1)
    vertex = vertex.astype(numpy.uint32)
    a, b, c, d = (v.reshape(-1) for v in (vertex[:-1, :-1], vertex[:-1, 1:], vertex[1:, 1:], vertex[1:, :-1]))
    out = numpy.empty((len(a), 2, 3), numpy.uint32)
    out[:, 0, 0], out[:, 0, 1], out[:, 0, 2] = a, b, numpy.where(ac, c, d)
    out[:, 1, 0], out[:, 1, 1], out[:, 1, 2] = numpy.where(ac, a, b), c, d
    return out.reshape(-1, 3)


def positions(welded, origin, step):
    """Binary32 positions (9.5.1): product, sum and result rounded one after the other."""
    product = float(step) * welded.astype(numpy.float64)
    return (numpy.array(origin, numpy.float64)[None, :] + product).astype(numpy.float32)


def mesh_hash(points, triangles):
    """How the manifest names a mesh: SHA-256 of counts, positions and faces, all big-endian."""
    return hashlib.sha256(struct.pack(">II", len(points), len(triangles)) + points.astype(">f4").tobytes()
                          + triangles.astype(">u4").tobytes()).hexdigest()


def rebuild(charts, codes):
    """Digest (10.3) and mesh hash of a frame: charts in order, codes[i] an array [3][S][S]."""
    digest, all_points, all_faces, raised = hashlib.sha256(), [], [], 0
    for chart, code in zip(charts, codes):
        vertex, fold = weld(chart.size, chart.start, tuple(chart.steps), tuple(chart.sides))
        welded = welded_codes(vertex, code)
        triangles = faces(vertex, fold, welded)
        digest.update(struct.pack(">II", len(welded), len(triangles)))
        digest.update(welded.astype(">u2").tobytes() + triangles.astype(">u4").tobytes())
        all_points.append(positions(welded, chart.origin, chart.step))
        all_faces.append(triangles + numpy.uint32(raised))
        raised += len(welded)
    return digest.digest()[:8], mesh_hash(numpy.concatenate(all_points), numpy.concatenate(all_faces))
