# SPDX-License-Identifier: MIT
"""Invalid vectors of ftyp and moov: gvc.md 4.1 to 4.5, 4.9 and 11.2."""
from .boxes import Box, full, u32, u64
from .good_exact import exact_movie
from .head import edit_list, file_type
from .scenes import base

GEOMETRY, SHAPE = "trak", "trak[1]"
ENTRY = "/mdia/minf/stbl/stsd/"


def _moov(suite, name, about, clauses, edit, error="corrupt", movie=None):
    """A vector with a changed moov; its checksum is right."""
    movie = movie or base()
    movie.edit_moov = edit
    suite.bad(name, movie, about, clauses, ["head"], error)


def boxes(suite):
    """Missing and second boxes of the tables, and versions above those given."""
    rows = [("4.4", GEOMETRY, "geometry", ("tkhd", "mdia/mdhd", "mdia/hdlr", "mdia/minf/stbl/stsd", "mdia/minf/stbl/stsz")),
            ("4.5", SHAPE, "shape", ("tkhd", "mdia/mdhd", "mdia/hdlr", "mdia/minf/stbl/stsd", "mdia/minf/stbl/stsz", "tref")),
            ("4.4", GEOMETRY, "geometry", ("mdia/minf/stbl/stsd/avc1/avcC", "mdia/minf/stbl/stsd/avc1/gvcC")),
            ("4.5", SHAPE, "shape", ("mdia/minf/stbl/stsd/urim/uri ",))]
    for table, track, name, paths in rows:
        for path in paths:
            kind = path.rpartition("/")[2]
            row = "%s %s" % (table, kind)
            clauses = ["4.1.5", row] + (["4.4.2"] if kind in ("hdlr", "stsd") else [])
            _moov(suite, "%s-without-%s" % (name, kind.strip()), "the %s track has no %s" % (name, kind), clauses,
                  lambda m, p=track + "/" + path: m.remove(p))
            _moov(suite, "%s-two-%s" % (name, kind.strip()), "the %s track has two %s" % (name, kind), clauses,
                  lambda m, p=track + "/" + path: m.double(p))
    for path in ("mdia", "mdia/minf", "mdia/minf/stbl"):
        kind = path.rpartition("/")[2]
        _moov(suite, "geometry-without-" + kind, "the geometry track has no " + kind, ["4.4.2"],
              lambda m, p=GEOMETRY + "/" + path: m.remove(p))
        _moov(suite, "geometry-two-" + kind, "the geometry track has two " + kind, ["4.4.2"],
              lambda m, p=GEOMETRY + "/" + path: m.double(p))
    _moov(suite, "geometry-two-edts", "the geometry track has two edts", ["4.1.5", "4.4 edts"], lambda m: m.double("trak/edts"))
    _moov(suite, "geometry-two-elst", "edts holds two elst", ["4.1.5", "4.4 edts"], lambda m: m.double("trak/edts/elst"))
    _moov(suite, "shape-two-edts", "the shape track has two edts", ["4.1.5", "4.5 edts"],
          lambda m: [m.add(SHAPE, edit_list(0), 1) for _ in range(2)])
    _moov(suite, "mvex-missing", "there is no mvex", ["4.1.5", "4.3 mvex"], lambda m: m.remove("mvex"))
    _moov(suite, "mvex-twice", "there are two mvex", ["4.1.5", "4.3 mvex"], lambda m: m.double("mvex"))
    for i, name in enumerate(("geometry", "shape")):
        _moov(suite, "trex-missing-" + name, "the %s track has no trex" % name, ["4.1.5", "4.3 trex"],
              lambda m, p="mvex/trex[%d]" % i: m.remove(p))
        _moov(suite, "trex-twice-" + name, "the %s track has two trex" % name, ["4.1.5", "4.3 trex"],
              lambda m, p="mvex/trex[%d]" % i: m.double(p))
    _moov(suite, "trex-description-2", "default_sample_description_index 2", ["4.3 trex"],
          lambda m: m.patch("mvex/trex", 8, u32(2)))


def versions(suite):
    """Boxes of versions above those given (14.4)."""
    for path, version, row in (("trak/tkhd", 2, "4.4 tkhd"), ("trak/mdia/mdhd", 2, "4.4 mdhd"),
                               ("trak/mdia/hdlr", 1, "4.4 hdlr"), ("trak/mdia/minf/stbl/stsd", 2, "4.4 stsd"),
                               ("trak/mdia/minf/stbl/stsz", 1, "4.4 stsz"), ("mvex/trex", 1, "4.3 trex"),
                               ("trak/edts/elst", 2, "4.4 edts"), ("trak[1]" + ENTRY + "urim/uri ", 1, "4.5 uri ")):
        kind = path.rpartition("/")[2].strip()
        _moov(suite, "version-%s-%d" % (kind, version), "%s of version %d" % (kind, version), ["4.1.6", "14.4", row],
              lambda m, p=path, v=version: m.patch(p, 0, bytes([v])), "unsupported")


def tracks(suite):
    """Which tracks there are."""
    _moov(suite, "shape-track-missing", "there is no shape track", ["4.3 trak", "4.5.2"], lambda m: m.remove(SHAPE))
    _moov(suite, "geometry-track-missing", "there is no geometry track", ["4.3 trak"], lambda m: m.remove(GEOMETRY))
    for i, name in enumerate(("geometry", "shape")):
        def second(moov, i=i):
            moov.double("trak[%d]" % i)
            copy = Box("tkhd", moov.get("trak[%d]/tkhd" % i).fields[:12] + u32(7) + moov.get("trak[%d]/tkhd" % i).fields[16:])
            other = Box("trak", children=[copy if b.kind == "tkhd" else b for b in moov.get("trak[%d]" % i).children])
            place = moov.children.index(moov.get("trak[%d]" % (i + 1)))
            moov.children[place] = other
            moov.add("mvex", full("trex", 0, 0, u32(7, 1, 1, 0, 0)), -1)
        _moov(suite, "second-%s-track" % name, "two %s tracks" % name, ["4.3.3", "4.3 trak"], second)
    _moov(suite, "track-number-0", "track_ID 0", ["4.4 tkhd"], lambda m: [m.patch("trak/tkhd", 12, u32(0)),
                                                                          m.patch("trak[1]/tref/cdsc", 0, u32(0))])
    _moov(suite, "tracks-of-one-number", "both tracks have the number 1", ["4.3.3", "4.4 tkhd"],
          lambda m: m.patch("trak[1]/tkhd", 12, u32(1)))
    _moov(suite, "wrong-cdsc", "cdsc names another track than the geometry track", ["4.5 tref"],
          lambda m: m.patch("trak[1]/tref/cdsc", 0, u32(2)))
    _moov(suite, "without-cdsc", "tref holds no cdsc", ["4.5 tref"], lambda m: m.remove("trak[1]/tref/cdsc"))
    for name, path in (("geometry", "trak"), ("shape", "trak[1]")):
        _moov(suite, "timescale-" + name, "the timescale of the %s track is not N" % name, ["11.1", "4.4 mdhd"],
              lambda m, p=path: m.patch(p + "/mdia/mdhd", 12, u32(26)))
    movie = base()
    movie.file_type = file_type(b"isom", 0, (b"iso6", b"mp41"))
    suite.bad("brand-missing", movie, "gvc1 is not among the brands", ["4.3.1", "4.3 ftyp"], ["head"], "unsupported")
    movie = base()
    movie.file_type = Box("ftyp", b"gvc1")
    suite.bad("ftyp-short", movie, "ftyp without minor version", ["4.3.1", "4.3 ftyp"], ["head"])


def entries(suite):
    """Sample entries and tables."""
    def two_entries(moov):
        stsd = moov.get("trak/mdia/minf/stbl/stsd")
        stsd.fields = stsd.fields[:4] + u32(2)
        stsd.children.append(stsd.children[0])
    _moov(suite, "two-sample-entries", "the geometry track has two sample entries", ["4.4 stsd"], two_entries)
    _moov(suite, "other-sample-entry", "the sample entry of the geometry track is avc3", ["4.4 avc1"],
          lambda m: setattr(m.get("trak" + ENTRY + "avc1"), "kind", "avc3"))
    _moov(suite, "short-sample-entry", "avc1 ends within its 78 bytes", ["4.4 avc1"],
          lambda m: [setattr(m.get("trak" + ENTRY + "avc1"), "fields", bytes(50)),
                     setattr(m.get("trak" + ENTRY + "avc1"), "children", [])])
    _moov(suite, "short-urim", "urim ends within its 8 bytes", ["4.5 urim"],
          lambda m: [setattr(m.get("trak[1]" + ENTRY + "urim"), "fields", bytes(4)),
                     setattr(m.get("trak[1]" + ENTRY + "urim"), "children", [])])
    _moov(suite, "other-handler", "the handler of the geometry track is text", ["4.4 hdlr"],
          lambda m: m.patch("trak/mdia/hdlr", 8, b"text"))
    _moov(suite, "other-handler-shape", "the handler of the shape track is text", ["4.5 hdlr"],
          lambda m: m.patch("trak[1]/mdia/hdlr", 8, b"text"))
    for i, name in enumerate(("geometry", "shape")):
        _moov(suite, "samples-outside-" + name, "stsz of the %s track has a sample" % name, ["4.4 stsz", "13.2"],
              lambda m, p="trak[%d]/mdia/minf/stbl/stsz" % i: setattr(m.get(p), "fields", u32(0, 0, 1, 99)))
    for name, text, error in (("later", b"urn:gvc:shape:1\0", "unsupported"), ("longer", b"urn:gvc:shape:00\0", "unsupported"),
                              ("no-number", b"urn:gvc:shape:\0", "unsupported"), ("other", b"urn:gvc:shapes\0", "corrupt")):
        _moov(suite, "uri-" + name, "the URI of the shape track is " + text[:-1].decode(), ["4.5.1", "14.4"],
              lambda m, t=text: setattr(m.get("trak[1]" + ENTRY + "urim/uri "), "fields", u32(0) + t), error)
    _moov(suite, "uri-without-zero", "the URI does not end in a zero byte", ["4.5 uri ", "4.5.1"],
          lambda m: setattr(m.get("trak[1]" + ENTRY + "urim/uri "), "fields", u32(0) + b"urn:gvc:shape:0"), "unsupported")


def _instead(moov, box, path="trak"):
    track = moov.get(path)
    track.children = [box if b.kind == "edts" else b for b in track.children]


def edits(suite):
    """Edit lists that do more than shift (11.2)."""
    for name, box, error in (("two-entries", edit_list(2, count=2), "unsupported"),
                             ("no-entry", edit_list(2, count=0), "unsupported"),
                             ("empty", edit_list(-1), "unsupported"), ("empty-32", edit_list(-1, 0), "unsupported"),
                             ("rate", edit_list(2, rate=0x20000), "unsupported"),
                             ("short", Box("edts", children=[full("elst", 1, 0, u32(1) + u64(0))]), "corrupt")):
        _moov(suite, "edit-list-" + name, "an edit list that is not as this format allows: " + name, ["11.2"],
              lambda m, b=box: _instead(m, b), error)
    movie = base()
    movie.config.rate_num, movie.config.rate_den = 30000, 1001
    movie.media_time["geometry"] = 2002
    _moov(suite, "edit-list-no-frame", "a media_time that is no multiple of D", ["11.2", "13.2"],
          lambda m: _instead(m, edit_list(2003)), "corrupt", movie)
    movie = base()
    movie.media_time["geometry"] = None
    _moov(suite, "edit-list-too-great", "a media_time of 2^31 frames", ["11.2"],
          lambda m: m.add("trak", edit_list(1 << 31), 1), "corrupt", movie)


def exact_tracks(suite):
    """The exact track and its bit."""
    def edit(movie, about, name, clauses, change, error="corrupt"):
        movie.edit_moov = change
        suite.bad(name, movie, about, clauses, ["head", "exact"], error)
    movie = exact_movie()
    movie.config.features = 0
    suite.bad("exact-without-bit", movie, "an exact track, but bit 0 of features is not set", ["4.9.2", "5.7"], ["head", "exact"])
    movie = base()
    movie.config.features = 1
    suite.bad("bit-without-exact", movie, "bit 0 of features is set, but there is no exact track", ["4.9.2", "5.7"],
              ["head", "exact"])
    edit(exact_movie(), "the URI of the exact track is urn:gvc:exact:1", "exact-uri-later", ["4.9.1", "14.4"],
         lambda m: setattr(m.get("trak[1]" + ENTRY + "urim/uri "), "fields", u32(0) + b"urn:gvc:exact:1\0"), "unsupported")
    edit(exact_movie(), "the exact track is the main track and has no gvcC", "exact-without-gvcC", ["4.3.4", "4.9"],
         lambda m: m.remove("trak[1]" + ENTRY + "urim/gvcC"))
    edit(exact_movie(), "stsz of the exact track has a sample", "samples-outside-exact", ["4.4 stsz", "13.2"],
         lambda m: setattr(m.get("trak[1]/mdia/minf/stbl/stsz"), "fields", u32(0, 0, 1, 99)))

    def second(moov):
        fields = moov.get("trak[1]/tkhd").fields
        other = Box("trak", children=[Box("tkhd", fields[:12] + u32(7) + fields[16:]) if b.kind == "tkhd" else b
                                      for b in moov.get("trak[1]").children])
        moov.add("", other, 3)
        moov.add("mvex", full("trex", 0, 0, u32(7, 1, 1, 0, 0)), -1)
    edit(exact_movie(), "two exact tracks", "second-exact-track", ["4.3.3", "4.3 trak"], second)


def everything(suite):
    """All of them."""
    for part in (boxes, versions, tracks, entries, edits, exact_tracks):
        part(suite)
