# SPDX-License-Identifier: MIT
"""Numbers, varints and labels (gvc.md 2.3 to 2.5), read from bytes with a bound."""

import struct

from .errors import Damaged


def check_label_text(text, clause="2.5"):
    """Raise unless text (bytes) is well-formed UTF-8 without control characters (2.5)."""
    try:
        characters = text.decode("utf-8")
    except UnicodeDecodeError:
        raise Damaged(clause, "label is not well-formed UTF-8") from None
    if any(c < " " or "\x7f" <= c <= "\x9f" for c in characters):
        raise Damaged(clause, "label has a control character")
    return characters


class Reader:
    """Reads fields from a bytes object; clause is named where it ends too early."""

    def __init__(self, data, clause):
        self.data = bytes(data)
        self.at = 0
        self.clause = clause

    @property
    def left(self):
        """Bytes that are left."""
        return len(self.data) - self.at

    def take(self, n):
        """The next n bytes."""
        if n > self.left:
            raise Damaged(self.clause, f"ends early: {n} bytes wanted, {self.left} left")
        self.at += n
        return self.data[self.at - n:self.at]

    def rest(self):
        """All bytes that are left."""
        return self.take(self.left)

    def unpack(self, form):
        """Fields of a struct format, big-endian."""
        return struct.unpack(">" + form, self.take(struct.calcsize(">" + form)))

    def u8(self):
        """u8 of 2.3."""
        return self.unpack("B")[0]

    def u16(self):
        """u16 of 2.3."""
        return self.unpack("H")[0]

    def f64(self):
        """f64 of 2.3."""
        return self.unpack("d")[0]

    def varint(self, bits):
        """Shortest-form LEB128 number below 2^bits (2.4)."""
        value = shift = 0
        while True:
            byte = self.u8()
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
            if shift >= 70:
                raise Damaged("2.4", "varint of more than ten bytes")
        if byte == 0 and shift > 7:
            raise Damaged("2.4", "varint not in its shortest form")
        if value >> bits:
            raise Damaged("2.4", f"varint {value} too great for its field")
        return value

    def label(self, least, most):
        """Label (2.5) of least to most bytes, as text."""
        size = self.u8()
        if not least <= size <= most:
            raise Damaged(self.clause, f"label of {size} bytes, allowed are {least} to {most}")
        return check_label_text(self.take(size))
