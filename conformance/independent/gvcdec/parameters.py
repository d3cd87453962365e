# SPDX-License-Identifier: MIT
"""H.264 parameter sets in avcC and their restrictions (gvc.md 6.2.1, 6.2.4, 13.1)."""

from .bits import Bits, check_nal
from .errors import Damaged, Limit, Unsupported, placed
from .fields import Reader
from .limits import PICTURE_MEMORY


class Parameters:
    """What slice headers need of the parameter sets; sps, pps: NAL units as bytes."""


def want(name, value, allowed):
    """Reject a stream where a syntax element has another value (6.2.1)."""
    if value != allowed:
        raise Damaged("6.2.1", f"{name} is {value}, not {allowed}")


def read_avcc(box, config):
    """Parameters of an avcC box (6.2.4), which must fit the config."""
    with placed(box.name):
        r = Reader(box.content(), "6.2.4")
        version, profile, _, _, length, count = r.unpack("6B")
        if version == 1 and profile != 110:
            raise Unsupported("6.2.1", f"AVCProfileIndication {profile}, not 110")
        if version != 1 or length & 3 != 3 or count & 31 != 1:
            raise Damaged("6.2.4", f"avcC: version {version}, "
                                   f"length size {(length & 3) + 1}, {count & 31} SPS")
        p = Parameters()
        p.sps = r.take(r.u16())
        if len(p.sps) > 1024:
            raise Damaged("6.2.4", f"sequence parameter set of {len(p.sps)} bytes")
        count = r.u8()
        if count != 1:
            raise Damaged("6.2.4", f"{count} picture parameter sets")
        p.pps = r.take(r.u16())
        for unit, kind in ((p.sps, 7), (p.pps, 8)):
            check_nal(unit)
            if unit[0] & 31 != kind or not unit[0] & 96:
                raise Damaged("6.2.4", f"no parameter set: NAL unit header {unit[0]:#x}")
        read_sps(p, config)
        read_pps(p)
    return p


def skip_scaling_list(bits, size):
    """scaling_list() of ISO/IEC 14496-10 7.3.2.1.1.1."""
    last = following = 8
    for _ in range(size):
        if following:
            following = (last + bits.se()) % 256
        last = following or last


def skip_scaling_matrix(bits, lists):
    """Scaling lists of a parameter set if they are there."""
    if bits.flag():
        for i in range(lists):
            if bits.flag():
                skip_scaling_list(bits, 16 if i < 6 else 64)


def read_sps(p, config):
    """seq_parameter_set_data() (ISO/IEC 14496-10 7.3.2.1.1), the table of 6.2.1."""
    b = Bits(p.sps[1:])
    profile = b.u(8)
    if profile != 110:
        raise Unsupported("6.2.1", f"profile_idc {profile}, not 110")
    b.u(16)
    p.sps_id = b.ue(31)
    want("chroma_format_idc", b.ue(3), 1)
    want("bit_depth_luma_minus8", b.ue(), 2)
    want("bit_depth_chroma_minus8", b.ue(), 2)
    want("qpprime_y_zero_transform_bypass_flag", b.flag(), 0)
    skip_scaling_matrix(b, 8)
    p.frame_num_bits = b.ue(12) + 4
    read_order_type(p, b)
    p.references = b.ue(16)
    want("gaps_in_frame_num_value_allowed_flag", b.flag(), 0)
    columns, rows = b.ue(1 << 20) + 1, b.ue(1 << 20) + 1
    want("frame_mbs_only_flag", b.flag(), 1)
    b.flag()
    crop = [b.ue() for _ in range(4)] if b.flag() else [0, 0, 0, 0]
    b.flag()
    check_size(p, columns, rows, crop, config)


def read_order_type(p, b):
    """Fields of picture order count (ISO/IEC 14496-10 7.4.2.1.1)."""
    p.order_type = b.ue(2)
    p.lsb_bits = p.always_zero = p.non_ref = p.top_to_bottom = 0
    p.cycle = []
    if p.order_type == 0:
        p.lsb_bits = b.ue(12) + 4
    elif p.order_type == 1:
        p.always_zero = b.flag()
        p.non_ref, p.top_to_bottom = b.se(), b.se()
        p.cycle = [b.se() for _ in range(b.ue(255))]


def check_size(p, columns, rows, crop, config):
    """Size of a picture after cropping (6.2.1), its area (13.1) and memory (15.3)."""
    p.macroblocks = columns * rows
    p.width = 16 * columns - 2 * (crop[0] + crop[1])
    p.height = 16 * rows - 2 * (crop[2] + crop[3])
    want("width after cropping", p.width, config.width)
    want("height after cropping", p.height, 3 * config.plane_height)
    if p.macroblocks > 139264:
        raise Damaged("13.1", f"picture of {p.macroblocks} macroblocks")
    # 4:2:0 of two bytes a sample is 768 bytes a macroblock; references and the one being decoded.
    if 768 * p.macroblocks * (p.references + 4) > PICTURE_MEMORY:
        raise Limit("13.3", "pictures need more memory than this decoder gives")


def read_pps(p):
    """pic_parameter_set_rbsp() (ISO/IEC 14496-10 7.3.2.2) as far as slice headers need it."""
    b = Bits(p.pps[1:])
    p.pps_id = b.ue(255)
    if b.ue(31) != p.sps_id:
        raise Damaged("6.2.1", "picture parameter set names another sequence parameter set")
    p.cabac = b.flag()
    p.bottom_order = b.flag()
    want("num_slice_groups_minus1", b.ue(7), 0)
    p.active = [b.ue(31) + 1, b.ue(31) + 1]
    p.weighted = b.flag()
    p.weighted_b = b.u(2)
    if p.weighted_b == 3:
        raise Damaged("6.2.1", "weighted_bipred_idc 3")
    b.se(), b.se(), b.se()
    b.flag(), b.flag()
    want("redundant_pic_cnt_present_flag", b.flag(), 0)
