# SPDX-License-Identifier: MIT
"""Invalid vectors of side tables: gvc.md 8.2 and 8.5, each rule by itself."""
from .content import codes_of, smooth
from .h264 import Picture, code
from .pictures import intra_pcm
from .scenes import Group, add_units, draw, movie_for, straight
from .shape import Chart
from .surface import border_sets
from .tables import JUNCTION, ROOT, chart, corners_clear, extremum, walk


def _table(suite, name, about, clauses, c, features=("side table",)):
    """A vector of one frame whose digest is not that of any surface, since the table makes none."""
    movie = movie_for([c], size=(16, 16) if c.size <= 16 else (32, 32))
    movie.config.image_size = max(16, c.size)
    luma = draw(movie.config, [chart(16, (0, 1, 1))], [codes_of(smooth(16))])
    units = [code(movie.stream, Picture("I", intra_pcm(movie.stream, luma), 0, 0, idr=True))]
    fine = chart(16, (0, 1, 1))

    def put(records):
        records[0].charts = [c]
    add_units(movie, Group([fine], []), units, [luma], straight(1), put)
    suite.bad("table-" + name, movie, about, clauses, list(features))


def _unchecked(size, parents, genus, steps, start):
    """A chart as tables.chart makes it, with any start and steps."""
    edges, sides = walk(list(parents), genus)
    nodes = [ROOT] + [JUNCTION if i + 1 in parents else extremum(i) for i in range(len(parents))]
    return Chart(size=size, steps=list(steps), sides=sides, start=start, nodes=nodes, edges=edges, genus=genus)


def rule_1(suite):
    """Size and start."""
    c = chart(16, (0, 1, 1))
    c.start += 60
    _table(suite, "start-p", "start is P or more", ["8.2(1)", "8.2.1", "13.2"], c)
    small = Chart(size=15, steps=[28], sides=[0, 1], start=4, nodes=[ROOT, extremum(0)], edges=[(0, 1)])
    _table(suite, "size-15", "S is 15", ["8.2(1)", "8.2.1", "13.2"], small)
    for size in (0, 1):
        tiny = Chart(size=size, steps=[2], sides=[0, 1], start=0, nodes=[ROOT, extremum(0)], edges=[(0, 1)])
        _table(suite, "size-%d" % size, "S is %d" % size, ["8.2(1)", "8.2.1"], tiny)


def rule_2(suite):
    """Each edge has its two sides."""
    for name, sides, about in (
            ("two-forward", [0, 2, 2, 4, 4, 1], "edges with two forward sides, and none reversed"),
            ("side-beyond", [0, 2, 3, 4, 7, 1], "a side of edge 3 of three"),
            ("side-twice", [0, 2, 3, 2, 3, 1], "an edge with four sides and one with none"),
            ("side-huge", [0, 2, 3, 4, 0xFFFFFFFF, 1], "a side of edge 2^31 - 1")):
        c = chart(16, (0, 1, 1))
        c.sides = sides
        _table(suite, name, about, ["8.2(2)", "8.2.1"], c)


def rule_3(suite):
    """Steps."""
    for name, steps, about in (("one-step", [1, 14, 15], "an edge of one step"), ("no-step", [0, 15, 15], "an edge of no step"),
                               ("sum-less", [9, 10, 10], "steps sum to less than P / 2"),
                               ("sum-more", [10, 11, 10], "steps sum to more than P / 2"),
                               ("sum-wraps", [10, 10, 0xFFFFFFFF], "steps sum to P / 2 and more, beyond 32 bits")):
        starts = [s for s in range(60) if sum(steps) == 30 and min(steps) > 0
                  and corners_clear(16, s, steps, chart(16, (0, 1, 1)).sides)]
        c = _unchecked(16, (0, 1, 1), 0, steps, (starts or [4])[0])
        _table(suite, name, about, ["8.2(3)", "8.2.1"], c)


def rule_4(suite):
    """Loops."""
    for start in range(60):
        c = _unchecked(16, (0, 1), 1, [8, 8, 2, 12], start)
        if corners_clear(16, start, c.steps, c.sides):
            _table(suite, "loop-of-two-steps", "an edge of two steps whose ends are one vertex", ["8.2(4)", "8.2.1"], c)
            return
    raise ValueError("no start")


def _broken_corners(c):
    """Corners at which rule 5 does not hold."""
    sets = border_sets(c.size, c.start, c.steps, c.sides)
    around = [{sets[(k * (c.size - 1) + d) % len(sets)] for d in range(-2, 3)} for k in range(4)]
    return [k for k in range(4) if len(around[k]) < 5]


def _folds(c):
    sets = border_sets(c.size, c.start, c.steps, c.sides)
    return [p for p in range(len(sets)) if sets[p - 1] == sets[(p + 1) % len(sets)]]


def rule_5(suite):
    """Corners: the rule holds at all but one."""
    for name, distance in (("on", 0), ("behind", 1), ("before", -1)):
        for corner in range(4):
            found = (c for first in range(5, 13) for start in range(60)
                     for c in [_unchecked(16, (0, 0, 0), 0, [first, 13, 17 - first], start)]
                     if (15 * corner + distance) % 60 in _folds(c) and _broken_corners(c) == [corner])
            _table(suite, "fold-%s-corner-%d" % (name, corner), "a fold %d steps from corner %d" % (distance, corner),
                   ["8.2(5)", "8.2.1", "13.2"], next(found))
    found = (c for loop in range(3, 5) for start in range(60)
             for c in [_unchecked(16, (0,), 1, [12, loop, 18 - loop], start)]
             if len(_broken_corners(c)) == 1 and not any(min((p - 15 * k) % 60, (15 * k - p) % 60) < 2
                                                         for p in _folds(c) for k in range(4)))
    _table(suite, "corner-in-loop", "two samples near a corner are one vertex, the ends of a short loop, with no fold near it",
           ["8.2(5)", "8.2.1"], next(found))


def genus(suite):
    """The genus that follows (8.5)."""
    for name, c, wrong in (("too-great", chart(16, (0, 1, 1)), 1), ("too-small", chart(16, (0, 1), 1), 0)):
        c.genus = wrong
        count = len(c.edges) + 1 - 2 * wrong
        c.nodes = (c.nodes + [JUNCTION] * count)[:count] if count > len(c.nodes) else c.nodes[:count]
        c.edges = [(a % count, b % count) for a, b in c.edges]
        _table(suite, "genus-" + name, "the genus given is not that which follows from the sides", ["7.3.4", "8.5", "13.2"], c,
               ("side table", "genus"))
    c = chart(16, (0, 1, 1))
    c.genus = 0x80000002
    _table(suite, "genus-huge", "a genus whose double is beyond 32 bits", ["7.3.4", "8.5", "15.4"], c, ("side table", "genus"))


def everything(suite):
    """All of them."""
    for part in (rule_1, rule_2, rule_3, rule_4, rule_5, genus):
        part(suite)
