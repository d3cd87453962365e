# SPDX-License-Identifier: MIT
"""Unusual good files: several charts, other predictors, cropping, dropped output."""

import hashlib
import struct

import numpy as np

import records
from encode_residual import encode
from gvcdec.exact import read_exact
from gvcdec.record import read_record
from gvcdec.surface import add_digest, faces_of, welded_codes
from samples import digest_of, gvcc
from video import replace_video

CASES = []


def case(name, status, clause, base):
    def add(change):
        CASES.append((name, base, status, clause, change))
        return change
    return add


def all_codes(p):
    """(charts, codes of each frame) of fragment 0 of a file of one chart."""
    runs = p.fragments[0]
    charts = read_record(runs["shape"]["samples"][0], True, p.file.head.config,
                         p.file.head.preview).charts
    codes, before = [], None
    for sample in runs["exact"]["samples"]:
        before = read_exact(sample, charts, before)
        codes.append(before[0])
    return charts, codes


def widen(p, width, height=None):
    """Set picture_width (and plane_height) in gvcC."""
    config, n = p.file.head.config, gvcc(p)
    config.width, config.plane_height = width, height or config.plane_height
    n.head = n.head[:8] + struct.pack(">II", config.width, config.plane_height) + n.head[16:]


for predictor in (0, 1):
    for reference in (0, 1):
        @case(f"predictor {predictor}, reference {reference}", 0, "", "lossless")
        def _(p, predictor=predictor, reference=reference):
            _, codes = all_codes(p)
            samples = p.fragments[0]["exact"]["samples"]
            for i in range(1, len(codes)):
                samples[i] = encode(codes[i], codes[i - 1], predictor, reference)


def noisy(p, predictor, reference, make):
    """Replace the codes of frames 1 to 3 by those of make(i, S), with their digests."""
    charts, codes = all_codes(p)
    runs, before = p.fragments[0], codes[0]
    for i in range(1, len(codes)):
        now = make(i, charts[0].size)
        runs["exact"]["samples"][i] = encode(now, before, predictor, reference)
        runs["shape"]["samples"][i] = b"\1" + digest_of(now, charts[0])
        before = now


RNG = np.random.default_rng(3)
for predictor in (0, 1):
    for word, make in (
            ("noise", lambda i, S: RNG.integers(0, 65536, (3, S, S))),
            ("extremes", lambda i, S: 65535 * RNG.integers(0, 2, (3, S, S))),
            ("constant", lambda i, S: np.full((3, S, S), 65535 * (i % 2))),
            ("ramp", lambda i, S: np.tile(np.arange(S) * 2849 % 65536, (3, S, 1)))):
        @case(f"predictor {predictor}: {word}", 0, "", "lossless")
        def _(p, predictor=predictor, make=make):
            noisy(p, predictor, 1, make)


def two_charts(p, x):
    """Record of fragment 0 with its chart twice, the second one at column x."""
    samples = p.fragments[0]["shape"]["samples"]
    d = records.parse(samples[0])
    d["charts"].append(dict(d["charts"][0], component=1, x=x, origin=(1.0, 2.0, 3.0)))
    samples[0] = records.record_bytes(d)


def two_exact(p):
    charts, codes = all_codes(p)
    widen(p, 64)
    two_charts(p, 32)
    runs = p.fragments[0]
    for i, image in enumerate(runs["exact"]["samples"]):
        digest = hashlib.sha256()
        for _ in range(2):
            w = welded_codes(codes[i], charts[0].weld)
            add_digest(digest, w, faces_of(w, charts[0].weld))
        d = records.parse(runs["shape"]["samples"][i])
        d["digest"] = digest.digest()[:8]
        runs["shape"]["samples"][i] = records.record_bytes(d)
        runs["exact"]["samples"][i] = 2 * (struct.pack(">I", len(image)) + image)
    return runs["exact"]["samples"]


case("two charts, exact", 0, "", "lossless")(lambda p: two_exact(p) and None)


def exact_two(name, clause, function, sample=1):
    @case(f"two charts, exact: {name}", 1, clause, "lossless")
    def _(p):
        samples = two_exact(p)
        samples[sample] = function(samples[sample])


exact_two("bytes behind", "6.4.2", lambda v: v + b"\0")
exact_two("one image", "6.4.2", lambda v: v[:len(v) // 2])
exact_two("length beyond", "6.4.2", lambda v: b"\xff" + v[1:])
exact_two("cut", "6.4.2", lambda v: v[:-1])


@case("two charts, lossy", 0, "", "lossy")
def _(p):
    widen(p, 96)
    two_charts(p, 48)
    replace_video(p, "bframes=2")


@case("two charts, second overlaps by one column", 1, "7.3.2", "lossy")
def _(p):
    widen(p, 96)
    replace_video(p, "bframes=2")
    two_charts(p, 32)


@case("cropped picture", 0, "", "lossy")
def _(p):
    widen(p, 38, 34)
    replace_video(p, "bframes=2")


@case("picture after cropping of another size", 1, "6.2.1", "lossy")
def _(p):
    replace_video(p, "bframes=2")
    widen(p, 46)


@case("IDR picture that drops what was not output", 0, "", "example")
def _(p):
    from gvcdec.bits import Bits
    sample = p.fragments[1]["geometry"]["samples"][0]
    par = p.file.head.avc
    b = Bits(sample[5:])
    whole = b.left
    b.ue(), b.ue(), b.ue(), b.u(par.frame_num_bits), b.ue(), b.u(par.lsb_bits)
    at = whole - b.left
    data = bytearray(sample)
    data[5 + at // 8] |= 128 >> at % 8
    p.fragments[1]["geometry"]["samples"][0] = bytes(data)
