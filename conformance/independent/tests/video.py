# SPDX-License-Identifier: MIT
"""Other H.264 streams in a good lossy file, with digests of what ffmpeg decodes of them."""

import hashlib
import os
import struct
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))

import numpy as np  # noqa: E402

import records  # noqa: E402
from gvcdec.frames import picture_codes  # noqa: E402
from gvcdec.record import read_record  # noqa: E402
from gvcdec.surface import add_digest, faces_of, welded_codes  # noqa: E402


def ffmpeg(*args, data):
    done = subprocess.run(["ffmpeg", "-loglevel", "error", *args], input=data,
                          stdout=subprocess.PIPE, check=True)
    return done.stdout


def noise(count, width, height, seed=1):
    """Raw yuv420p10le pictures that move."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width]
    out = []
    for f in range(count):
        luma = 512 + 300 * np.sin((x + 3 * f) / 7) * np.cos((y - 2 * f) / 9)
        luma = np.clip(luma + rng.normal(0, 12, luma.shape), 0, 1023).astype("<u2")
        out.append(luma.tobytes() + np.full(width * height // 2, 512, "<u2").tobytes())
    return b"".join(out)


def encode(count, width, height, options):
    """NAL units of an x264 stream."""
    size = f"{width}x{height}"
    stream = ffmpeg("-f", "rawvideo", "-pix_fmt", "yuv420p10le", "-s", size, "-r", "30", "-i", "-",
                    "-c:v", "libx264", "-profile:v", "high10", "-x264-params", options,
                    "-f", "h264", "-", data=noise(count, width, height))
    units = stream.replace(b"\0\0\0\1", b"\0\0\1").split(b"\0\0\1")[1:]
    return [u for u in units if u[0] & 31 not in (6, 9)], stream


def pictures(units):
    """Slice units grouped by picture."""
    groups = []
    for u in units:
        if u[0] & 31 in (1, 5):
            if u[1] & 128:
                groups.append([])
            groups[-1].append(u)
    return groups


def sample(units):
    return b"".join(struct.pack(">I", len(u)) + u for u in units)


def replace_video(p, options, count=None, numbers=None):
    """Put a stream of x264 into fragment 0 of a lossy file; returns its groups of slices.

    numbers: order of presentation; p.units: all NAL units.
    """
    config = p.file.head.config
    runs = p.fragments[0]
    count = count or len(runs["geometry"]["samples"])
    units, stream = encode(count, config.width, 3 * config.plane_height, options)
    sps = next(u for u in units if u[0] & 31 == 7)
    pps = next(u for u in units if u[0] & 31 == 8)
    groups, p.units = pictures(units), units
    assert len(groups) == count
    avcc = p.moov.find("trak0/mdia/minf/stbl/stsd/avc1/avcC")
    avcc.head = bytes([1, 110, 0, sps[3], 255, 0xE1]) + struct.pack(">H", len(sps)) + sps + \
        b"\1" + struct.pack(">H", len(pps)) + pps + b"\xfd\xfa\xfa\0"
    numbers = numbers or order(sps, pps, groups, config, p)
    D, T = p.D, p.file.head.tracks["geometry"].T
    runs["geometry"].update(samples=[sample(g) for g in groups],
                            offsets=[(n - i) * D + T for i, n in enumerate(numbers)])
    raw = ffmpeg("-f", "h264", "-i", "-", "-fps_mode", "passthrough", "-f", "rawvideo", "-",
                 data=stream)
    shape = runs["shape"]
    shape["offsets"] = (shape["offsets"] + [0] * count)[:count]
    shape["samples"] = (shape["samples"] + [b"\1" + bytes(8)] * count)[:count]
    set_digests(p, raw)
    return groups


def order(sps, pps, groups, config, p):
    """Presentation numbers by picture order count."""
    from gvcdec.order import Order
    from gvcdec.parameters import Parameters, read_pps, read_sps
    from gvcdec.slices import read_slice
    par = Parameters()
    par.sps, par.pps = sps, pps
    read_sps(par, config)
    read_pps(par)
    o = Order(par)
    places = [o.place(read_slice(g[0], par)) for g in groups]
    ranks = sorted(places)
    return [ranks.index(x) for x in places]


def set_digests(p, raw):
    """Write the digests of raw pictures into the records of fragment 0."""
    config = p.file.head.config
    samples = p.fragments[0]["shape"]["samples"]
    charts = read_record(samples[0], True, config, False).charts
    size = config.width * 3 * config.plane_height
    for i, data in enumerate(samples):
        luma = np.frombuffer(raw, "<u2", size, i * size * 3).reshape(-1, config.width)
        digest = hashlib.sha256()
        for codes, chart in zip(picture_codes(luma, charts, config), charts):
            w = welded_codes(codes, chart.weld)
            add_digest(digest, w, faces_of(w, chart.weld))
        d = records.parse(data)
        d["digest"] = digest.digest()[:8]
        samples[i] = records.record_bytes(d)
