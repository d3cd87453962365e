# SPDX-License-Identifier: MIT
"""Meshes as binary little-endian PLY files."""

import numpy as np

HEADER = """ply
format binary_little_endian 1.0
element vertex {}
property float x
property float y
property float z
element face {}
property list uchar uint vertex_indices
end_header
"""
FACE = np.dtype([("count", "u1"), ("vertices", "<u4", 3)])


def write_ply(path, parts):
    """Write parts, a list of (positions [V, 3], faces [F, 3] counted in the part), to path."""
    vertices = sum(len(positions) for positions, _ in parts)
    with open(path, "wb") as out:
        out.write(HEADER.format(vertices, sum(len(f) for _, f in parts)).encode())
        for positions, _ in parts:
            out.write(positions.astype("<f4").tobytes())
        before = 0
        for positions, faces in parts:
            rows = np.empty(len(faces), dtype=FACE)
            rows["count"] = 3
            rows["vertices"] = faces + before
            out.write(rows.tobytes())
            before += len(positions)
