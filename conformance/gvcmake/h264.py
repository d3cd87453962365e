# SPDX-License-Identifier: MIT
"""A writer of H.264 High 10 streams that use CAVLC, I_PCM, Intra_16x16 without residual, and skipped macroblocks.

Nothing is searched: the caller says what each macroblock is, so that decoded samples are known exactly. All motion
vectors are 0. Chroma is 512 everywhere. Numbers of clauses are those of ISO/IEC 14496-10.
"""
from dataclasses import dataclass, field

from .bits import BitWriter, nal_unit

CHROMA_SAMPLES = (0, 128, 256, 512)  # of a macroblock, by chroma_format_idc
INTRA_MB_TYPE = {"I": 0, "P": 5, "B": 23}  # what mb_type of an intra macroblock begins with (7.4.5)
SLICE_TYPE = {"P": 0, "B": 1, "I": 2}


@dataclass
class Stream:
    """What the parameter sets say. width and height are those after cropping."""
    width: int
    height: int
    profile_idc: int = 110
    level_idc: int = 31
    chroma_format_idc: int = 1
    depth_luma: int = 2
    depth_chroma: int = 2
    bypass: int = 0
    frame_num_bits: int = 4
    poc_type: int = 0
    poc_bits: int = 8
    poc_cycle: int = 255  # of pic_order_cnt_type 1
    max_num_ref_frames: int = 2
    gaps: int = 0
    frame_mbs_only: int = 1
    reorder: int = 1
    vui: bool = True
    full_range: int = 1
    crop_extra: int = 0  # steps of two rows cropped besides what is needed
    mb_columns: int = field(init=False)
    mb_rows: int = field(init=False)

    def __post_init__(self):
        self.mb_columns = (self.width + 15) // 16
        unit = 16 if self.frame_mbs_only else 32
        self.mb_rows = (self.height + unit - 1) // unit * (unit // 16)

    def sps(self):
        """seq_parameter_set_rbsp() (7.3.2.1) as a NAL unit."""
        b = BitWriter()
        b.u(8, self.profile_idc)
        b.u(8, 0)
        b.u(8, self.level_idc)
        b.ue(0)
        if self.profile_idc in (100, 110, 122, 244):
            b.ue(self.chroma_format_idc)
            b.ue(self.depth_luma)
            b.ue(self.depth_chroma)
            b.u(1, self.bypass)
            b.u(1, 0)  # seq_scaling_matrix_present_flag
        b.ue(self.frame_num_bits - 4)
        b.ue(self.poc_type)
        if self.poc_type == 0:
            b.ue(self.poc_bits - 4)
        elif self.poc_type == 1:
            b.u(1, 1)  # delta_pic_order_always_zero_flag
            b.se(0)
            b.se(0)
            b.ue(self.poc_cycle)
            for _ in range(self.poc_cycle):
                b.se(1 << 29)
        b.ue(self.max_num_ref_frames)
        b.u(1, self.gaps)
        b.ue(self.mb_columns - 1)
        b.ue(self.mb_rows // (1 if self.frame_mbs_only else 2) - 1)
        b.u(1, self.frame_mbs_only)
        if not self.frame_mbs_only:
            b.u(1, 0)  # mb_adaptive_frame_field_flag
        b.u(1, 1)  # direct_8x8_inference_flag
        self._cropping(b)
        self._vui(b)
        b.trailing()
        return nal_unit(7, 3, b.bytes())

    def grey(self):
        """The chroma samples of an I_PCM macroblock, all in the middle of their range."""
        bits = 8 + self.depth_chroma
        return format(1 << (bits - 1), "0%db" % bits) * CHROMA_SAMPLES[self.chroma_format_idc]

    def _cropping(self, b):
        right = (16 * self.mb_columns - self.width) // 2
        bottom = (16 * self.mb_rows - self.height) // (2 if self.frame_mbs_only else 4) + self.crop_extra
        b.u(1, 1 if right or bottom else 0)
        if right or bottom:
            for steps in (0, right, 0, bottom):
                b.ue(steps)

    def _vui(self, b):
        b.u(1, 1 if self.vui else 0)
        if not self.vui:
            return
        b.u(2, 0)  # aspect ratio, overscan
        b.u(1, 1)  # video_signal_type_present_flag
        b.u(3, 5)
        b.u(1, self.full_range)
        b.u(1, 1)  # colour_description_present_flag: unspecified
        b.u(24, 0x020202)
        b.u(5, 0)  # chroma location, timing, NAL and VCL HRD, picture structure
        b.u(1, 1)  # bitstream_restriction_flag
        b.u(1, 1)
        for value in (0, 0, 16, 16, self.reorder, max(self.max_num_ref_frames, self.reorder)):
            b.ue(value)

    def pps(self):
        """pic_parameter_set_rbsp() (7.3.2.2) as a NAL unit: CAVLC, deblocking said in each slice."""
        b = BitWriter()
        b.ue(0)
        b.ue(0)
        b.u(2, 0)  # CAVLC, no field order
        b.ue(0)  # one slice group
        b.ue(0)
        b.ue(0)
        b.u(3, 0)  # no weighted prediction
        for _ in range(3):
            b.se(0)
        b.u(3, 4)  # deblocking_filter_control_present_flag
        b.trailing()
        return nal_unit(8, 3, b.bytes())


@dataclass
class Picture:
    """One coded picture. mbs: for each macroblock "skip", ("pcm", 256 luma samples) or ("intra", prediction mode)."""
    kind: str
    mbs: list
    frame_num: int
    poc: int
    idr: bool = False
    reference: bool = True
    slices: tuple = (0,)  # first macroblock of each
    idr_pic_id: int = 0
    mixed: bool = False  # intra slices in a P or B picture where nothing is skipped
    chroma: object = None  # makes the chroma bits of an I_PCM macroblock, if they are not to be grey


def _slice_header(stream, picture, kind, first):
    b = BitWriter()
    b.ue(first)
    b.ue(SLICE_TYPE[kind])
    b.ue(0)
    b.u(stream.frame_num_bits, picture.frame_num % (1 << stream.frame_num_bits))
    if not stream.frame_mbs_only:
        b.u(1, 0)  # field_pic_flag
    if picture.idr:
        b.ue(picture.idr_pic_id)
    if stream.poc_type == 0:
        b.u(stream.poc_bits, picture.poc % (1 << stream.poc_bits))
    if kind == "B":
        b.u(1, 1)  # direct_spatial_mv_pred_flag
    if kind != "I":
        b.u(1, 0)  # num_ref_idx_active_override_flag
        b.u({"P": 1, "B": 2}[kind], 0)  # no modification of reference lists
    if picture.reference:
        b.u(2 if picture.idr else 1, 0)  # dec_ref_pic_marking()
    b.se(0)  # slice_qp_delta
    b.ue(1)  # disable_deblocking_filter_idc
    return b


def _no_coefficients(stream, picture, at, first):
    """coeff_token for no coefficients: which code depends on the blocks to the left and above (9.2.1)."""
    counts = []
    if at % stream.mb_columns and at - 1 >= first:
        counts.append(at - 1)
    if at - stream.mb_columns >= first:
        counts.append(at - stream.mb_columns)
    counts = [16 if picture.mbs[a][0] == "pcm" else 0 for a in counts]
    n = (sum(counts) + len(counts) - 1) // len(counts) if counts else 0
    return "1" if n < 2 else "11" if n < 4 else "1111" if n < 8 else "000011"


def _macroblock(b, stream, picture, kind, at, first):
    what, value = picture.mbs[at]
    if what == "pcm":
        b.ue(INTRA_MB_TYPE[kind] + 25)
        b.align()
        form = "0%db" % (8 + stream.depth_luma)
        b.text("".join(format(int(v) >> (2 - min(stream.depth_luma, 2)), form) for v in value))
        b.text(picture.chroma() if picture.chroma else stream.grey())
        return
    b.ue(INTRA_MB_TYPE[kind] + 1 + value)
    b.ue(0)  # intra_chroma_pred_mode: DC
    b.se(0)  # mb_qp_delta
    b.text(_no_coefficients(stream, picture, at, first))


def _slice(stream, picture, first, end):
    mbs = picture.mbs[first:end]
    kind = "I" if picture.mixed and "skip" not in mbs else picture.kind
    b = _slice_header(stream, picture, kind, first)
    run = 0
    for at in range(first, end):
        if picture.mbs[at] == "skip":
            run += 1
            continue
        if kind != "I":
            b.ue(run)
            run = 0
        _macroblock(b, stream, picture, kind, at, first)
    if run:
        b.ue(run)
    b.trailing()
    return nal_unit(5 if picture.idr else 1, 3 if picture.reference else 0, b.bytes())


def code(stream, picture):
    """The slices of a picture, as NAL units."""
    ends = list(picture.slices[1:]) + [len(picture.mbs)]
    return [_slice(stream, picture, first, end) for first, end in zip(picture.slices, ends)]
