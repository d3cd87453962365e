# SPDX-License-Identifier: MIT
"""The configuration box gvcC (gvc.md clause 5)."""

from .errors import Damaged, Unsupported, placed
from .fields import Reader

EXACT = 1  # bit 0 of features (5.7)


class Config:
    """What holds for the whole file.  N, D: frame rate; width, plane_height: in samples."""

    def __init__(self, content):
        r = Reader(content, "5")
        self.major, self.minor, self.features = r.unpack("HHI")
        self._check_version()
        (self.width, self.plane_height, self.image_size,
         self.code_bits, self.code_shift) = r.unpack("IIIBB")
        self.N, self.D, self.declared = r.unpack("IIQ")
        self._check_ranges()
        self.unit = r.label(0, 15)
        self.encoder = r.label(0, 63)
        self.settings = r.label(0, 255)
        # Bytes that follow are ignored (5.3).

    def _check_version(self):
        """5.1, 5.7."""
        if self.major > 0:
            raise Unsupported("5.1", f"version_major {self.major}")
        if self.features & ~EXACT:
            raise Unsupported("5.1", f"unknown bits in features {self.features:#x}")
        if self.minor < 1:
            raise Damaged("5.2", "version_minor 0 with version_major 0")

    def _check_ranges(self):
        """5.2 and the table of clause 5."""
        if self.width % 2 or not 16 <= self.width <= 16384:
            raise Damaged("5.2", f"picture_width {self.width}")
        if self.plane_height % 2 or not 16 <= self.plane_height <= 5460:
            raise Damaged("5.2", f"plane_height {self.plane_height}")
        if not 16 <= self.image_size <= 2049:
            raise Damaged("5.2", f"image_size {self.image_size}")
        if self.N < 1 or self.D < 1:
            raise Damaged("5.2", f"frame rate {self.N} / {self.D}")
        if self.declared * self.D >= 1 << 64:
            raise Damaged("5.2", f"declared_frames {self.declared} times {self.D} reaches 2^64")
        if self.code_bits != 10 or self.code_shift != 6:
            raise Unsupported("5.2", f"code_bits {self.code_bits}, code_shift {self.code_shift}")

    @property
    def exact(self):
        """Whether the features say that there is an exact track (5.7)."""
        return bool(self.features & EXACT)


def read_config(box):
    """Config of a gvcC box."""
    with placed(box.name):
        return Config(box.content())
