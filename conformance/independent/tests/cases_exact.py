# SPDX-License-Identifier: MIT
"""Forged exact images (gvc.md 6.4 to 6.6)."""

import struct

from encode_exr import SIX, ZIP, channels, file_bytes, header_bytes
from gvcdec.exr import read_chunks, read_header

CASES = []


def image(name, status, clause, sample=0):
    """Change an image of lossless."""
    def add(function):
        def change(p):
            samples = p.fragments[0]["exact"]["samples"]
            samples[sample] = function(samples[sample])
        CASES.append((name, "lossless", status, clause, change))
        return function
    return add


def exr(name, status, clause, function):
    """Change the attributes of the first image, a list of [name, type, value]."""
    @image(name, status, clause)
    def _(data):
        attributes, at = read_header(data)
        items = [[n, t, v] for n, (t, v) in attributes.items()]
        items = function(items) or items
        head = header_bytes(data[:8], items)
        chunks = (24 + 15) // 16
        shift = len(head) - at
        table = struct.unpack_from(f"<{chunks}Q", data, at)
        table = struct.pack(f"<{chunks}Q", *(o + shift for o in table))
        return head + table + data[at + 8 * chunks:]


def setter(key, value=None, kind=None):
    def function(items):
        for item in items:
            if item[0] == key:
                item[1] = kind or item[1]
                item[2] = item[2] if value is None else value
    return function


def without(key):
    return lambda items: [i for i in items if i[0] != key]


exr("as it was", 0, "", lambda i: None)
for key in (b"gvcVersion", b"gvcOrigin", b"gvcStep", b"gvcTime"):
    exr(f"no {key}", 1, "6.5.5", without(key))
    exr(f"{key} of another type", 1, "6.5.5", setter(key, None, b"string"))
exr("gvcVersion 1", 3, "6.5.5", setter(b"gvcVersion", b"\1\0\0\0"))
exr("gvcOrigin NaN", 1, "6.5.5", setter(b"gvcOrigin", struct.pack("<3d", 0, float("nan"), 0)))
exr("gvcOrigin other", 0, "", setter(b"gvcOrigin", bytes(24)))
exr("gvcStep 0", 1, "6.5.5", setter(b"gvcStep", bytes(8)))
exr("gvcStep inf", 1, "6.5.5", setter(b"gvcStep", struct.pack("<d", float("inf"))))
exr("gvcTime inf", 1, "6.5.5", setter(b"gvcTime", struct.pack("<d", float("-inf"))))
exr("gvcTime other", 0, "", setter(b"gvcTime", struct.pack("<d", 77)))
exr("gvcUnit m", 0, "", lambda i: i + [[b"gvcUnit", b"string", b"m"]])
exr("gvcUnit empty", 1, "6.5.5", lambda i: i + [[b"gvcUnit", b"string", b""]])
exr("gvcUnit long", 1, "6.5.5", lambda i: i + [[b"gvcUnit", b"string", b"m" * 16]])
exr("gvcUnit control", 1, "6.5.5", lambda i: i + [[b"gvcUnit", b"string", b"\n"]])
exr("gvcUnit of another type", 1, "6.5.5", lambda i: i + [[b"gvcUnit", b"int", b"abcd"]])
exr("unknown attribute", 0, "", lambda i: i + [[b"abc", b"def", b"ghi"]])
exr("attribute twice", 1, "6.5.1", lambda i: i + i[:1])
for key in (b"channels", b"compression", b"dataWindow", b"lineOrder"):
    exr(f"no {key}", 1, None, without(key))
exr("dataWindow", 1, "6.5.2", setter(b"dataWindow", struct.pack("<4i", 0, 0, 23, 24)))
exr("dataWindow shifted", 1, "6.5.2", setter(b"dataWindow", struct.pack("<4i", 1, 1, 24, 24)))
exr("displayWindow", 0, "", setter(b"displayWindow", struct.pack("<4i", 1, 1, 24, 24)))
exr("lineOrder", 1, "6.5.2", setter(b"lineOrder", b"\1"))
exr("compression PIZ", 1, "6.5.2", setter(b"compression", b"\4"))
exr("compression ZIPS", 1, None, setter(b"compression", b"\2"))
exr("channels of type FLOAT", 1, "6.5.3", setter(b"channels", channels(*SIX, kind=2)))
exr("channels with sampling 2", 1, "6.5.3", setter(b"channels", channels(*SIX, sampling=2)))
exr("five channels", 1, "6.5.3", setter(b"channels", channels(*SIX[:5])))
exr("seven channels", 1, "6.5.3", setter(b"channels", channels(b"A", *SIX)))
image("tiled", 3, "6.5.1")(lambda d: d[:5] + b"\2" + d[6:])
image("multi-part", 3, "6.5.1")(lambda d: d[:5] + b"\x10" + d[6:])
image("version 3", 3, "6.5.1")(lambda d: d[:4] + b"\3" + d[5:])
image("long names", 0, "")(lambda d: d[:5] + b"\4" + d[6:])
image("cut", 1, "6.5.2.1")(lambda d: d[:-1])
image("cut header", 1, "6.5.1")(lambda d: d[:40])
image("bytes behind", 1, "6.5.2.1")(lambda d: d + b"\0")
image("not OpenEXR first", 1, "6.4.3")(lambda d: b"\0\0\0\x18" + bytes(9))


def rewrite(function, compression=ZIP):
    """Write the image again with pixels [bytes] altered and another compression."""
    def change(data):
        attributes, at = read_header(data)
        pixels = bytearray(read_chunks(data, at, 24, attributes[b"compression"][1][0]).tobytes())
        function(pixels)
        items = [[n, t, v] for n, (t, v) in attributes.items()]
        setter(b"compression", bytes([compression]))(items)
        return file_bytes(header_bytes(data[:8], items), bytes(pixels), 24, compression)
    return change


def chunk(name, clause, function):
    """Change the second of two chunks (line, size, bytes) of the first image, or its offset."""
    @image(name, 1, clause)
    def _(data):
        _, at = read_header(data)
        place = struct.unpack_from("<Q", data, at + 8)[0]
        return data[:at + 8] + function(data[at + 8:at + 16], data[at + 16:place], data[place:])


chunk("offset of a chunk", "6.5.2.1", lambda o, a, b: struct.pack("<Q", 7) + a + b)
chunk("offset of a chunk beyond the file", "6.5.2.1", lambda o, a, b: b"\xff" * 8 + a + b)
chunk("line of a chunk", "6.5.2.1", lambda o, a, b: o + a + b"\0" + b[1:])
chunk("size of a chunk", "6.5.2.1", lambda o, a, b: o + a + b[:4] + b"\xff\xff\0\0" + b[8:])
chunk("negative size of a chunk", "6.5.2.1", lambda o, a, b: o + a + b[:4] + b"\xff" * 4 + b[8:])
chunk("chunk of noise", "6.5.2.1", lambda o, a, b: o + a + b[:8] + b"\x55" * (len(b) - 8))
for key in (b"displayWindow", b"pixelAspectRatio", b"screenWindowCenter", b"screenWindowWidth"):
    exr(f"no {key}, which nobody needs", 0, "", without(key))


for kind, word in enumerate(("none", "RLE", "ZIPS", "ZIP")):
    image(f"compression {word}", 0, "")(rewrite(lambda p: None, kind))
for bits in (0x8000, 0x3C00, 0x7C00, 0x7E00, 0xBC00, 0x0001, 0x3BFF + 1, 0x0C01):
    def high(p, bits=bits):
        p[0:2] = struct.pack("<H", bits)
    image(f"X of bits {bits:04x}", 1, "6.5.4")(rewrite(high))
for bits in (0, 0x3820, 0x37FF, 0x3C00):
    def low(p, bits=bits):
        p[48:50] = struct.pack("<H", bits)
    image(f"X.lo of bits {bits:04x}", 1, "6.5.4")(rewrite(low))


def other_code(p):
    """Another X of the first pixel: its h is 1/2 or more."""
    p[0] ^= 1


image("another code", 1, None)(rewrite(other_code))

image("predictor 2", 3, "6.6.2", 1)(lambda d: b"\2" + d[1:])
image("reference 2", 3, "6.6.2", 1)(lambda d: d[:1] + b"\2" + d[2:])
image("reference 0", 1, None, 1)(lambda d: d[:1] + b"\0" + d[2:])
image("predictor 0", 1, None, 1)(lambda d: b"\0" + d[1:])
image("size 25", 1, "6.6.2", 1)(lambda d: d[:3] + b"\x19" + d[4:])
image("residual bytes behind", 1, "6.6.7", 1)(lambda d: d + b"\0")
image("residual cut", 1, "6.6.7", 1)(lambda d: d[:-1])
image("residual last byte", 1, "6.6.7", 1)(lambda d: d[:-1] + bytes([d[-1] ^ 1]))
image("residual of 3 bytes", 1, None, 1)(lambda d: d[:3])
image("residual of 7 bytes", 1, "6.6.7", 1)(lambda d: d[:7])
image("residual all ones", 1, None, 1)(lambda d: d[:4] + b"\xff" * 4000)


def first_residual(p):
    samples = p.fragments[0]["exact"]["samples"]
    samples[0], samples[1] = samples[1], samples[0]


CASES.append(("residual first", "lossless", 1, "6.4.3", first_residual))
