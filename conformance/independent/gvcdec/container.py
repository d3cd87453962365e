# SPDX-License-Identifier: MIT
"""The whole file in file order: structure, checksums, index (gvc.md 4.1, 10.5, 11.3, 12.8)."""

import struct

from .boxes import check_gcrc, is_gcrc, read_box
from .errors import Damaged, Limit, placed
from .fragment import check_sums, check_times, place_samples, read_moof
from .head import check_ftyp, read_head
from .index import check_index
from .limits import STRUCTURE
from .order import Order, check_output
from .slices import read_sample


class GvcFile:
    """A file whose structure and checksums are right.

    head: Head; fragments: list in the order of the file; gaps: list of (first frame, count) of
    ggap boxes; frames: number of frames with those that are missing.
    """

    def __init__(self, data):
        self.data = data
        self.head = None
        self.fragments = []
        self.gaps = []
        self.frames = 0
        self._moof = None          # moof whose mdat must follow
        self._ftyp = self._moov = self._mfra = None
        self._read()

    def _read(self):
        """Go through the top level (4.1.1)."""
        at, end = 0, len(self.data)
        if end == 0:
            raise Damaged("4.1.1", "file of 0 bytes")
        while at < end:
            try:
                box = read_box(self.data, at, end)
            except Damaged as error:
                if self._mfra is None and "leaves" in error.reason or "too few" in error.reason:
                    error.reason += " (cut off, 12.5?)"
                raise
            self._take(box)
            at = box.end
        if self._moof is not None:
            raise Damaged("12.5", "cut off: moof without mdat", self._moof[0].name)
        if self._mfra is None:
            raise Damaged("12.5", "cut off: no mfra at the end")

    def _take(self, box):
        """Check that a box may stand here and read it."""
        if self._mfra is not None:
            raise Damaged("4.1.1", "box behind mfra", box.name)
        if self._moof is not None and box.type != b"mdat":
            raise Damaged("4.1.1", "box between moof and its mdat", box.name)
        if self._ftyp is None and box.type != b"ftyp":
            raise Damaged("4.1.1", "file does not begin with ftyp", box.name)
        step = {b"ftyp": self._take_ftyp, b"moov": self._take_moov, b"moof": self._take_moof,
                b"mdat": self._take_mdat, b"ggap": self._take_ggap,
                b"mfra": self._take_mfra}.get(box.type)
        if step is None:
            return
        if box.type in (b"moof", b"mdat", b"ggap", b"mfra") and self._moov is None:
            raise Damaged("4.1.1", "box before moov", box.name)
        if box.type != b"mdat" and box.size > STRUCTURE:
            raise Limit("13.3", f"box of {box.size} bytes", box.name)
        step(box)

    def _take_ftyp(self, box):
        """4.3.1: the first box, once."""
        if self._ftyp is not None:
            raise Damaged("4.1.1", "a second ftyp", box.name)
        self._ftyp = box
        check_ftyp(box)

    def _take_moov(self, box):
        """4.3: the head, once."""
        if self._moov is not None:
            raise Damaged("4.1.1", "a second moov", box.name)
        self._moov = box
        self.head = read_head(box)

    def _take_moof(self, box):
        """4.6, 11.3: a fragment of frames, or one of other tracks (4.11)."""
        self._moof = (box, read_moof(box, self.head))
        fragment = self._moof[1]
        if fragment:
            with placed(f"fragment at {box.start:#x}"):
                check_times(fragment, self.frames, self.head.config)
            self.frames += fragment.count

    def _take_mdat(self, box):
        """4.8, 10.2.2: its samples, with their checksums and H.264 headers."""
        if self._moof is None:
            raise Damaged("4.1.1", "mdat that does not follow a moof", box.name)
        moof, fragment = self._moof
        self._moof = None
        if fragment is None:
            return
        with placed(f"fragment at {moof.start:#x}"):
            place_samples(fragment, box)
            check_sums(fragment)
        if "geometry" in fragment.runs:
            check_pictures(fragment, self.head.avc)
        self.fragments.append(fragment)

    def _take_ggap(self, box):
        """Missing frames (12.8)."""
        with placed(box.name):
            if box.size != 44 or box.body != box.start + 8 or not is_gcrc(box.data, box.end - 16):
                raise Damaged("12.8.1", "ggap has not the form of clause 12.8")
            check_gcrc(box.data, box.start, box.end - 16, "ggap")
            box.full("12.8.1")  # flags are ignored (14.4)
            first, count = struct.unpack_from(">QQ", box.data, box.body + 4)
            if first != self.frames:
                raise Damaged("12.8.2", f"first_frame is {first}, not {self.frames}")
            if count < 1:
                raise Damaged("12.8.2", "frame_count is 0")
            if (first + count) * self.head.config.D >= 1 << 64:
                raise Damaged("12.8.2", "first_frame + frame_count times D reaches 2^64")
            declared = self.head.config.declared
            if declared and first + count > declared:
                raise Damaged("5.6", f"gap goes beyond the {declared} declared frames")
            self.gaps.append((first, count))
            self.frames += count

    def _take_mfra(self, box):
        """4.10: the index, the last box."""
        self._mfra = box
        if box.end != len(self.data):
            raise Damaged("4.1.1", "bytes behind mfra", f"offset {box.end:#x}")
        check_index(box, self.head, self.fragments, self._moov.end)


def check_pictures(fragment, parameters):
    """H.264 of a fragment before any decoder sees it (6.2.5 to 6.2.7)."""
    run = fragment.runs["geometry"]
    order, places = Order(parameters), []
    for i, number in enumerate(run.numbers):
        with placed(f"frame {number}, offset {run.starts[i]:#x}"):
            picture = read_sample(fragment.sample("geometry", i), i == 0, parameters)
            places.append(order.place(picture))
    with placed(f"fragment at {fragment.moof.start:#x}"):
        check_output(places, run.numbers)


def check_count(file):
    """5.6: as many frames as declared."""
    declared = file.head.config.declared
    if declared and file.frames != declared:
        raise Damaged("5.6", f"{file.frames} frames, {declared} are declared")
