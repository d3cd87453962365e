# SPDX-License-Identifier: MIT
"""Takes a good gvc file apart and puts it together again with right checksums, altered by hooks."""

import hashlib
import os
import struct
import sys
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import zstandard  # noqa: E402

from gvcdec.container import GvcFile  # noqa: E402

CONTAINERS = {b"moov": 0, b"trak": 0, b"mdia": 0, b"minf": 0, b"stbl": 0, b"mvex": 0, b"edts": 0,
              b"tref": 0, b"stsd": 8, b"avc1": 78, b"urim": 8}
ORDER = ("shape", "geometry", "exact")


def box(kind, content, long=False):
    """Bytes of a box."""
    if long:
        return struct.pack(">I4sQ", 1, kind, len(content) + 16) + content
    return struct.pack(">I4s", len(content) + 8, kind) + content


class Node:
    """Box of a tree: kind, head (bytes before the children or all content), kids or None."""

    def __init__(self, kind, head, kids=None):
        self.kind, self.head, self.kids = kind, head, kids

    @classmethod
    def parse(cls, data):
        size, kind = struct.unpack_from(">I4s", data)
        content = data[8:size]
        skip = CONTAINERS.get(kind)
        if skip is None:
            return cls(kind, content)
        kids, at = [], skip
        while at < len(content):
            n = struct.unpack_from(">I", content, at)[0]
            kids.append(cls.parse(content[at:at + n]))
            at += n
        return cls(kind, content[:skip], kids)

    def bytes(self):
        return box(self.kind, self.head + b"".join(k.bytes() for k in self.kids or []))

    def find(self, path):
        """Node at a path such as "trak1/mdia/hdlr" (a number counts from 0)."""
        node = self
        for step in path.split("/"):
            kind, n = (step[:4], int(step[4:] or 0))
            node = [k for k in node.kids if k.kind == kind.encode()][n]
        return node


class Parts:
    """ftyp bytes, moov Node (without gcrc), fragments, gaps {index of fragment: count}, hooks."""

    def __init__(self, data):
        file = GvcFile(memoryview(data))
        self.file = file
        head = file.head
        n = struct.unpack_from(">I", data)[0]
        self.ftyp = data[:n]
        self.moov = Node.parse(data[n:n + struct.unpack_from(">I", data, n)[0]])
        self.moov.kids.pop()
        self.D = head.config.D
        self.tracks = {k: t.id for k, t in head.tracks.items()}
        self.main = head.main.kind
        self.fragments = []
        for f in file.fragments:
            runs = {}
            for kind, run in f.runs.items():
                samples = [f.sample(kind, i) for i in range(f.count)]
                offsets = [number * self.D + run.track.T - run.t - i * self.D
                           for i, number in enumerate(run.numbers)]
                runs[kind] = {"samples": samples, "offsets": offsets, "t": run.t}
            self.fragments.append(runs)
        self.hooks = {}

    def hook(self, name, value, *more):
        return self.hooks[name](value, *more) if name in self.hooks else value

    def head(self):
        ftyp = self.hook("ftyp", self.ftyp)
        kids = self.head_kids = self.hook("moov", [k.bytes() for k in self.moov.kids])
        return with_gcrc(b"moov", kids, ftyp, self.hook("crc", True, "moov"), start=ftyp)

    def traf(self, runs, kind, index, offset):
        run = runs[kind]
        n = len(run["samples"])
        tfhd = struct.pack(">II", 0x020000, self.tracks[kind])
        tfdt = struct.pack(">IQ", 0x01000000, run["t"])
        rows = b"".join(struct.pack(">Ii", len(s), o)
                        for s, o in zip(run["samples"], run["offsets"]))
        trun = struct.pack(">IIiI", 0x01000A05, n, offset, 0x02000000) + rows
        gcks = struct.pack(">I", 0) + b"".join(struct.pack(">I", zlib.crc32(s))
                                               for s in run["samples"])
        kids = []
        for name, content in (("tfhd", tfhd), ("tfdt", tfdt), ("trun", trun), ("gcks", gcks)):
            content = self.hook(name, content, kind, index)
            if content is not None:
                kids.append(box(name.encode(), content))
        return box(b"traf", b"".join(self.hook("traf", kids, kind, index)))

    def fragment(self, index):
        runs = self.fragments[index]
        content = b"".join(b"".join(runs[k]["samples"]) for k in ORDER if k in runs)
        content = self.hook("mdat", content, index)
        mdat = box(b"mdat", content, self.hook("long", False))
        size = 0
        for _ in range(2):
            kids = [box(b"mfhd", struct.pack(">II", 0, index + 1))]
            offset = size + (16 if self.hook("long", False) else 8)
            places = {}
            for k in ORDER:
                if k in runs:
                    places[k] = offset
                    offset += sum(map(len, runs[k]["samples"]))
            for k in ("geometry", "shape", "exact"):
                if k in runs:
                    kids.append(self.traf(runs, k, index, places[k]))
            kids = self.hook("moof", kids, index)
            moof = with_gcrc(b"moof", kids, b"", self.hook("crc", True, "moof"))
            size = len(moof)
        return moof, mdat

    def build(self):
        """Bytes of the file."""
        head = self.hook("ftyp", self.ftyp) + self.head()
        top, entries, at = [head], [], len(head)
        for i, runs in enumerate(self.fragments):
            for extra in self.hook("before", [], i):
                top.append(extra)
                at += len(extra)
            moof, mdat = self.fragment(i)
            run = runs[self.main]
            entries.append((run["t"] + run["offsets"][0], at))
            pair = self.hook("pair", [moof, mdat], i)
            top += pair
            at += sum(map(len, pair))
        for extra in self.hook("before", [], len(self.fragments)):
            top.append(extra)
        body = b"".join(top)
        return self.hook("file", self.finish(body, entries, head))

    def finish(self, body, entries, head):
        rows = b"".join(struct.pack(">QQ3B", t, o, 1, 1, 1)
                        for t, o in self.hook("entries", entries))
        tfra = struct.pack(">IIII", 0x01000000, self.tracks[self.main], 0, len(entries)) + rows
        kids = [box(b"tfra", self.hook("tfra", tfra))]
        kids.append(box(b"ghed", b"\0\0\0\0" + self.hook(
            "ghed", zstandard.ZstdCompressor().compress(head))))
        kids = self.hook("mfra", kids)
        size = 8 + sum(map(len, kids)) + 44 + 32
        index = struct.pack(">I4s", size, b"mfra") + b"".join(kids)
        gdig = struct.pack(">I4s", 44, b"gdig") + self.hook("gdigflags", b"\0\0\0\0")
        digest = hashlib.sha256(body + index + gdig).digest()
        if not self.hook("crc", True, "gdig"):
            digest = bytes(32)
        index += gdig + digest + struct.pack(">I4sI", 16, b"gcrc", 0)
        crc = zlib.crc32(index) ^ (0 if self.hook("crc", True, "mfra") else 1)
        mfro = struct.pack(">I4sII", 16, b"mfro", 0, size)
        return body + index + struct.pack(">I", crc) + self.hook("mfro", mfro)


def with_gcrc(kind, kids, before, right=True, start=b""):
    """A box with kids and a gcrc as its last child; `before` precedes it in the sum."""
    inner = b"".join(kids)
    data = struct.pack(">I4s", len(inner) + 24, kind) + inner + struct.pack(">I4sI", 16, b"gcrc", 0)
    return data + struct.pack(">I", zlib.crc32(before + data) ^ (not right))


def ggap(first, count, flags=0):
    data = struct.pack(">I4sIQQI4sI", 44, b"ggap", flags, first, count, 16, b"gcrc", 0)
    return data + struct.pack(">I", zlib.crc32(data))
