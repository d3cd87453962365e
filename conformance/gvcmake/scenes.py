# SPDX-License-Identifier: MIT
"""From charts and codes to movies: what most vectors begin with."""
import copy
from dataclasses import dataclass

import numpy

from . import content, pictures
from .bits import with_length
from .fragment import Fragment, Run
from .head import Config
from .h264 import Picture, Stream, code
from .movie import Frame, Gap, Movie
from .shape import Record
from .surface import rebuild
from .tables import chart


def draw(config, charts, codes, padding=None):
    """The picture (6.1.1) of a frame: luma samples of charts; padding repeats the nearest sample or is given."""
    height = config.plane_height
    luma = numpy.zeros((3 * height, config.picture_width), numpy.uint16) if padding is None else padding.copy()
    for k in range(3):
        plane = luma[k * height:(k + 1) * height]
        for c, code in zip(charts, codes):
            if padding is None and len(charts) == 1:
                rows = (numpy.arange(height) - c.y).clip(0, c.size - 1)
                columns = (numpy.arange(config.picture_width) - c.x).clip(0, c.size - 1)
                plane[:] = code[k][rows][:, columns] >> 6
            plane[c.y:c.y + c.size, c.x:c.x + c.size] = code[k] >> 6
    return luma


def cut_out(config, charts, luma):
    """The codes of the charts of a picture (6.3.1)."""
    height = config.plane_height
    return [numpy.stack([luma[k * height + c.y:k * height + c.y + c.size, c.x:c.x + c.size] for k in range(3)])
            .astype(numpy.uint16) << 6 for c in charts]


def straight(count):
    """Decoding order without B pictures."""
    return [("I" if i == 0 else "P", i) for i in range(count)]


@dataclass
class Group:
    """A group before it is coded. codes: for each frame a list of arrays [3][S][S], one a chart."""
    charts: list
    codes: list
    order: list = None
    segment: int = 0
    sources: list = None
    pack: object = None
    slices: tuple = (0,)
    padding: object = None


def records(group, digests, previews=None):
    """Shape records of a group: the first whole, the others *same* (7.1.2)."""
    out = []
    for i, digest in enumerate(digests):
        out.append(Record(digest, [] if i else group.charts, same=i > 0, segment=group.segment,
                          source=group.sources[i] if group.sources else None, pack=None if i else group.pack,
                          preview_digest=previews[i] if previews else None))
    return out


def movie_for(charts, rate=(25, 1), size=None, kinds=("geometry", "shape"), shift=2, **fields):
    """A movie without fragments. size: width of a picture and height of a plane; None takes what the charts need."""
    if size is None:
        size = [(max(c.x + c.size for c in charts) + 15) // 16 * 16, (max(c.y + c.size for c in charts) + 15) // 16 * 16]
    config = Config(size[0], size[1], max(c.size for c in charts), rate[0], rate[1],
                    features=1 if "exact" in kinds else 0)
    stream = Stream(size[0], 3 * size[1], **fields)
    movie = Movie(config, stream, kinds)
    if "geometry" in kinds and shift is not None:
        movie.media_time["geometry"] = shift * rate[1]
    return movie


def next_frame(movie):
    """The number of the frame that follows what is there."""
    runs = sum(len(p.runs["shape"].samples) for p in movie.parts if isinstance(p, Fragment))
    return runs + sum(p.count for p in movie.parts if isinstance(p, Gap))


def add_units(movie, group, units, lumas, order, edit_records=None):
    """Adds a fragment of coded pictures. lumas: what they decode to, in presentation order. Gives the fragment."""
    first = next_frame(movie)
    results = [rebuild(group.charts, cut_out(movie.config, group.charts, luma)) for luma in lumas]
    whole = records(group, [digest for digest, _ in results])
    if edit_records:
        edit_records(whole)
    fragment = Fragment(first, {
        "geometry": Run([b"".join(with_length(n) for n in nals) for nals in units], [n for _, n in order]),
        "shape": Run([r.encode() for r in whole], list(range(len(lumas))), offsets=False)})
    movie.parts.append(fragment)
    for i, (digest, mesh) in enumerate(results):
        movie.frames[first + i] = Frame(digest, mesh)
    return fragment


def add_group(movie, group, edit_records=None, edit_units=None):
    """Codes a group of a movie of geometry and shape track and adds the fragment. Gives the fragment."""
    lumas = [draw(movie.config, group.charts, codes, group.padding) for codes in group.codes]
    order = group.order or straight(len(lumas))
    units = pictures.group(movie.stream, lumas, order, group.slices, len(movie.parts) % 2)
    if edit_units:
        edit_units(units)
    return add_units(movie, group, units, lumas, order, edit_records)


def add_sparse(movie, group, seed, one_in, more=0):
    """A group of one small picture of all kinds of Intra_16x16 prediction and `more` skipped ones."""
    stream = movie.stream
    target = draw(movie.config, group.charts, group.codes[0])
    mbs = pictures.sparse(stream, target, content.Lcg(seed), one_in)
    luma = pictures.reconstruct(stream, mbs)
    coded = [code(stream, Picture("I", mbs, 0, 0, idr=True))]
    for i in range(more):
        coded.append(code(stream, Picture("P", ["skip"] * len(mbs), 1 + i, 2 + 2 * i)))
    return add_units(movie, group, coded, [luma] * (1 + more), straight(1 + more))


def still_codes(charts, times, seed=None):
    """Codes for each time: bumps that move, or noise that does not depend on the time."""
    if seed is not None:
        return [[content.codes_of(content.noise(c.size, seed + i)) for i, c in enumerate(charts)] for _ in times]
    return [[content.codes_of(content.smooth(c.size, t)) for c in charts] for t in times]


_base = []


def base(frames=(2, 1)):
    """The movie that most vectors are variations of: S = 16, groups of so many frames, declared_frames stated."""
    key = tuple(frames)
    for known, movie in _base:
        if known == key:
            return copy.deepcopy(movie)
    one = chart(16, (0, 1, 1))
    movie, time = movie_for([one]), 0
    for count in frames:
        add_group(movie, Group([one], still_codes([one], range(time, time + count))))
        time += count
    movie.config.declared_frames = sum(frames)
    _base.append((key, movie))
    return copy.deepcopy(movie)
