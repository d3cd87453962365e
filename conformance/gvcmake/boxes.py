# SPDX-License-Identifier: MIT
"""Boxes of ISO/IEC 14496-12 as a tree that can be changed before it is written."""
import struct
import zlib


class Box:
    """A box: fields first, then children. Sizes are found when it is written."""

    def __init__(self, kind, fields=b"", children=(), large=False):
        self.kind, self.fields, self.children, self.large = kind, fields, list(children), large
        self.size = None  # to state another size than it has

    def encode(self):
        """The bytes of the box."""
        content = self.fields + b"".join(c.encode() for c in self.children)
        kind = self.kind.encode("latin-1")
        if self.large:
            return struct.pack(">I4sQ", 1, kind, len(content) + 16 if self.size is None else self.size) + content
        return struct.pack(">I4s", len(content) + 8 if self.size is None else self.size, kind) + content

    def all(self, kind):
        """Children of a type."""
        return [c for c in self.children if c.kind == kind]

    def get(self, path):
        """A box below this one by its path; [n] chooses among several: trak[1]/mdia/hdlr."""
        box = self
        for name in path.split("/"):
            kind, _, number = name.partition("[")
            box = box.all(kind)[int(number[:-1]) if number else 0]
        return box

    def _parent(self, path):
        above, _, name = path.rpartition("/")
        return (self.get(above) if above else self), self.get(path), name

    def remove(self, path):
        """Takes a box out."""
        parent, box, _ = self._parent(path)
        parent.children = [c for c in parent.children if c is not box]

    def double(self, path):
        """Puts a second one behind a box."""
        parent, box, _ = self._parent(path)
        parent.children.insert([c is box for c in parent.children].index(True) + 1, box)

    def add(self, path, box, at=0):
        """Puts a new box into the one at `path` ("" for this), before child `at`."""
        parent = self.get(path) if path else self
        parent.children.insert(len(parent.children) + 1 + at if at < 0 else at, box)

    def patch(self, path, offset, data):
        """Overwrites fields of a box; offset counts from the first byte behind its type."""
        box = self.get(path)
        box.fields = box.fields[:offset] + data + box.fields[offset + len(data):]


def full(kind, version=0, flags=0, fields=b"", children=()):
    """A FullBox (gvc.md 2.6)."""
    return Box(kind, struct.pack(">I", version << 24 | flags) + fields, children)


def u16(*values):
    """Big-endian 16-bit numbers."""
    return struct.pack(">%dH" % len(values), *values)


def u32(*values):
    """Big-endian 32-bit numbers."""
    return struct.pack(">%dI" % len(values), *values)


def u64(*values):
    """Big-endian 64-bit numbers."""
    return struct.pack(">%dQ" % len(values), *values)


def crc32(data):
    """The CRC-32 of gvc.md 10."""
    return zlib.crc32(data) & 0xFFFFFFFF


def seal(data, flip=0):
    """gcrc for what stands before it (10.1). `data` ends with what the checksum covers before gcrc. flip: bits to be wrong."""
    head = struct.pack(">I4sI", 16, b"gcrc", 0)
    return head + u32(crc32(data + head) ^ flip)
