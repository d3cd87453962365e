# SPDX-License-Identifier: MIT
"""NAL units and slice headers of a sample (gvc.md 6.2.5; ISO/IEC 14496-10 7.3.3)."""

import struct

from .bits import Bits, check_nal
from .errors import Damaged

HEADER_BYTES = 4096  # a slice header is shorter than this
SKIPPED = (6, 9, 12)  # SEI, delimiter, filler
P, B, I = 0, 1, 2


class Slice:
    """Header fields that gvc.md or the picture order count needs."""

    __slots__ = ("idr", "ref", "first", "type", "pps", "frame_num", "idr_id", "lsb",
                 "bottom", "delta", "marks")

    def picture(self):
        """What must be the same in all slices of a picture (7.4.1.2.4 of H.264)."""
        return (self.idr, self.ref > 0, self.pps, self.frame_num, self.idr_id, self.lsb,
                self.bottom, self.delta, self.marks)


def nal_units(sample):
    """NAL units of a sample (bytes), each with a u32 length, which fill it (6.2.5)."""
    at, units = 0, []
    while at < len(sample):
        if len(sample) - at < 4:
            raise Damaged("6.2.5", "sample ends inside a length of a NAL unit")
        size = struct.unpack_from(">I", sample, at)[0]
        at += 4
        if size > len(sample) - at:
            raise Damaged("6.2.5", f"NAL unit of {size} bytes leaves the sample")
        units.append(sample[at:at + size])
        check_nal(units[-1])
        at += size
    return units


def read_sample(sample, first, p):
    """Slice header of the picture of a sample; first: of its fragment (6.2.5)."""
    wanted = 5 if first else 1
    picture, before = None, -1
    for unit in nal_units(sample):
        kind = unit[0] & 31
        if kind in SKIPPED:
            continue
        if kind != wanted:
            raise Damaged("6.2.5", f"NAL unit of type {kind} where {wanted} is wanted")
        head = read_slice(unit, p)
        if picture is None:
            picture = head
            if head.first != 0:
                raise Damaged("6.2.5", f"first slice begins at macroblock {head.first}")
        elif head.first <= before:
            raise Damaged("6.2.5", "first_mb_in_slice does not grow: two pictures in a sample")
        elif head.picture() != picture.picture():
            raise Damaged("6.2.5", "slices of two pictures in a sample")
        before = head.first
    if picture is None:
        raise Damaged("6.2.5", "sample without a slice")
    return picture


def read_slice(unit, p):
    """Slice header of a NAL unit of type 1 or 5."""
    s = Slice()
    s.idr, s.ref = unit[0] & 31 == 5, (unit[0] >> 5) & 3
    if s.idr and not s.ref:
        raise Damaged("6.2.5", "IDR picture with nal_ref_idc 0")
    b = Bits(unit[1:HEADER_BYTES], "6.2.5")
    s.first = b.ue(p.macroblocks - 1)
    s.type = b.ue(9) % 5
    if s.type > I or (s.idr and s.type != I):
        raise Damaged("6.2.5", f"slice_type {s.type} in this picture")
    s.pps = b.ue(255)
    if s.pps != p.pps_id:
        raise Damaged("6.2.5", f"slice names picture parameter set {s.pps}")
    s.frame_num = b.u(p.frame_num_bits)
    s.idr_id = b.ue(65535) if s.idr else -1
    read_order(s, b, p)
    if s.type == B:
        b.flag()
    active = read_active(s, b, p)
    read_list_changes(s, b)
    if (p.weighted and s.type == P) or (p.weighted_b == 1 and s.type == B):
        skip_weights(s, b, active)
    read_marking(s, b)
    return s


def read_order(s, b, p):
    """Fields of the picture order count."""
    s.lsb = s.bottom = 0
    delta = [0, 0]
    if p.order_type == 0:
        s.lsb = b.u(p.lsb_bits)
        if p.bottom_order:
            s.bottom = b.se()
    elif p.order_type == 1 and not p.always_zero:
        delta[0] = b.se()
        if p.bottom_order:
            delta[1] = b.se()
    s.delta = tuple(delta)


def read_active(s, b, p):
    """Numbers of active references of both lists."""
    active = list(p.active)
    if s.type != I and b.flag():
        active[0] = b.ue(31) + 1
        if s.type == B:
            active[1] = b.ue(31) + 1
    if s.type != I and max(active[:1 + (s.type == B)]) > 16:
        raise Damaged("6.2.5", "more than 16 active references of a frame")
    return active


def read_list_changes(s, b):
    """ref_pic_list_modification()."""
    for _ in range({P: 1, B: 2, I: 0}[s.type]):
        if not b.flag():
            continue
        while b.ue(3) != 3:
            b.ue()


def skip_weights(s, b, active):
    """pred_weight_table() of 4:2:0."""
    b.ue(7), b.ue(7)
    for count in active[:1 + (s.type == B)]:
        for _ in range(count):
            if b.flag():
                b.se(), b.se()
            if b.flag():
                b.se(), b.se(), b.se(), b.se()


def read_marking(s, b):
    """dec_ref_pic_marking(); operation 5 would break the sequence of frame_num (6.2.6)."""
    s.marks = ()
    if not s.ref:
        return
    if s.idr:
        s.marks = (b.flag(), b.flag())
        return
    marks = []
    if b.flag():
        while True:
            operation = b.ue(6)
            marks.append(operation)
            if operation == 0:
                break
            if operation == 5:
                raise Damaged("6.2.6", "memory_management_control_operation 5")
            marks += [b.ue() for _ in range(2 if operation == 3 else 1)]
    s.marks = tuple(marks)
