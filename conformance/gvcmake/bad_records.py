# SPDX-License-Identifier: MIT
"""Invalid vectors of shape records and digests: gvc.md 7, 10.3 and 2.4."""
import struct

from . import zstd
from .scenes import Group, add_group, movie_for, still_codes
from .tables import JUNCTION, ROOT, chart


def _record(suite, name, about, clauses, edit, error="corrupt", good=(0,), number=0, **fields):
    """A vector of a group of one frame and one of two; edit(record) changes one of the records of the second group."""
    one = chart(16, (0, 1, 1))
    movie = movie_for([one])
    add_group(movie, Group([one], still_codes([one], [7]), **fields))
    add_group(movie, Group([chart(16, (0, 1, 1))], still_codes([one], [7, 7]), **fields), lambda records: edit(records[number]))
    movie.config.declared_frames = 3
    suite.bad("record-" + name, movie, about, clauses, ["records"], error, good=good)


def _set(**fields):
    def edit(record):
        for key, value in fields.items():
            setattr(record, key, value)
    return edit


def _chart(**fields):
    def edit(record):
        for key, value in fields.items():
            setattr(record.charts[0], key, value)
    return edit


def flags(suite):
    """Flags and what belongs to them (7.1)."""
    for bit in (4, 5, 6, 7):
        _record(suite, "flag-%d" % bit, "reserved flag %d is set" % bit, ["7.1.1", "13.2", "14.4"], _set(extra_flags=1 << bit),
                "unsupported")
    _record(suite, "flag-4-same", "reserved flag 4 is set in a record that is same", ["7.1.1"], _set(extra_flags=16), "unsupported",
            [0, 1], 1)
    _record(suite, "preview-without-track", "preview is set in a file without exact track", ["7.1.5", "13.2"],
            _set(preview_digest=bytes(8)))
    _record(suite, "same-first", "the first record of a group is same", ["7.1.2", "13.2"], _set(same=True))
    _record(suite, "same-with-body", "a byte follows in a record that is same", ["7.1.2", "13.2"], _set(after=b"\0"), good=[0, 1],
            number=1)
    _record(suite, "same-with-zstd", "same and zstd are both set", ["7.1.2", "13.2"], _set(extra_flags=4), good=[0, 1], number=1)

    def whole(record):
        record.same, record.charts = False, [chart(16, (0, 1, 1))]
    _record(suite, "whole-elsewhere", "a whole record that is not the first of its group", ["7.1.2", "13.2"], whole, good=[0, 1],
            number=1)
    _record(suite, "short", "a record that ends within its digest", ["7.5"], lambda r: setattr(r, "encode", lambda: bytes(5)))
    _record(suite, "empty-source", "named, with a source of no bytes", ["7.1.4", "2.5", "13.2"], _set(source=b""))
    _record(suite, "long-source", "a source of 64 bytes", ["7.1.4", "2.5"], _set(source=b"x" * 64))
    _record(suite, "control-source", "a source with an escape character", ["2.5", "13.2"], _set(source=b"a\x1b[2J"))
    _record(suite, "malformed-source", "a source of malformed UTF-8", ["2.5", "13.2"], _set(source=b"a\xff"), good=[0, 1], number=1)


def digests(suite):
    """Digests of frames (10.3)."""
    def flip(record):
        record.digest = bytes([record.digest[0] ^ 1]) + record.digest[1:]
    _record(suite, "digest-wrong", "the digest of the first frame of a group is wrong", ["10.3.2", "12.1"], flip, good=[0, 2])
    _record(suite, "digest-wrong-later", "the digest of the last frame is wrong", ["10.3.2", "12.1"], flip, good=[0, 1], number=1)
    _record(suite, "digest-last-byte", "the last byte of a digest is wrong", ["10.3.2"], lambda r: setattr(
        r, "digest", r.digest[:7] + bytes([r.digest[7] ^ 1])), good=[0, 1], number=1)


def bodies(suite):
    """Body and its Zstandard frame (7.1.3, 7.2)."""
    packs = {"no-content-size": (zstd.without_content_size, "states no content size"),
             "dictionary": (zstd.with_dictionary, "needs a dictionary"),
             "two": (lambda b: zstd.raw(b[:20]) + zstd.raw(b[20:]), "is followed by another"),
             "tail": (lambda b: zstd.raw(b) + b"\0", "is followed by a byte"),
             "skippable": (lambda b: struct.pack("<II", 0x184D2A50, 4) + bytes(4) + zstd.raw(b), "follows a skippable one"),
             "cut": (lambda b: zstd.raw(b)[:-1], "is cut off"),
             "checksum": (lambda b: zstd.checksummed(b)[:-1] + bytes([zstd.checksummed(b)[-1] ^ 1]), "has a wrong checksum"),
             "content-size-wrong": (lambda b: zstd.raw(b, zstd.frame_header(len(b) + 1)), "holds a byte less than it states"),
             "none": (lambda b: b, "is none"),
             "bomb": (lambda b: zstd.MAGIC + b"\xe0" + struct.pack("<Q", 1 << 40) + zstd.block(1, 1 << 17, b"\0", 0) * 64
                      + zstd.block(1, 1, b"\0", 1), "states a content of 2^40 bytes")}
    for name, (pack, about) in packs.items():
        _record(suite, "zstd-" + name, "the Zstandard frame of a body " + about, ["7.1.3"] + (["13.2"] if name in (
            "no-content-size", "two", "tail") else ["13.3", "15.3"] if name == "bomb" else []), _set(pack=pack))
    _record(suite, "tail", "a byte follows the last chart", ["7.2.1", "13.2"], _set(tail=b"\0"))
    _record(suite, "cut", "the body ends within its last chart", ["7.2.1", "7.5"], lambda r: setattr(
        r, "pack", None) or _cut(r))
    _record(suite, "no-charts", "chart_count 0", ["7.3.5", "7.5"], lambda r: [setattr(r, "charts", []), setattr(r, "chart_count", 0)])
    for name, count in (("2", 2), ("huge", 1 << 40), ("huge-64", (1 << 64) - 1)):
        _record(suite, "chart-count-" + name, "chart_count %d for one chart" % count, ["7.2.1", "13.2", "15.2"], _set(chart_count=count))
    for name, text in (("long", b"\x80\x00"), ("long-1", b"\x81\x00"), ("ten-bytes", b"\xff" * 9 + b"\x02"),
                       ("eleven-bytes", b"\x80" * 10 + b"\x01"), ("endless", b"\xff" * 30)):
        _record(suite, "varint-" + name, "segment written as " + text.hex(" "), ["2.4", "13.2"], _set(segment=text))


def _cut(record):
    whole = record.encode()
    record.encode = lambda: whole[:-1]


def charts(suite):
    """Fields of charts (7.3)."""
    for name, value in (("component-1", 1), ("component-2-32", 1 << 32)):
        _record(suite, name, "the first chart has component %d" % value, ["7.3.1", "13.2"], _chart(component=value))
    for key, value in (("x", 1), ("y", 1), ("x", 0xFFFFFFFF), ("y", 0xFFFFFFF8)):
        _record(suite, "place-%s-%d" % (key, value), "the chart leaves the plane: %s is %d" % (key, value), ["7.3.2", "13.2", "15.4"],
                _chart(**{key: value}))
    for key in ("x", "y", "genus", "start"):
        _record(suite, "varint-32-" + key, "%s is 2^32" % key, ["2.4", "7.3.5"], _chart(**{key: 1 << 32}))
    _record(suite, "varint-form-in-chart", "x is written in two bytes", ["2.4", "13.2"], _chart(x=b"\x80\x00"))
    nan, inf = float("nan"), float("inf")
    for name, origin in (("nan", (nan, 0.0, 0.0)), ("infinite", (0.0, -inf, 0.0)), ("too-great", (0.0, 0.0, 3.4e38)),
                         ("beyond-binary32", (1e300, 0.0, 0.0))):
        _record(suite, "origin-" + name, "origin is " + name.replace("-", " "), ["7.3.3", "13.2"],
                _chart(origin=origin, step=1e33 if name == "too-great" else 1.0))
    for name, step in (("0", 0.0), ("negative", -1.0), ("minus-0", -0.0), ("nan", nan), ("infinite", inf), ("too-great", 1e34)):
        _record(suite, "step-" + name, "step is " + name.replace("-", " "), ["7.3.3", "13.2"], _chart(step=step))
    for name, count in (("more", 5), ("fewer", 3), ("0", 0), ("huge", 0xFFFFFFFF)):
        _record(suite, "node-count-" + name, "node_count %d does not fit four nodes of three edges" % count, ["7.3.4", "15.2"],
                _chart(node_count=count))
    for name, count in (("0", 0), ("huge", 0xFFFFFFFF), ("16", 16)):
        _record(suite, "edge-count-" + name, "edge_count %d" % count, ["7.3.4", "15.2", "13.1"], _chart(edge_count=count))
    one = chart(17, (0, 1, 1))
    movie = movie_for([one], size=(32, 32))
    movie.config.image_size = 16
    add_group(movie, Group([one], still_codes([one], [7])))
    suite.bad("record-chart-too-great", movie, "a chart of 17 in a file of image_size 16", ["5.4", "13.2"], ["records"])
    for name, place in (("same-place", {}), ("one-sample", {"x": 15, "y": 15}), ("column", {"x": 15}), ("row", {"y": 15})):
        pair = [chart(16, (0, 1, 1)), chart(16, (0,), component=1, **place)]
        movie = movie_for(pair, size=(32, 32))
        add_group(movie, Group(pair, still_codes(pair, [7])))
        suite.bad("record-overlap-" + name, movie, "charts overlap: " + name.replace("-", " "), ["7.3.2", "13.2"], ["records",
                  "several charts"])
    pair = [chart(16, (0, 1, 1)), chart(16, (0,), x=16)]
    movie = movie_for(pair)
    add_group(movie, Group(pair, still_codes(pair, [7])))
    suite.bad("record-component-twice", movie, "both charts have component 0", ["7.3.1", "13.2"], ["records", "several charts"])


def graphs(suite):
    """Nodes and edges (7.4)."""
    _record(suite, "node-kind-3", "a node of kind 3", ["7.4.1", "14.4"], _chart(nodes=[ROOT, b"\3", JUNCTION, JUNCTION]))
    _record(suite, "node-feature-2-32", "the feature of an extremum is 2^32", ["2.4"], _chart(
        nodes=[ROOT, JUNCTION, b"\1\x80\x80\x80\x80\x10", JUNCTION]))
    _record(suite, "edge-node-missing", "an edge runs to node 4 of four", ["7.4.2", "7.3.4"], _chart(edges=[(0, 1), (1, 2), (1, 4)]))
    for name, edges in (("reversed", [(0, 1), (2, 1), (1, 3)]), ("elsewhere", [(0, 1), (1, 2), (2, 3)]),
                        ("loop", [(0, 1), (1, 1), (1, 3)]), ("node-unused", [(0, 1), (1, 2), (1, 2)])):
        _record(suite, "walk-" + name, "sides do not walk along the graph, or a node has no edge: " + name, ["7.4.2", "13.2"],
                _chart(edges=edges))
    _record(suite, "walk-node-of-two-vertices", "one node stands for two vertices, and another has no edge", ["7.4.2", "13.2"],
            _chart(edges=[(0, 1), (1, 0), (1, 0)]))
    _record(suite, "walk-nodes-swapped", "the first side begins at another node than the one where the last ends", ["7.4.2"],
            lambda r: r.charts.__setitem__(0, _renamed()))


def _renamed():
    c = chart(16, (0, 1, 1))
    c.edges[0] = (2, 1)
    return c


def everything(suite):
    """All of them."""
    for part in (flags, digests, bodies, charts, graphs):
        part(suite)
