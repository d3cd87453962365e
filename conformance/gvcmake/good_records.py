# SPDX-License-Identifier: MIT
"""Valid vectors of shape records: gvc.md 7."""
from . import zstd
from .scenes import Group, add_group, movie_for, still_codes
from .tables import chart


def _movie(times=(7, 7), edit=None, **fields):
    c = chart(16, (0, 1, 1))
    movie = movie_for([c])
    add_group(movie, Group([c], still_codes([c], times), **fields), edit)
    return movie


def packed(suite):
    """Bodies in Zstandard frames."""
    for name, pack in (("raw", zstd.raw), ("runs", zstd.runs), ("checksum", zstd.checksummed), ("eight-bytes", lambda b: zstd.raw(b, zstd.long_header(len(b)))),
                       ("window", lambda b: zstd.raw(b, zstd.window_header(len(b))))):
        suite.good("core/zstd-" + name, _movie(pack=pack), "body in a Zstandard frame: %s" % name, ["7.1.3"], ["zstd"])
    c = chart(33, tuple(range(30)))
    movie = movie_for([c])
    add_group(movie, Group([c], still_codes([c], [7]), pack=zstd.raw))
    suite.good("extended/zstd-size-of-two-bytes", movie, "a content size of two bytes", ["7.1.3"], ["zstd"])


def named(suite):
    """Names of the original frames."""
    suite.good("core/named", _movie(sources=["frame_0001.obj", "frame_0002.obj"]), "records with the name of the original, "
               "the whole one and the others", ["7.1.4", "2.5"], ["named"])
    suite.good("core/named-longest", _movie(sources=["n" * 63, "\u00e9" * 31]), "names of 63 and 62 bytes", ["7.1.4", "2.5"],
               ["named"])
    suite.good("extended/named-with-zstd", _movie(sources=["a", "../b"], pack=zstd.raw), "named records with a packed body",
               ["7.1.4", "7.1.3"], ["named", "zstd"])
    suite.good("extended/named-now-and-then", _movie((7, 7, 7), sources=[None, "b", None]), "only some records are named",
               ["7.1.4"], ["named"])


def segments(suite):
    """Numbers of segments, and what may change with them."""
    a, b = chart(16, (0, 1, 1)), chart(18, (0,), 1, steps=[10, 12, 12], x=3, y=2, origin=(9.0, 8.0, 7.0), step=0.5)
    movie = movie_for([a], size=(32, 32))
    movie.config.image_size = 18
    add_group(movie, Group([a], still_codes([a], [0, 0])))
    add_group(movie, Group([b], still_codes([b], [1]), segment=1))
    add_group(movie, Group([b], still_codes([b], [2]), segment=1))
    suite.good("core/segments", movie, "cut graph, size, place, map and genus change with the segment", ["7.2.2", "7.1.2"],
               ["segments"])
    suite.good("extended/segment-number-greatest", _movie(segment=(1 << 64) - 1), "the greatest number of a segment: a varint "
               "of ten bytes", ["2.4", "7.2.2"], ["segments"])


def everything(suite):
    """All of them."""
    for part in (packed, named, segments):
        part(suite)
