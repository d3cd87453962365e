# SPDX-License-Identifier: MIT
"""Limits of this decoder (13.3), so that memory is bounded before it is taken."""

# Samples of all charts of one frame: about 100 bytes of memory each.
CHART_SAMPLES = 1 << 24
# Charts of one frame; each costs some milliseconds of Python.
CHARTS = 4096
# Bytes of pictures that the H.264 decoder may hold (15.3).
PICTURE_MEMORY = 4 << 30
# Bytes of `moov`, of a `moof`, of `mfra`.
STRUCTURE = 1 << 30
# Bytes of one sample (a shape record, a picture or a frame of exact images).
SAMPLE = 1 << 30
# Content of `ghed` (4.10.5).
HEAD_COPY = 1 << 24
