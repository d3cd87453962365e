# SPDX-License-Identifier: MIT
"""Movies with an exact track, with and without a preview (gvc.md 6.4)."""
import struct

from . import exr, residual
from .fragment import Fragment, Run
from .bits import with_length
from .movie import Frame
from .pictures import group as code_group
from .scenes import draw, movie_for, next_frame, records, straight
from .surface import rebuild


def keyframe(movie, chart, codes, frame, **fields):
    """An OpenEXR image with the attributes of 6.5.5."""
    config = movie.config
    return exr.Image(codes, chart.origin, chart.step, frame * config.rate_den / config.rate_num,
                     unit=config.unit, **fields)


def sample(images):
    """The images of a frame as one sample (6.4.2)."""
    if len(images) == 1:
        return images[0]
    return b"".join(struct.pack(">I", len(i)) + i for i in images)


def plan_residuals(predictor=residual.GRADIENT, reference=1):
    """How the frames behind the first of a group are coded: residuals of one kind."""
    def code(movie, group, number, c, first):
        before = group.codes[number - 1][c] if reference else None
        return residual.encode(group.codes[number][c], before, predictor)
    return code


def all_keyframes(movie, group, number, c, first):
    """Frames behind the first of a group are OpenEXR files, too."""
    return keyframe(movie, group.charts[c], group.codes[number][c], first + number).encode()


def add_lossless(movie, group, plan=None, compression=exr.ZIP, edit_images=None, previews=None, edit_records=None):
    """Adds a group with exact images; previews: codes of the pictures, in a movie that has a geometry track, too.

    edit_images(images) may change the list of images, [frame][chart].
    """
    plan = plan or plan_residuals()
    first = next_frame(movie)
    images = []
    for number, codes in enumerate(group.codes):
        if number == 0:
            images.append([keyframe(movie, c, code, first, compression=compression).encode()
                           for c, code in zip(group.charts, codes)])
        else:
            images.append([plan(movie, group, number, c, first) for c in range(len(group.charts))])
    if edit_images:
        edit_images(images)
    results = [rebuild(group.charts, codes) for codes in group.codes]
    seen = [rebuild(group.charts, codes) for codes in previews] if previews else None
    whole = records(group, [r[0] for r in results], [s[0] for s in seen] if seen else None)
    if edit_records:
        edit_records(whole)
    count = len(group.codes)
    runs = {"shape": Run([r.encode() for r in whole], list(range(count)), offsets=False),
            "exact": Run([sample(i) for i in images], list(range(count)), offsets=False)}
    if previews:
        order = group.order or straight(count)
        lumas = [draw(movie.config, group.charts, codes) for codes in previews]
        units = code_group(movie.stream, lumas, order)
        runs["geometry"] = Run([b"".join(with_length(n) for n in nals) for nals in units], [n for _, n in order])
    fragment = Fragment(first, runs)
    movie.parts.append(fragment)
    for i, result in enumerate(results):
        movie.frames[first + i] = Frame(*result, preview=seen[i] if seen else None)
    return fragment


def lossless_movie(charts, preview=False, **fields):
    """A movie without fragments for exact images."""
    kinds = ("geometry", "shape", "exact") if preview else ("shape", "exact")
    return movie_for(charts, kinds=kinds, **fields)
