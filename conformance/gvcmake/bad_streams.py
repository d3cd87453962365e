# SPDX-License-Identifier: MIT
"""Invalid vectors of H.264 streams: gvc.md 6.2."""
from dataclasses import replace

import numpy

from .bits import nal_unit
from .boxes import u16, u32
from .h264 import Picture, Stream, code
from .head import avc_config
from .pictures import intra_pcm
from .scenes import Group, add_group, add_units, base, draw, movie_for, still_codes, straight
from .tables import chart

ENTRY = "trak/mdia/minf/stbl/stsd/avc1/"


def _two_groups(**fields):
    """A movie of one frame, and a function that adds a group of two as broken units."""
    c = chart(16, (0, 1, 1))
    movie = movie_for([c], **fields)
    add_group(movie, Group([c], still_codes([c], [7])))
    movie.config.declared_frames = 3
    return movie, c


def _units(suite, name, about, clauses, edit, good=(0,), times=(7, 8)):
    """A vector whose second group has changed NAL units; checksums are right."""
    movie, c = _two_groups()
    movie.config.declared_frames = 1 + len(times)
    add_group(movie, Group([c], still_codes([c], times)), edit_units=edit)
    suite.bad("h264-" + name, movie, about, clauses, ["h264"], good=good)


def restrictions(suite):
    """Rows of the table of 6.2.1: the slices are written as the parameter set says."""
    rows = [("profile-high", {"profile_idc": 100}, "profile_idc 100"), ("profile-422", {"profile_idc": 122}, "profile_idc 122"),
            ("profile-444", {"profile_idc": 244}, "profile_idc 244"),
            ("monochrome", {"chroma_format_idc": 0}, "chroma_format_idc 0"), ("422", {"chroma_format_idc": 2}, "chroma_format_idc 2"),
            ("luma-8", {"depth_luma": 0}, "luma of 8 bits"), ("luma-9", {"depth_luma": 1}, "luma of 9 bits"),
            ("chroma-8", {"depth_chroma": 0}, "chroma of 8 bits"), ("bypass", {"bypass": 1}, "qpprime_y_zero_transform_bypass_flag 1"),
            ("gaps", {"gaps": 1}, "gaps_in_frame_num_value_allowed_flag 1"),
            ("references-17", {"max_num_ref_frames": 17}, "max_num_ref_frames 17"),
            ("cropped-more", {"crop_extra": 1}, "a picture that is two rows lower than stated")]
    for name, fields, about in rows:
        c = chart(16, (0, 1, 1))
        movie = movie_for([c], **fields)
        luma = draw(movie.config, [c], still_codes([c], [7])[0])
        units = [code(movie.stream, Picture("I", intra_pcm(movie.stream, luma), 0, 0, idr=True))]
        add_units(movie, Group([c], []), units, [luma], straight(1))
        suite.bad("h264-" + name, movie, about, ["6.2.1"] + (["6.2.2"] if "cropped" in name else []), ["h264"],
                  "unsupported" if "profile" in name else "corrupt")
    c = chart(16, (0, 1, 1))
    movie = movie_for([c], size=(32, 32), frame_mbs_only=0)
    add_group(movie, Group([c], still_codes([c], [7])))
    suite.bad("h264-interlaced", movie, "frame_mbs_only_flag 0, although all pictures are frames", ["6.2.1"], ["h264"])
    for name, width, height in (("wider", 32, 48), ("higher", 16, 64)):
        movie = movie_for([c])
        movie.stream = Stream(width, height)
        lumas = [draw(movie.config, [c], still_codes([c], [7])[0])]
        large = numpy.pad(lumas[0], ((0, height - 48), (0, width - 16)), mode="edge")
        units = [code(movie.stream, Picture("I", intra_pcm(movie.stream, large), 0, 0, idr=True))]
        add_units(movie, Group([c], []), units, lumas, straight(1))
        suite.bad("h264-" + name, movie, "pictures of %d x %d samples where 16 x 48 are stated" % (width, height),
                  ["6.2.1", "6.1.1"], ["h264"])


def configurations(suite):
    """avcC (6.2.4)."""
    def changed(name, about, edit, error="corrupt"):
        movie = base()

        def on_moov(moov):
            box = moov.get(ENTRY + "avcC")
            box.fields = edit(box.fields, movie.stream)
        movie.edit_moov = on_moov
        suite.bad("avcC-" + name, movie, about, ["6.2.4", "4.4 avcC"], ["h264"], error)
    changed("version-2", "configurationVersion 2", lambda f, s: b"\2" + f[1:])
    changed("profile", "AVCProfileIndication 100", lambda f, s: f[:1] + b"\x64" + f[2:], "unsupported")
    for size in (1, 2):
        changed("lengths-%d" % size, "lengthSizeMinusOne %d" % (size - 1), lambda f, s, n=size: f[:4] + bytes([0xFB + n]) + f[5:])
    sets = (("no-sps", [], None), ("no-pps", None, []), ("two-sps", 2, None), ("two-pps", None, 2))
    for name, sps, pps in sets:
        changed(name, "%s in avcC" % name.replace("-", " "), lambda f, s, a=sps, b=pps: avc_config(
            s, sps=[s.sps()] * 2 if a == 2 else a, pps=[s.pps()] * 2 if b == 2 else b).fields)
    changed("cut", "avcC ends within the sequence parameter set", lambda f, s: f[:20])
    changed("empty", "avcC is empty", lambda f, s: b"")
    changed("sps-huge", "the length of the sequence parameter set is beyond the box", lambda f, s: f[:6] + u16(65535) + f[8:])
    c = chart(16, (0, 1, 1))
    movie = movie_for([c], poc_type=1)
    add_group(movie, Group([c], still_codes([c], [7])))
    suite.bad("avcC-sps-long", movie, "a sequence parameter set of more than 1024 bytes", ["6.2.4"], ["h264"])


def samples(suite):
    """Forms of samples (6.2.5)."""
    def run_edit(name, about, change, clauses=("6.2.5",)):
        movie = base((1, 1))
        samples_of = movie.fragment(1).runs["geometry"].samples
        samples_of[0] = change(samples_of[0])
        suite.bad("h264-" + name, movie, about, list(clauses), ["h264"], good=[0])
    run_edit("length-too-great", "a NAL unit is longer than its sample", lambda s: u32(len(s)) + s[4:])
    run_edit("length-too-small", "a NAL unit ends before its sample does", lambda s: u32(len(s) - 6) + s[4:])
    run_edit("length-0", "a NAL unit of no bytes", lambda s: s + u32(0))
    run_edit("bytes-behind", "three bytes behind the last NAL unit", lambda s: s + b"\0\0\0")
    run_edit("start-code", "a sample with a start code instead of lengths", lambda s: b"\0\0\0\1" + s[4:])
    run_edit("cut-slice", "a slice that ends within its macroblocks", lambda s: u32(900) + s[4:904], ("6.2.5.2",))
    run_edit("two-pictures", "two pictures in one sample", lambda s: s + s, ("6.2.5", "13.2"))


def units(suite):
    """Kinds of NAL units."""
    stream = Stream(16, 48)
    for name, unit in (("sps", stream.sps()), ("pps", stream.pps()), ("partition-a", nal_unit(2, 3, b"\x88\x80")),
                       ("partition-b", nal_unit(3, 3, b"\x88\x80")), ("partition-c", nal_unit(4, 3, b"\x88\x80")),
                       ("extension", nal_unit(20, 3, b"\x00\x00\x07\x88\x80")), ("prefix", nal_unit(14, 3, b"\x00\x00\x07")),
                       ("end-of-sequence", b"\x0a\x80"), ("sps-extension", nal_unit(13, 3, b"\xc0")),
                       ("auxiliary", nal_unit(19, 3, b"\x88\x80")), ("unspecified", nal_unit(24, 0, b"\x80"))):
        _units(suite, "unit-" + name, "a NAL unit of type %d in a sample" % (unit[0] & 31), ["6.2.5"] + (
            ["13.2"] if name in ("sps", "pps") else []), lambda us, u=unit: us[1].insert(0, u), good=[0, 1])
    hidden = b"\0\0\1" + stream.sps()
    for name, about, unit in (("parameter-set-hidden", "a NAL unit of type 6 with a start code and a parameter set inside", b"\x06" + hidden),
                              ("three-zeros", "three bytes 00 inside of a NAL unit of type 12", b"\x0c\xff\0\0\0\xff\x80"),
                              ("zeros-and-2", "00 00 02 inside of a NAL unit of type 12", b"\x0c\xff\0\0\2\xff\x80"),
                              ("last-byte-0", "a NAL unit of type 12 that ends in 00", b"\x0c\xff\x80\0"),
                              ("of-one-byte", "a NAL unit of one byte", b"\x0c")):
        _units(suite, "unit-" + name, about, ["6.2.5.1", "13.2"], lambda us, u=unit: us[1].insert(0, u), good=[0, 1])
    _units(suite, "slice-last-byte-0", "a slice that ends in 00", ["6.2.5.1"], lambda us: us[1].__setitem__(0, us[1][0] + b"\0"),
           good=[0, 1])
    _units(suite, "first-not-idr", "the first picture of a group has slices of type 1", ["6.2.5", "13.2"],
           lambda us: us[0].__setitem__(0, _as_plain_slice(us[0][0])))
    movie, c = _two_groups()
    codes = still_codes([c], [7, 8])
    lumas = [draw(movie.config, [c], x) for x in codes]
    twice = [code(movie.stream, Picture("I", intra_pcm(movie.stream, luma), 0, 0, idr=True, idr_pic_id=i))
             for i, luma in enumerate(lumas)]
    add_units(movie, Group([c], codes), twice, lumas, straight(2))
    suite.bad("h264-second-idr", movie, "an IDR picture inside of a group", ["6.2.5", "13.2"], ["h264"], good=[0, 1])
    _units(suite, "forbidden-bit", "forbidden_zero_bit is 1", ["6.2.5"], lambda us: us[1].__setitem__(
        0, bytes([us[1][0][0] | 0x80]) + us[1][0][1:]), good=[0, 1])


def _as_plain_slice(nal):
    """An I slice of an IDR picture as one of another picture: the header is written anew, the macroblocks are the same."""
    c = chart(16, (0, 1, 1))
    movie = movie_for([c])
    luma = draw(movie.config, [c], still_codes([c], [7])[0])
    return code(movie.stream, Picture("I", intra_pcm(movie.stream, luma), 0, 0))[0]


def _group_of(pictures_of, **fields):
    """A movie with one frame and a group made by pictures_of(stream, lumas)."""
    movie, c = _two_groups(**fields)
    codes = still_codes([c], [7, 8, 9])
    lumas = [draw(movie.config, [c], x) for x in codes]
    coded = pictures_of(movie.stream, lumas)
    movie.config.declared_frames = 1 + len(coded)
    add_units(movie, Group([c], codes), coded, lumas[:len(coded)], straight(len(coded)))
    return movie


def slices(suite):
    """Slices of a picture (6.2.5)."""
    def whole(stream, luma, **fields):
        return Picture("I", intra_pcm(stream, luma), 0, 0, idr=True, slices=(0, 1, 2), **fields)

    def make(name, about, change, clauses=("6.2.5",)):
        def pictures_of(stream, lumas):
            nals = code(stream, whole(stream, lumas[0]))
            return [change(nals, stream, lumas[0])]
        suite.bad("h264-slices-" + name, _group_of(pictures_of), about, list(clauses), ["h264"], good=[0])
    make("swapped", "slices in another order", lambda n, s, l: [n[0], n[2], n[1]])
    make("twice", "a slice stands twice", lambda n, s, l: [n[0], n[1], n[1], n[2]])
    make("first-missing", "the first slice is missing", lambda n, s, l: n[1:], ("6.2.5", "6.2.5.2"))
    make("middle-missing", "a slice in the middle is missing: macroblocks are not coded", lambda n, s, l: [n[0], n[2]],
         ("6.2.5.2",))
    make("last-missing", "the last slice is missing", lambda n, s, l: n[:2], ("6.2.5.2",))
    make("reference-differs", "nal_ref_idc is 0 in one slice", lambda n, s, l: [n[0], code(s, replace(
        whole(s, l), reference=False))[1], n[2]])
    make("types-differ", "a slice of type 1 in an IDR picture", lambda n, s, l: [n[0], code(s, replace(whole(s, l), idr=False))[1],
                                                                              n[2]], ("6.2.5", "13.2"))
    make("none", "a sample without slices", lambda n, s, l: [nal_unit(9, 0, b"\xf0")])
    make("frame-num-differs", "frame_num differs between slices", lambda n, s, l: [n[0], code(s, replace(
        whole(s, l), frame_num=1))[1], n[2]])


def numbers(suite):
    """frame_num (6.2.6)."""
    def plan(name, about, nums, good, kinds="IPP", references=(True, True, True)):
        def pictures_of(stream, lumas):
            out = []
            for i, (kind, num, reference) in enumerate(zip(kinds, nums, references)):
                mbs = intra_pcm(stream, lumas[i])
                out.append(code(stream, Picture(kind, mbs, num, 2 * i, idr=i == 0, reference=reference)))
            return out
        suite.bad("h264-frame-num-" + name, _group_of(pictures_of), about, ["6.2.6", "12.6"], ["h264"], good=good)
    plan("not-0", "frame_num of the IDR picture is 1", (1, 2, 3), [0])
    plan("gap", "frame_num leaves one out", (0, 2, 3), [0, 1])
    plan("gap-later", "frame_num leaves one out after a picture that is no reference", (0, 1, 2), [0, 1, 2],
         references=(True, False, True))
    plan("back", "frame_num goes back", (0, 1, 0), [0, 1, 2])
    plan("again", "frame_num of a picture is that of the reference picture before it", (0, 1, 1), [0, 1, 2])


def output_order(suite):
    """Pictures that H.264 outputs in another order than they are presented (6.2.7)."""
    movie, c = _two_groups()
    codes = still_codes([c], [7, 8, 9])
    lumas = [draw(movie.config, [c], x) for x in codes]
    coded = [code(movie.stream, Picture(kind, intra_pcm(movie.stream, lumas[shown]), i, 2 * i, idr=i == 0))
             for i, (kind, shown) in enumerate((("I", 0), ("P", 2), ("P", 1)))]
    movie.config.declared_frames = 4
    add_units(movie, Group([c], codes), coded, lumas, [("I", 0), ("P", 2), ("P", 1)])
    suite.bad("h264-output-order", movie, "the second picture is output before the third, but presented after it",
              ["6.2.7", "13.2"], ["h264"], good=[0, 1])


def everything(suite):
    """All of them."""
    for part in (restrictions, configurations, samples, units, slices, numbers, output_order):
        part(suite)
