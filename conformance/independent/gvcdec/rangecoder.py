# SPDX-License-Identifier: MIT
"""Range decoder and residuals (gvc.md 6.6.4, 6.7)."""

from .errors import Damaged

UNARY, MANTISSA, SIGN = 0, 72 * 15, 72 * 15 + 16 * 8  # E[72][15], M[16][8], G[9] in one list


class RangeDecoder:
    """Bits with models.  Models are pairs (z, n), kept in the lists z and n (6.7.3)."""

    def __init__(self, data):
        if len(data) < 4:
            raise Damaged("6.6.7", "bits of a residual image end early")
        self.data = data
        self.at = 4
        self.R = 0xFFFFFFFF
        self.D = int.from_bytes(data[:4], "big")
        self.z = [16384] * (SIGN + 9)
        self.n = [0] * (SIGN + 9)

    def refill(self):
        """6.7.2, the part while R < 2^24."""
        while self.R < 1 << 24:
            if self.at >= len(self.data):
                raise Damaged("6.6.7", "bits of a residual image end early")
            self.R <<= 8
            self.D = (self.D << 8 | self.data[self.at]) & 0xFFFFFFFF
            self.at += 1

    def bit(self, m):
        """bit(m) of model number m (6.7.3)."""
        z = self.z[m]
        n = self.n[m]
        if n < 6:
            n += 1
            self.n[m] = n
        B = (self.R >> 15) * z
        if self.D < B:
            self.R = B
            self.z[m] = z + (32768 - z >> n)
            bit = 0
        else:
            self.D -= B
            self.R -= B
            self.z[m] = z - (z >> n)
            bit = 1
        if self.R < 1 << 24:
            self.refill()
        return bit

    def even(self):
        """Bit of even odds (6.7.4)."""
        B = self.R >> 1
        bit = self.D >= B
        if bit:
            self.D -= B
            self.R -= B
        else:
            self.R = B
        if self.R < 1 << 24:
            self.refill()
        return int(bit)

    def residual(self, a, g):
        """One residual with contexts a and g (6.6.4)."""
        bit, n, base = self.bit, 0, 15 * a
        while n < 15 and bit(base + n):
            n += 1
        if n == 0:
            return 0
        v = 1
        for i in range(n):
            v = 2 * v + (bit(MANTISSA + 8 * n + v) if i < 3 else self.even())
        e = 1 - v if bit(SIGN + g) else v - 1
        if not -32768 <= e <= 32767:
            raise Damaged("6.6.4", f"residual {e}")
        return e

    def check_end(self):
        """All bytes used and D 0 (6.6.7)."""
        if self.at != len(self.data):
            raise Damaged("6.6.7", f"{len(self.data) - self.at} bytes of a residual image are left")
        if self.D:
            raise Damaged("6.6.7", "residual image does not end with D = 0")
