# SPDX-License-Identifier: MIT
"""Decoding of all frames of a file in order (gvc.md 3.1, 10.5)."""

import hashlib

import numpy as np

from .errors import Damaged, placed
from .exact import read_exact
from .pictures import Pictures
from .record import read_record
from .surface import add_digest, faces_of, positions_of, welded_codes


def picture_codes(picture, charts, config):
    """Codes, int64 [3, S, S], of each chart of a luma plane (6.3.1)."""
    planes = picture.reshape(3, config.plane_height, config.width)
    return [planes[:, c.y:c.y + c.size, c.x:c.x + c.size].astype(np.int64) << 6 for c in charts]


def build(codes, charts, digest, what):
    """Welded codes and faces of each chart, if their digest is right (9, 10.3)."""
    found, parts = hashlib.sha256(), []
    for code, chart in zip(codes, charts):
        welded = welded_codes(code, chart.weld)
        faces = faces_of(welded, chart.weld)
        add_digest(found, welded, faces)
        parts.append((welded, faces))
    if found.digest()[:8] != digest:
        raise Damaged("10.3.2", f"wrong digest of the {what}: {found.digest()[:8].hex()}, "
                                f"not {digest.hex()}")
    return parts


def mesh(parts, charts):
    """[(positions, faces)] of each chart (9.5)."""
    return [(positions_of(w, chart), faces) for (w, faces), chart in zip(parts, charts)]


def in_order(fragment, kind):
    """Index in the run of each frame, in order of presentation."""
    numbers = fragment.runs[kind].numbers
    return sorted(range(len(numbers)), key=numbers.__getitem__)


def fragment_records(fragment, head):
    """(records in order of presentation, charts) of a fragment."""
    records = []
    for n, i in enumerate(in_order(fragment, "shape")):
        place = f"frame {fragment.first + n}, offset {fragment.runs['shape'].starts[i]:#x}"
        with placed(place):
            records.append(read_record(fragment.sample("shape", i), n == 0, head.config,
                                       head.preview))
    return records, records[0].charts


def decode_fragment(fragment, head, pictures, preview):
    """Yield (frame number, mesh) of a fragment; preview: that of the picture in any case."""
    records, charts = fragment_records(fragment, head)
    exact_order = in_order(fragment, "exact") if "exact" in fragment.runs else None
    before = None
    for n, record in enumerate(records):
        where = f"frame {fragment.first + n}"
        with placed(where):
            parts = shown = None
            if pictures:
                codes = picture_codes(pictures.next(where), charts, head.config)
                digest = record.preview_digest if head.preview else record.digest
                shown = parts = build(codes, charts, digest, "preview" if head.preview else "frame")
            if exact_order:
                sample = fragment.sample("exact", exact_order[n])
                before = read_exact(sample, charts, before)
                parts = build(before, charts, record.digest, "frame")
            yield fragment.first + n, mesh(shown if preview else parts, charts)


def decode(file, preview):
    """Yield (frame number, mesh) of all frames of a GvcFile that are present."""
    pictures = None
    if "geometry" in file.head.tracks:
        pictures = Pictures(file.fragments, file.head.avc)
    try:
        for fragment in file.fragments:
            with placed(f"fragment at {fragment.moof.start:#x}"):
                yield from decode_fragment(fragment, file.head, pictures, preview)
    finally:
        if pictures:
            pictures.close()
