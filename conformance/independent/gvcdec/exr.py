# SPDX-License-Identifier: MIT
"""OpenEXR files that hold exact images (gvc.md 6.5; OpenEXR file layout)."""

import math
import struct
import zlib

import numpy as np

from .errors import Damaged, Unsupported
from .fields import check_label_text

MAGIC = b"\x76\x2f\x31\x01"
CHANNELS = (b"X", b"X.lo", b"Y", b"Y.lo", b"Z", b"Z.lo")
NONE, RLE, ZIPS, ZIP = 0, 1, 2, 3
NEEDED = {b"channels": b"chlist", b"compression": b"compression", b"dataWindow": b"box2i",
          b"lineOrder": b"lineOrder"}  # of those that OpenEXR requires
SIZES = {b"int": 4, b"v3d": 24, b"double": 8, b"box2i": 16, b"compression": 1, b"lineOrder": 1}


def tables():
    """For each of the 65536 HALFs its n as h = n / 2048, and as l = 1/2 + n / 2048; else -1
    (6.5.4)."""
    high = np.full(65536, -1, dtype=np.int64)
    n = np.arange(2048)
    high[(n / 2048).astype(np.float16).view(np.uint16)] = n
    low = np.full(65536, -1, dtype=np.int64)
    low[0x3800:0x3820] = np.arange(32)
    return high, low


HIGH, LOW = tables()


def text_to_zero(data, at, most):
    """(bytes up to a zero byte, offset behind it); they are at most `most`."""
    end = data.find(b"\0", at, at + most + 1)
    if end < 0:
        raise Damaged("6.5.1", "OpenEXR: text without end in the header")
    return data[at:end], end + 1


def read_header(data):
    """({name: (type, value)}, offset behind the header)."""
    if data[4:8] not in (b"\2\0\0\0", b"\2\4\0\0"):
        raise Unsupported("6.5.1", f"OpenEXR of another kind: {data[4:8].hex()}")
    most = 255 if data[5] else 31
    at, attributes = 8, {}
    while True:
        name, at = text_to_zero(data, at, most)
        if not name:
            return attributes, at
        kind, at = text_to_zero(data, at, most)
        if len(data) - at < 4:
            raise Damaged("6.5.1", "OpenEXR header ends early")
        size = struct.unpack_from("<i", data, at)[0]
        at += 4
        if not 0 <= size <= len(data) - at:
            raise Damaged("6.5.1", f"OpenEXR attribute of {size} bytes")
        if name in attributes:
            raise Damaged("6.5.1", f"OpenEXR attribute {name!r} twice")
        attributes[name] = kind, data[at:at + size]
        at += size


def attribute(attributes, name, kind, clause):
    """Value of an attribute that must be there with its type and size."""
    if name not in attributes:
        raise Damaged(clause, f"OpenEXR without attribute {name.decode()}")
    found, value = attributes[name]
    if found != kind or len(value) != SIZES.get(kind, len(value)):
        raise Damaged(clause, f"OpenEXR attribute {name.decode()} of another type")
    return value


def check_header(attributes, S):
    """6.5.2, 6.5.3, 6.5.5; returns the compression."""
    values = {n: attribute(attributes, n, t, "6.5.1") for n, t in NEEDED.items()}
    window = struct.unpack("<4i", values[b"dataWindow"])
    if window != (0, 0, S - 1, S - 1):
        raise Damaged("6.5.2", f"dataWindow {window} of a chart of size {S}")
    if values[b"lineOrder"] != b"\0":
        raise Damaged("6.5.2", "lineOrder is not INCREASING_Y")
    compression = values[b"compression"][0]
    if compression > ZIP:
        raise Damaged("6.5.2", f"compression {compression}")
    check_channels(values[b"channels"])
    check_gvc(attributes)
    return compression


def check_channels(value):
    """The six channels of type HALF with sampling 1, in alphabetical order (6.5.3)."""
    at, found = 0, []
    while True:
        name, at = text_to_zero(value, at, 255)
        if not name:
            break
        if len(value) - at < 16:
            raise Damaged("6.5.3", "OpenEXR channel list ends early")
        kind, _, x, y = struct.unpack_from("<iIii", value, at)
        at += 16
        found.append(name)
        if kind != 1 or x != 1 or y != 1:
            raise Damaged("6.5.3", f"channel {name!r} is not HALF with sampling 1")
    if tuple(found) != CHANNELS:
        raise Damaged("6.5.3", f"channels {found}")


def check_gvc(attributes):
    """Attributes of 6.5.5."""
    version, = struct.unpack("<i", attribute(attributes, b"gvcVersion", b"int", "6.5.5"))
    if version:
        raise Unsupported("6.5.5", f"gvcVersion {version}")
    origin = struct.unpack("<3d", attribute(attributes, b"gvcOrigin", b"v3d", "6.5.5"))
    step, = struct.unpack("<d", attribute(attributes, b"gvcStep", b"double", "6.5.5"))
    time, = struct.unpack("<d", attribute(attributes, b"gvcTime", b"double", "6.5.5"))
    if not all(map(math.isfinite, (*origin, step, time))) or step <= 0:
        raise Damaged("6.5.5", "gvcOrigin, gvcStep or gvcTime is not a number in range")
    if b"gvcUnit" in attributes:
        text = attribute(attributes, b"gvcUnit", b"string", "6.5.5")
        if not 1 <= len(text) <= 15:
            raise Damaged("6.5.5", f"gvcUnit of {len(text)} bytes")
        check_label_text(text, "6.5.5")


def unpack_rle(data, size):
    """Run length code of OpenEXR: count n >= 0: a byte n + 1 times; n < 0: -n bytes as they are."""
    out, at = bytearray(), 0
    while at < len(data):
        count = data[at]
        at += 1
        if count < 128:
            out += data[at:at + 1] * (count + 1)
            at += 1
        else:
            out += data[at:at + 256 - count]
            at += 256 - count
        if at > len(data) or len(out) > size:
            raise Damaged("6.5.2.1", "OpenEXR: run length code is wrong")
    return bytes(out)


def unpack_zlib(data, size):
    """zlib stream of at most size bytes with nothing behind it."""
    stream = zlib.decompressobj()
    try:
        out = stream.decompress(data, size + 1)
    except zlib.error as error:
        raise Damaged("6.5.2.1", f"OpenEXR: {error}") from None
    if not stream.eof or stream.unused_data:
        raise Damaged("6.5.2.1", "OpenEXR: zlib stream does not fill its chunk")
    return out


def unpack_chunk(data, size, compression):
    """Pixel data of a chunk, `size` bytes (6.5.2.2)."""
    if len(data) == size:
        return data
    if len(data) > size or compression == NONE:
        raise Damaged("6.5.2.1", f"OpenEXR: chunk of {len(data)} bytes for {size}")
    out = (unpack_rle if compression == RLE else unpack_zlib)(data, size)
    if len(out) != size:
        raise Damaged("6.5.2.1", f"OpenEXR: chunk expands to {len(out)} bytes, not {size}")
    # Each byte is the difference to the one before plus 128; then even and odd bytes are joined.
    steps = np.frombuffer(out, dtype=np.uint8).astype(np.int64)
    steps[1:] -= 128
    joined = (np.cumsum(steps) & 255).astype(np.uint8)
    pixels = np.empty(size, dtype=np.uint8)
    pixels[0::2] = joined[:(size + 1) // 2]
    pixels[1::2] = joined[(size + 1) // 2:]
    return pixels.tobytes()


def read_chunks(data, at, S, compression):
    """HALF bits, uint16 [S, 6, S] (line, channel, column); the offset table is at `at` (6.5.2.1).

    Chunks must stand one behind the other, so that all readers see the same pixels.
    """
    lines = 16 if compression == ZIP else 1
    count = -(-S // lines)
    if len(data) - at < 8 * count:
        raise Damaged("6.5.2.1", "OpenEXR offset table ends early")
    offsets = struct.unpack_from(f"<{count}Q", data, at)
    at += 8 * count
    parts = []
    for i, offset in enumerate(offsets):
        if offset != at:
            raise Damaged("6.5.2.1", f"OpenEXR chunk {i} is not where the one before ends")
        if len(data) - at < 8:
            raise Damaged("6.5.2.1", "OpenEXR ends early")
        line, size = struct.unpack_from("<ii", data, at)
        at += 8
        if line != i * lines or not 0 <= size <= len(data) - at:
            raise Damaged("6.5.2.1", f"OpenEXR chunk of line {line} and {size} bytes")
        wanted = min(lines, S - line) * 12 * S
        parts.append(unpack_chunk(data[at:at + size], wanted, compression))
        at += size
    if at != len(data):
        raise Damaged("6.5.2.1", "bytes behind the last chunk of an OpenEXR file")
    return np.frombuffer(b"".join(parts), dtype="<u2").reshape(S, 6, S)


def read_exr(data, S):
    """Codes, int64 [3, S, S], of an OpenEXR file of a chart of size S."""
    attributes, at = read_header(data)
    compression = check_header(attributes, S)
    pixels = read_chunks(data, at, S, compression)
    high, low = HIGH[pixels[:, 0::2]], LOW[pixels[:, 1::2]]
    if (high < 0).any() or (low < 0).any():
        raise Damaged("6.5.4", "OpenEXR: HALF that is no code")
    return np.ascontiguousarray((32 * high + low).transpose(1, 0, 2))
