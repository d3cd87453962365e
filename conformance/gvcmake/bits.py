# SPDX-License-Identifier: MIT
"""Bits of H.264: fixed and Exp-Golomb codes, NAL units (ISO/IEC 14496-10, 7.2, 7.4.1, 9.1)."""
import re
import struct


class BitWriter:
    """Collects bits, the most significant one first."""

    def __init__(self):
        self.parts = []

    def u(self, count, value):
        """u(n): `value` in `count` bits."""
        if count:
            self.parts.append(format(value, "0%db" % count))

    def ue(self, value):
        """ue(v): unsigned Exp-Golomb code."""
        self.u(2 * (value + 1).bit_length() - 1, value + 1)

    def se(self, value):
        """se(v): signed Exp-Golomb code."""
        self.ue(2 * value - 1 if value > 0 else -2 * value)

    def text(self, bits):
        """Bits written as a string of 0 and 1."""
        self.parts.append(bits)

    def align(self, bit="0"):
        """Fills up to a whole byte."""
        joined = "".join(self.parts)
        self.parts = [joined + bit * (-len(joined) % 8)]

    def trailing(self):
        """rbsp_trailing_bits()."""
        self.text("1")
        self.align()

    def bytes(self):
        """The bytes; there must be a whole number of them."""
        joined = "".join(self.parts)
        return int("1" + joined, 2).to_bytes(len(joined) // 8 + 1, "big")[1:]


def escape(payload):
    """Puts emulation_prevention_three_byte where it belongs (7.4.1)."""
    return re.sub(rb"\x00\x00(?=[\x00-\x03])", b"\x00\x00\x03", payload)


def nal_unit(nal_type, ref_idc, payload):
    """A NAL unit without its length."""
    return bytes([ref_idc << 5 | nal_type]) + escape(payload)


def with_length(nal):
    """A NAL unit as it stands in a sample: gvc.md 6.2.5."""
    return struct.pack(">I", len(nal)) + nal
