# SPDX-License-Identifier: MIT
"""Invalid vectors of the file as a whole: gvc.md 4.1, 4.10, 10.1, 10.4 and 12."""
import struct

from . import good_container
from .boxes import Box, full, u32, u64
from .movie import Gap, reseal, top_level
from .scenes import Group, add_group, base, movie_for, still_codes
from .tables import chart

FREE = Box("free", b"something").encode()


def order(suite):
    """The order of the top level (4.1.1)."""
    def shuffled(pick):
        def change(data):
            parts = [data[at:at + size] for at, _, size in top_level(data)]
            return reseal(b"".join(pick(parts)))
        return change
    # parts: ftyp moov moof mdat moof mdat mfra
    plans = [("ftyp-missing", "there is no ftyp", lambda p: p[1:]), ("ftyp-second", "ftyp stands behind moov",
                                                                     lambda p: [p[1], p[0]] + p[2:]),
             ("two-ftyp", "there are two ftyp", lambda p: [p[0]] + p), ("free-first", "free stands before ftyp",
                                                                        lambda p: [FREE] + p),
             ("ftyp-later", "a second ftyp stands before mfra", lambda p: p[:6] + [p[0], p[6]]),
             ("moov-missing", "there is no moov", lambda p: [p[0]] + p[2:]),
             ("two-moov", "there are two moov", lambda p: p[:2] + p[1:]),
             ("moov-later", "moov stands behind the fragments", lambda p: [p[0]] + p[2:6] + [p[1], p[6]]),
             ("two-mfra", "there are two mfra", lambda p: p + p[-1:]),
             ("mfra-early", "mfra stands before the last fragment", lambda p: p[:4] + [p[6]] + p[4:6]),
             ("box-behind-mfra", "a free box stands behind mfra", lambda p: p + [FREE]),
             ("bytes-behind-mfra", "three bytes stand behind mfra", lambda p: p + [b"end"]),
             ("mdat-alone", "an mdat without moof", lambda p: p[:2] + [p[3]] + p[2:]),
             ("mdat-after-mdat", "a second mdat behind a moof", lambda p: p[:4] + [p[3]] + p[4:]),
             ("moof-without-mdat", "a moof without mdat", lambda p: p[:5] + p[6:])]
    for name, about, pick in plans:
        movie = base()
        movie.copy = "missing"
        movie.edit_bytes = shuffled(pick)
        row = {"ftyp": ["4.3 ftyp"], "moov": ["4.3 moov"], "mfra": ["4.10 mfra"], "moof": ["4.6 moof"]}
        more = [r for key, rows in row.items() if key in name for r in rows]
        suite.bad("order-" + name, movie, about, ["4.1.1"] + more, ["order"], good="all")
    for name, part in (("between", FREE), ("unknown", Box("zzzz").encode())):
        movie = base()
        movie.fragment(1).between = part
        suite.bad("order-box-%s-moof-and-mdat" % name, movie, "a box of unknown type stands between moof and mdat", ["4.1.3", "4.1.1",
                  "4.6 moof"], ["order"], good=[0, 1])


def sizes(suite):
    """Sizes of boxes (4.1.2)."""
    def stated(path, size, where):
        movie = base()
        if where == "moov":
            movie.edit_moov = lambda m: setattr(m.get(path), "size", size)
        elif where == "moof":
            movie.fragment(1).edit = lambda m: setattr(m.get(path), "size", size)
        else:
            movie.edit_index = lambda m: setattr(m.get(path), "size", size)
        return movie
    for where, path, good in (("moov", "trak[1]/mdia/minf/stbl/stsz", ()), ("moov", "mvex", ()), ("moof", "traf[1]/gcks", [0, 1]),
                              ("moof", "traf[1]", [0, 1]), ("mfra", "tfra", "all")):
        for name, size in (("0", 0), ("7", 7), ("too-great", 0x7FFFFFFF)):
            suite.bad("size-%s-%s" % (path.replace("/", "-").replace("[1]", "-2"), name), stated(path, size, where),
                      "%s in %s states a size of %d" % (path, where, size), ["4.1.2"], ["sizes"], good=good)
    for name, large in (("0", 0), ("15", 15), ("wraps", (1 << 64) - 1)):
        movie = base()

        def edit(moov, large=large):
            box = moov.get("trak[1]/mdia/minf/stbl/stsz")
            box.large, box.size = True, large
        movie.edit_moov = edit
        suite.bad("size-of-64-bits-" + name, movie, "a box states a size of 64 bits of %d" % large, ["4.1.2"], ["sizes"])
    for name, size in (("0", 0), ("7", 7), ("too-great", 0xFFFFFFF0)):
        movie = base()
        movie.parts.insert(1, struct.pack(">I4s", size, b"free") + bytes(8))
        suite.bad("size-top-" + name, movie, "free at the top level states a size of %d" % size, ["4.1.2"], ["sizes"], good="all")
        movie = base()
        movie.fragment(1).mdat_size = size
        suite.bad("size-mdat-" + name, movie, "mdat states a size of %d" % size, ["4.1.2", "4.8.2"], ["sizes"], good="all")
    movie = base()
    movie.edit_bytes = lambda data: data[:top_level(data)[-1][0]] + u32(0) + data[top_level(data)[-1][0] + 4:]
    suite.bad("size-mfra-0", movie, "mfra states a size of 0", ["4.1.2"], ["sizes"], good="all")


def cuts(suite):
    """Files that end too early (12.5)."""
    data = base().write()
    top = top_level(data)
    places = [("nothing", 0, ()), ("in-ftyp", 12, ()), ("behind-ftyp", top[0][2], ()), ("in-moov", top[1][0] + 500, ()),
              ("behind-moov", top[2][0], ()), ("in-moof", top[2][0] + 50, ()), ("behind-moof", top[3][0], ()),
              ("in-first-mdat", top[4][0] - 1000, [0]), ("between-fragments", top[4][0], [0, 1]),
              ("in-last-mdat", top[6][0] - 1, [0, 1]), ("before-mfra", top[6][0], "all"), ("in-mfra", top[6][0] + 30, "all"),
              ("last-byte", len(data) - 1, "all")]
    for name, place, good in places:
        movie = base()
        movie.edit_bytes = lambda data, place=place: data[:place]
        suite.bad("cut-" + name, movie, "the file ends after %d of %d bytes" % (place, len(data)),
                  ["12.5", "4.10.4"] if place >= top[2][0] else ["4.1.1", "4.1.2"], ["cut"], good=good)


def checksums(suite):
    """gcrc and gdig (10.1, 10.4)."""
    for where in ("wrong", "missing"):
        movie = base()
        movie.moov_crc = where
        suite.bad("crc-moov-" + where, movie, "gcrc of moov is " + where, ["10.1.1", "4.3 moov"], ["checksums"])
        movie = base()
        movie.index_crc = where
        suite.bad("crc-mfra-" + where, movie, "gcrc of mfra is " + where, ["10.1.1", "4.10 mfra"], ["checksums"], good="all")
        movie = base()
        movie.digest = where
        suite.bad("digest-of-file-" + where, movie, "gdig is " + where, ["10.4.2", "4.10 gdig"], ["checksums"], good="all",
                  checks="whole file" if where == "wrong" else None)
        movie = base()
        setattr(movie.fragment(1), "crc_flip" if where == "wrong" else "crc_missing", 1)
        suite.bad("crc-moof-" + where, movie, "gcrc of moof is " + where, ["10.1.1", "4.6 moof"], ["checksums"], good=[0, 1])
    for kind in ("geometry", "shape"):
        movie = base()

        def spoil(moof, kind=kind):
            box = moof.get("traf[%d]/gcks" % ("geometry", "shape").index(kind))
            box.fields = box.fields[:-1] + bytes([box.fields[-1] ^ 1])
        movie.fragment(1).edit = spoil
        suite.bad("crc-sample-" + kind, movie, "a checksum of the %s track is wrong" % kind, ["10.2.1", "10.2.2", "12.6"], ["checksums"],
                  good=[0, 1])
    movie = base()
    movie.moov_crc = "early"
    suite.bad("crc-moov-not-last", movie, "a box stands behind gcrc in moov", ["4.1.3", "10.1.1", "4.3 moov"], ["checksums"])
    movie = base()
    movie.fragment(1).crc_early = True
    suite.bad("crc-moof-not-last", movie, "a box stands behind gcrc in moof", ["4.1.3", "10.1.1", "4.6 moof"], ["checksums"],
              good=[0, 1])
    movie = good_container.with_sound()
    movie.parts.insert(1, good_container._sound_fragment(True, flip=1))
    suite.bad("crc-of-sound", movie, "a moof of a sound track ends in a wrong gcrc", ["4.11.1"], ["checksums"], good="all")
    movie = base()
    movie.parts.insert(1, Box("zzzz", bytes(20)).encode())
    movie.edit_bytes = lambda data: data.replace(b"zzzz\0", b"zzzz\1")
    suite.bad("digest-of-file-unknown-box", movie, "a bit is wrong in a box of unknown type, which only gdig covers",
              ["10.4.2", "10.4.1"], ["checksums"], good="all", checks="whole file")


def index(suite):
    """mfra (4.10)."""
    def change(name, about, clauses, edit, error="corrupt", checks=None, movie=None):
        movie = movie or base()
        movie.edit_index = edit
        suite.bad("index-" + name, movie, about, clauses, ["index"], error, good="all", checks=checks)
    row = ["4.10 tfra", "4.1.5"]
    change("without-tfra", "there is no tfra", row, lambda m: m.remove("tfra"))
    change("two-tfra", "there are two tfra of the main track", row, lambda m: m.double("tfra"))
    change("tfra-version", "tfra of version 2", ["4.10 tfra", "14.4"], lambda m: m.patch("tfra", 0, b"\2"), "unsupported")
    change("wrong-time", "a time in tfra is wrong", ["4.10.1", "4.10.3"], lambda m: m.patch("tfra", 16, u64(3)))
    change("wrong-place", "an offset in tfra is wrong", ["4.10.1", "4.10.3"],
           lambda m: m.patch("tfra", 31, b"\x01"))
    change("trun-number", "trun_number 2", ["4.10.1", "4.10.3"], lambda m: m.patch("tfra", 33, b"\2"))
    change("sample-number", "sample_number 2", ["4.10.1", "4.10.3"], lambda m: m.patch("tfra", 34, b"\2"))
    change("entry-too-few", "tfra lists one fragment of two", ["4.10.1", "4.10.3"], lambda m: [
        m.patch("tfra", 12, u32(1)), setattr(m.get("tfra"), "fields", m.get("tfra").fields[:-19])])
    change("entry-too-many", "tfra lists a fragment twice", ["4.10.1", "4.10.3"], lambda m: [
        m.patch("tfra", 12, u32(3)), setattr(m.get("tfra"), "fields", m.get("tfra").fields + m.get("tfra").fields[-19:])])
    change("entries-swapped", "entries of tfra are not in the order of the file", ["4.10.1", "4.10.3"], lambda m: setattr(
        m.get("tfra"), "fields", m.get("tfra").fields[:16] + m.get("tfra").fields[35:] + m.get("tfra").fields[16:35]))
    change("bytes-behind-entries", "bytes behind the entries of tfra", ["4.10.1"],
           lambda m: setattr(m.get("tfra"), "fields", m.get("tfra").fields + b"\0"))
    change("count-too-great", "tfra states 2^32 - 1 entries", ["15.2", "4.10.1"], lambda m: m.patch("tfra", 12, u32(0xFFFFFFFF)))
    change("tfra-of-other-track", "the only tfra is of the shape track", row, lambda m: m.patch("tfra", 4, u32(2)))
    for name, size in (("size-of-mfra-wrong", 1), ("size-of-mfra-0", None)):
        movie = base()
        movie.size_field = size if size else -len(movie.write()) + top_level(movie.write())[-1][0]
        suite.bad("index-" + name, movie, "mfro states another size than that of mfra", ["4.10 mfro"], ["index"], good="all")

    def ending(edit):
        def change_bytes(data):
            at, _, size = top_level(data)[-1]
            body = edit(data[at + 8:at + size])
            return reseal(data[:at] + u32(8 + len(body)) + b"mfra" + body)
        return change_bytes
    for name, about, row, edit in (
            ("without-mfro", "mfra does not end in mfro", "4.10 mfro", lambda b: b[:-16]),
            ("digest-first", "gdig is not the third last child of mfra", "4.10 mfra", lambda b: b[-76:-32] + b[:-76] + b[-32:]),
            ("mfro-version", "mfro of version 1", "4.10 mfro", lambda b: b[:-8] + b"\1" + b[-7:]),
            ("mfro-flags", "mfro with a flag", "4.10 mfro", lambda b: b[:-5] + b"\1" + b[-4:])):
        movie = base()
        movie.edit_bytes = ending(edit)
        suite.bad("index-" + name, movie, about, [row], ["index"], "any" if name == "mfro-version" else "corrupt",
                  good="all")
    movie = base()
    movie.edit_index = lambda m: m.children.append(full("gdig", 0, 0, bytes(32)))
    suite.bad("index-two-gdig", movie, "there are two gdig", ["4.10 gdig"], ["index"], good="all")
    movie = base()
    movie.edit_index = lambda m: m.children.append(full("mfro", 0, 0, u32(99)))
    suite.bad("index-two-mfro", movie, "there are two mfro", ["4.10 mfro"], ["index"], good="all")


def gaps(suite):
    """ggap (12.8)."""
    one = chart(16, (0, 1, 1))

    def make(gap, declared=6):
        movie = movie_for([one])
        add_group(movie, Group([one], still_codes([one], [7] * 2)))
        movie.parts.append(Gap(2, 3))
        add_group(movie, Group([one], still_codes([one], [7])))
        movie.parts[1] = gap
        movie.config.declared_frames = declared
        return movie
    suite.bad("gap-crc", make(Gap(2, 3, crc_flip=1)), "gcrc of ggap is wrong", ["12.8.2", "10.1.1"], ["gaps"], good="all")
    suite.bad("gap-first-frame", make(Gap(2, 3, stated_first=1)), "first_frame of ggap is wrong", ["12.8.2"], ["gaps"], good="all")
    suite.bad("gap-count-0", make(Gap(2, 0)), "a ggap of no frames", ["12.8.1"], ["gaps"], good="all")
    suite.bad("gap-count-wrong", make(Gap(2, 2)), "a ggap of fewer frames than are missing", ["11.3", "12.8.2"], ["gaps"],
              good="all")
    suite.bad("gap-count-wraps", make(Gap(2, (1 << 64) - 2)), "a ggap whose frames end beyond 2^64", ["13.1", "15.4"], ["gaps"],
              "any", good="all")
    suite.bad("gap-beyond-declared", make(Gap(2, 3), declared=5), "the frames after a gap are more than declared_frames",
              ["5.6", "12.8.2"], ["gaps"], good=[0, 1])
    movie = make(Gap(2, 3))
    movie.parts[1] = full("ggap", 0, 0, u64(2, 3)).encode()
    suite.bad("gap-without-crc", movie, "a ggap without gcrc", ["12.8.2", "10.1.1"], ["gaps"], good="all")


def everything(suite):
    """All of them."""
    for part in (order, sizes, cuts, checksums, index, gaps):
        part(suite)
