# SPDX-License-Identifier: MIT
"""Which track is which, and the checks of their boxes (gvc.md 4.4, 4.5, 4.9, 11.2)."""

from .boxes import at_most_one, of_type, one, walk
from .errors import Damaged, Unsupported, placed

SHAPE, EXACT = b"urn:gvc:shape:", b"urn:gvc:exact:"
CLAUSE = {"geometry": "4.4", "shape": "4.5", "exact": "4.9"}
# Levels of 4.2 in a trak: container boxes and those in them.  `tref` is in the shape track only;
# `stsd` and sample entries are read by classify().
LEVELS = {b"trak": (b"edts", b"mdia", b"tref"), b"mdia": (b"minf",), b"minf": (b"dinf", b"stbl"),
          b"dinf": (b"dref",)}


class Track:
    """A track of a known kind.

    kind: "geometry", "shape" or "exact"; id: track_ID; trak, entry: boxes; inner: boxes of the
    sample entry; T: shift of presentation (11.2); defaults: duration, size and flags of samples
    by trex.
    """

    def __init__(self, kind, trak, entry, inner):
        self.kind, self.trak, self.entry, self.inner = kind, trak, entry, inner
        self.id = self.T = 0
        self.defaults = (0, 0, 0)


def path(box, *kinds):
    """The box under `box` at a path of types, each of which must be there once (4.4.2)."""
    for kind in kinds:
        box = one(box.children(), kind, "4.4.2", box.name)
    return box


def track_id(trak, clause):
    """track_ID of a trak (4.4)."""
    tkhd = one(trak.children(), b"tkhd", clause, trak.name)
    version, _ = tkhd.full(clause, 1)
    return tkhd.fields("I", 20 if version else 12, clause)[0]


def classify(trak):
    """The Track that a trak is, or None for other tracks (4.4, 4.4.2, 4.5, 4.9, 4.11)."""
    hdlr, stsd = path(trak, b"mdia", b"hdlr"), path(trak, b"mdia", b"minf", b"stbl", b"stsd")
    if hdlr.end - hdlr.body < 12 or stsd.end - stsd.body < 8:
        return None
    handler = hdlr.content(8)[:4]
    if handler not in (b"vide", b"meta") or stsd.content(4)[:4] != b"\0\0\0\1":
        return None
    entries = list(walk(stsd.data, stsd.body + 8, stsd.end))
    if not entries:
        return None
    if entries[0].type not in (b"avc1", b"urim"):
        return None
    track = classify_video(trak, entries[0]) if handler == b"vide" \
        else classify_meta(trak, entries[0])
    if track and len(entries) != 1:
        raise Damaged(CLAUSE[track.kind], "boxes behind the only sample entry", stsd.name)
    return track


def classify_video(trak, entry):
    """A vide track with avc1 and gvcC is the geometry track (4.4)."""
    if entry.type != b"avc1":
        return None
    inner = entry.children(78)
    if not any(b.type == b"gvcC" for b in inner):
        return None
    return Track("geometry", trak, entry, inner)


def classify_meta(trak, entry):
    """A meta track with urim and one of the two URIs (4.5, 4.9); another number is unsupported."""
    if entry.type != b"urim":
        return None
    inner = entry.children(8)
    for box in of_type(inner, b"uri "):
        uri = bytes(box.data[box.body + 4:box.end])
        for kind, prefix, clause in (("shape", SHAPE, "4.5.1"), ("exact", EXACT, "4.9.1")):
            if not uri.startswith(prefix):
                continue
            box.full(clause)
            if uri != prefix + b"0\0":
                raise Unsupported(clause, f"URI {uri.decode('latin-1')!r}", box.name)
            one(inner, b"uri ", CLAUSE[kind], entry.name)
            return Track(kind, trak, entry, inner)
    return None


def check_sizes(track):
    """Sizes of the boxes on all levels of 4.2 in a track of this document (4.1.2)."""
    boxes = [track.trak]
    while boxes:
        box = boxes.pop()
        inner = LEVELS.get(box.type, ())
        for child in box.children(8 if box.type == b"dref" else 0):
            if child.type in inner and (child.type != b"tref" or track.kind == "shape"):
                boxes.append(child)


def check_track(track, config, main_id):
    """Check the boxes of a track marked R and find its T (4.4, 4.5, 4.9)."""
    clause = CLAUSE[track.kind]
    with placed(f"{track.kind} track, {track.trak.name}"):
        parts = track.trak.children()
        track.id = track_id(track.trak, clause)
        if track.id == 0:
            raise Damaged(clause, "track_ID 0")
        track.T = edit_shift(at_most_one(parts, b"edts", clause, None), config.D)
        media = one(parts, b"mdia", clause, None).children()
        mdhd = one(media, b"mdhd", clause, None)
        version, _ = mdhd.full(clause, 1)
        timescale = mdhd.fields("I", 20 if version else 12, clause)[0]
        if timescale != config.N:
            raise Damaged(clause, f"timescale {timescale} is not N = {config.N}")
        hdlr = one(media, b"hdlr", clause, None)
        hdlr.full(clause)
        check_table(one(media, b"minf", clause, None), clause)
        if track.kind == "shape":
            check_reference(one(parts, b"tref", "4.5", None), main_id)


def check_table(minf, clause):
    """stbl: stsd version 0, stsz without samples (4.4)."""
    table = one(minf.children(), b"stbl", clause, None).children()
    one(table, b"stsd", clause, None).full(clause)
    stsz = one(table, b"stsz", clause, None)
    stsz.full(clause)
    if stsz.fields("II", 4, clause)[1] != 0:
        raise Damaged(clause, "stsz: samples outside of fragments")


def check_reference(tref, main_id):
    """tref holds one cdsc whose first track_ID is that of the main track (4.5)."""
    cdsc = one(tref.children(), b"cdsc", "4.5", tref.name)
    if cdsc.fields("I", 0, "4.5")[0] != main_id:
        raise Damaged("4.5", "cdsc does not name the main track", cdsc.name)


def edit_shift(edts, D):
    """T of an edts box or None (11.2), in units of the timescale."""
    if edts is None:
        return 0
    elst = at_most_one(edts.children(), b"elst", "11.2", edts.name)
    if elst is None:
        return 0
    with placed(elst.name):
        version, _ = elst.full("11.2", 1)
        count = elst.fields("I", 4, "11.2")[0]
        if count != 1:
            raise Unsupported("11.2", f"edit list of {count} entries")
        _, T, rate = elst.fields("QqI" if version else "IiI", 8, "11.2")
        if T == -1 or rate != 0x10000:
            raise Unsupported("11.2", "edit that is empty or changes the rate")
        if T < 0 or T % D or T > (2**31 - 1) * D:
            raise Damaged("11.2", f"media_time {T} is no multiple of D = {D} in range")
    return T
