# SPDX-License-Identifier: MIT
"""Shape records: gvc.md clause 7. Fields are written as they are given, right or wrong."""
import struct
from dataclasses import dataclass, field

SAME, NAMED, ZSTD, PREVIEW = 1, 2, 4, 8


def varint(value):
    """Shortest LEB128 (2.4). Bytes are taken as they are, so that wrong forms can be written."""
    if isinstance(value, bytes):
        return value
    out = b""
    while value > 127:
        out += bytes([value & 127 | 128])
        value >>= 7
    return out + bytes([value])


def label(text):
    """A label (2.5); text may be bytes."""
    raw = text if isinstance(text, bytes) else text.encode()
    return bytes([len(raw)]) + raw


@dataclass
class Chart:
    """The fields of 7.3. nodes: bytes of each node. edges: pairs of nodes."""
    size: int
    steps: list
    sides: list
    start: int
    nodes: list
    edges: list
    genus: int = 0
    component: int = 0
    x: int = 0
    y: int = 0
    origin: tuple = (-1.0, -2.0, 0.5)
    step: float = 2.0 ** -15
    edge_count: object = None  # to write another one than there are
    node_count: object = None

    def encode(self):
        """The bytes of the chart."""
        numbers = [self.component, self.x, self.y, self.size, self.genus]
        out = b"".join(varint(n) for n in numbers)
        out += b"".join(v if isinstance(v, bytes) else struct.pack(">d", v) for v in (*self.origin, self.step))
        out += varint(len(self.nodes) if self.node_count is None else self.node_count)
        out += varint(len(self.edges) if self.edge_count is None else self.edge_count)
        out += b"".join(self.nodes) + b"".join(varint(a) + varint(b) for a, b in self.edges)
        out += varint(self.start) + b"".join(varint(n) for n in list(self.steps) + list(self.sides))
        return out


@dataclass
class Record:
    """A shape record (7.1). `pack`, if given, makes the bytes of the body from the body (7.1.3)."""
    digest: bytes
    charts: list = field(default_factory=list)
    same: bool = False
    preview_digest: bytes = None
    source: object = None
    segment: object = 0
    chart_count: object = None
    pack: object = None
    extra_flags: int = 0
    tail: bytes = b""  # behind the last chart
    after: bytes = b""  # behind everything

    def encode(self):
        """The bytes of the sample."""
        flags = self.extra_flags | (SAME if self.same else 0) | (NAMED if self.source is not None else 0)
        flags |= (ZSTD if self.pack else 0) | (PREVIEW if self.preview_digest is not None else 0)
        out = bytes([flags]) + self.digest + (self.preview_digest or b"")
        if self.source is not None:
            out += label(self.source)
        if self.same:
            return out + self.after
        body = varint(self.segment) + varint(len(self.charts) if self.chart_count is None else self.chart_count)
        body += b"".join(c.encode() for c in self.charts) + self.tail
        return out + (self.pack(body) if self.pack else body) + self.after
