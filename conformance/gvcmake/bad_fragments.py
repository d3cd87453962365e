# SPDX-License-Identifier: MIT
"""Invalid vectors of moof and mdat: gvc.md 4.6 to 4.8, 10.2, 11.2, 11.3 and 12.4."""
from . import good_container
from .boxes import Box, full, u32, u64
from .fragment import Run
from .good_exact import exact_movie
from .head import NOT_SYNC, SYNC
from .movie import reseal
from .scenes import Group, add_group, base, movie_for, still_codes
from .tables import chart

PATHS = {"geometry": "traf", "shape": "traf[1]"}


def _moof(suite, name, about, clauses, edit, error="corrupt", movie=None):
    """A vector whose second fragment, of frames 1 and 2, has a changed moof; its checksum is right."""
    movie = movie or base((1, 2))
    movie.fragment(1).edit = edit
    suite.bad("moof-" + name, movie, about, clauses, ["fragments"], error, good=[0])


def boxes(suite):
    """Missing and second boxes, and versions above those given."""
    for track, path in PATHS.items():
        for kind in ("tfhd", "tfdt", "trun", "gcks"):
            _moof(suite, "%s-without-%s" % (track, kind), "the %s traf has no %s" % (track, kind), ["4.1.5", "4.6 " + kind],
                  lambda m, p=path + "/" + kind: m.remove(p))
            _moof(suite, "%s-two-%s" % (track, kind), "the %s traf has two %s" % (track, kind), ["4.1.5", "4.6 " + kind],
                  lambda m, p=path + "/" + kind: m.double(p))
        _moof(suite, "without-" + track, "the moof has no traf of the %s track" % track, ["4.6 traf"],
              lambda m, p=path: m.remove(p))
        _moof(suite, "two-" + track, "the moof has two traf of the %s track" % track, ["4.6 traf"], lambda m, p=path: m.double(p))
    for kind, version in (("tfhd", 1), ("tfdt", 2), ("trun", 2), ("gcks", 1)):
        _moof(suite, "%s-version" % kind, "%s of version %d" % (kind, version), ["14.4", "4.6 " + kind],
              lambda m, k=kind, v=version: m.patch("traf/" + k, 0, bytes([v])), "unsupported")
    movie = good_container.with_sound((1, 2))
    sound = Box("traf", children=[full("tfhd", 0, 0x020000, u32(9)), full("tfdt", 1, 0, u64(0)),
                                  full("trun", 0, 0x201, u32(1, 0, 4))])
    _moof(suite, "with-sound", "a traf of a sound track stands among those of this format", ["4.11.1", "4.6 traf"],
          lambda m: m.add("", sound, -1), movie=movie)


def headers(suite):
    """tfhd (4.6.1)."""
    def flags(box, value, fields=b""):
        def edit(moof):
            moof.patch("traf/" + box, 1, value.to_bytes(3, "big"))
            moof.get("traf/" + box).fields += fields
        return edit
    _moof(suite, "base-data-offset", "tfhd gives a base data offset", ["4.6.1", "13.2"], flags("tfhd", 0x020001, u64(0)))
    _moof(suite, "no-default-base", "tfhd lacks default-base-is-moof", ["4.6.1", "13.2"], flags("tfhd", 0))
    _moof(suite, "duration-is-empty", "tfhd has duration-is-empty", ["4.6.1"], flags("tfhd", 0x030000))
    _moof(suite, "description-2", "tfhd names sample description 2", ["4.6.1"], flags("tfhd", 0x020002, u32(2)))
    _moof(suite, "tfhd-short", "tfhd ends before the field that a flag asks for", ["4.6.1"], flags("tfhd", 0x020008))


def runs(suite):
    """trun (4.7)."""
    def edit_run(track, change):
        def edit(moof):
            box = moof.get(PATHS[track] + "/trun")
            box.fields = change(box.fields)
        return edit
    for track in PATHS:
        _moof(suite, "bytes-behind-samples-" + track, "trun of the %s track has four bytes more than its flags ask for" % track,
              ["4.7.2", "4.7.6"], edit_run(track, lambda f: f + bytes(4)))
        _moof(suite, "trun-short-" + track, "trun of the %s track ends within its last sample" % track, ["4.7.2", "4.7.6"],
              edit_run(track, lambda f: f[:-4]))
        _moof(suite, "count-huge-" + track, "trun of the %s track states 2^32 - 1 samples" % track, ["4.7.2", "15.2"],
              edit_run(track, lambda f: f[:4] + u32(0xFFFFFFFF) + f[8:]))
        _moof(suite, "count-0-" + track, "trun of the %s track has no sample" % track, ["4.7.1", "4.7.6"], lambda m, p=PATHS[track]: [
            setattr(m.get(p + "/trun"), "fields", m.get(p + "/trun").fields[:4] + u32(0) + m.get(p + "/trun").fields[8:16]),
            setattr(m.get(p + "/gcks"), "fields", u32(0))])
        movie = base((1, 2))
        movie.fragment(1).runs[track].samples[1] = b""
        _moof(suite, "sample-of-0-bytes-" + track, "a sample of the %s track has no bytes" % track, ["4.7.3", "4.7.6", "13.2"],
              None, movie=movie)
    _moof(suite, "no-data-offset", "trun gives no data offset", ["4.7.1", "4.7.6"],
          edit_run("geometry", lambda f: f[:3] + bytes([f[3] & 0xFE]) + f[4:8] + f[12:]))
    _moof(suite, "gcks-too-few", "gcks has one checksum for two samples", ["10.2.1", "4.7.2"],
          lambda m: setattr(m.get("traf/gcks"), "fields", m.get("traf/gcks").fields[:-4]))
    _moof(suite, "gcks-too-many", "gcks has three checksums for two samples", ["10.2.1", "4.7.2"],
          lambda m: setattr(m.get("traf/gcks"), "fields", m.get("traf/gcks").fields + u32(0)))
    _moof(suite, "gcks-odd", "gcks has a byte more", ["10.2.1"],
          lambda m: setattr(m.get("traf/gcks"), "fields", m.get("traf/gcks").fields + b"\0"))

    movie = base((1, 2))
    movie.fragment(1).runs["geometry"].flags_in = "each"

    def both(moof):
        box = moof.get("traf/trun")
        box.fields = box.fields[:3] + bytes([box.fields[3] | 4]) + box.fields[4:12] + u32(SYNC) + box.fields[12:]
    _moof(suite, "first-flags-twice", "trun has first-sample-flags and flags of each sample", ["4.7.1", "4.7.6"], both, movie=movie)
    for name, offset, values in (("second", 12, (SYNC, SYNC)), ("none", 12, (NOT_SYNC, NOT_SYNC))):
        for track in PATHS:
            movie = base((1, 2))
            movie.fragment(1).runs[track].flags_in = "each"

            def flags(moof, track=track, values=values):
                box = moof.get(PATHS[track] + "/trun")
                step = 12 if track == "geometry" else 8
                for i, value in enumerate(values):
                    at = 12 + step * i + 4
                    box.fields = box.fields[:at] + u32(value) + box.fields[at + 4:]
            _moof(suite, "sync-%s-%s" % (name, track), "%s sample of a run of the %s track is a sync sample"
                  % ("the second" if name == "second" else "no", track), ["4.7.5", "4.7.6", "13.2"], flags, movie=movie)


def durations(suite):
    """Durations (4.7.3)."""
    movie = base((1, 2))
    movie.fragment(1).runs["geometry"].duration_in = "trun"
    _moof(suite, "duration-in-trun", "a sample whose duration in trun is not D", ["4.7.3", "4.7.6"],
          lambda m: m.patch("traf/trun", 16, u32(2)), movie=movie)
    movie = base((1, 2))
    movie.fragment(1).runs["shape"].duration_in = "tfhd"
    _moof(suite, "duration-in-tfhd", "a default duration in tfhd that is not D", ["4.7.3", "4.7.6"],
          lambda m: m.patch("traf[1]/tfhd", 8, u32(0)), movie=movie)
    movie = base((1, 2))
    movie.edit_moov = lambda m: m.patch("mvex/trex", 12, u32(3))
    suite.bad("duration-in-trex", movie, "a default duration in trex that is not D", ["4.7.3", "4.7.6"], ["fragments"])


def data(suite):
    """Places of samples (4.8)."""
    for track, shift in (("geometry", 1), ("geometry", -1), ("shape", -8), ("shape", 8)):
        movie = base((1, 2))
        movie.fragment(1).runs[track].data_offset = shift
        suite.bad("data-offset-%s-%s" % (track, "later" if shift > 0 else "earlier"), movie,
                  "the data offset of the %s run is off by %d" % (track, shift), ["4.8.2", "4.8.1"], ["fragments"], good=[0])
    movie = base((1, 2))
    movie.fragment(1).mdat_tail = b"\0"
    suite.bad("mdat-tail", movie, "mdat has a byte behind the samples", ["4.8.1", "4.8.2", "13.2"], ["fragments"], good="all")
    movie = base((1, 2))
    _moof(suite, "swapped-data", "geometry samples stand before shape records", ["4.8.1", "4.8.2"], None, movie=_swapped(movie))
    movie = exact_movie()
    movie.fragment().runs["exact"].data_offset = -4
    suite.bad("data-offset-exact", movie, "the data offset of the exact run is off by -4", ["4.8.2"], ["fragments", "exact"])
    movie = exact_movie(groups=2)
    movie.fragment(1).edit = lambda m: m.remove("traf[1]")
    suite.bad("moof-without-exact", movie, "the moof has no traf of the exact track", ["4.6 traf", "4.9"], ["fragments", "exact"],
              good=[0, 1, 2])


def _swapped(movie):
    """The second fragment with geometry first in mdat; offsets say so."""
    runs = movie.fragment(1).runs
    shape, geometry = b"".join(runs["shape"].samples), b"".join(runs["geometry"].samples)
    runs["shape"].data_offset, runs["geometry"].data_offset = len(geometry), -len(shape)

    def swap(raw):
        at = raw.rindex(shape + geometry)
        return raw[:at] + geometry + shape + raw[at + len(shape) + len(geometry):]
    movie.edit_bytes = lambda raw: reseal(swap(raw))
    return movie


def times(suite):
    """Times and presentation numbers (11.2, 11.3)."""
    def run_of(movie, track, **fields):
        for key, value in fields.items():
            setattr(movie.fragment(1).runs[track], key, value)
    one = ["11.3", "13.2"]
    for track in PATHS:
        for name, about, order in (
                ("twice", "two samples are of one frame", [0, -1]), ("outside", "a sample is of a frame after the fragment", [0, 1]),
                ("before", "a sample is of a frame before the fragment", [-1, 0])):
            movie = base((1, 2))
            shift = 2 if track == "geometry" else 0
            run_of(movie, track, order=[o + shift for o in order])
            suite.bad("time-%s-%s" % (name, track), movie, "%s (%s track)" % (about, track), one, ["times"], good=[0])
        c = chart(16, (0, 1, 1))
        movie = movie_for([c], rate=(30000, 1001))
        add_group(movie, Group([c], still_codes([c], [7])))
        add_group(movie, Group([c], still_codes([c], [7, 7])))
        run_of(movie, track, order=[0 if track == "shape" else 2002, 1 if track == "shape" else 2003])
        suite.bad("time-offset-%s" % track, movie, "a composition offset that is no multiple of D (%s track)" % track,
                  ["11.2.1", "13.2"], ["times"], good=[0])
    for name, ticks in (("later", 2), ("again", 0)):
        movie = base((1, 2))
        movie.fragment(1).decode_time = ticks
        movie.config.declared_frames = 0
        suite.bad("time-fragment-" + name, movie, "the second fragment begins at frame %d, not at 1" % ticks, ["11.3", "12.4"],
                  ["times"], good=[0])
    movie = base((1, 2))
    movie.fragment(0).decode_time = 1
    movie.fragment(1).decode_time = 2
    movie.config.declared_frames = 0
    suite.bad("time-not-from-0", movie, "the first fragment begins at frame 1", ["11.3"], ["times"])
    c = chart(16, (0, 1, 1))
    movie = movie_for([c], rate=(30000, 1001))
    add_group(movie, Group([c], still_codes([c], [7])))
    movie.fragment().decode_time = 1
    suite.bad("time-no-multiple", movie, "a time in tfdt that is no multiple of D", ["11.2.1", "11.3", "13.2"], ["times"])
    movie = base((1, 2))
    movie.fragment(1).edit = lambda m: m.patch("traf[1]/tfdt", 4, u64(2))
    suite.bad("time-tracks-differ", movie, "the tracks of a fragment begin at different frames", ["11.3"], ["times"], good=[0])
    movie = base((1, 2))
    movie.fragment(1).edit = lambda m: [m.patch(p + "/tfdt", 4, u64((1 << 64) - 1)) for p in PATHS.values()]
    suite.bad("time-wraps", movie, "a time near 2^64", ["15.4", "11.3"], ["times"], "any", good=[0])
    movie = base((1, 2))
    run = movie.fragment(1).runs["shape"]
    movie.fragment(1).runs["shape"] = Run(run.samples[:1], [0], offsets=False)
    suite.bad("moof-counts-differ", movie, "a record for one of two pictures", ["4.7.1", "4.7.6"], ["fragments"], good=[0])


def everything(suite):
    """All of them."""
    for part in (boxes, headers, runs, durations, data, times):
        part(suite)
