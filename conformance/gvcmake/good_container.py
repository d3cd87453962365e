# SPDX-License-Identifier: MIT
"""Valid vectors of the container: gvc.md 4, 5 and 11."""
from .boxes import Box, full, u16, u32, u64
from .content import codes_of, noise
from .fragment import close
from .head import SYNC, Config, edit_list, file_type, handler, media_header, sample_table, track_header
from .movie import Gap
from .scenes import Group, add_group, base, movie_for, still_codes
from .tables import chart

FRAGMENT = ["4.7.3", "4.7.4", "4.8.2"]


def _movie(rate=(25, 1), frames=(2, 1), **fields):
    """Groups of a small chart, of which little changes from frame to frame."""
    c = chart(16, (0, 1, 1))
    movie = movie_for([c], rate=rate, **fields)
    for count in frames:
        add_group(movie, Group([c], still_codes([c], [7] * count)))
    movie.config.declared_frames = sum(frames)
    return movie


def _each_run(movie, **fields):
    for part in movie.parts:
        for run in part.runs.values():
            for name, value in fields.items():
                setattr(run, name, value)


def simple(suite):
    """What every file is made of."""
    suite.good("core/base", base(), "three frames in two groups, the file that most invalid vectors are changed from",
               ["4.1.1", "10.1.1", "10.2.1", "10.2.2", "10.4", "11.3"], ["container"])
    suite.good("core/groups-of-one", _movie(frames=(1, 1, 1, 1)), "each frame is a group of its own", ["11.3", "6.2.5"],
               ["container"])
    suite.good("core/long-group", _movie(frames=(20,)), "twenty frames in one group: frame_num runs past its range",
               ["6.2.6", "11.3"], ["container", "h264"])
    movie = base()
    movie.config.declared_frames = 0
    suite.good("core/frames-not-declared", movie, "declared_frames 0: not known", ["5.6"], ["gvcC"])
    movie = base()
    movie.copy = "missing"
    suite.good("core/no-copy-of-head", movie, "there is no ghed", ["4.10.5"], ["index"])
    movie = _movie(frames=())
    suite.good("extended/no-frames", movie, "a file without frames", ["4.1.1"], ["container"])


def runs(suite):
    """Forms of tfhd, tfdt and trun."""
    for name, about, fields in (
            ("flags-per-sample", "flags of each sample in trun", {"flags_in": "each"}),
            ("flags-in-tfhd", "default flags in tfhd", {"flags_in": "tfhd"}),
            ("duration-in-tfhd", "default duration in tfhd", {"duration_in": "tfhd"}),
            ("duration-in-trun", "duration of each sample in trun", {"duration_in": "trun"}),
            ("times-of-32-bits", "tfdt of version 0", {"time_version": 0}),
            ("offsets-unsigned", "trun of version 0", {"version": 0})):
        movie = base()
        _each_run(movie, **fields)
        suite.good("core/" + name, movie, about, FRAGMENT + ["4.7.5", "11.3"], ["runs"])
    movie = base()
    _each_run(movie, duration_in="trun")

    def wrong_defaults(moov):
        for i in range(2):
            moov.patch("mvex/trex[%d]" % i, 12, u32(77, 99, SYNC))
    movie.edit_moov = wrong_defaults
    _each_run(movie, flags_in="each")
    suite.good("extended/trun-overrides-trex", movie, "defaults of trex that no sample has", ["4.7.3", "4.3.2"], ["runs"])
    movie = _movie(frames=(1, 1))
    _each_run(movie, flags_in="none")
    movie.edit_moov = lambda moov: [moov.patch("mvex/trex[%d]" % i, 20, u32(SYNC)) for i in range(2)]
    suite.good("extended/flags-in-trex", movie, "groups of one frame; trex says that samples are sync samples",
               ["4.7.3", "4.7.5"], ["runs"])
    movie = _movie(frames=(1, 1))
    _each_run(movie, sizes_in="tfhd")
    suite.good("core/size-in-tfhd", movie, "default size in tfhd", ["4.7.3"], ["runs"])
    movie = _movie(frames=(1, 1))
    _each_run(movie, sizes_in="trex")
    lengths = [len(movie.fragment().runs[k].samples[0]) for k in movie.kinds]
    movie.edit_moov = lambda moov: [moov.patch("mvex/trex[%d]" % i, 16, u32(n)) for i, n in enumerate(lengths)]
    suite.good("extended/size-in-trex", movie, "default size in trex", ["4.7.3"], ["runs"])


def times(suite):
    """Frame rates, edit lists, order of presentation."""
    for name, rate in (("30000-1001", (30000, 1001)), ("24000-1001", (24000, 1001)), ("one-a-minute", (1, 60)),
                       ("12800-512", (12800, 512)), ("great-timescale", (4294967295, 1000000007))):
        suite.good(("extended/" if "great" in name or "minute" in name else "core/") + "rate-" + name, _movie(rate),
                   "N / D = %d / %d" % rate, ["11.1", "11.2"], ["times"])
    movie = _movie((4294967295, 4294967295), frames=(1, 1, 1), shift=None)
    suite.good("extended/times-beyond-32-bits", movie, "times in tfdt and tfra beyond 32 bits", ["11.3", "4.10.1"], ["times"])
    movie = _movie(shift=None)
    _each_run(movie, offsets=False)
    suite.good("core/no-edit-list", movie, "no edit list and no composition offsets", ["11.2", "4.7.4"], ["times"])
    for name, shift, about in (("edit-list-zero", 0, "an edit list with media_time 0"),
                               ("edit-list-great", 1000, "an edit list that shifts by 1000 frames")):
        suite.good("extended/" + name, _movie(shift=shift), about, ["11.2"], ["times"])
    movie = _movie()
    movie.edit_moov = lambda moov: setattr(moov.get("trak"), "children",
                                           [b if b.kind != "edts" else edit_list(2, 0) for b in moov.get("trak").children])
    suite.good("core/edit-list-of-32-bits", movie, "elst of version 0", ["11.2"], ["times"])
    movie = _movie()
    movie.media_time["shape"] = 5
    _each_run(movie, offsets=True)
    suite.good("extended/edit-list-of-shape-track", movie, "each track has an edit list of its own", ["11.2", "11.4"], ["times"])


def order(suite):
    """B pictures."""
    c = chart(16, (0, 1, 1))
    decoding = [("I", 0), ("P", 3), ("B", 1), ("B", 2), ("P", 4)]
    codes = still_codes([c], range(5))
    for name, about, shift, version in (("b-pictures", "B pictures, edit list and offsets that are never negative", 2, 1),
                                        ("b-pictures-unsigned", "B pictures, trun of version 0", 2, 0),
                                        ("b-pictures-negative", "B pictures, no edit list, negative offsets", None, 1)):
        movie = movie_for([c], shift=shift, poc_bits=16)
        add_group(movie, Group([c], codes, decoding))
        movie.fragment().runs["geometry"].version = version
        suite.good("core/" + name, movie, about, ["11.2", "11.2.1", "11.2.2", "11.4", "6.2.7", "4.7.4"], ["b pictures"])
    grey = [codes_of(noise(16, 70)), codes_of(noise(16, 71))]
    middle = [((a.astype(int) + b + 64) >> 7 << 6) for a, b in [grey]][0].astype("uint16")
    movie = movie_for([c])
    add_group(movie, Group([c], [[grey[0]], [middle], [grey[1]]], [("I", 0), ("P", 2), ("B", 1)]))
    suite.good("core/b-pictures-skipped", movie, "a B picture of skipped macroblocks: the mean of two pictures",
               ["11.2", "6.2.7"], ["b pictures"])
    movie = movie_for([c])
    add_group(movie, Group([c], codes[:3]))
    run = movie.fragment().runs["shape"]
    run.samples, run.shown = [run.samples[0], run.samples[2], run.samples[1]], [0, 2, 1]
    suite.good("extended/records-in-another-order", movie, "shape records that are not in presentation order: they have "
               "composition offsets", ["11.4", "7.1.2"], ["times"])


def index(suite):
    """Forms of tfra."""
    for name, version, sizes in (("version-0", 0, 0), ("numbers-2-3-4", 1, 0x1B), ("numbers-4", 1, 0x3F)):
        movie = base()
        movie.index_version, movie.number_sizes = version, sizes
        suite.good("core/tfra-" + name, movie, "tfra of version %d, lengths of numbers %02x" % (version, sizes), ["4.10.1"],
                   ["index"])

    def other(mfra):
        mfra.children.insert(0, full("tfra", 1, 0, u32(2, 0, 0)))
    movie = base()
    movie.edit_index = other
    suite.good("extended/tfra-of-shape-track", movie, "a tfra of another track, too", ["4.10.2"], ["index"])


def large(suite):
    """64-bit sizes."""
    for name in ("large_moov", "large_mfra"):
        movie = base()
        setattr(movie, name, True)
        suite.good("core/" + name.replace("_", "-"), movie, "%s with a size of 64 bits" % name[6:], ["4.1.2"], ["64-bit sizes"])
    movie = base()
    for part in movie.parts:
        part.large_moof = part.large_mdat = True
    suite.good("core/large-fragments", movie, "moof and mdat with sizes of 64 bits", ["4.1.2", "4.8.2"], ["64-bit sizes"])

    def children(moov):
        for path in ("trak", "trak/mdia/minf/stbl/stsd/avc1", "trak/mdia/minf/stbl/stsd/avc1/gvcC", "mvex/trex"):
            moov.get(path).large = True
    movie = base()
    movie.edit_moov = children
    movie.fragment().edit = lambda moof: [setattr(moof.get(p), "large", True) for p in ("traf", "traf/trun", "traf[1]/gcks")]
    suite.good("extended/large-children", movie, "boxes inside of others with sizes of 64 bits", ["4.1.2"], ["64-bit sizes"])


def unknown(suite):
    """Boxes that nobody knows."""
    some = [Box("free", b"something"), Box("uuid", bytes(range(16)) + b"more"), Box("zzzz", b""), Box("skip", bytes(3))]
    plain = b"".join(b.encode() for b in some)
    movie = base()
    movie.before_moov = plain
    movie.parts = [plain, movie.parts[0], plain, movie.parts[1], plain]
    suite.good("core/unknown-at-top", movie, "unknown boxes between those of the top level", ["4.1.3", "14.4"], ["unknown boxes"])

    def into_moov(moov):
        for path in ("", "trak", "trak/edts", "trak/mdia", "trak/mdia/minf", "trak/mdia/minf/dinf", "trak/mdia/minf/stbl",
                     "trak/mdia/minf/stbl/stsd/avc1", "trak[1]/tref", "trak[1]/mdia/minf/stbl/stsd/urim", "mvex"):
            for i, box in enumerate(some):
                moov.add(path, box, 0 if i < 2 else -1)
    movie = base()
    movie.edit_moov = into_moov
    suite.good("core/unknown-in-moov", movie, "unknown boxes in moov and in the boxes below it", ["4.1.3", "14.4"],
               ["unknown boxes"])

    def into_moof(moof):
        for path in ("", "traf", "traf[1]"):
            for i, box in enumerate(some):
                moof.add(path, box, 0 if i < 2 else -1)
    movie = base()
    for part in movie.parts:
        part.edit = into_moof
    movie.edit_index = lambda mfra: [mfra.add("", b, 0) for b in some]
    suite.good("core/unknown-in-moof", movie, "unknown boxes in moof, traf and mfra", ["4.1.3", "14.4"], ["unknown boxes"])

    def backwards(box):
        for path in ("trak", "trak[1]", "trak/mdia", "trak/mdia/minf/stbl", "trak/mdia/minf/stbl/stsd/avc1", ""):
            (box.get(path) if path else box).children.reverse()
    movie = base()
    movie.edit_moov = backwards
    for part in movie.parts:
        part.edit = lambda moof: [b.children.reverse() for b in moof.all("traf")]
    suite.good("extended/children-in-another-order", movie, "children of boxes in the reverse order", ["4.2"], ["container"])
    movie = base()
    for part in movie.parts:
        part.edit = lambda moof: [moof.patch("traf/" + k, 1, flag)
                                  for k, flag in (("tfhd", b"\x82"), ("trun", b"\x80"), ("gcks", b"\x80"))]
    suite.good("extended/unknown-flags", movie, "flags of tfhd, trun and gcks that have no meaning", ["14.4"], ["unknown boxes"])


def _sound_track():
    """A trak with a sample entry of sound."""
    entry = Box("sowt", bytes(6) + u16(1) + bytes(8) + u16(1, 16) + bytes(4) + u32(8000 << 16))
    minf = Box("minf", children=[full("smhd", 0, 0, bytes(4)), Box("dinf", children=[
        full("dref", 0, 0, u32(1), [full("url ", 0, 1)])]), sample_table(entry)])
    return Box("trak", children=[track_header(9, 0, 0), Box("mdia", children=[media_header(8000), handler(b"soun", "sound"),
                                                                              minf])])


def _sound_fragment(seal_it, flip=0):
    traf = Box("traf", children=[full("tfhd", 0, 0x020000, u32(9)), full("tfdt", 1, 0, u64(0)),
                                 full("trun", 0, 0x201, u32(2, 0, 4, 4))])
    moof = Box("moof", children=[full("mfhd", 0, 0, u32(1)), traf])
    raw = close(moof, flip) if seal_it else moof.encode()
    return raw + Box("mdat", b"soundbit").encode()


def with_sound(frames=(2, 1)):
    """The base file with a sound track (4.11)."""
    movie = base(frames)

    def edit(moov):
        moov.add("", _sound_track(), 1)
        moov.add("mvex", full("trex", 0, 0, u32(9, 1, 1, 0, 0)), 0)
    movie.edit_moov = edit
    return movie


def others(suite):
    """Tracks and brands that are not of this document, configurations of later versions."""
    movie = with_sound()
    movie.parts = [_sound_fragment(False), movie.parts[0], _sound_fragment(True), movie.parts[1], _sound_fragment(False)]
    suite.good("core/sound", movie, "a sound track in fragments of its own, with and without gcrc", ["4.11.1", "4.3 trak"],
               ["other tracks"])

    def more(moov):
        entry = Box("urim", bytes(6) + u16(1), [full("uri ", 0, 0, b"urn:example:other\0")])
        two = Box("trak", children=[b for b in moov.get("trak[1]").children if b.kind not in ("mdia", "tkhd")]
                  + [track_header(8, 0, 0), Box("mdia", children=[
                      media_header(25), handler(b"meta", "other"), Box("minf", children=[full("nmhd"), sample_table(entry)])])])
        moov.add("", two, 1)
        moov.add("mvex", full("trex", 0, 0, u32(8, 1, 1, 0, 0)), 0)
    movie = base()
    movie.edit_moov = more
    suite.good("extended/other-metadata-track", movie, "a metadata track with another URI", ["4.11.1", "14.6"], ["other tracks"])
    for name, box in (("brand-compatible", file_type(b"isom", 512, (b"iso6", b"gvc1"))),
                      ("brand-major", file_type(b"gvc1", 7, ())),
                      ("brands-many", file_type(b"gvc1", 0, (b"abcd", b"gvc1", b"gvc2", b"mp42", b"iso6")))):
        movie = base()
        movie.file_type = box
        suite.good("core/" + name, movie, "gvc1 is where it may be in ftyp", ["4.3.1", "14.4"], ["brands"])
    movie = base()
    movie.versions = 1
    suite.good("core/headers-of-version-1", movie, "tkhd and mdhd of version 1", ["4.4 tkhd", "4.4 mdhd"], ["container"])
    movie = base()
    movie.track_id = {"geometry": 70000, "shape": 4294967295, "exact": 5}
    suite.good("extended/track-numbers", movie, "numbers of tracks up to 2^32 - 1", ["4.4 tkhd", "4.5 tref"], ["container"])
    movie = base()
    movie.kinds = ("shape", "geometry")
    suite.good("core/shape-track-first", movie, "trak and traf of the shape track come first", ["4.10.2", "4.2"], ["container"])


def configurations(suite):
    """gvcC."""
    long = Config(unit="123456789 12345", encoder="e" * 63, settings="s" * 255)
    texts = {"labels-empty": Config(unit="", encoder="", settings=""), "labels-maximal": long,
             "labels-utf-8": Config(unit="\u00b5m", encoder="\u6e2c\u8a66 \U0001f600", settings="\u202eabc\u00a0\u20ac\ufffd")}
    for name, config in texts.items():
        movie = base()
        for field in ("unit", "encoder", "settings"):
            setattr(movie.config, field, getattr(config, field))
        suite.good("core/" + name, movie, "unit, encoder and settings: %s" % name[7:], ["2.5", "5.5"], ["gvcC"])
    for name, minor, tail in (("minor-version-2", 2, b""), ("minor-version-later", 65535, b"fields of a later version\0\xff")):
        movie = base()
        movie.config.version_minor, movie.config.tail = minor, tail
        suite.good("core/" + name, movie, "version_minor %d, %d bytes after settings" % (minor, len(tail)),
                   ["5.1", "5.3", "14.4"], ["gvcC"])


def ignored(suite):
    """Fields and boxes that say nothing to a decoder (4.1.5, 4.4.1)."""
    movie = base()
    movie.edit_moov = lambda m: m.remove("trak/mdia/minf/stbl/stsd/avc1/colr")
    suite.good("extended/no-colr", movie, "there is no colr", ["4.4.1", "4.1.5"], ["container"])

    def dates(moov):
        for path in ("mvhd", "trak/tkhd", "trak[1]/tkhd", "trak/mdia/mdhd", "trak[1]/mdia/mdhd"):
            moov.patch(path, 4, u32(3900000000, 3900000001))
        moov.patch("trak/edts/elst", 8, u64(3))
        moov.patch("trak[1]/mdia/mdhd", 20, u16(0x15C7))
    movie = base()
    movie.edit_moov = dates
    suite.good("core/dates", movie, "times of creation, a language, and a segment duration in the edit list", ["4.1.5", "11.2"],
               ["container"])
    movie = base()
    for part in movie.parts:
        part.edit = lambda moof: [
            setattr(moof.get(p), "fields", u32(0x020002) + moof.get(p).fields[4:8] + u32(1)) for p in ("traf/tfhd", "traf[1]/tfhd")]
    suite.good("extended/description-in-tfhd", movie, "tfhd says that the sample description is 1", ["4.6.1"], ["runs"])


def gaps(suite):
    """Repaired files (12.8)."""
    one = chart(16, (0, 1, 1))
    for name, plan in (("gap-in-the-middle", (2, -3, 1)), ("gap-at-the-start", (-2, 2)), ("gap-at-the-end", (2, -1)),
                       ("gaps-side-by-side", (1, -2, -1, 1, -5, 2, -1))):
        movie = movie_for([one])
        for count in plan:
            if count > 0:
                add_group(movie, Group([one], still_codes([one], [7] * count)))
                movie.parts[-1].sequence = 10 * len(movie.parts)
            else:
                movie.parts.append(Gap(sum(abs(p) for p in plan[:len(movie.parts)]), -count))
        movie.config.declared_frames = sum(abs(p) for p in plan)
        suite.good("%s/%s" % ("core" if name == "gap-in-the-middle" else "extended", name), movie,
                   "frames that are stated to be lost", ["12.8.2", "11.3", "5.6"], ["gaps"])


def everything(suite):
    """All of them."""
    for part in (simple, runs, times, order, index, large, unknown, others, configurations, ignored, gaps):
        part(suite)
