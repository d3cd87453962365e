#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Random damage with right checksums: fuzz.py COUNT [SEED].  Lines with "seed" are bugs."""

import random
import sys

from forge import Parts
from run_tests import decode_bytes
from samples import all_files


def flip(rng, data):
    """Data with a few bytes changed, cut out or put in."""
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        at = rng.randrange(len(data)) if data else 0
        what = rng.random()
        if what < .7 and data:
            data[at] = rng.choice((rng.randrange(256), data[at] ^ 1 << rng.randrange(8), 0, 255))
        elif what < .85:
            del data[at:at + rng.choice((1, 4, 8))]
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.choice((1, 4))))
    return bytes(data)


def leaves(node):
    """All nodes without children."""
    if node.kids is None:
        yield node
    for kid in node.kids or []:
        yield from leaves(kid)


def damage(rng, p):
    """Damage something of a file."""
    kind = rng.choice(("moov", "sample", "sample", "box", "ghed", "raw", "index"))
    if kind == "moov":
        leaf = rng.choice(list(leaves(p.moov)))
        leaf.head = flip(rng, leaf.head)
    elif kind == "sample":
        run = rng.choice(list(rng.choice(p.fragments).values()))
        i = rng.choice((0, rng.randrange(len(run["samples"]))))
        run["samples"][i] = flip(rng, run["samples"][i])
    elif kind == "box":
        which = rng.choice(("tfhd", "tfdt", "trun", "gcks"))
        seed = rng.random()
        p.hooks[which] = lambda v, k, i: flip(random.Random(seed), v)
    elif kind == "ghed":
        p.hooks["ghed"] = lambda v: flip(rng, v)
    elif kind == "index":
        p.hooks["tfra"] = lambda v: flip(rng, v)
    else:
        p.hooks["file"] = lambda v: flip(rng, v)


def main(count, seed=1):
    """Damage good files `count` times; prints how often each status and clause came out."""
    files = [data for name, data in all_files().items() if name != "repaired"]
    found = {}
    for number in range(int(seed), int(seed) + int(count)):
        rng = random.Random(number)
        p = Parts(rng.choice(files))
        damage(rng, p)
        try:
            data = p.build()
        except Exception:  # the damage does not fit into a file
            continue
        try:
            status, clause, _ = decode_bytes(data)
        except Exception as error:
            print("seed", number, type(error).__name__, error)
            status, clause = 5, ""
        found[status, clause] = found.get((status, clause), 0) + 1
    for key, n in sorted(found.items()):
        print(n, *key)


if __name__ == "__main__":
    main(*sys.argv[1:])
