# SPDX-License-Identifier: MIT
"""Side table, weld and vertices of a chart (gvc.md 8)."""

import numpy as np

from .errors import Damaged


def border_samples(S):
    """Raster index j * S + i of each of the P = 4 (S - 1) border positions (8.1.1)."""
    a = np.arange(S - 1, dtype=np.int64)
    top, right = a, a * S + S - 1
    bottom, left = (S - 1) * S + S - 1 - a, (S - 1 - a) * S
    return np.concatenate([top, right, bottom, left])


def check_sides(S, start, steps, sides):
    """Rules 1 to 3 of 8.2.1; returns begin[m] of each side (8.1.2), not reduced modulo P."""
    P, edges = 4 * (S - 1), len(steps)
    if not 16 <= S <= 2049 or start >= P:
        raise Damaged("8.2.1", f"rule 1: S = {S}, start = {start}")
    if edges < 1 or sorted(sides) != list(range(2 * edges)):
        raise Damaged("8.2.1", "rule 2: not one forward and one reversed side of every edge")
    if min(steps) < 2 or sum(steps) != P // 2:
        raise Damaged("8.2.1", f"rule 3: steps sum to {sum(steps)}, not {P // 2}, or one is "
                               "below 2")
    begins, at = [], start
    for side in sides:
        begins.append(at)
        at += steps[side // 2]
    return begins


def weld_border(P, steps, sides, begins):
    """For each border position the least position that is the same vertex (8.1.3)."""
    parent = list(range(P))

    def find(p):
        """Least position of the set of p."""
        while parent[p] != p:
            parent[p] = parent[parent[p]]
            p = parent[p]
        return p

    begin = {side: b for side, b in zip(sides, begins)}
    for edge, n in enumerate(steps):
        forward, backward = begin[2 * edge], begin[2 * edge + 1] + n
        for j in range(n + 1):
            a, b = find((forward + j) % P), find((backward - j) % P)
            if a < b:
                parent[b] = a
            elif b < a:
                parent[a] = b
    return [find(p) for p in range(P)]


def check_weld(S, steps, sides, begins, same):
    """Rules 4 and 5 of 8.2.1."""
    P = 4 * (S - 1)
    for side, b in zip(sides, begins):
        n = steps[side // 2]
        if n < 3 and same[b % P] == same[(b + n) % P]:
            raise Damaged("8.2.1", f"rule 4: edge {side // 2} is a loop of {n} steps")
    for c in range(0, P, S - 1):
        if len({same[(c + d) % P] for d in range(-2, 3)}) != 5:
            raise Damaged("8.2.1", f"rule 5: welded samples around the corner at position {c}")


class Weld:
    """How the border of a chart closes.

    S: size; V: number of vertices; vertex: int32 [S, S], vertex of each sample (8.4); first:
    raster index of the first sample of each vertex; border_vertex: vertex of each border position;
    border: its raster index; same: least position that is the same vertex; folds: bool [S, S];
    genus (8.5); begins: where the sides begin (8.1.2).
    """

    def __init__(self, S, start, steps, sides):
        self.S = S
        self.begins = check_sides(S, start, steps, sides)
        P = 4 * (S - 1)
        self.same = weld_border(P, steps, sides, self.begins)
        check_weld(S, steps, sides, self.begins, self.same)
        count = len(set(self.same))
        if (2 * S - 1 - count) % 2 or count > 2 * S - 1:
            raise Damaged("8.5", f"{count} vertices on the border give no genus")
        self.genus = (2 * S - 1 - count) // 2

    def number(self):
        """Number the vertices in raster order (8.4.1) and find the folds (9.3.2)."""
        S, P = self.S, 4 * (self.S - 1)
        self.border = border_samples(S)
        same = np.array(self.same, dtype=np.int64)
        least = np.full(P, S * S, dtype=np.int64)
        np.minimum.at(least, same, self.border)
        label = np.arange(S * S, dtype=np.int64)
        label[self.border] = least[same]
        is_first = label == np.arange(S * S)
        self.first = np.flatnonzero(is_first)
        self.vertex = (np.cumsum(is_first) - 1).astype(np.int32)[label].reshape(S, S)
        self.V = len(self.first)
        self.border_vertex = self.vertex.reshape(-1)[self.border]
        folds = np.zeros(S * S, dtype=bool)
        folds[self.border] = np.roll(same, 1) == np.roll(same, -1)
        self.folds = folds.reshape(S, S)
