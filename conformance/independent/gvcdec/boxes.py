# SPDX-License-Identifier: MIT
"""Boxes of ISO base media files as gvc.md 4.1.2 and 4.1.3 restrict them."""

import struct
import zlib

from .errors import Damaged, Unsupported


class Box:
    """One box of the file: type (4 bytes), start, body and end (offsets in the file)."""

    __slots__ = ("data", "type", "start", "body", "end")

    def __init__(self, data, type_, start, body, end):
        self.data, self.type, self.start, self.body, self.end = data, type_, start, body, end

    @property
    def name(self):
        """Type and place for messages."""
        return f"{self.type.decode('latin-1')!r} at {self.start:#x}"

    @property
    def size(self):
        """Bytes of the box with its header."""
        return self.end - self.start

    def content(self, skip=0):
        """Bytes of the body from `skip` on."""
        return bytes(self.data[self.body + skip:self.end])

    def children(self, skip=0):
        """List of the boxes inside, which begin `skip` bytes into the body."""
        if skip > self.end - self.body:
            raise Damaged("4.1.2", "too short for its fields", self.name)
        return list(walk(self.data, self.body + skip, self.end))

    def full(self, clause, greatest=0):
        """(version, flags) of a FullBox (2.6); the version must be known (4.1.6)."""
        if self.end - self.body < 4:
            raise Damaged(clause, "too short for version and flags", self.name)
        word = struct.unpack_from(">I", self.data, self.body)[0]
        if word >> 24 > greatest:
            raise Unsupported("4.1.6", f"version {word >> 24} of the box", self.name)
        return word >> 24, word & 0xFFFFFF

    def fields(self, form, skip, clause):
        """Big-endian struct fields from `skip` on; bytes behind them are ignored (4.1.6)."""
        size = struct.calcsize(">" + form)
        left = self.end - self.body - skip
        if left < size:
            raise Damaged(clause, f"{left} bytes where {size} are wanted", self.name)
        return struct.unpack_from(">" + form, self.data, self.body + skip)


def read_box(data, at, end):
    """The box at offset `at`, which must end at `end` at the latest (4.1.2)."""
    where = f"offset {at:#x}"
    if end - at < 8:
        raise Damaged("4.1.2", f"{end - at} bytes left, too few for a box", where)
    size, kind = struct.unpack_from(">I4s", data, at)
    header = 8
    if size == 0:
        raise Damaged("4.1.2", f"box {kind!r} of size 0", where)
    if size == 1:
        if end - at < 16:
            raise Damaged("4.1.2", "box leaves its parent", where)
        size = struct.unpack_from(">Q", data, at + 8)[0]
        header = 16
    if size < header:
        raise Damaged("4.1.2", f"box {kind!r} is smaller than its header", where)
    if size > end - at:
        raise Damaged("4.1.2", f"box {kind!r} of {size} bytes leaves its parent or the file", where)
    return Box(data, kind, at, at + header, at + size)


def walk(data, at, end):
    """Yield the boxes that fill [at, end) exactly."""
    while at < end:
        box = read_box(data, at, end)
        yield box
        at = box.end


def of_type(boxes, kind):
    """All boxes of one type, in order."""
    return [b for b in boxes if b.type == kind]


def at_most_one(boxes, kind, clause, where):
    """The only box of a type or None; a second one is rejected (4.1.5)."""
    found = of_type(boxes, kind)
    if len(found) > 1:
        raise Damaged(clause, f"{len(found)} boxes {kind.decode('latin-1')!r}", where)
    return found[0] if found else None


def one(boxes, kind, clause, where):
    """The only box of a type; a missing or second one is rejected (4.1.5)."""
    box = at_most_one(boxes, kind, clause, where)
    if box is None:
        raise Damaged(clause, f"no box {kind.decode('latin-1')!r}", where)
    return box


def is_gcrc(data, at):
    """Whether the 16 bytes at `at` are the head of a gcrc of 16 bytes."""
    return bytes(data[at:at + 8]) == b"\0\0\0\x10gcrc"


def check_gcrc(data, first, at, name):
    """Check the gcrc at `at`, which covers all bytes from `first` on (10.1, 10.1.1)."""
    version, crc = struct.unpack_from(">II", data, at + 8)
    if zlib.crc32(data[first:at + 12]) != crc:
        raise Damaged("10.1.1", f"wrong gcrc of {name}", f"offset {at:#x}")
    if version:
        raise Damaged("10.1.1", f"version or flags of gcrc of {name} are not 0", f"offset {at:#x}")


def check_last_gcrc(box, children, first):
    """Check that the last child of box is a right gcrc that covers from `first` on (10.1)."""
    name = box.type.decode("latin-1")
    if not children or children[-1].type != b"gcrc" or not is_gcrc(box.data, box.end - 16) \
            or children[-1].start != box.end - 16:
        raise Damaged("10.1.1", "last child is no gcrc of 16 bytes", box.name)
    check_gcrc(box.data, first, box.end - 16, name)
