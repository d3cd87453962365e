# SPDX-License-Identifier: MIT
"""OpenEXR images: gvc.md 6.5. Every part can be replaced by a wrong one."""
import struct
from dataclasses import dataclass, field

import numpy

from .deflate import compress

NONE, RLE, ZIPS, ZIP = 0, 1, 2, 3
LINES = {NONE: 1, RLE: 1, ZIPS: 1, ZIP: 16}
CHANNELS = ("X", "X.lo", "Y", "Y.lo", "Z", "Z.lo")
HALF = 1


def halves(codes):
    """Bits of the six channels (6.5.4), an array [6][S][S]."""
    codes = codes.astype(numpy.uint32)
    high = (codes // 32).astype(numpy.float64) / 2048
    out = numpy.empty((6,) + codes.shape[1:], numpy.uint16)
    out[0::2] = high.astype(numpy.float16).view(numpy.uint16)
    out[1::2] = 0x3800 + codes % 32
    return out


def attribute(name, kind, value):
    """One attribute of the header."""
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def channel_list(names=CHANNELS, pixel_type=HALF, sampling=1):
    """The value of `channels`."""
    fields = struct.pack("<iB3xii", pixel_type, 0, sampling, sampling)
    return b"".join(n.encode() + b"\0" + fields for n in names) + b"\0"


def _predicted(raw):
    """Bytes of even places, then those of odd ones, as differences: before RLE and ZIP."""
    data = raw[0::2] + raw[1::2]
    values = numpy.frombuffer(data, numpy.uint8).astype(numpy.int64)
    values[1:] = (values[1:] - numpy.frombuffer(data, numpy.uint8)[:-1] + 128) % 256
    return values.astype(numpy.uint8).tobytes()


def _run_lengths(data):
    """OpenEXR's run lengths: n - 1 and a byte for a run of n >= 3, else -n and n bytes."""
    out, at, literal = b"", 0, b""
    while at < len(data):
        end = at
        while end < len(data) and data[end] == data[at] and end - at < 128:
            end += 1
        if end - at >= 3:
            out += _literal(literal) + bytes([end - at - 1, data[at]])
            literal = b""
        else:
            literal += data[at:end]
        at = end
    return out + _literal(literal)


def _literal(data):
    parts = [data[i:i + 127] for i in range(0, len(data), 127)]
    return b"".join(bytes([256 - len(p)]) + p for p in parts)


def _packed(raw, compression):
    if compression == NONE:
        return raw
    small = _run_lengths(_predicted(raw)) if compression == RLE else compress(_predicted(raw))
    return small if len(small) < len(raw) else raw


@dataclass
class Image:
    """An OpenEXR file of codes [3][S][S]. drop and replace: attributes by name."""
    codes: object
    origin: tuple
    step: float
    time: float
    compression: int = ZIP
    unit: str = "m"
    version: bytes = b"\x02\0\0\0"
    channels: bytes = field(default_factory=channel_list)
    drop: tuple = ()
    replace: dict = field(default_factory=dict)
    more: tuple = ()
    edit_halves: object = None
    line_order: int = 0

    def attributes(self):
        """The attributes of the header in the order of their names but for those of gvc, which stand last."""
        last = self.codes.shape[1] - 1
        window = struct.pack("<4i", 0, 0, last, last)
        values = {
            "channels": ("chlist", self.channels), "compression": ("compression", bytes([self.compression])),
            "dataWindow": ("box2i", window), "displayWindow": ("box2i", window),
            "lineOrder": ("lineOrder", bytes([self.line_order])), "pixelAspectRatio": ("float", struct.pack("<f", 1)),
            "screenWindowCenter": ("v2f", bytes(8)), "screenWindowWidth": ("float", struct.pack("<f", 1)),
            "gvcVersion": ("int", bytes(4)), "gvcOrigin": ("v3d", struct.pack("<3d", *self.origin)),
            "gvcStep": ("double", struct.pack("<d", self.step)), "gvcTime": ("double", struct.pack("<d", self.time))}
        if self.unit:
            values["gvcUnit"] = ("string", self.unit.encode())
        values.update(self.replace)
        out = [attribute(n, *v) for n, v in values.items() if n not in self.drop]
        return b"".join(out + [attribute(*a) for a in self.more])

    def encode(self):
        """The bytes of the file."""
        head = b"\x76\x2f\x31\x01" + self.version + self.attributes() + b"\0"
        bits = halves(self.codes)
        if self.edit_halves:
            self.edit_halves(bits)
        size, lines = self.codes.shape[1], LINES.get(self.compression, 1)
        chunks = []
        for y in range(0, size, lines):
            raw = bits[:, y:y + lines].transpose(1, 0, 2).astype("<u2").tobytes()
            packed = _packed(raw, self.compression)
            chunks.append(struct.pack("<ii", y, len(packed)) + packed)
        at, table = len(head) + 8 * len(chunks), b""
        for chunk in chunks:
            table += struct.pack("<Q", at)
            at += len(chunk)
        return head + table + b"".join(chunks)
