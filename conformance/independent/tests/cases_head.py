# SPDX-License-Identifier: MIT
"""Forged heads, indexes and top levels (gvc.md 4.1 to 4.5, 4.9, 4.10, 5, 10, 12.8)."""

import struct

from forge import Node, box

CASES = []


def case(name, status, clause, base="example"):
    def add(change):
        CASES.append((name, base, status, clause, change))
        return change
    return add


def node(name, status, clause, path, at, new, base="example"):
    """Overwrite bytes of a leaf of moov at an offset of its content."""
    def change(p):
        n = p.moov.find(path)
        n.head = n.head[:at] + new + n.head[at + len(new):]
    CASES.append((name, base, status, clause, change))


def drop(path, status, clause, base="example"):
    def change(p):
        up, _, last = path.rpartition("/")
        parent = p.moov.find(up) if up else p.moov
        parent.kids.remove(parent.find(last))
    CASES.append((f"no {path}", base, status, clause, change))


def double(path, status, clause, base="example"):
    def change(p):
        up, _, last = path.rpartition("/")
        parent = p.moov.find(up) if up else p.moov
        parent.kids.append(parent.find(last))
    CASES.append((f"two {path}", base, status, clause, change))


def hook(name, status, clause, which, function, base="example"):
    def change(p):
        p.hooks[which] = function
    CASES.append((name, base, status, clause, change))


GVCC = "trak0/mdia/minf/stbl/stsd/avc1/gvcC"
G, S = "trak0/", "trak1/"
T = "mdia/minf/stbl/"

for path in ("tkhd", "mdia/mdhd", T + "stsz"):
    for track, clause in ((G, "4.4"), (S, "4.5")):
        drop(track + path, 1, clause)
        double(track + path, 1, None)
for path, clause in ((G + "mdia/hdlr", "4.4.2"), (S + "mdia/hdlr", "4.4.2"),
                     (G + T + "stsd", "4.4.2"), (G + "mdia", "4.4.2"), (G + "mdia/minf", "4.4.2"),
                     (S + "tref", "4.5"), ("mvex", "4.3"), ("mvex/trex0", "4.3"),
                     ("mvex/trex1", "4.3"), (GVCC, "4.3"), (G + T + "stsd/avc1/avcC", "4.4"),
                     (G + "edts/elst", "11.3"), ("trak1", "4.5.2"), ("trak0", "4.3"),
                     (S + "tref/cdsc", "4.5"), (S + T + "stsd/urim/uri ", "4.5.2")):
    drop(path, 1, clause)
for path, clause in ((G + "mdia", "4.4.2"), (G + "mdia/hdlr", "4.4.2"),
                     (G + T + "stsd", "4.4.2"), (S + "tref", "4.5"), ("mvex", "4.3"),
                     ("mvex/trex0", "4.3"), (GVCC, "4.3.4"), (G + T + "stsd/avc1/avcC", "4.4"),
                     (G + "edts", "4.4"), (G + "edts/elst", "11.2"), ("trak0", "4.3.3"),
                     ("trak1", "4.3.3"), (S + "tref/cdsc", "4.5"),
                     (S + T + "stsd/urim/uri ", "4.5")):
    double(path, 1, clause)
drop("mvex/mehd", 0, "")
drop("mvhd", 0, "")
drop(G + "mdia/minf/vmhd", 0, "")
drop(G + T + "stsd/avc1/colr", 0, "")

node("tkhd version 2", 3, "4.1.6", G + "tkhd", 0, b"\2")
node("track_ID 0", 1, "4.4", G + "tkhd", 12, bytes(4))
node("same track_ID", 1, "4.3.3", S + "tkhd", 12, b"\0\0\0\1")
node("mdhd version 2", 3, "4.1.6", S + "mdia/mdhd", 0, b"\2")
node("timescale", 1, "4.4", G + "mdia/mdhd", 12, b"\0\0\0\1")
node("hdlr version 1", 3, "4.1.6", G + "mdia/hdlr", 0, b"\1")
node("stsd version 1", 3, "4.1.6", G + T + "stsd", 0, b"\1")
node("stsz version 1", 3, "4.1.6", S + T + "stsz", 0, b"\1")
node("stsz with samples", 1, "4.4", G + T + "stsz", 8, b"\0\0\0\1")
node("uri version 1", 3, "4.1.6", S + T + "stsd/urim/uri ", 0, b"\1")
node("shape:1", 3, "4.5.1", S + T + "stsd/urim/uri ", 18, b"1")
node("cdsc names 2", 1, "4.5", S + "tref/cdsc", 0, b"\0\0\0\2")
node("trex version 1", 3, "4.1.6", "mvex/trex0", 0, b"\1")
node("trex description 2", 1, "4.3", "mvex/trex1", 8, b"\0\0\0\2")
node("elst empty edit", 3, "11.2", G + "edts/elst", 16, b"\xff" * 8)
node("elst rate", 3, "11.2", G + "edts/elst", 24, b"\0\2\0\0")
node("elst no multiple", 1, "11.2", G + "edts/elst", 16, struct.pack(">q", 2003))
node("elst negative", 1, "11.2", G + "edts/elst", 16, struct.pack(">q", -2002))
node("elst too great", 1, "11.2", G + "edts/elst", 16, struct.pack(">q", 1001 << 31))
node("elst other shift", 1, "11.3", G + "edts/elst", 16, struct.pack(">q", 1001))
node("elst two entries", 3, "11.2", G + "edts/elst", 4, b"\0\0\0\2")
node("elst no entry", 3, "11.2", G + "edts/elst", 4, b"\0\0\0\0")
node("elst version 2", 3, "4.1.6", G + "edts/elst", 0, b"\2")

node("version_major", 3, "5.1", GVCC, 0, b"\0\1")
node("version_minor 2", 0, "", GVCC, 2, b"\0\2")
node("features bit 1", 3, "5.1", GVCC, 4, b"\0\0\0\2")
node("features exact", 1, "4.9.2", GVCC, 4, b"\0\0\0\1")
for value in (14, 17, 16386):
    node(f"picture_width {value}", 1, "5.2", GVCC, 8, struct.pack(">I", value))
for value in (14, 17, 5462):
    node(f"plane_height {value}", 1, "5.2", GVCC, 12, struct.pack(">I", value))
node("picture_width of another picture", 1, "6.2.1", GVCC, 8, struct.pack(">I", 34))
for value in (15, 2050):
    node(f"image_size {value}", 1, "5.2", GVCC, 16, struct.pack(">I", value))
node("chart above image_size", 1, "5.4", GVCC, 16, struct.pack(">I", 17))
node("code_bits 8", 3, "5.2", GVCC, 20, b"\x08")
node("code_shift 5", 3, "5.2", GVCC, 21, b"\x05")
node("N 0", 1, "5.2", GVCC, 22, bytes(4))
node("D 0", 1, "5.2", GVCC, 26, bytes(4))
node("declared 2", 1, "5.6", GVCC, 30, struct.pack(">Q", 2))
node("declared 4", 1, "5.6", GVCC, 30, struct.pack(">Q", 4))
node("declared 0", 0, "", GVCC, 30, struct.pack(">Q", 0))
node("declared D beyond", 1, "5.2", GVCC, 30, struct.pack(">Q", (1 << 64) // 1001 + 1))
node("unit control character", 1, "2.5", GVCC, 38, b"\1\n")
node("unit C1", 1, "2.5", GVCC, 38, b"\2\xc2\x80")
node("unit not UTF-8", 1, "2.5", GVCC, 38, b"\1\xff")
node("unit surrogate", 1, "2.5", GVCC, 38, b"\3\xed\xa0\x80")
node("unit overlong", 1, "2.5", GVCC, 38, b"\2\xc0\xaf")
node("unit of 16 bytes", 1, "5", GVCC, 38, b"\x10" + b"m" * 16)


@case("gvcC short", 1, "5")
def _(p):
    n = p.moov.find(GVCC)
    n.head = n.head[:37]


@case("bytes behind settings", 0, "")
def _(p):
    p.moov.find(GVCC).head += b"later"


hook("no brand", 3, "4.3.1", "ftyp", lambda v: v.replace(b"gvc1", b"isom"))
hook("not major brand", 0, "", "ftyp", lambda v: v[:8] + b"isom" + v[12:])
for which in ("moov", "moof", "gdig", "mfra"):
    hook(f"wrong sum of {which}", 1, "10.4.2" if which == "gdig" else "10.1.1", "crc",
         lambda v, w, which=which: w != which)


@case("moov: box behind gcrc", 1, "10.1.1")
def _(p):
    p.hooks["file"] = lambda v: v
    head = p.head()
    n = struct.unpack(">I", head[:4])[0]
    longer = struct.pack(">I", n + 8) + head[4:] + box(b"free", b"")
    p.head = lambda: longer


def top(name, status, clause, function, base="example"):
    """Change the list of top-level boxes before the first fragment, or a pair moof, mdat."""
    hook(name, status, clause, "pair", lambda v, i: function(v) if i == 0 else v, base)


FREE = box(b"free", b"abc")
top("unknown box between fragments", 0, "", lambda v: [FREE] + v)
CASES.pop()
hook("unknown boxes", 0, "", "before", lambda v, i: [FREE, box(b"uuid", bytes(20))])
hook("unknown 64-bit box", 0, "", "before", lambda v, i: [box(b"abcd", bytes(20), True)])
hook("uuid without user type", 0, "", "before", lambda v, i: [box(b"uuid", bytes(8))])
top("box between moof and mdat", 1, "4.1.1", lambda v: [v[0], FREE, v[1]])
top("two mdat", 1, "4.1.1", lambda v: v + [v[1]])
top("no mdat", 1, "4.1.1", lambda v: v[:1])
top("no moof", 1, "4.1.1", lambda v: v[1:])
top("second ftyp", 1, "4.1.1", lambda v: v + [box(b"ftyp", b"gvc1\0\0\0\0")])
top("second moov", 1, "4.1.1", lambda v: v + [box(b"moov", b"")])
hook("mfra before the end", 1, "4.1.1", "before", lambda v, i: [box(b"mfra", b"")] if i else v)
hook("bytes behind mfra", 1, "4.1.1", "file", lambda v: v + FREE)
hook("one byte behind mfra", 1, None, "file", lambda v: v + b"\0")
hook("no mfra", 1, "12.5", "file", lambda v: v[:-struct.unpack(">I", v[-4:])[0]])
for cut in (1, 8, 15, 17, 100, 2000):
    hook(f"cut by {cut}", 1, None, "file", lambda v, cut=cut: v[:-cut])
hook("empty file", 1, "4.1.1", "file", lambda v: b"")
hook("size 0", 1, "4.1.2", "before", lambda v, i: [bytes(4) + b"free"] if i else v)
hook("size 7", 1, "4.1.2", "before", lambda v, i: [b"\0\0\0\7free"] if i else v)
hook("64-bit size 15", 1, "4.1.2", "before", lambda v, i: [b"\0\0\0\1free" + struct.pack(">Q", 15)])
hook("64-bit size wraps", 1, "4.1.2", "before",
     lambda v, i: [b"\0\0\0\1free" + struct.pack(">Q", 2**64 - 8)])
hook("ftyp not first", 1, "4.1.1", "file", lambda v: FREE + v)
hook("moof before moov", 1, "4.1.1", "file", lambda v: v[:28] + box(b"moof", b"") + v[28:])
hook("unknown box inside moov", 0, "", "moov", lambda v: [FREE] + v)

X = "trak1/" + T + "stsd/urim/uri "
node("exact:1", 3, "4.9.1", X, 18, b"1", "lossless")
node("exact without bit", 1, "4.9.2", "trak1/" + T + "stsd/urim/gvcC", 4, bytes(4), "lossless")
double("trak0", 1, "4.3.3", "lossless")
drop("trak2", 1, "4.9.2", "preview")
drop("trak0", 1, "4.3.4", "preview")
drop("trak1", 1, None, "preview")


@case("uri without zero", 3, "4.5.1")
def _(p):
    n = p.moov.find(S + T + "stsd/urim/uri ")
    n.head = n.head[:-1]


@case("size 0 in dinf", 1, "4.1.2")
def _(p):
    p.moov.find("trak0/mdia/minf/dinf").head += bytes(4) + b"free"


@case("another track", 0, "")
def _(p):
    other = Node.parse(p.moov.find("trak1").bytes())
    other.find("tkhd").head = p.moov.find("trak1/tkhd").head[:12] + b"\0\0\0\7" + \
        p.moov.find("trak1/tkhd").head[16:]
    n = other.find(T + "stsd/urim/uri ")
    n.head = n.head.replace(b"gvc:shape", b"oth:shape")
    p.moov.kids.append(other)
    traf = box(b"traf", box(b"tfhd", struct.pack(">II", 0, 7)))
    p.hooks["before"] = lambda v, i: [box(b"moof", traf), box(b"mdat", b"sound")]


@case("fragment of another track with a wrong gcrc", 1, "10.1.1")
def _(p):
    traf = box(b"traf", box(b"tfhd", struct.pack(">II", 0, 7)))
    bad = box(b"gcrc", bytes(8))
    p.hooks["before"] = lambda v, i: [box(b"moof", traf + bad), box(b"mdat", b"sound")]


def other_trak(p):
    """A trak of another kind, with all that 4.4.2 wants."""
    other = Node.parse(p.moov.find("trak1").bytes())
    other.find("tkhd").head = p.moov.find("trak1/tkhd").head[:12] + b"\0\0\0\7" + \
        p.moov.find("trak1/tkhd").head[16:]
    hdlr = other.find("mdia/hdlr")
    hdlr.head = hdlr.head[:8] + b"soun" + hdlr.head[12:]
    p.moov.kids.append(other)
    return other


for path, status in ((None, 0), ("mdia", 1), ("mdia/hdlr", 1), ("mdia/minf", 1), (T[:-1], 1),
                     (T + "stsd", 1), ("mdia/mdhd", 0), ("tkhd", 0), (T + "stsz", 0)):
    @case(f"another track without {path}", status, "4.4.2" if status else "")
    def _(p, path=path):
        trak = other_trak(p)
        if path:
            up, _, last = path.rpartition("/")
            parent = trak.find(up) if up else trak
            parent.kids.remove(parent.find(last))


@case("another track with a sample description of its own", 0, "")
def _(p):
    stsd = other_trak(p).find(T + "stsd")
    stsd.head, stsd.kids = b"\1\0\0\0\0\0\0\2" + bytes(7), []


@case("size 0 in dref", 1, "4.1.2")
def _(p):
    n = p.moov.find("trak0/mdia/minf/dinf")
    n.head = n.head[:16] + bytes(4) + n.head[20:]


@case("size 0 in tref of the geometry track, which is unknown there", 0, "")
def _(p):
    p.moov.find("trak0").kids.append(Node(b"tref", bytes(4) + b"cdsc"))
