# SPDX-License-Identifier: MIT
"""Shape records as dictionaries, to alter and write them again (gvc.md 7)."""

import struct
import sys
import os

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

from gvcdec.fields import Reader  # noqa: E402


def varint(n):
    out = b""
    while n > 127:
        out += bytes([n & 127 | 128])
        n >>= 7
    return out + bytes([n])


def parse(data):
    """Dictionary of a record of one or more charts without zstd."""
    r = Reader(data, "7")
    d = {"flags": r.u8(), "digest": r.take(8), "charts": [], "tail": b""}
    d["preview"] = r.take(8) if d["flags"] & 8 else b""
    d["source"] = r.take(r.u8()) if d["flags"] & 2 else None
    if d["flags"] & 1:
        return d
    if d["flags"] & 4:
        import zstandard
        r = Reader(zstandard.ZstdDecompressor().decompress(r.rest()), "7")
        d["flags"] &= ~4
    d["segment"], count = r.varint(64), r.varint(64)
    for _ in range(count):
        c = {k: r.varint(32) for k in ("component", "x", "y", "size", "genus")}
        c["origin"], c["step"] = r.unpack("3d"), r.f64()
        nodes, edges = r.varint(32), r.varint(32)
        c["nodes"] = []
        for _ in range(nodes):
            kind = r.u8()
            c["nodes"].append((kind, r.varint(32) if kind == 1 else 0))
        c["edges"] = [(r.varint(32), r.varint(32)) for _ in range(edges)]
        c["start"] = r.varint(32)
        c["steps"] = [r.varint(32) for _ in range(edges)]
        c["sides"] = [r.varint(32) for _ in range(2 * edges)]
        d["charts"].append(c)
    return d


def chart_bytes(c):
    out = b"".join(varint(c[k]) for k in ("component", "x", "y", "size", "genus"))
    out += struct.pack(">4d", *c["origin"], c["step"])
    out += varint(c.get("node_count", len(c["nodes"])))
    out += varint(c.get("edge_count", len(c["edges"])))
    for kind, feature in c["nodes"]:
        out += bytes([kind]) + (varint(feature) if kind == 1 else b"")
    out += b"".join(varint(a) + varint(b) for a, b in c["edges"]) + varint(c["start"])
    return out + b"".join(map(varint, c["steps"] + c["sides"]))


def body_bytes(d):
    return (d.get("segment_bytes") or varint(d["segment"])) + \
        varint(d.get("chart_count", len(d["charts"]))) + \
        b"".join(map(chart_bytes, d["charts"])) + d["tail"]


def record_bytes(d):
    out = bytes([d["flags"]]) + d["digest"] + d["preview"]
    if d["source"] is not None:
        out += bytes([len(d["source"])]) + d["source"]
    if "body" in d:
        return out + d["body"]
    return out + (body_bytes(d) if d["charts"] else d["tail"])
