# SPDX-License-Identifier: MIT
"""Cut graphs with their side tables: trees, and loops that close handles (gvc.md 7.3, 8.2)."""
from .shape import Chart, varint
from .surface import border_sets

ROOT, JUNCTION = b"\x00", b"\x02"


def extremum(feature):
    """A node of kind 1 with the number of its feature (7.4)."""
    return b"\x01" + varint(feature)


def walk(parents, genus):
    """Edges and sides of a tree with `genus` handles at its root, in the order of a walk around it.

    parents[i] is the node that node i + 1 hangs on; edge i joins the two. The loops of handle h are edges
    len(parents) + 2 h and the one after it; their sides come first: forward, forward, reversed, reversed.
    """
    edges = [(p, i + 1) for i, p in enumerate(parents)] + [(0, 0)] * (2 * genus)
    sides = []
    for h in range(genus):
        a = len(parents) + 2 * h
        sides += [2 * a, 2 * a + 2, 2 * a + 1, 2 * a + 3]

    def visit(node):
        for i, parent in enumerate(parents):
            if parent == node:
                sides.append(2 * i)
                visit(i + 1)
                sides.append(2 * i + 1)

    visit(0)
    return edges, sides


def corners_clear(size, start, steps, sides):
    """Rule 5 of 8.2."""
    sets = border_sets(size, start, steps, sides)
    around = [{sets[(c * (size - 1) + d) % len(sets)] for d in range(-2, 3)} for c in range(4)]
    return all(len(vertices) == 5 for vertices in around)


def even_steps(size, count, least):
    """Steps of `count` edges that sum to P / 2, all about the same, each at least `least`."""
    total = 2 * (size - 1)
    steps = [total // count + (1 if i < total % count else 0) for i in range(count)]
    if min(steps) < least:
        raise ValueError("no room for %d edges" % count)
    return steps


def starts(size, steps, sides):
    """All starts that rule 5 allows."""
    return [s for s in range(4 * (size - 1)) if corners_clear(size, s, steps, sides)]


def chart(size, parents=(0,), genus=0, steps=None, start=None, **fields):
    """A chart with a tree and handles. start: None takes the first that rule 5 allows, "last" the last one."""
    parents = list(parents)
    edges, sides = walk(parents, genus)
    steps = steps or even_steps(size, len(edges), 3 if genus else 2)
    if start is None:
        start = next(s for s in range(4 * (size - 1)) if corners_clear(size, s, steps, sides))
    elif start == "last":
        start = next(s for s in range(4 * (size - 1) - 1, -1, -1) if corners_clear(size, s, steps, sides))
    nodes = [ROOT] + [JUNCTION if i + 1 in parents else extremum(i) for i in range(len(parents))]
    return Chart(size=size, steps=list(steps), sides=sides, start=start, nodes=nodes, edges=edges, genus=genus,
                 **fields)
