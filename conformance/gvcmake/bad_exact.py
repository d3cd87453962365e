# SPDX-License-Identifier: MIT
"""Invalid vectors of exact images: gvc.md 6.4 to 6.6, 7.1.5 and 10.3.5."""
import struct

from . import content, exr, residual
from .exr import channel_list
from .good_exact import CHART, exact_movie
from .lossless import add_lossless, keyframe, lossless_movie
from .scenes import Group, still_codes
from .tables import chart


def _image(suite, name, about, clauses, error="corrupt", **fields):
    """A vector whose second keyframe is another OpenEXR file than it must be."""
    c = chart(*CHART)
    movie = lossless_movie([c])
    codes = [[content.exact_codes(16)]]
    add_lossless(movie, Group([c], codes))

    def swap(images):
        images[0][0] = keyframe(movie, c, codes[0][0], 1, **fields).encode()
    add_lossless(movie, Group([c], codes), edit_images=swap)
    suite.bad("exr-" + name, movie, about, clauses, ["exact", "exr"], error, good=[0])


def files(suite):
    """Kinds of files and what they must hold (6.5.1 to 6.5.3)."""
    for name, flags in (("version-1", b"\1\0\0\0"), ("version-3", b"\3\0\0\0"), ("tiled", b"\2\2\0\0"), ("deep", b"\2\x08\0\0"),
                        ("multi-part", b"\2\x10\0\0"), ("flag", b"\2\0\0\1")):
        _image(suite, name, "an OpenEXR file with version and flags " + flags.hex(" "), ["6.5.1", "13.2"], "unsupported", version=flags)
    for name, window in (("larger", (0, 0, 16, 16)), ("smaller", (0, 0, 14, 15)), ("moved", (1, 0, 16, 15)), ("empty", (0, 0, -1, -1)),
                         ("huge", (0, 0, 2147483646, 2147483646))):
        _image(suite, "window-" + name, "dataWindow %d %d %d %d" % window, ["6.5.2"],
               replace={"dataWindow": ("box2i", struct.pack("<4i", *window))})
    for order in (1, 2):
        _image(suite, "line-order-%d" % order, "lineOrder %d" % order, ["6.5.2"], "any", line_order=order)
    for name, kind in (("piz", 4), ("pxr24", 5), ("b44", 6), ("dwaa", 8), ("later", 99)):
        _image(suite, "compression-" + name, "compression %d" % kind, ["6.5.2"], "any", replace={"compression": ("compression", bytes([kind]))})
    names = exr.CHANNELS
    for name, value in (("missing", channel_list(names[:5])), ("more", channel_list(("W",) + names)),
                        ("other", channel_list(("R",) + names[1:])), ("float", channel_list(names, 2)), ("uint", channel_list(names, 0)),
                        ("sampling", channel_list(names, 1, 2))):
        _image(suite, "channels-" + name, "channels: " + name, ["6.5.3", "13.2"], channels=value)


def codes(suite):
    """Halves that are no code (6.5.4)."""
    cases = [("high-1", 0, 0x3C00, "1"), ("high-negative", 0, 0x9000, "negative"), ("high-minus-0", 0, 0x8000, "-0"),
             ("high-infinite", 2, 0x7C00, "infinite"), ("high-nan", 2, 0x7E00, "not a number"), ("high-fine", 4, 0x0001, "2^-24"),
             ("high-between", 4, 0x1200, "3 / 4096"), ("low-0", 1, 0x0000, "0"), ("low-too-great", 3, 0x3820, "1/2 + 32 / 2048"),
             ("low-too-small", 5, 0x37FF, "just below 1/2"), ("low-nan", 5, 0xFFFF, "not a number")]
    for name, channel, bits, about in cases:
        def spoil(halves, channel=channel, bits=bits):
            halves[channel, 7, 9] = bits
        _image(suite, "half-" + name, "a sample of channel %s is %s" % (exr.CHANNELS[channel], about), ["6.5.4", "13.2"],
               edit_halves=spoil)


def attributes(suite):
    """Attributes (6.5.5)."""
    nan, inf = float("nan"), float("inf")
    for name in ("gvcVersion", "gvcOrigin", "gvcStep", "gvcTime"):
        _image(suite, "without-" + name, "there is no " + name, ["6.5.5"], drop=(name,))
    doubles = [("gvcOrigin", "v3f", struct.pack("<3f", 0, 0, 0)), ("gvcStep", "float", struct.pack("<f", 1)),
               ("gvcTime", "float", struct.pack("<f", 0)), ("gvcVersion", "float", bytes(4)), ("gvcUnit", "int", bytes(4))]
    for name, kind, value in doubles:
        _image(suite, "type-of-" + name, "%s is of type %s" % (name, kind), ["6.5.5"], replace={name: (kind, value)})
    _image(suite, "gvcVersion-1", "gvcVersion 1", ["6.5.5"], "unsupported", replace={"gvcVersion": ("int", struct.pack("<i", 1))})
    for name, value in (("nan", nan), ("infinite", inf)):
        _image(suite, "gvcOrigin-" + name, "a coordinate of gvcOrigin is " + name, ["6.5.5"],
               replace={"gvcOrigin": ("v3d", struct.pack("<3d", 0, value, 0))})
        _image(suite, "gvcTime-" + name, "gvcTime is " + name, ["6.5.5"], replace={"gvcTime": ("double", struct.pack("<d", value))})
    for name, value in (("0", 0.0), ("negative", -1.0), ("nan", nan), ("infinite", inf)):
        _image(suite, "gvcStep-" + name, "gvcStep is " + name, ["6.5.5"], replace={"gvcStep": ("double", struct.pack("<d", value))})
    for name, text in (("empty", b""), ("too-long", b"x" * 16), ("control", b"m\n"), ("malformed", b"\xc3")):
        _image(suite, "gvcUnit-" + name, "gvcUnit is " + name.replace("-", " "), ["6.5.5"], replace={"gvcUnit": ("string", text)})


def _bytes(suite, name, about, clauses, edit, frame=1, good=(0,), error="corrupt", feature="residual"):
    """A vector in which the bytes of the image of one frame of three are changed."""
    def change(images):
        images[frame][0] = edit(images[frame][0])
    movie = exact_movie(edit_images=change)
    suite.bad("exact-" + name, movie, about, clauses, ["exact", feature], error, good=good)


def broken(suite):
    """Images that are cut or go on."""
    for name, edit in (("cut", lambda b: b[:-1]), ("cut-header", lambda b: b[:60]), ("cut-table", lambda b: b[:b.index(b"gvcUnit") + 30]),
                       ("cut-half", lambda b: b[:-200])):
        _bytes(suite, "exr-" + name, "an OpenEXR file that is cut: " + name, ["6.5.1"], edit, 0, (), feature="exr")
    _bytes(suite, "exr-offset", "the offset of the only block of lines is beyond the file", ["6.5.2.1"], _first_offset, 0, (), feature="exr")
    _bytes(suite, "residual-first", "the first image of a fragment is a residual", ["6.4.3", "13.2"],
           lambda b: residual.encode(content.exact_codes(16)), 0, ())
    _bytes(suite, "predictor-2", "predictor 2", ["6.6.2"], lambda b: b"\2" + b[1:], error="unsupported")
    _bytes(suite, "predictor-255", "predictor 255", ["6.6.2"], lambda b: b"\xff" + b[1:], error="unsupported")
    _bytes(suite, "reference-2", "reference 2", ["6.6.2"], lambda b: b[:1] + b"\2" + b[2:], error="unsupported")
    for size in (0, 15, 17, 65535):
        _bytes(suite, "residual-size-%d" % size, "a residual image of %d samples a side for a chart of 16" % size, ["6.6.2"],
               lambda b, n=size: b[:2] + struct.pack(">H", n) + b[4:])
    _bytes(suite, "residual-cut", "bits that end early", ["6.6.7", "13.2"], lambda b: b[:-1])
    _bytes(suite, "residual-head-only", "a residual image of four bytes", ["6.6.7", "13.2"], lambda b: b[:4])
    _bytes(suite, "residual-short-head", "a residual image of three bytes", ["6.6.1", "6.6.7"], lambda b: b[:3])
    _bytes(suite, "residual-tail", "a byte behind the bits", ["6.6.7", "13.2"], lambda b: b + b"\0")
    _bytes(suite, "residual-not-0", "D is not 0 at the end", ["6.6.7"], lambda b: b[:-1] + bytes([b[-1] ^ 1]))

    def great(k, x, y, e):
        return 40000 if (k, x, y) == (1, 3, 2) else e
    _bytes(suite, "residual-too-great", "a residual of 40000", ["6.6.4"], lambda b: residual.encode_spoiled(
        content.exact_codes(16, 1), content.exact_codes(16, 0), spoil=great))
    _bytes(suite, "residual-32768", "a residual of 32768", ["6.6.4"], lambda b: residual.encode_spoiled(
        content.exact_codes(16, 1), content.exact_codes(16, 0), spoil=lambda k, x, y, e: 32768 if k + x + y == 0 else e))


def _first_offset(image):
    """The image with a wrong first entry of the table of offsets, which stands behind the byte that ends the header."""
    table = image.index(b"gvcUnit") + len(b"gvcUnit\0string\0") + 4 + 1 + 1
    return image[:table] + struct.pack("<Q", 1 << 40) + image[table + 8:]


def samples(suite):
    """Samples of several images (6.4.2), and of previews (7.1.5)."""
    two = [chart(16, (0, 1, 1)), chart(16, (0,), component=1, x=16)]

    def change(name, about, edit, clauses=("6.4.2", "13.2")):
        movie = exact_movie(charts=two)
        samples_of = movie.fragment().runs["exact"].samples
        samples_of[1] = edit(samples_of[1])
        suite.bad("exact-sample-" + name, movie, about, list(clauses), ["exact", "several charts"], good=[0])
    change("tail", "a byte behind the last image", lambda s: s + b"\0")
    change("cut", "the last image ends early", lambda s: s[:-1])
    change("one-image", "one image for two charts", lambda s: s[:4 + int.from_bytes(s[:4], "big")], ("6.4.2",))
    change("length-huge", "an image is longer than the sample", lambda s: b"\xff" * 4 + s[4:], ("6.4.2", "15.2"))
    change("no-lengths", "images without their lengths", lambda s: s[4:], ("6.4.2",))
    one = [chart(*CHART)]
    movie = exact_movie()
    samples_of = movie.fragment().runs["exact"].samples
    samples_of[0] = struct.pack(">I", len(samples_of[0])) + samples_of[0]
    suite.bad("exact-sample-length-of-one", movie, "a length before the only image", ["6.4.2", "6.4.3"], ["exact"])
    movie = exact_movie(previews=still_codes(one, range(3)), edit_records=lambda r: setattr(r[1], "preview_digest", None))
    suite.bad("exact-without-preview-digest", movie, "a record without preview in a file with geometry and exact track",
              ["7.1.5", "13.2"], ["exact", "preview"], good=[0, 2])
    movie = exact_movie(edit_records=lambda r: setattr(r[0], "preview_digest", bytes(8)))
    suite.bad("exact-preview-without-geometry", movie, "a record with preview in a file without geometry track", ["7.1.5", "13.2"],
              ["exact"])

    def flip(records):
        records[2].digest = bytes(8)
    suite.bad("exact-digest-wrong", exact_movie(edit_records=flip), "the digest of an exact frame is wrong", ["10.3.2", "10.3.5"],
              ["exact"], good=[0, 1])

    def flip_preview(records):
        records[2].preview_digest = bytes(8)
    suite.bad("exact-preview-digest-wrong", exact_movie(previews=still_codes(one, range(3)), edit_records=flip_preview),
              "the digest of a preview is wrong", ["10.3.5"], ["exact", "preview"], good=[0, 1], checks="preview")

    def spoil(moof):
        box = moof.get("traf[1]/gcks")
        box.fields = box.fields[:-1] + bytes([box.fields[-1] ^ 1])
    movie = exact_movie()
    movie.fragment().edit = spoil
    suite.bad("crc-sample-exact", movie, "the checksum of an exact image is wrong", ["10.2.2", "12.6"], ["exact", "checksums"],
              good=[0, 1])


def everything(suite):
    """All of them."""
    for part in (files, codes, attributes, broken, samples):
        part(suite)
