# SPDX-License-Identifier: MIT
"""Valid vectors of images and surfaces: gvc.md 6.1 to 6.3, 7.3, 8 and 9."""
import numpy

from . import content
from .scenes import Group, add_group, add_sparse, movie_for, still_codes
from .tables import chart, starts

SURFACE = ["8.4.1", "9.2.1", "9.3.1", "9.3.2", "9.4.1", "10.3.1"]


def _one(c, codes=None, seed=None, **fields):
    """A movie of one frame of one chart."""
    movie = movie_for([c], **fields)
    add_group(movie, Group([c], [[codes]] if codes is not None else still_codes([c], [0], seed)))
    movie.config.declared_frames = 1
    return movie


def sizes(suite):
    """Sizes of charts."""
    for size in (16, 17, 18, 33):
        suite.good("core/size-%d" % size, _one(chart(size, (0, 1, 1)), seed=size), "one frame, charts of %d x %d samples "
                   "without any order" % (size, size), ["6.3.1", "5.4"] + SURFACE, ["image size"])
    for size in (64, 65, 129, 257, 513, 1025, 2049):
        c = chart(size, (0, 1, 1, 0, 4))
        movie = movie_for([c], level_idc=62)
        add_sparse(movie, Group([c], still_codes([c], [0])), size, 12 if size < 100 else 60 if size < 300 else 1500,
                   1 if size < 100 else 0)
        suite.good("%s/size-%d" % ("core" if size < 500 else "extended", size), movie,
                   "charts of %d x %d samples, most of them predicted within the picture" % (size, size),
                   ["6.3.1", "5.4", "13.1", "13.4.2"] + SURFACE, ["image size"])


def examples(suite):
    """The surfaces of 8.3."""
    suite.good("core/one-edge", _one(chart(16, (0,), start=4), seed=1), "8.3, first example: a sphere cut along one curve",
               ["8.1.2", "8.1.3", "8.4.2"] + SURFACE, ["side table"])
    suite.good("core/three-edges", _one(chart(16, (0, 0, 0), steps=[9, 10, 11], start=8), seed=2),
               "8.3, second example: a junction of three dangling edges, welded of three samples",
               ["8.1.2", "8.1.3", "9.2.1"] + SURFACE, ["side table"])
    suite.good("core/torus", _one(chart(16, (), 1, steps=[15, 15], start=0), seed=3),
               "8.3, third example: a torus whose four corners are one vertex and whose border has no fold",
               ["8.1.3", "8.5"] + SURFACE, ["side table", "genus"])


def genus(suite):
    """Handles."""
    for g in range(5):
        c = chart(16, (0, 1) if g < 4 else (0,), g)
        suite.good("core/genus-%d" % g, _one(c, seed=10 + g), "a surface of genus %d" % g, ["7.3.4", "8.5"] + SURFACE,
                   ["genus"])
    c = chart(33, (0, 1, 1), 6)
    suite.good("extended/genus-6", _one(c), "six handles, all of their loops at the root", ["7.3.4", "8.5"] + SURFACE,
               ["genus"])
    c = chart(16, (), 5, steps=[3] * 10)
    suite.good("extended/genus-5-no-tree", _one(c, seed=20), "five handles whose loops have the least number of steps, three,"
               " and no other edge", ["8.2(4)", "8.5"] + SURFACE, ["genus"])


def _fold_at_two(size):
    """A start where a fold is two steps from a corner, as near as rule 5 allows."""
    c = chart(size, (0,))
    near = [s for s in starts(size, c.steps, c.sides) if s % (size - 1) == 2]
    return chart(size, (0,), start=near[0])


def tables(suite):
    """Side tables at their limits."""
    suite.good("core/edges-maximum", _one(chart(16, [i for i in range(15)]), seed=30),
               "S - 1 edges of two steps each, one behind the other", ["8.2(3)", "13.1"] + SURFACE, ["side table"])
    tree = (0, 1, 1, 3, 3, 5, 5, 7, 7, 9, 9, 11, 11, 0, 14, 14)
    suite.good("core/many-nodes", _one(chart(33, tree)), "seventeen nodes, seven junctions and more", ["7.4.1", "7.4.2"]
               + SURFACE, ["side table"])
    star = (0,) * 12
    suite.good("core/star", _one(chart(33, star), seed=31), "twelve edges meet in one vertex, which is welded of twelve "
               "samples", ["9.2.1", "9.2.2"] + SURFACE, ["side table", "weld"])
    suite.good("core/start-last", _one(chart(16, (0, 1, 1), start="last"), seed=32),
               "the first side begins at the greatest position that rule 5 allows, and the sides run past position 0",
               ["8.1.2"] + SURFACE, ["side table"])
    suite.good("core/fold-near-corner", _one(_fold_at_two(16), seed=33), "a fold two steps from a corner, as near as can be",
               ["8.2(5)"] + SURFACE, ["side table"])
    c = chart(16, (0, 1, 1))
    other = chart(16, (0, 1, 1))
    order = [2, 0, 1]  # numbers of edges need not follow the walk
    other.steps = [c.steps[order.index(i)] for i in range(3)]
    other.edges = [c.edges[order.index(i)] for i in range(3)]
    other.sides = [2 * order[s >> 1] + (s & 1) for s in c.sides]
    suite.good("core/edges-in-any-order", _one(other, seed=34), "edges are numbered in another order than the walk meets them",
               ["8.1.2", "7.4.2"] + SURFACE, ["side table"])
    c = chart(16, (0,))
    c.edges, c.sides = [(1, 0)], [1, 0]
    suite.good("core/reversed-first", _one(c, seed=35), "the walk begins with a reversed side", ["7.4.2", "8.1.3"] + SURFACE,
               ["side table"])
    c = chart(16, (0, 1, 1))
    c.nodes = [b"\x01\xff\xff\xff\xff\x0f", b"\x00", b"\x00", b"\x02"]
    suite.good("extended/kinds-of-nodes", _one(c, seed=36), "kinds and features of nodes that say nothing sensible",
               ["7.4.1"], ["side table"])


def codes(suite):
    """Codes at their limits."""
    c = chart(16, (0, 1, 1))
    extremes = 1023 * content.Lcg(40).array((3, 16, 16), 2)
    suite.good("core/luma-extremes", _one(c, content.codes_of(extremes)), "luma samples are 0 and 1023 only: squares of "
               "lengths need more than 32 bits", ["6.1.2", "9.3.2"] + SURFACE, ["codes"])
    suite.good("core/flat", _one(c, content.codes_of(numpy.full((3, 16, 16), 512))), "all samples are alike: all diagonals "
               "tie", ["9.3.2"] + SURFACE, ["codes"])
    few = 500 + content.Lcg(41).array((3, 16, 16), 3)
    suite.good("core/ties", _one(chart(16, (0,) * 4), content.codes_of(few)), "codes of three values: diagonals that tie and "
               "welds that are rounded up", ["9.2.1", "9.3.2"] + SURFACE, ["codes", "weld"])
    for name, origin, step in (("map-rounding", (-0.1 * 32768, -0.1 * 32704, 1e6 / 3), 0.1),
                               ("map-large", (3.4028234e38 - 1e34, -3.4e38, 0.0), 1e29),
                               ("map-small", (0.0, -0.0, 5e-324), 2.0 ** -1074)):
        c = chart(16, (0, 1, 1), origin=origin, step=step)
        field = 511 + content.Lcg(42).array((3, 16, 16), 3) if name == "map-rounding" else content.noise(16, 43)
        suite.good("core/" + name if name == "map-rounding" else "extended/" + name, _one(c, content.codes_of(field)),
                   {"map-rounding": "affine maps where product and sum fused into one rounding give other positions",
                    "map-large": "positions near the greatest of binary32", "map-small": "positions that are subnormal or 0 "
                    "in binary32, and a step that is subnormal in binary64"}[name], ["9.5.1", "9.5.2", "7.3.3"], ["map"])


def places(suite):
    """Where charts lie."""
    c = chart(16, (0, 1, 1), x=5, y=3)
    movie = movie_for([c], size=(32, 32))
    padding = content.Lcg(50).array((96, 32), 1024).astype(numpy.uint16)
    add_group(movie, Group([c], still_codes([c], [0], 51), padding=padding))
    suite.good("core/padding", movie, "a chart at an odd place among padding without order", ["6.1.3", "7.3.2", "6.3.1"],
               ["place"])
    c = chart(18, (0, 1, 1))
    movie = movie_for([c], size=(18, 18))
    add_group(movie, Group([c], still_codes([c], [0, 1])))
    suite.good("core/cropped", movie, "pictures of 18 x 54 samples, coded as 32 x 64 and cropped", ["6.2.2", "6.1.1"], ["place"])
    c = chart(17, (0, 1, 1), x=47, y=15)
    movie = movie_for([c], size=(64, 32))
    movie.config.image_size = 33
    add_group(movie, Group([c], still_codes([c], [0], 52)))
    suite.good("core/chart-smaller-than-image-size", movie, "charts are smaller than image_size, in the last corner of "
               "the plane", ["5.4", "7.3.2"], ["place"])


def several(suite):
    """Several charts in a picture."""
    pair = [chart(16, (0, 1, 1)), chart(16, (0,), component=1, x=16, origin=(5.0, 6.0, 7.0), step=0.25)]
    movie = movie_for(pair)
    add_group(movie, Group(pair, still_codes(pair, [0, 1], 60)))
    suite.good("core/two-charts", movie, "two surfaces side by side, with maps of their own", ["7.3.1", "9.1", "10.3.1"],
               ["several charts"])
    four = [chart(16, (0, 1), 0), chart(17, (0, 1), 1, component=1, x=31), chart(18, (0,), 2, component=2, y=30),
            chart(20, (), 3, steps=[6, 6, 6, 6, 7, 7], component=3, x=28, y=28)]
    movie = movie_for(four, size=(48, 48))
    add_group(movie, Group(four, still_codes(four, [0], 61)))
    suite.good("extended/four-charts", movie, "four charts of different sizes and genus, listed in another order than they lie",
               ["7.3.1", "7.3.2", "9.1", "10.3.1"], ["several charts", "genus"])
    apart = [chart(16, (0,), x=16), chart(16, (0, 1), component=1)]
    movie = movie_for(apart)
    add_group(movie, Group(apart, still_codes(apart, [0], 62)))
    add_group(movie, Group(apart[:1], still_codes(apart[:1], [0], 63), segment=1))
    suite.good("extended/number-of-charts-changes", movie, "two charts in the first group, one in the second",
               ["7.3.1", "7.1.2"], ["several charts"])


def everything(suite):
    """All of them."""
    for part in (sizes, examples, genus, tables, codes, places, several):
        part(suite)
