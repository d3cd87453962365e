# SPDX-License-Identifier: MIT
"""Forged fragments (gvc.md 4.6 to 4.8, 4.11, 10.2, 11)."""

import struct

from cases_head import hook as _hook
import cases_head
from forge import box

CASES = []


def hook(*args, **kw):
    _hook(*args, **kw)
    CASES.append(cases_head.CASES.pop())


def case(name, status, clause, base="example"):
    def add(change):
        CASES.append((name, base, status, clause, change))
        return change
    return add


def content(name, status, clause, which, function, kind="geometry", base="example"):
    """Change the content of a box of the traf of a kind in fragment 0."""
    hook(name, status, clause, which,
         lambda v, k, i: function(v) if k == kind and i == 0 else v, base)


def put(at, new):
    return lambda v: v[:at] + new + v[at + len(new):]


for which in ("tfhd", "tfdt", "trun", "gcks"):
    content(f"no {which}", 1, None, which, lambda v: None)
    hook(f"two {which}", 1, None, "traf", lambda v, k, i, w=which: v + [
        b for b in v if b[4:8] == w.encode()])
content("tfhd version 1", 3, "4.1.6", "tfhd", put(0, b"\1"))
content("tfhd without base-is-moof", 1, "4.6.1", "tfhd", put(1, b"\0"))
content("tfhd base-data-offset", 1, "4.6.1", "tfhd", lambda v: b"\0\2\0\1" + v[4:] + bytes(8))
content("tfhd duration-is-empty", 1, "4.6.1", "tfhd", put(1, b"\3"))
content("tfhd sample description 1", 0, "", "tfhd", lambda v: b"\0\2\0\2" + v[4:] + b"\0\0\0\1")
content("tfhd sample description 2", 1, "4.6.1", "tfhd",
        lambda v: b"\0\2\0\2" + v[4:] + b"\0\0\0\2")
content("tfhd default duration", 1, "4.7.3", "tfhd", lambda v: b"\0\2\0\x08" + v[4:] + b"\0\0\0\2")
content("tfhd default flags sync", 1, "4.7.5", "tfhd", lambda v: b"\0\2\0\x20" + v[4:] + bytes(4))
content("tfhd short", 1, "4.6.1", "tfhd", lambda v: b"\0\2\0\x20" + v[4:])
content("tfhd unknown flag", 0, "", "tfhd", put(1, b"\x82"))
content("tfhd unknown track", 1, "4.6", "tfhd", put(4, b"\0\0\0\x09"))
content("tfdt version 2", 3, "4.1.6", "tfdt", put(0, b"\2"))
content("tfdt version 0", 0, "", "tfdt", lambda v: bytes(8))
content("tfdt other time", 1, "11.3", "tfdt", put(4, struct.pack(">Q", 1001)))
content("tfdt no multiple", 1, "11.2.1", "tfdt", put(4, struct.pack(">Q", 1)))
content("tfdt greatest", 1, None, "tfdt", put(4, b"\xff" * 8))
content("trun version 2", 3, "4.1.6", "trun", put(0, b"\2"))
content("trun without data offset", 1, "4.7.1", "trun", lambda v: v[:3] + b"\4" + v[4:8] + v[12:])
content("trun both flags", 1, "4.7.1", "trun", put(2, b"\x0e"))
content("trun too long", 1, "4.7.2", "trun", lambda v: v + bytes(8))
content("trun one byte more", 1, "4.7.2", "trun", lambda v: v + b"\0")
content("trun count", 1, "4.7.2", "trun", put(4, b"\0\0\0\3"))
content("trun huge count", 1, "4.7.2", "trun", put(4, b"\xff\xff\xff\xff"))
content("trun no columns, huge count", 1, "10.2.1", "trun",
        lambda v: b"\1\0\0\1\x7f\xff\xff\xff" + v[8:12])
content("trun zero samples", 1, "4.7.1", "trun", lambda v: v[:4] + bytes(4) + v[8:16])
content("trun first not sync", 1, "4.7.5", "trun", put(12, b"\1\1\0\0"))
content("trun unknown flag", 0, "", "trun", put(1, b"\x80"))
content("data offset", 1, "4.8.2", "trun", lambda v: v[:11] + bytes([v[11] + 1]) + v[12:])
content("data offset negative", 1, "4.8.2", "trun", put(8, b"\xff"))
content("size of a sample", 1, None, "trun", put(19, b"\x45"))
content("sample of 0 bytes", 1, "4.7.3", "trun", put(16, bytes(4)))
content("sample beyond the file", 1, None, "trun", put(16, b"\x3f\xff\xff\xff"))
content("composition offset no multiple", 1, "11.2.1", "trun", put(20, b"\0\0\0\1"))
content("two samples of one frame", 1, "11.3", "trun", put(20, struct.pack(">i", 3003)))
content("composition offset beyond", 1, "11.3", "trun", put(28, struct.pack(">i", 4004)))
content("trun version 0", 0, "", "trun", put(0, b"\0"))
content("negative offset in version 0", 1, None, "trun",
        lambda v: b"\0" + v[1:20] + struct.pack(">i", -1001) + v[24:])
content("gcks flags", 0, "", "gcks", put(3, b"\1"))
content("gcks version", 3, "4.1.6", "gcks", put(0, b"\1"))
content("gcks too short", 1, "10.2.1", "gcks", lambda v: v[:-4])
content("gcks too long", 1, "10.2.1", "gcks", lambda v: v + bytes(4))
content("gcks wrong sum", 1, "10.2.2", "gcks", put(4, bytes(4)))
content("shape gcks wrong sum", 1, "10.2.2", "gcks", put(4, bytes(4)), "shape")
content("shape data offset", 1, "4.8.2", "trun", lambda v: v[:11] + bytes([v[11] + 1]) + v[12:],
        "shape")
content("shape duration", 1, "4.7.3", "tfhd",
        lambda v: b"\0\2\0\x08" + v[4:] + b"\0\0\0\2", "shape")

hook("unknown boxes in moof and traf", 0, "", "moof", lambda v, i: [box(b"free", b"")] + v)
hook("unknown box in traf", 0, "", "traf", lambda v, k, i: v + [box(b"sbgp", b"abcdefgh")])
hook("no mfhd", 0, "", "moof", lambda v, i: v[1:])
hook("no traf of shape", 1, "4.6", "moof", lambda v, i: v[:2] if i == 0 else v)
hook("two traf of shape", 1, "4.6", "moof", lambda v, i: v + v[2:] if i == 0 else v)
hook("traf of another track", 1, "4.6", "moof", lambda v, i: v + [
    box(b"traf", box(b"tfhd", struct.pack(">II", 0, 9)))])
hook("mdat too long", 1, "4.8.2", "mdat", lambda v, i: v + b"\0")
hook("mdat too short", 1, "4.8.2", "mdat", lambda v, i: v[:-1])
hook("mdat with a 64-bit size", 0, "", "long", lambda v: True)


@case("numbers of samples differ", 1, "4.7.1")
def _(p):
    run = p.fragments[0]["shape"]
    run["samples"].append(run["samples"][-1])
    run["offsets"].append(run["offsets"][-1])


@case("shape samples not in presentation order", 0, "")
def _(p):
    run = p.fragments[0]["shape"]
    run["samples"].reverse()
    run["offsets"] = [1001, -1001]


@case("exact samples not in presentation order", 0, "", "lossless")
def _(p):
    run = p.fragments[0]["exact"]
    run["samples"][1:3] = run["samples"][2:0:-1]
    run["offsets"][1:3] = [p.D, -p.D]


@case("fragments exchanged", 1, None)
def _(p):
    p.fragments.reverse()


@case("fragment missing", 1, None)
def _(p):
    p.fragments.pop(0)


@case("last fragment missing", 1, "5.6")
def _(p):
    p.fragments.pop()


@case("no fragments", 0, "")
def _(p):
    n = p.moov.find(cases_head.GVCC)
    n.head = n.head[:30] + bytes(8) + n.head[38:]
    p.fragments = []


@case("two sync samples", 1, "4.7.5", "lossy")
def _(p):
    def trun(v, k, i):
        n = struct.unpack(">I", v[4:8])[0]
        flags = [struct.pack(">I", 0 if j in (0, 3) else 0x10000) for j in range(n)]
        rows = b"".join(v[16 + 8 * j:20 + 8 * j] + flags[j] + v[20 + 8 * j:24 + 8 * j]
                        for j in range(n))
        return b"\1\0\x0e\1" + v[4:12] + rows
    p.hooks["trun"] = trun
