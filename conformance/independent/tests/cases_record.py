# SPDX-License-Identifier: MIT
"""Forged shape records (gvc.md 2.4, 7, 8)."""

import math
import struct

import zstandard

from records import body_bytes, parse, record_bytes

CASES = []


def record(name, status, clause, base="example", sample=0):
    """Change the dictionary of a record of fragment 0."""
    def add(change):
        def whole(p):
            samples = p.fragments[0]["shape"]["samples"]
            d = parse(samples[sample])
            change(d)
            samples[sample] = record_bytes(d)
        CASES.append((name, base, status, clause, whole))
        return change
    return add


def field(name, status, clause, key, value, base="example"):
    """Change a field of the first chart."""
    def change(d):
        d["charts"][0][key] = value(d["charts"][0][key]) if callable(value) else value
    record(name, status, clause, base)(change)


def whole(name, status, clause, key, value, sample=0, base="example"):
    """Change a field of the record."""
    def change(d):
        d[key] = value(d[key]) if callable(value) else value
    record(name, status, clause, base, sample)(change)


whole("as it was", 0, "", "tail", b"")
whole("wrong digest", 1, "10.3.2", "digest", bytes(8))
whole("wrong digest of frame 1", 1, "10.3.2", "digest", bytes(8), 1)
whole("reserved flag", 3, "7.1.1", "flags", 16)
whole("reserved flag of frame 1", 3, "7.1.1", "flags", lambda f: f | 128, 1)
whole("preview in a lossy file", 1, "7.1.5", "flags", 8)
whole("no preview", 1, "7.1.5", "flags", 0, 0, "preview")
whole("wrong preview digest", 1, "10.3.2", "preview", bytes(8), 0, "preview")
whole("same first", 1, None, "flags", 1)
whole("same with zstd", 1, "7.1.2", "flags", 5, 1)
whole("same with body", 1, "7.1.2", "tail", b"\0", 1)
whole("bytes behind charts", 1, "7.2.1", "tail", b"\0")
whole("segment great", 0, "", "segment", 2**64 - 1)


def extra(name, status, clause, key, value):
    @record(name, status, clause)
    def _(d):
        d[key] = value


extra("chart_count 0", 1, "7.2", "chart_count", 0)
extra("chart_count 2", 1, "7.2.1", "chart_count", 2)
extra("chart_count huge", 1, "7.2.1", "chart_count", 2**63)
extra("segment not shortest", 1, "2.4", "segment_bytes", b"\x80\x00")
extra("segment 2^64", 1, "2.4", "segment_bytes", b"\x80" * 9 + b"\2")
extra("segment endless", 1, "2.4", "segment_bytes", b"\x80" * 12 + b"\1")
extra("body empty", 1, "7.2", "body", b"")


@record("named", 0, "")
def _(d):
    d["flags"], d["source"] = 2, "Größe.ply".encode()


for text, clause in ((b"", "7.1"), (b"a" * 64, "7.1"), (b"\n", "2.5"), (b"\xff", "2.5"),
                     (b"\x7f", "2.5")):
    @record(f"source {text!r}", 1, clause)
    def _(d, text=text):
        d["flags"], d["source"] = 2, text


@record("whole record behind", 1, "7.1.2", sample=1)
def _(d):
    d["flags"], d["tail"] = 0, b"abc"


@record("zstd", 0, "")
def _(d):
    d["flags"], d["body"] = 4, zstandard.ZstdCompressor().compress(body_bytes(d))


def zstd(name, status, function):
    @record(name, status, "7.1.3" if status else "")
    def _(d):
        d["flags"], d["body"] = 4, function(body_bytes(d))


zstd("zstd with checksum", 0,
     lambda b: zstandard.ZstdCompressor(write_checksum=True).compress(b))
zstd("zstd with wrong checksum", 1,
     lambda b: zstandard.ZstdCompressor(write_checksum=True).compress(b)[:-1] + b"\0")
zstd("zstd without size", 1,
     lambda b: zstandard.ZstdCompressor(write_content_size=False).compress(b))
zstd("zstd with bytes behind", 1, lambda b: zstandard.compress(b) + b"\0")
zstd("zstd cut", 1, lambda b: zstandard.compress(b)[:-1])
zstd("two zstd frames", 1, lambda b: zstandard.compress(b) * 2)
zstd("zstd skippable frame before", 1,
     lambda b: b"\x50\x2a\x4d\x18\1\0\0\0a" + zstandard.compress(b))
zstd("zstd of too much", 1, lambda b: zstandard.compress(bytes(10**6)))
zstd("zstd states petabytes", 1, lambda b: b"\x28\xb5\x2f\xfd\xe0" + b"\xff" * 7 + b"\0\1\0\0")
zstd("zstd dictionary", 1, lambda b: b"\x28\xb5\x2f\xfd\x61\7" + zstandard.compress(b)[5:])
zstd("no zstd", 1, lambda b: b)
zstd("zstd states less", 1, lambda b: b"\x28\xb5\x2f\xfd\x20\5" + struct.pack(
    "<I", len(b) << 3 | 1)[:3] + b)
zstd("zstd empty", 1, lambda b: b"")


def windowed(byte, b):
    """A frame with a window descriptor and one block as it is."""
    return b"\x28\xb5\x2f\xfd\x80" + bytes([byte]) + struct.pack("<I", len(b)) + \
        struct.pack("<I", len(b) << 3 | 1)[:3] + b


zstd("zstd with a window of 8 MiB", 0, lambda b: windowed(13 << 3, b))
zstd("zstd with a window of 9 MiB", 1, lambda b: windowed(13 << 3 | 1, b))
zstd("zstd with a dictionary_ID of 0", 0,
     lambda b: b"\x28\xb5\x2f\xfd\xa1\0" + windowed(0, b)[6:])

field("component 1", 1, "7.3.1", "component", 1)
field("chart leaves at the right", 1, "7.3.2", "x", 15)
field("chart leaves below", 1, "7.3.2", "y", 2**32 - 1)
field("x of 2^32", 1, "2.4", "x", 2**32)
field("chart elsewhere", 1, "10.3.2", "x", 14)
field("size 15", 1, "5.4", "size", 15)
field("size 19", 1, "5.4", "size", 19)
field("size 17", 1, "8.2.1", "size", 17)
field("genus 1", 1, "7.3.5", "genus", 1)
field("genus 4", 1, "7.3.5", "genus", 4)
for bad in (math.nan, math.inf, -math.inf):
    field(f"origin {bad}", 1, "7.3.5", "origin", (0.0, bad, 0.0))
    field(f"step {bad}", 1, "7.3.5", "step", bad)
field("step 0", 1, "7.3.5", "step", 0.0)
field("step -0", 1, "7.3.5", "step", -0.0)
field("step negative", 1, "7.3.5", "step", -1.0)
field("step subnormal", 0, "", "step", 5e-324)
field("step too great", 1, "7.3.3", "step", 1e300)
field("origin too great", 1, "7.3.3", "origin", (0.0, 0.0, 3.5e38))
field("origin at the edge", 0, "", "origin", (0.0, 0.0, 3.4028234663852885e38))
field("kind 3", 1, "7.4.1", "nodes", lambda n: [(3, 0)] + n[1:])
field("kinds exchanged", 0, "", "nodes", lambda n: [(2, 0)] + n[1:])
field("feature of 2^32", 1, "2.4", "nodes", lambda n: [n[0], (1, 2**32)] + n[2:])
field("node missing", 1, "7.3.5", "nodes", lambda n: n[:-1])
field("node too many", 1, "7.3.5", "nodes", lambda n: n + [(0, 0)])
field("edge with node 8", 1, "7.3.5", "edges", lambda e: [(8, 2)] + e[1:])
field("edge turned round", 1, "7.4.2", "edges", lambda e: [e[0][::-1]] + e[1:])
field("edge to another node", 1, "7.4.2", "edges", lambda e: [(0, 1)] + e[1:])
field("start P", 1, "8.2.1", "start", 68)
field("start 0", 1, None, "start", 0)
field("steps sum", 1, "8.2.1", "steps", lambda s: [3] + s[1:])
field("steps of 1", 1, "8.2.1", "steps", lambda s: [1, s[1] + 1] + s[2:])
field("sides: one twice", 1, "8.2.1", "sides", lambda s: s[:1] + s[:1] + s[2:])
field("sides: beyond", 1, "8.2.1", "sides", lambda s: [14] + s[1:])
field("sides exchanged", 1, None, "sides", lambda s: [s[1], s[0]] + s[2:])
field("edge_count 0", 1, "7.3.5", "edges", lambda e: [])


@record("node_count huge", 1, "7.3.5")
def _(d):
    d["charts"][0]["node_count"] = 2**31


@record("edge_count huge", 1, "7.3.5")
def _(d):
    d["charts"][0]["edge_count"] = 2**31


@record("two charts that overlap", 1, "7.3.2")
def _(d):
    d["charts"].append(dict(d["charts"][0], component=1))


@record("rule 4: loop of two steps", 1, "8.2.1")
def _(d):
    c = d["charts"][0]
    half = 2 * (c["size"] - 1)
    c["genus"] = 1
    c["nodes"], c["edges"] = [(0, 0)], [(0, 0), (0, 0)]
    c["steps"], c["sides"], c["start"] = [2, half - 2], [0, 2, 1, 3], 1


@record("sphere with genus of a torus", 1, "8.5")
def _(d):
    c = d["charts"][0]
    c["nodes"], c["edges"] = [(0, 0)], [(0, 0), (0, 0)]
    half = c["size"] - 1
    c["genus"] = 1
    c["steps"], c["sides"], c["start"] = [half, half], [0, 1, 2, 3], 4
