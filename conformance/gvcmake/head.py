# SPDX-License-Identifier: MIT
"""ftyp and moov: gvc.md 4.3 to 4.5, 4.9 and clause 5."""
import struct
from dataclasses import dataclass

from .boxes import Box, full, u16, u32, u64
from .h264 import Stream
from .shape import label

MATRIX = u32(0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000)
NOT_SYNC, SYNC = 0x01010000, 0x02000000
NAMES = {"geometry": "gvc geometry images", "shape": "gvc shape records", "exact": "gvc exact images"}
URI = {"shape": b"urn:gvc:shape:0\0", "exact": b"urn:gvc:exact:0\0"}


@dataclass
class Config:
    """The fields of gvcC, clause 5."""
    picture_width: int = 16
    plane_height: int = 16
    image_size: int = 16
    rate_num: int = 25
    rate_den: int = 1
    declared_frames: int = 0
    features: int = 0
    version_major: int = 0
    version_minor: int = 1
    code_bits: int = 10
    code_shift: int = 6
    unit: object = "m"
    encoder: object = "conformance generator"
    settings: object = ""
    tail: bytes = b""

    def encode(self):
        """The content of gvcC."""
        return (u16(self.version_major, self.version_minor)
                + u32(self.features, self.picture_width, self.plane_height, self.image_size)
                + bytes([self.code_bits, self.code_shift]) + u32(self.rate_num, self.rate_den)
                + u64(self.declared_frames) + label(self.unit) + label(self.encoder) + label(self.settings) + self.tail)


def file_type(major=b"gvc1", minor=0, compatible=(b"gvc1", b"iso6", b"mp41")):
    """ftyp (4.3.1)."""
    return Box("ftyp", major + u32(minor) + b"".join(compatible))


def avc_config(stream: Stream, length_size=4, sps=None, pps=None):
    """avcC (6.2.4)."""
    sps = [stream.sps()] if sps is None else sps
    pps = [stream.pps()] if pps is None else pps
    out = bytes([1, 110, 0, stream.level_idc, 0xFC | (length_size - 1), 0xE0 | len(sps)])
    out += b"".join(u16(len(s)) + s for s in sps) + bytes([len(pps)]) + b"".join(u16(len(p)) + p for p in pps)
    return Box("avcC", out + bytes([0xFC | stream.chroma_format_idc, 0xF8 | stream.depth_luma,
                                    0xF8 | stream.depth_chroma, 0]))


def edit_list(media_time, version=1, count=1, rate=0x10000, duration=0):
    """edts with elst (11.2)."""
    form = ">QqI" if version else ">IiI"
    entry = struct.pack(form, duration, media_time, rate)
    return Box("edts", children=[full("elst", version, 0, u32(count) + entry * count)])


def track_header(track_id, width, height, version=0):
    """tkhd."""
    times = u32(0, 0, track_id, 0, 0) if version == 0 else u64(0, 0) + u32(track_id, 0) + u64(0)
    return full("tkhd", version, 3, times + bytes(16) + MATRIX + u32(width << 16, height << 16))


def media_header(timescale, version=0):
    """mdhd."""
    times = u32(0, 0, timescale, 0) if version == 0 else u64(0, 0) + u32(timescale) + u64(0)
    return full("mdhd", version, 0, times + u16(0x55C4, 0))


def handler(kind, name):
    """hdlr."""
    return full("hdlr", 0, 0, u32(0) + kind + bytes(12) + name.encode() + b"\0")


def sample_table(entry):
    """stbl without samples."""
    return Box("stbl", children=[full("stsd", 0, 0, u32(1), [entry])]
               + [full(kind, 0, 0, u32(0)) for kind in ("stts", "stsc", "stco")] + [full("stsz", 0, 0, u32(0, 0))])


def visual_entry(config, stream):
    """avc1 with avcC, colr and gvcC (4.4)."""
    fields = bytes(6) + u16(1) + bytes(16) + u16(config.picture_width, 3 * config.plane_height)
    fields += u32(0x480000, 0x480000, 0) + u16(1) + b"\x03gvc".ljust(32, b"\0") + b"\x00\x18\xff\xff"
    colour = Box("colr", b"nclx" + u16(2, 2, 2) + b"\x80")
    return Box("avc1", fields, [avc_config(stream), colour, Box("gvcC", config.encode())])


def uri_entry(kind, config):
    """urim with `uri ` and, in the main track, gvcC (4.5, 4.9)."""
    return Box("urim", bytes(6) + u16(1), [full("uri ", 0, 0, URI[kind])]
               + ([Box("gvcC", config.encode())] if config else []))


def track(kind, track_id, config, stream, media_time, described, is_main, versions=0):
    """trak of one of the three kinds."""
    picture = (config.picture_width, 3 * config.plane_height) if kind == "geometry" else (0, 0)
    entry = visual_entry(config, stream) if kind == "geometry" else uri_entry(kind, config if is_main else None)
    header = full("vmhd", 0, 1, bytes(8)) if kind == "geometry" else full("nmhd")
    place = Box("dinf", children=[full("dref", 0, 0, u32(1), [full("url ", 0, 1)])])
    media = Box("mdia", children=[
        media_header(config.rate_num, versions),
        handler(b"vide" if kind == "geometry" else b"meta", NAMES[kind]),
        Box("minf", children=[header, place, sample_table(entry)])])
    out = [track_header(track_id, *picture, versions)]
    if kind == "shape":
        out.append(Box("tref", children=[Box("cdsc", u32(described))]))
    if media_time is not None:
        out.append(edit_list(media_time))
    return Box("trak", children=out + [media])


def movie_header(timescale, next_track):
    """mvhd."""
    return full("mvhd", 0, 0, u32(0, 0, timescale, 0, 0x10000) + u16(0x100) + bytes(10) + MATRIX + bytes(24)
                + u32(next_track))


def extends(config, track_ids):
    """mvex with mehd and trex (4.3.2)."""
    boxes = [full("trex", 0, 0, u32(i, 1, config.rate_den, 0, NOT_SYNC)) for i in track_ids]
    length = config.declared_frames * config.rate_den
    if length:
        boxes.insert(0, full("mehd", 1, 0, u64(length)))
    return Box("mvex", children=boxes)
