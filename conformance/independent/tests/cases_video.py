# SPDX-License-Identifier: MIT
"""H.264 streams, good and forged (gvc.md 6.2)."""

import struct

from cases_parameters import bits_to_nal, ue
from gvcdec.parameters import Parameters, read_sps
from video import replace_video, sample

CASES = []
BASE = "lossy"


def stream(name, options, status=0, clause=""):
    """A stream of x264, altered by a function of (parts, groups of slices)."""
    def add(function):
        def change(p):
            groups = replace_video(p, options)
            changed = function(p, groups)
            if changed is not None:
                p.fragments[0]["geometry"]["samples"] = [
                    g if isinstance(g, bytes) else sample(g) for g in changed]
        CASES.append((name, BASE, status, clause, change))
        return function
    return add


def as_it_is(p, groups):
    return None


SIMPLE = "bframes=0:scenecut=0"
for options in (
        "bframes=3:b-pyramid=normal:b-adapt=0", "bframes=0", "bframes=0:ref=1:weightp=2",
        "bframes=8:b-adapt=0:b-pyramid=strict:ref=16", "cabac=0:8x8dct=0:bframes=2",
        "slices=3:bframes=2", "slice-max-mbs=2", "keyint=infinite:intra-refresh=1:bframes=0",
        "cqm=jvt", "lossless=0:qp=51", "qp=1", "constrained-intra=1:bframes=1",
        "weightb=1:weightp=1:bframes=4:b-adapt=0:ref=5",
        "bframes=3:b-adapt=0:vbv-maxrate=500:vbv-bufsize=500:nal-hrd=vbr", "deblock=-3,-3",
        "no-deblock=1", "bframes=1:ref=1"):
    stream(f"x264 {options}", options)(as_it_is)

stream("IDR in the middle", "keyint=5:min-keyint=1:bframes=0", 1, None)(as_it_is)
SLICES = "slices=3:bframes=0:scenecut=0"
stream("first slice missing", SLICES, 1, "6.2.5")(lambda p, g: [g[0], g[1][1:]] + g[2:])
stream("slices exchanged", SLICES, 1, "6.2.5")(
    lambda p, g: [g[0], [g[1][0], g[1][2], g[1][1]]] + g[2:])
stream("slice twice", SLICES, 1, "6.2.5")(lambda p, g: [g[0], g[1] + g[1][-1:]] + g[2:])
stream("middle slice missing", SLICES, 1, "6.2.5.2")(lambda p, g: [g[0], g[1][::2]] + g[2:])
stream("last slice missing", SLICES, 1, "6.2.5.2")(lambda p, g: [g[0], g[1][:2]] + g[2:])
stream("last slice of the last picture missing", SLICES, 1, "6.2.5.2")(
    lambda p, g: g[:-1] + [g[-1][:2]])
stream("slice of another picture", SLICES, 1, "6.2.5")(
    lambda p, g: [g[0], g[1][:2] + g[2][2:]] + g[2:])
stream("picture missing", SIMPLE, 1, "6.2.6")(lambda p, g: g[:3] + [g[4]] * 2 + g[5:])
stream("picture twice", SIMPLE, 1, "6.2.6")(lambda p, g: g[:4] + [g[3]] + g[5:])
stream("pictures exchanged", SIMPLE, 1, "6.2.6")(lambda p, g: g[:3] + [g[4], g[3]] + g[5:])
stream("IDR twice", SIMPLE, 1, "6.2.5")(lambda p, g: [g[0], g[0]] + g[2:])
stream("no IDR", SIMPLE, 1, "6.2.5")(lambda p, g: [g[1]] + g[1:])


def with_unit(unit, place=1):
    return lambda p, g: g[:place] + [[unit] + g[place]] + g[place + 1:]


for kind in (6, 9, 12):
    stream(f"NAL unit of type {kind}", SIMPLE)(with_unit(bytes([kind, 1, 0x80])))
for kind in (2, 3, 4, 7, 8, 13, 14, 15, 19, 20, 21, 0, 1, 5, 10, 11, 24, 31):
    stream(f"NAL unit of type {kind}", SIMPLE, 1, None)(with_unit(bytes([kind | 96, 1, 0x80])))
stream("sample of SEI only", SIMPLE, 1, "6.2.5")(lambda p, g: [g[0], [b"\6\1\x80"]] + g[2:])
stream("NAL unit of 0 bytes", SIMPLE, 1, "6.2.5.1")(with_unit(b""))
stream("NAL unit of 1 byte", SIMPLE, 1, "6.2.5.1")(with_unit(b"\x09"))
stream("NAL unit that ends in 00", SIMPLE, 1, "6.2.5.1")(with_unit(b"\x06\1\x80\0"))
stream("three zeros inside", SIMPLE, 1, "6.2.5.1")(with_unit(b"\x06\1\0\0\0\x80"))
stream("forbidden bit", SIMPLE, 1, "6.2.5.1")(with_unit(b"\x86\1\x80"))
stream("start code inside", SIMPLE, 1, "6.2.5.1")(with_unit(b"\x06\0\0\1\x67\x80"))
stream("NAL length beyond", SIMPLE, 1, "6.2.5")(
    lambda p, g: [g[0], struct.pack(">I", len(g[1][0]) + 1) + g[1][0]] + g[2:])
stream("bytes behind NAL units", SIMPLE, 1, "6.2.5")(
    lambda p, g: [g[0], sample(g[1]) + b"\0\0\0"] + g[2:])
stream("slice cut", SIMPLE, 1, "6.2.5.2")(lambda p, g: [g[0], [g[1][0][:-9]]] + g[2:])
stream("slice of the last picture cut", SIMPLE, 1, None)(lambda p, g: g[:-1] + [[g[-1][0][:-9]]])
stream("slice cut, CAVLC", SIMPLE + ":cabac=0", 1, "6.2.5.2")(
    lambda p, g: [g[0], [g[1][0][:-9]]] + g[2:])
stream("slice of 5 bytes", SIMPLE, 1, None)(lambda p, g: [g[0], [g[1][0][:5] + b"\x80"]] + g[2:])
stream("slice of noise", SIMPLE, 1, None)(
    lambda p, g: [g[0], [g[1][0][:9] + bytes(7 * i % 255 + 1 for i in range(400))]] + g[2:])


@stream("presentation not in order of output", "bframes=2:b-adapt=0", 1, "6.2.7")
def _(p, groups):
    run = p.fragments[0]["geometry"]
    numbers = [o // p.D - 2 + i for i, o in enumerate(run["offsets"])]
    i, j = numbers.index(4), numbers.index(5)
    numbers[i], numbers[j] = 5, 4
    run["offsets"] = [(n - i + 2) * p.D for i, n in enumerate(numbers)]


@stream("memory_management_control_operation 5", SIMPLE + ":weightp=0", 1, "6.2.6")
def _(p, groups):
    par = Parameters()
    par.sps = next(u for u in p.units if u[0] & 31 == 7)
    read_sps(par, p.file.head.config)
    text = ue(0) + ue(5) + ue(0) + format(1, f"0{par.frame_num_bits}b")
    text += "1" * par.lsb_bits + "0" + "0" + "1" + ue(5) + ue(0) + "1" * 40
    return [groups[0], [bits_to_nal(0x41, text)]] + groups[2:]
