# SPDX-License-Identifier: MIT
"""Reads the PLY files a decoder under test writes, and names meshes as the manifest does."""
import hashlib
import re
import struct

import numpy

HEAD = re.compile(rb"ply\r?\nformat binary_little_endian 1\.0\r?\n(?:(?:comment|obj_info)[^\n]*\n)*element vertex (\d+)\r?\n"
                  rb"property float(?:32)? x\r?\nproperty float(?:32)? y\r?\nproperty float(?:32)? z\r?\n"
                  rb"element face (\d+)\r?\nproperty list u(?:int8|char) (?:u?int(?:32)?) vertex_ind(?:ices|ex)\r?\n"
                  rb"end_header\r?\n")
FACE = numpy.dtype([("corners", "u1"), ("vertex", "<u4", 3)])


def mesh_hash(path):
    """SHA-256 over counts, positions and faces, all big-endian. Raises ValueError for a file of another form."""
    with open(path, "rb") as stream:
        data = stream.read()
    head = HEAD.match(data)
    if not head:
        raise ValueError("not a PLY file of the form agreed on")
    vertices, faces = int(head[1]), int(head[2])
    if len(data) != head.end() + 12 * vertices + 13 * faces:
        raise ValueError("a PLY file of the wrong length")
    points = numpy.frombuffer(data, "<f4", 3 * vertices, head.end())
    table = numpy.frombuffer(data, FACE, faces, head.end() + 12 * vertices)
    if not (table["corners"] == 3).all():
        raise ValueError("a face that is no triangle")
    return hashlib.sha256(struct.pack(">II", vertices, faces) + points.astype(">f4").tobytes()
                          + table["vertex"].astype(">u4").tobytes()).hexdigest()
