# SPDX-License-Identifier: MIT
"""Valid vectors of H.264 streams: gvc.md 6.2."""
from . import content
from .bits import nal_unit
from .h264 import Picture, code
from .pictures import against, intra_pcm, pcm
from .scenes import Group, add_group, add_units, draw, movie_for, still_codes, straight
from .tables import chart


def _changing(size, count):
    """Codes of frames of which only a corner changes."""
    c = chart(size, (0, 1, 1))
    codes = still_codes([c], [3] * count)
    for i in range(1, count):
        codes[i] = [codes[i][0].copy()]
        codes[i][0][0, :5, :7] = 64 * (100 * i)
    return c, codes


def parameters(suite):
    """Parameter sets of other kinds."""
    for name, about, fields in (
            ("poc-type-2", "pic_order_cnt_type 2: output order is decoding order", {"poc_type": 2, "reorder": 0}),
            ("frame-num-of-16-bits", "frame_num of 16 bits", {"frame_num_bits": 16}),
            ("references-16", "max_num_ref_frames 16", {"max_num_ref_frames": 16, "level_idc": 51}),
            ("reference-1", "max_num_ref_frames 1", {"max_num_ref_frames": 1}),
            ("no-vui", "no VUI", {"vui": False}),
            ("limited-range", "video_full_range_flag 0, which decoders ignore", {"full_range": 0})):
        c, codes = _changing(16, 3)
        movie = movie_for([c], **fields)
        add_group(movie, Group([c], codes))
        suite.good("core/h264-" + name, movie, about, ["6.2.1", "6.2.3"], ["h264"])
    c, codes = _changing(16, 1)
    movie = movie_for([c], max_num_ref_frames=0, reorder=0)
    for code_of in (codes, codes):
        add_group(movie, Group([c], code_of))
    suite.good("extended/h264-references-0", movie, "max_num_ref_frames 0: IDR pictures only", ["6.2.1"], ["h264"])


def slices(suite):
    """Several slices in a picture."""
    c, codes = _changing(33, 2)
    movie = movie_for([c])
    add_group(movie, Group([c], codes, slices=(0, 5, 6, 20)))
    suite.good("core/slices", movie, "four slices in each picture", ["6.2.5"], ["h264"])
    c, codes = _changing(33, 2)
    movie = movie_for([c])
    lumas = [draw(movie.config, [c], code_of) for code_of in codes]
    first = Picture("I", intra_pcm(movie.stream, lumas[0]), 0, 0, idr=True)
    mbs = against(movie.stream, lumas[1], lumas[0])
    mbs[:9] = [pcm(lumas[1], movie.stream, at) for at in range(9)]
    second = Picture("P", mbs, 1, 2, slices=(0, 9), mixed=True)
    add_units(movie, Group([c], codes), [code(movie.stream, p) for p in (first, second)], lumas, straight(2))
    suite.good("core/slices-of-both-kinds", movie, "a picture of an I slice and a P slice", ["6.2.5"], ["h264"])


def references(suite):
    """Pictures that nothing refers to."""
    c, codes = _changing(16, 4)
    movie = movie_for([c])
    lumas = [draw(movie.config, [c], code_of) for code_of in codes]
    stream = movie.stream
    plan = [Picture("I", intra_pcm(stream, lumas[0]), 0, 0, idr=True),
            Picture("P", against(stream, lumas[1], lumas[0]), 1, 2, reference=False),
            Picture("P", against(stream, lumas[2], lumas[0]), 1, 4),
            Picture("I", intra_pcm(stream, lumas[3]), 2, 6)]
    add_units(movie, Group([c], codes), [code(stream, p) for p in plan], lumas, straight(4))
    suite.good("core/h264-disposable-picture", movie, "a P picture with nal_ref_idc 0, after which frame_num stays, and an I "
               "picture that is no IDR picture", ["6.2.6", "6.2.5"], ["h264"])


def colours(suite):
    """Chroma, which decoders ignore (6.1.2)."""
    c, codes = _changing(16, 1)
    movie, lcg = movie_for([c]), content.Lcg(8)
    luma = draw(movie.config, [c], codes[0])
    picture = Picture("I", intra_pcm(movie.stream, luma), 0, 0, idr=True, chroma=lambda: "".join(
        format(lcg.below(1024), "010b") for _ in range(128)))
    add_units(movie, Group([c], codes), [code(movie.stream, picture)], [luma], straight(1))
    suite.good("extended/h264-chroma", movie, "chroma without order, where it should be 512", ["6.1.2"], ["h264"])


def other_units(suite):
    """NAL units that decoders SHOULD skip."""
    sei = nal_unit(6, 0, b"\x05\x11" + bytes(range(16)) + b"\x41\x80")
    extra = {9: nal_unit(9, 0, b"\xf0"), 6: sei, 12: nal_unit(12, 0, b"\xff" * 9 + b"\x80")}

    def put_in(units):
        for nals in units:
            nals[:] = [extra[9], extra[6], *nals, extra[12]]
    c, codes = _changing(16, 2)
    movie = movie_for([c])
    add_group(movie, Group([c], codes), edit_units=put_in)
    suite.good("extended/h264-sei-delimiter-filler", movie, "SEI, access unit delimiters and filler, which writers must not "
               "write and decoders should skip", ["6.2.5"], ["h264", "should"])


def everything(suite):
    """All of them."""
    for part in (parameters, slices, references, colours, other_units):
        part(suite)
