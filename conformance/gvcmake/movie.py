# SPDX-License-Identifier: MIT
"""A whole file: gvc.md 4.1, 4.10 and 10.4. What is right is worked out; edits make it wrong where they are asked to."""
import hashlib
import struct
from dataclasses import dataclass, field

from . import fragment as fragments
from . import head, zstd
from .boxes import Box, full, seal, u32, u64
from .head import Config
from .h264 import Stream


@dataclass
class Frame:
    """What a decoder must make of a frame."""
    digest: bytes
    mesh: str
    preview: tuple = None  # digest and mesh of the preview


@dataclass
class Gap:
    """A ggap box (12.8)."""
    first_frame: int
    count: int
    crc_flip: int = 0
    stated_first: int = None


@dataclass
class Movie:
    """Parts of a file. parts: fragments, gaps and bytes in the order of the file. Edits get the tree to change it."""
    config: Config
    stream: Stream
    kinds: tuple  # tracks, in the order of moov
    parts: list = field(default_factory=list)
    frames: dict = field(default_factory=dict)
    track_id: dict = field(default_factory=lambda: {"geometry": 1, "shape": 2, "exact": 3})
    media_time: dict = field(default_factory=lambda: {"geometry": None, "shape": None, "exact": None})
    file_type: Box = field(default_factory=head.file_type)
    versions: int = 0  # of tkhd and mdhd
    edit_moov: object = None
    edit_index: object = None  # (mfra without gdig, gcrc, mfro)
    large_moov: bool = False
    large_mfra: bool = False
    moov_crc: str = "right"  # or "wrong", "missing", "early"
    index_crc: str = "right"
    digest: str = "right"  # or "wrong", "missing"
    size_field: int = 0  # added to the size in mfro
    index_version: int = 1
    number_sizes: int = 0  # of tfra: lengths of traf, trun and sample numbers
    index: str = "whole"  # or "missing"
    copy: str = "whole"  # or "missing"
    tail: bytes = b""  # behind mfra
    before_moov: bytes = b""
    edit_bytes: object = None

    @property
    def main(self):
        """The kind of the main track (4.3.4)."""
        return "geometry" if "geometry" in self.kinds else "exact"

    def fragment(self, number=0):
        """A fragment by its number from 0."""
        return [p for p in self.parts if isinstance(p, fragments.Fragment)][number]

    def write(self):
        """The bytes of the file."""
        out = self._head()
        copy, entries, number = out, [], 0
        for part in self.parts:
            if isinstance(part, bytes):
                out += part
            elif isinstance(part, Gap):
                out += _gap(part)
            else:
                number += 1
                out += part.before
                entries.append((self._entry_time(part), len(out)))
                out += fragments.write(self, part, number)[0]
        if self.index == "whole":
            out += self._index(out, copy, entries)
        out += self.tail
        return self.edit_bytes(out) if self.edit_bytes else out

    def _entry_time(self, part):
        run = part.runs[self.main]
        time = part.first_frame * self.config.rate_den if part.decode_time is None else part.decode_time
        return time + fragments.composition_offsets(self, self.main, run)[0]

    def _head(self):
        main = self.track_id[self.main]
        tracks = [head.track(kind, self.track_id[kind], self.config, self.stream, self.media_time[kind], main,
                             kind == self.main, self.versions) for kind in self.kinds]
        moov = Box("moov", children=[head.movie_header(self.config.rate_num, min(1 + max(self.track_id.values()), 0xFFFFFFFF))] + tracks
                   + [head.extends(self.config, [self.track_id[k] for k in self.kinds])], large=self.large_moov)
        if self.edit_moov:
            self.edit_moov(moov)
        first = self.file_type.encode() + self.before_moov
        if self.moov_crc == "missing":
            return first + moov.encode()
        moov.add("", Box("gcrc", bytes(8)), -1)
        behind = Box("free", bytes(8)).encode() if self.moov_crc == "early" else b""
        if behind:
            moov.add("", Box("free", bytes(8)), -1)
        raw = first + moov.encode()[:-16 - len(behind)]
        return raw + seal(raw, 1 if self.moov_crc == "wrong" else 0) + behind

    def _table(self, entries):
        """tfra (4.10.1)."""
        fields = u32(self.track_id[self.main], self.number_sizes, len(entries))
        for time, offset in entries:
            fields += u64(time, offset) if self.index_version else u32(time, offset)
            for shift in (4, 2, 0):
                size = (self.number_sizes >> shift & 3) + 1
                fields += (1 + (self.kinds.index(self.main) if shift == 4 else 0)).to_bytes(size, "big")
        return full("tfra", self.index_version, 0, fields)

    def _index(self, before, copy, entries):
        mfra = Box("mfra", children=[self._table(entries)], large=self.large_mfra)
        if self.copy == "whole":
            mfra.children.append(full("ghed", 0, 0, zstd.raw(copy)))
        if self.edit_index:
            self.edit_index(mfra)
        if self.digest != "missing":
            mfra.children.append(full("gdig", 0, 0, bytes(32)))
        if self.index_crc != "missing":
            mfra.children.append(full("gcrc", 0, 0, bytes(4)))
        mfra.children.append(full("mfro", 0, 0, bytes(4)))
        raw = mfra.encode()
        mfro = struct.pack(">I4sII", 16, b"mfro", 0, len(raw) + self.size_field)
        raw = raw[:-16]
        if self.index_crc != "missing":
            raw = raw[:-16]
        if self.digest != "missing":
            value = bytearray(hashlib.sha256(before + raw[:-32]).digest())
            value[0] ^= 1 if self.digest == "wrong" else 0
            raw = raw[:-32] + bytes(value)
        if self.index_crc != "missing":
            raw += seal(raw, 1 if self.index_crc == "wrong" else 0)
        return raw + mfro


def _gap(gap):
    first = gap.first_frame if gap.stated_first is None else gap.stated_first
    raw = struct.pack(">I4sIQQ", 44, b"ggap", 0, first, gap.count)
    return raw + seal(raw, gap.crc_flip)


def top_level(data):
    """Offset, type and size of each box of the top level (sizes of 32 bits)."""
    at, out = 0, []
    while at + 8 <= len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        out.append((at, kind.decode("latin-1"), size))
        at += size
    return out


def reseal(data):
    """Makes checksums of head and index, offsets in tfra and the digest right again after boxes were moved."""
    data = bytearray(data)
    top = top_level(bytes(data))
    places = [at for at, kind, _ in top if kind == "moof"]
    for at, kind, size in top:
        if kind == "moov":
            data[at + size - 16:at + size] = seal(bytes(data[:at + size - 16]))
    for at, kind, size in [b for b in top if b[1] == "mfra"][-1:]:
        inner = at + 8
        while inner < at + size:
            length, child = struct.unpack_from(">I4s", data, inner)
            if child == b"tfra":
                for i, place in enumerate(places[:(length - 24) // 19]):
                    struct.pack_into(">Q", data, inner + 32 + 19 * i, place)
            elif child == b"gdig":
                data[inner + 12:inner + 44] = hashlib.sha256(data[:inner + 12]).digest()
            elif child == b"gcrc":
                data[inner:inner + 16] = seal(bytes(data[at:inner]))
            inner += length
    return bytes(data)
