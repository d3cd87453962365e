# SPDX-License-Identifier: MIT
"""Samples of the exact track (gvc.md 6.4)."""

import struct

from .errors import Damaged, placed
from .exr import MAGIC, read_exr
from .residual import read_residual


def split_sample(sample, charts):
    """Exact images of a sample, one per chart (6.4.2)."""
    if charts == 1:
        return [sample]
    images, at = [], 0
    for _ in range(charts):
        if len(sample) - at < 4:
            raise Damaged("6.4.2", "exact sample ends early")
        size = struct.unpack_from(">I", sample, at)[0]
        at += 4
        if size > len(sample) - at:
            raise Damaged("6.4.2", "exact sample ends early")
        images.append(sample[at:at + size])
        at += size
    if at != len(sample):
        raise Damaged("6.4.2", "bytes behind the last exact image")
    return images


def read_exact(sample, charts, before):
    """Codes, int64 [3, S, S], of each chart.  before: those of the frame before in the
    fragment, or None for its first frame (6.4.3)."""
    codes = []
    for i, (image, chart) in enumerate(zip(split_sample(sample, len(charts)), charts)):
        with placed(f"exact image {i}"):
            if image[:4] == MAGIC:
                codes.append(read_exr(image, chart.size))
            elif before is None:
                raise Damaged("6.4.3", "first image of a fragment is no OpenEXR file")
            else:
                codes.append(read_residual(image, chart.size, before[i]))
    return codes
