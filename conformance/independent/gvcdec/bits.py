# SPDX-License-Identifier: MIT
"""Bits of H.264 syntax (ISO/IEC 14496-10 7.2, 9.1)."""

from .errors import Damaged


class Bits:
    """Reads u(n), ue(v) and se(v) from the payload of a NAL unit (header byte taken off)."""

    def __init__(self, payload, clause="6.2.1"):
        rbsp = payload.replace(b"\0\0\3", b"\0\0")
        self.value = int.from_bytes(rbsp, "big")
        self.left = 8 * len(rbsp)
        self.clause = clause

    def u(self, n):
        """n bits as an unsigned number."""
        if n > self.left:
            raise Damaged(self.clause, "H.264 header ends early")
        self.left -= n
        return (self.value >> self.left) & ((1 << n) - 1)

    def flag(self):
        """One bit."""
        return self.u(1)

    def ue(self, most=(1 << 32) - 2):
        """Exp-Golomb number, at most `most`."""
        zeros = 0
        while not self.u(1):
            zeros += 1
            if zeros > 32:
                raise Damaged(self.clause, "H.264: Exp-Golomb code too long")
        value = (1 << zeros) - 1 + self.u(zeros)
        if value > most:
            raise Damaged(self.clause, f"H.264: value {value} where at most {most} is allowed")
        return value

    def se(self):
        """Signed Exp-Golomb number."""
        k = self.ue()
        return (k + 1) // 2 if k & 1 else -(k // 2)


def check_nal(unit, clause="6.2.5.1"):
    """Raise unless unit (bytes) is well-formed and has no start code inside (6.2.5.1)."""
    if len(unit) < 2:
        raise Damaged(clause, f"NAL unit of {len(unit)} bytes")
    if unit[0] & 128:
        raise Damaged(clause, "forbidden_zero_bit of a NAL unit is set")
    if unit[-1] == 0:
        raise Damaged(clause, "NAL unit ends with a zero byte")
    for bad in (b"\0\0\0", b"\0\0\1", b"\0\0\2"):
        if bad in unit:
            raise Damaged(clause, "NAL unit with a start code inside")
