# SPDX-License-Identifier: MIT
"""The good files that tests alter: example.gvc (Annex B) and others made of it."""

import copy
import hashlib
import os
import struct

import numpy as np

import records
from encode_exr import write_exr
from encode_residual import encode
from forge import Node, Parts, ggap
from gvcdec.record import read_record
from gvcdec.surface import add_digest, faces_of, welded_codes
from video import replace_video

HERE = os.path.dirname(os.path.abspath(__file__))
VECTORS = os.environ.get("GVC_VECTORS", os.path.join(HERE, "..", ".."))
LARGE, FRAMES = 33, 9  # S and frames of "lossy"
EXACT = 24             # S of "lossless"


def example():
    """Bytes of the file of Annex B."""
    with open(os.path.join(VECTORS, "core", "example.gvc"), "rb") as file:
        return file.read()


def gvcc(p):
    """Node of gvcC, whichever track it is in."""
    for trak in p.moov.kids:
        if trak.kind == b"trak":
            for box in trak.find("mdia/minf/stbl/stsd").kids[0].kids:
                if box.kind == b"gvcC":
                    return box
    raise ValueError("no gvcC")


def configure(p, width, image_size, declared, features=0):
    """Set fields of gvcC, of the config in p as well."""
    config, node = p.file.head.config, gvcc(p)
    config.width = config.plane_height = width
    config.image_size = image_size
    node.head = node.head[:4] + struct.pack(">IIII", features, width, width, image_size) + \
        node.head[20:30] + struct.pack(">Q", declared) + node.head[38:]


def resize(p, S):
    """Give the record of fragment 0 a chart of size S with one edge."""
    samples = p.fragments[0]["shape"]["samples"]
    d = records.parse(samples[0])
    d["charts"][0].update(size=S, nodes=[(0, 0), (1, 0)], edges=[(0, 1)], start=4,
                          steps=[2 * (S - 1)], sides=[0, 1])
    samples[0] = records.record_bytes(d)


def digest_of(codes, chart):
    """Digest of a frame of one chart (10.3)."""
    welded, digest = welded_codes(codes, chart.weld), hashlib.sha256()
    add_digest(digest, welded, faces_of(welded, chart.weld))
    return digest.digest()[:8]


def smooth(frame, S):
    """Codes of a surface that moves, with noise."""
    y, x = np.mgrid[0:S, 0:S]
    rng = np.random.default_rng(frame)
    wave = [30000 * np.sin((x + frame + 9 * k) / 7) * np.cos((y - frame) / 8) for k in range(3)]
    codes = np.array(wave) + 36000 + rng.integers(-300, 300, (3, S, S))
    return np.clip(codes, 0, 65535).astype(np.int64)


def exact_trak(shape, ident):
    """trak of an exact track, made of that of the shape track."""
    trak = copy.deepcopy(shape)
    trak.kids = [k for k in trak.kids if k.kind != b"tref"]
    tkhd, uri = trak.find("tkhd"), trak.find("mdia/minf/stbl/stsd/urim/uri ")
    tkhd.head = tkhd.head[:12] + struct.pack(">I", ident) + tkhd.head[16:]
    uri.head = uri.head.replace(b"shape", b"exact")
    return trak


def lossy(data):
    """One fragment of FRAMES frames of S = LARGE with B pictures."""
    p = Parts(data)
    del p.fragments[1:]
    configure(p, 48, LARGE, FRAMES)
    resize(p, LARGE)
    replace_video(p, "bframes=2:b-adapt=0:scenecut=0", FRAMES)
    return p.build()


def lossless(data):
    """Traks: shape, exact.  Four frames of S = EXACT: OpenEXR and residuals."""
    p = Parts(data)
    del p.fragments[1:]
    configure(p, 32, EXACT, 4, 1)
    resize(p, EXACT)
    config, geometry, shape = gvcc(p), p.moov.find("trak0"), p.moov.find("trak1")
    exact = exact_trak(shape, 1)
    exact.find("mdia/minf/stbl/stsd/urim").kids.append(config)
    place = p.moov.kids.index(geometry)
    p.moov.kids[place:place + 2] = [shape, exact]
    p.tracks, p.main = {"shape": 2, "exact": 1}, "exact"
    run = p.fragments[0]["shape"]
    chart = read_record(run["samples"][0], True, p.file.head.config, False).charts[0]
    codes = [smooth(f, EXACT) for f in range(4)]
    images = [write_exr(codes[0])]
    for f, (predictor, reference) in enumerate(((1, 1), (0, 1), (1, 0)), 1):
        images.append(encode(codes[f], codes[f - 1], predictor, reference))
    whole = records.parse(run["samples"][0])
    whole["digest"] = digest_of(codes[0], chart)
    run["samples"] = [records.record_bytes(whole)] + [
        b"\1" + digest_of(c, chart) for c in codes[1:]]
    run["offsets"] = [0] * 4
    p.fragments[0] = {"shape": run, "exact": {"samples": images, "offsets": [0] * 4, "t": 0}}
    return p.build()


def preview(data):
    """Traks: geometry, shape, exact.  The example with exact images."""
    p = Parts(data)
    configure(p, 32, 18, 3, 1)
    p.tracks["exact"] = 3
    p.moov.kids.insert(p.moov.kids.index(p.moov.find("trak1")) + 1,
                       exact_trak(p.moov.find("trak1"), 3))
    trex = p.moov.find("mvex/trex1")
    p.moov.find("mvex").kids.append(Node(b"trex", trex.head[:4] + b"\0\0\0\3" + trex.head[8:]))
    frame = 0
    for runs in p.fragments:
        samples = runs["shape"]["samples"]
        chart = read_record(samples[0], True, p.file.head.config, False).charts[0]
        runs["exact"] = {"samples": [], "offsets": [0] * len(samples), "t": runs["shape"]["t"]}
        for i, sample in enumerate(samples):
            codes = smooth(frame, 18)
            d = records.parse(sample)
            d.update(flags=d["flags"] | 8, preview=d["digest"], digest=digest_of(codes, chart))
            samples[i] = records.record_bytes(d)
            runs["exact"]["samples"].append(write_exr(codes))
            frame += 1
    return p.build()


def repaired(data):
    """The example with three frames missing before the last."""
    p = Parts(data)
    configure(p, 32, 18, 6)
    for run in p.fragments[1].values():
        run["t"] += 3 * p.D
    p.hooks["before"] = lambda v, i: [ggap(2, 3)] if i == 1 else v
    return p.build()


def all_files():
    """{name: bytes}."""
    data = example()
    return {"example": data, "lossy": lossy(data), "lossless": lossless(data),
            "preview": preview(data), "repaired": repaired(data)}
