# SPDX-License-Identifier: MIT
"""Forged indexes and repaired files (gvc.md 4.10, 10.4, 12.8)."""

import zstandard

import cases_head
from cases_head import FREE, hook as _hook
from forge import ggap

CASES = []


def hook(*args):
    """hook() of cases_head, into the list of this file."""
    _hook(*args)
    CASES.append(cases_head.CASES.pop())


hook("no tfra", 1, "4.10", "mfra", lambda v: v[1:])
hook("two tfra", 1, "4.10", "mfra", lambda v: [v[0]] + v)
hook("no ghed", 0, "", "mfra", lambda v: v[:1])
hook("two ghed", 1, "4.10", "mfra", lambda v: v + v[1:])
hook("unknown box in mfra", 0, "", "mfra", lambda v: v + [FREE])
hook("ghed of another head", 1, "4.10.5", "ghed", lambda v: zstandard.compress(b"abc"))
hook("ghed with bytes behind", 1, "4.10.5", "ghed", lambda v: v + b"\0")
hook("wrong time in index", 1, "4.10.3", "entries", lambda v: [(v[0][0] + 1, v[0][1])] + v[1:])
hook("wrong offset in index", 1, "4.10.3", "entries", lambda v: [(v[0][0], v[0][1] + 1)] + v[1:])
hook("too many entries", 1, "4.10.1", "tfra", lambda v: v[:12] + b"\0\0\0\3" + v[16:])
hook("entry missing", 1, "4.10.3", "tfra", lambda v: v[:12] + b"\0\0\0\1" + v[16:35])
hook("bytes behind entries", 1, "4.10.1", "tfra", lambda v: v + b"\0")
hook("traf_number 77", 0, "", "tfra", lambda v: v[:32] + b"\x4d" + v[33:])
hook("trun_number 2", 1, "4.10.3", "tfra", lambda v: v[:33] + b"\2" + v[34:])
hook("sample_number 2", 1, "4.10.3", "tfra", lambda v: v[:34] + b"\2" + v[35:])
hook("tfra version 2", 3, "4.1.6", "tfra", lambda v: b"\2" + v[1:])
hook("mfro of another size", 1, "4.10", "mfro", lambda v: v[:12] + b"\0\0\0\1")
hook("mfro flags", 1, "4.10", "mfro", lambda v: v[:11] + b"\1" + v[12:])
hook("gdig flags", 0, "", "gdigflags", lambda v: b"\0\0\0\1")
hook("gdig version", 3, "4.1.6", "gdigflags", lambda v: b"\1\0\0\0")

hook("repaired without ggap", 1, "11.3", "none", None, "repaired")
for name, status, clause, bytes_ in (
        ("ggap", 0, "", ggap(2, 3)), ("ggap first", 1, "12.8.2", ggap(3, 3)),
        ("ggap too many", 1, None, ggap(2, 4)), ("ggap too few", 1, "11.3", ggap(2, 2)),
        ("ggap zero", 1, "12.8.2", ggap(2, 0)), ("ggap flags", 0, "", ggap(2, 3, 1)),
        ("ggap version", 3, "4.1.6", ggap(2, 3, 1 << 24)),
        ("ggap sum", 1, "10.1.1", ggap(2, 3)[:-1] + b"\0"), ("ggap beyond", 1, "5.6", ggap(2, 99)),
        ("ggap wraps", 1, "12.8.2", ggap(2, 2**64 - 1)),
        ("two ggap", 0, "", ggap(2, 1) + ggap(3, 2))):
    hook(name, status, clause, "before", lambda v, i, b=bytes_: [b] if i == 1 else v, "repaired")
