# SPDX-License-Identifier: MIT
"""Invalid vectors of gvcC: gvc.md clause 5, 2.5."""
from .good_exact import exact_movie
from .scenes import base


def _config(suite, name, about, clauses, error="corrupt", exact=False, **fields):
    movie = exact_movie() if exact else base()
    for key, value in fields.items():
        setattr(movie.config, key, value)
    suite.bad("gvcC-" + name, movie, about, clauses, ["gvcC"], error)


def fields(suite):
    """Fields outside of their ranges. Pictures keep the size they have."""
    _config(suite, "major-1", "version_major 1", ["5.1", "14.4"], "unsupported", version_major=1)
    _config(suite, "major-65535", "version_major 65535", ["5.1"], "unsupported", version_major=65535)
    for bit in (1, 2, 31):
        _config(suite, "feature-%d" % bit, "bit %d of features is set" % bit, ["5.1", "5.7", "13.2", "14.5.1"], "unsupported",
                features=1 << bit)
    for name, key, values in (("width", "picture_width", (0, 14, 17, 16386, 1 << 31)),
                              ("plane", "plane_height", (0, 14, 17, 5462, 1 << 31)),
                              ("image-size", "image_size", (0, 15, 2050, 1 << 31))):
        for value in values:
            _config(suite, "%s-%d" % (name, value), "%s %d" % (key, value), ["5.2"], exact=True, **{key: value})
    for key, value in (("code_bits", 8), ("code_bits", 12), ("code_shift", 4), ("code_shift", 7)):
        _config(suite, "%s-%d" % (key.replace("_", "-"), value), "%s %d" % (key, value), ["5.2"], "unsupported", **{key: value})
    for key in ("rate_num", "rate_den"):
        _config(suite, key.replace("_", "-") + "-0", "frame_%s 0" % key, ["5.2"], **{key: 0})
    movie = base()
    movie.config.rate_num, movie.config.rate_den = 4294967295, 4294967295
    movie.config.declared_frames, movie.parts, movie.media_time["geometry"] = 4294967300, [], None
    edit = movie.config.encode()
    movie.edit_moov = lambda m: [m.remove("mvex/mehd"), setattr(m.get("trak/mdia/minf/stbl/stsd/avc1/gvcC"), "fields", edit)]
    movie.config.declared_frames = 1
    suite.bad("gvcC-declared-too-great", movie, "declared_frames times D is above 2^64", ["5.2", "13.1"], ["gvcC"])


def frames(suite):
    """declared_frames (5.6)."""
    movie = base()
    movie.config.declared_frames = 4
    suite.bad("frames-too-few", movie, "three frames, but four are declared", ["5.6"], ["gvcC"], good="all")
    movie = base()
    movie.config.declared_frames = 2
    suite.bad("frames-too-many", movie, "three frames, but two are declared", ["5.6"], ["gvcC"], good=[0, 1])


def labels(suite):
    """Labels (2.5)."""
    for key, longest in (("unit", 15), ("encoder", 63)):
        _config(suite, key + "-too-long", "%s of %d bytes" % (key, longest + 1), ["5.2", "2.5"], **{key: "x" * (longest + 1)})
    bad = {"control-0": b"a\0b", "control-1f": b"\x1f", "control-7f": b"a\x7f", "control-80": b"\xc2\x80", "control-9f": b"\xc2\x9f",
           "lonely-byte": b"\x80", "cut": b"ab\xe2\x82", "overlong": b"\xc0\xaf", "overlong-3": b"\xe0\x80\xaf",
           "surrogate": b"\xed\xa0\x80", "beyond": b"\xf4\x90\x80\x80", "ff": b"\xff"}
    for i, (name, text) in enumerate(bad.items()):
        key = ("unit", "encoder", "settings")[i % 3]
        _config(suite, "label-" + name, "%s is not the text a label may be: %s" % (key, text.hex(" ")), ["2.5", "13.2"],
                **{key: text})
    for name, count in (("labels", 38), ("last-label", -1), ("fields", 20), ("all", 0)):
        movie = base()

        def cut(moov, count=count):
            box = moov.get("trak/mdia/minf/stbl/stsd/avc1/gvcC")
            box.fields = box.fields[:count]
        movie.config.settings = "something"
        movie.edit_moov = cut
        suite.bad("gvcC-without-" + name, movie, "gvcC is cut off", ["5.2", "2.5"], ["gvcC"])


def everything(suite):
    """All of them."""
    for part in (fields, frames, labels):
        part(suite)
