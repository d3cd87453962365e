# SPDX-License-Identifier: MIT
"""Shape records (gvc.md 7)."""

import math

import numpy as np

from .border import Weld
from .errors import Damaged, Limit, Unsupported, placed
from .fields import Reader
from .limits import CHART_SAMPLES, CHARTS
from .zstdframe import expand

SAME, NAMED, ZSTD, PREVIEW = 1, 2, 4, 8
GREATEST = float(np.finfo(np.float32).max)
CHART_BYTES = 46  # at least (7.2.1)
WINDOW = 1 << 23  # of a Zstandard frame (7.1.3)


class Record:
    """digest, preview_digest (or None): 8 bytes; source; charts: list, or None if *same*."""

    def __init__(self):
        self.preview_digest = None
        self.source = None
        self.charts = None


class Chart:
    """One chart (7.3): x, y, size, genus, origin (3 floats), step, nodes, edges, start, steps,
    sides; weld: Weld."""


def read_record(data, first, config, preview):
    """Record of a sample (7.5); first: of its fragment; preview: of a file with both tracks."""
    r = Reader(data, "7.1")
    flags = r.u8()
    if flags & ~15:
        raise Unsupported("7.1.1", f"reserved bit in flags {flags:#x} of a shape record")
    record = Record()
    record.digest = r.take(8)
    if bool(flags & PREVIEW) != preview:
        raise Damaged("7.1.5", "flag preview does not fit the tracks of the file")
    if flags & PREVIEW:
        record.preview_digest = r.take(8)
    if flags & NAMED:
        record.source = r.label(1, 63)
    if flags & SAME:
        if flags & ZSTD or r.left:
            raise Damaged("7.1.2", "same with zstd or with a body")
        if first:
            raise Damaged("7.1.2", "same in the first record of a fragment")
        return record
    if not first:
        raise Damaged("7.1.2", "whole record behind the first one of a fragment")
    body = r.rest()
    if flags & ZSTD:
        most = 20 + 3 * config.width * config.plane_height  # 13.3
        body = expand(body, most, "7.1.3", WINDOW)
    record.charts = read_body(body, config)
    return record


def read_body(body, config):
    """Charts of a body (7.2), checked."""
    r = Reader(body, "7.2")
    r.varint(64)
    count = r.varint(64)
    if count < 1:
        raise Damaged("7.2", "record without charts")
    if count > r.left // CHART_BYTES:
        raise Damaged("7.2.1", f"{count} charts in {r.left} bytes")
    if count > CHARTS:
        raise Limit("13.3", f"{count} charts in a frame")
    charts = []
    for i in range(count):
        with placed(f"chart {i}"):
            charts.append(read_chart(r, i, config))
    if r.left:
        raise Damaged("7.2.1", f"{r.left} bytes behind the last chart")
    check_places(charts, config)
    if sum(c.size ** 2 for c in charts) > CHART_SAMPLES:
        raise Limit("13.3", "frame with more samples than this decoder takes")
    for i, chart in enumerate(charts):
        with placed(f"chart {i}"):
            check_closure(chart)
    return charts


def read_chart(r, number, config):
    """One chart (7.3) without the checks that need the others."""
    c = Chart()
    r.clause = "7.3"
    component = r.varint(32)
    if component != number:
        raise Damaged("7.3.1", f"component {component}")
    c.x, c.y, c.size, c.genus = (r.varint(32) for _ in range(4))
    if not 16 <= c.size <= config.image_size:
        raise Damaged("5.4", f"chart of size {c.size}, image_size is {config.image_size}")
    c.origin, c.step = r.unpack("3d"), r.f64()
    check_map(c)
    nodes, edges = r.varint(32), r.varint(32)
    if not 1 <= edges <= c.size - 1 or nodes < 1 or nodes != edges + 1 - 2 * c.genus:
        raise Damaged("7.3.5", f"{nodes} nodes, {edges} edges, genus {c.genus}")
    for _ in range(nodes):
        kind = r.u8()
        if kind > 2:
            raise Damaged("7.4.1", f"node of kind {kind}")
        if kind == 1:
            r.varint(32)
    c.nodes = nodes
    c.edges = [(r.varint(32), r.varint(32)) for _ in range(edges)]
    if any(node >= nodes for edge in c.edges for node in edge):
        raise Damaged("7.3.5", "edge with a node that is not there")
    c.start = r.varint(32)
    c.steps = [r.varint(32) for _ in range(edges)]
    c.sides = [r.varint(32) for _ in range(2 * edges)]
    return c


def check_map(c):
    """The affine map is finite and stays within binary32 (7.3, 7.3.3)."""
    if not all(map(math.isfinite, c.origin)) or not math.isfinite(c.step) or c.step <= 0:
        raise Damaged("7.3.5", f"affine map with origin {c.origin} and step {c.step}")
    if any(abs(o) + 65535 * c.step > GREATEST for o in c.origin):
        raise Damaged("7.3.3", "positions beyond binary32")


def check_places(charts, config):
    """Charts lie in the plane and do not overlap (7.3.2)."""
    for i, c in enumerate(charts):
        if c.x + c.size > config.width or c.y + c.size > config.plane_height:
            raise Damaged("7.3.2", f"chart {i} leaves the plane")
    if len(charts) == 1:
        return
    taken = np.zeros((config.plane_height, config.width), dtype=bool)
    for i, c in enumerate(charts):
        place = taken[c.y:c.y + c.size, c.x:c.x + c.size]
        if place.any():
            raise Damaged("7.3.2", f"chart {i} overlaps another one")
        place[:] = True


def check_closure(c):
    """Side table, genus, cut graph (7.3.4, 7.4.2)."""
    c.weld = Weld(c.size, c.start, c.steps, c.sides)
    if c.weld.genus != c.genus:
        raise Damaged("8.5", f"genus {c.genus} given, the side table has {c.weld.genus}")
    check_graph(c)
    c.weld.number()


def check_graph(c):
    """Sides walk along the graph; places of a node are one vertex; every node occurs (7.4.2)."""
    P = 4 * (c.size - 1)
    ways = [c.edges[s // 2] if s % 2 == 0 else c.edges[s // 2][::-1] for s in c.sides]
    vertex = {}
    for i, ((begin, _), at) in enumerate(zip(ways, c.weld.begins)):
        if ways[i - 1][1] != begin:
            raise Damaged("7.4.2", f"side {i} does not begin where the one before ends")
        if vertex.setdefault(begin, c.weld.same[at % P]) != c.weld.same[at % P]:
            raise Damaged("7.4.2", f"node {begin} is at places that are not one vertex")
    if len(vertex) != c.nodes:
        raise Damaged("7.4.2", "a node without an edge")
