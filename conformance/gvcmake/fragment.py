# SPDX-License-Identifier: MIT
"""moof and mdat: gvc.md 4.6 to 4.8, 10.2 and 11.3."""
import struct
from dataclasses import dataclass

from .boxes import Box, crc32, full, seal, u32, u64
from .head import NOT_SYNC, SYNC

ORDER = ("shape", "geometry", "exact")  # of samples in mdat (4.8.1)


@dataclass
class Run:
    """The samples of a track in a fragment, in decoding order. shown: presentation numbers in the fragment."""
    samples: list
    shown: list
    offsets: bool = True  # composition offsets are written even where they are 0
    version: int = 1  # of trun
    time_version: int = 1  # of tfdt
    sizes_in: str = "trun"  # or "tfhd": one size for all
    duration_in: str = "trex"  # or "tfhd", "trun"
    flags_in: str = "first"  # "first": trex and first-sample-flags; "each": in trun; "tfhd": with first-sample-flags; "none"
    data_offset: int = 0  # added to what is right
    order: list = None  # composition offsets in ticks, if they are to be others than follow from `shown`


@dataclass
class Fragment:
    """A group of frames. edit(moof) may change the tree before the checksum is made."""
    first_frame: int
    runs: dict
    edit: object = None
    sequence: int = None
    large_moof: bool = False
    large_mdat: bool = False
    mdat_tail: bytes = b""
    mdat_type: str = "mdat"
    mdat_size: int = None
    crc_flip: int = 0
    crc_missing: bool = False
    crc_early: bool = False
    between: bytes = b""  # between moof and mdat
    before: bytes = b""  # before moof
    decode_time: int = None  # of tfdt, if it is to be another one than that of first_frame


def _header(movie, kind, run):
    flags, fields = 0x020000, u32(movie.track_id[kind])
    if run.duration_in == "tfhd":
        flags, fields = flags | 8, fields + u32(movie.config.rate_den)
    if run.sizes_in == "tfhd":
        flags, fields = flags | 0x10, fields + u32(len(run.samples[0]))
    if run.flags_in == "tfhd":
        flags, fields = flags | 0x20, fields + u32(NOT_SYNC)
    return full("tfhd", 0, flags, fields)


def composition_offsets(movie, kind, run):
    """o[i] of 11.2."""
    if run.order is not None:
        return run.order
    shift = movie.media_time[kind] or 0
    return [(shown - i) * movie.config.rate_den + shift for i, shown in enumerate(run.shown)]


def _run(movie, kind, run, data_offset):
    offsets = composition_offsets(movie, kind, run)
    with_offsets = run.offsets or any(offsets)
    flags = 1 | (0x100 if run.duration_in == "trun" else 0) | (0x200 if run.sizes_in == "trun" else 0)
    flags |= {"each": 0x400, "none": 0}.get(run.flags_in, 4) | (0x800 if with_offsets else 0)
    fields = u32(len(run.samples)) + struct.pack(">I", data_offset + run.data_offset)
    if flags & 4:
        fields += u32(SYNC)
    for i, (sample, offset) in enumerate(zip(run.samples, offsets)):
        fields += u32(movie.config.rate_den) if run.duration_in == "trun" else b""
        fields += u32(len(sample)) if run.sizes_in == "trun" else b""
        fields += u32(NOT_SYNC if i else SYNC) if run.flags_in == "each" else b""
        if with_offsets:
            fields += struct.pack(">i" if run.version else ">I", offset)
    return full("trun", run.version, flags, fields)


def _time(run, time):
    return full("tfdt", run.time_version, 0, u64(time) if run.time_version else u32(time))


def _moof(movie, fragment, number, places):
    boxes = [full("mfhd", 0, 0, u32(number if fragment.sequence is None else fragment.sequence))]
    time = fragment.first_frame * movie.config.rate_den if fragment.decode_time is None else fragment.decode_time
    for kind in movie.kinds:
        run = fragment.runs[kind]
        boxes.append(Box("traf", children=[
            _header(movie, kind, run), _time(run, time), _run(movie, kind, run, places.get(kind, 1 << 16)),
            full("gcks", 0, 0, u32(*[crc32(s) for s in run.samples]))]))
    moof = Box("moof", children=boxes, large=fragment.large_moof)
    if fragment.edit:
        fragment.edit(moof)
    return moof


def close(box, flip=0, missing=False, early=False):
    """Bytes of a box with gcrc as its last child, or with another box behind that."""
    if missing:
        return box.encode()
    behind = Box("free", bytes(8)).encode() if early else b""
    box.children += [Box("gcrc", bytes(8))] + ([Box("free", bytes(8))] if early else [])
    raw = box.encode()[:-16 - len(behind)]
    return raw + seal(raw, flip) + behind


def write(movie, fragment, number):
    """The bytes of moof and mdat, and the size of moof."""
    size = len(close(_moof(movie, fragment, number, {}), 0, fragment.crc_missing, fragment.crc_early))
    at, places, data = size + (16 if fragment.large_mdat else 8), {}, b""
    for kind in ORDER:
        if kind in movie.kinds:
            places[kind] = at
            content = b"".join(fragment.runs[kind].samples)
            at += len(content)
            data += content
    moof = close(_moof(movie, fragment, number, places), fragment.crc_flip, fragment.crc_missing, fragment.crc_early)
    mdat = Box(fragment.mdat_type, data + fragment.mdat_tail, large=fragment.large_mdat)
    mdat.size = fragment.mdat_size
    return moof + fragment.between + mdat.encode(), size
