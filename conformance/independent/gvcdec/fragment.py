# SPDX-License-Identifier: MIT
"""Fragments: moof and mdat (gvc.md 4.6 to 4.8, 10.2, 11.2, 11.3)."""

import zlib

from .boxes import check_last_gcrc, is_gcrc, check_gcrc, of_type, one
from .errors import Damaged, Limit, placed
from .limits import SAMPLE

KINDS = ("shape", "geometry", "exact")  # order in mdat (4.8.1)
NON_SYNC = 0x10000


class Run:
    """Samples of one track in a fragment.

    sizes, starts, numbers: of each sample in the order of the run: bytes, offset in the file,
    presentation number; sums: CRC-32; offset: data offset; first_offset: composition offset of
    the first sample; t: time of tfdt.
    """

    def __init__(self, track):
        self.track = track
        self.place = 0


class Fragment:
    """first: first frame number; count: frames; runs by kind; moof: Box; mdat: its Box."""

    def __init__(self, moof, runs):
        self.moof = moof
        self.runs = runs
        self.first = self.count = 0
        self.mdat = None

    def sample(self, kind, i):
        """Bytes of sample i of the run of a kind."""
        run = self.runs[kind]
        return bytes(self.moof.data[run.starts[i]:run.starts[i] + run.sizes[i]])


def read_moof(moof, head):
    """Fragment of a moof box, or None if it is one of other tracks only (4.6, 4.11)."""
    children = moof.children()
    trafs = [(traf, *read_tfhd(traf)) for traf in of_type(children, b"traf")]
    known = [head.by_id.get(ident) for _, _, ident in trafs]
    if not any(known):
        if children and children[-1].type == b"gcrc" and is_gcrc(moof.data, moof.end - 16):
            check_gcrc(moof.data, moof.start, moof.end - 16, "moof")
        elif children and children[-1].type == b"gcrc":
            raise Damaged("10.1.1", "gcrc is not 16 bytes long", children[-1].name)
        return None
    check_last_gcrc(moof, children, moof.start)
    runs = {}
    for (traf, parts, _), track in zip(trafs, known):
        if track is None:
            raise Damaged("4.6", "traf of another track among those of the frames", traf.name)
        if track.kind in runs:
            raise Damaged("4.6", f"a second traf of the {track.kind} track", traf.name)
        with placed(f"{track.kind} {traf.name}"):
            runs[track.kind] = read_run(traf, parts, track, head.config)
    if len(runs) != len(head.tracks):
        raise Damaged("4.6", "a traf is missing", moof.name)
    return Fragment(moof, runs)


def read_tfhd(traf):
    """(children of the traf, track_ID of its tfhd)."""
    parts = traf.children()
    tfhd = one(parts, b"tfhd", "4.6", traf.name)
    return parts, tfhd.fields("I", 4, "4.6")[0]


def tfhd_defaults(tfhd, track):
    """Default duration, size and flags of samples: tfhd over trex (4.6.1, 4.7.3)."""
    _, flags = tfhd.full("4.6")
    if not flags & 0x020000 or flags & 0x010001:
        raise Damaged("4.6.1", f"flags {flags:06x} of tfhd", tfhd.name)
    asked = [0x2, 0x8, 0x10, 0x20]
    given = [f for f in asked if flags & f]
    values = dict(zip(given, tfhd.fields(f"{len(given)}I", 8, "4.6.1")))
    if values.get(0x2, 1) != 1:
        raise Damaged("4.6.1", "sample description is not 1", tfhd.name)
    return tuple(values.get(f, d) for f, d in zip(asked[1:], track.defaults))


def read_run(traf, parts, track, config):
    """Run of a traf box."""
    run = Run(track)
    defaults = tfhd_defaults(one(parts, b"tfhd", "4.6", None), track)
    tfdt = one(parts, b"tfdt", "4.6", None)
    version, _ = tfdt.full("4.6", 1)
    run.t = tfdt.fields("Q" if version else "I", 4, "4.6")[0]
    trun = one(parts, b"trun", "4.6", None)
    gcks = one(parts, b"gcks", "4.6", None)
    gcks.full("10.2.1")  # flags are ignored (14.4)
    read_samples(run, trun, gcks, defaults, config)
    run.sums = gcks.fields(f"{len(run.sizes)}I", 4, "10.2.1")
    return run


def read_samples(run, trun, gcks, defaults, config):
    """Fill run by a trun (4.7)."""
    version, flags = trun.full("4.7", 1)
    if not flags & 1:
        raise Damaged("4.7.1", "trun without data offset", trun.name)
    if flags & 0x4 and flags & 0x400:
        raise Damaged("4.7.1", "trun with flags of the first sample and of all", trun.name)
    count, run.offset = trun.fields("Ii", 4, "4.7.2")
    if count < 1:
        raise Damaged("4.7.1", "trun without samples", trun.name)
    at = 12 + (4 if flags & 4 else 0)
    asked = [f for f in (0x100, 0x200, 0x400, 0x800) if flags & f]
    if trun.end - trun.body != at + 4 * len(asked) * count:
        raise Damaged("4.7.2", f"trun of {trun.size} bytes cannot hold {count} samples", trun.name)
    if gcks.end - gcks.body != 4 + 4 * count:
        raise Damaged("10.2.1", f"number of checksums is not {count}, that of samples", gcks.name)
    table = trun.fields(f"{len(asked) * count}I", at, "4.7.2")
    columns = {f: list(table[i::len(asked)]) for i, f in enumerate(asked)}
    duration, run.sizes, sample_flags = (
        columns.get(f, [d] * count) for f, d in zip((0x100, 0x200, 0x400), defaults))
    if flags & 4:
        sample_flags = [trun.fields("I", 12, "4.7.2")[0]] + sample_flags[1:]
    check_samples(run.sizes, duration, sample_flags, config)
    offsets = columns.get(0x800, [0] * count)
    if version == 1:
        offsets = [o - (1 << 32) if o >> 31 else o for o in offsets]
    run.first_offset = offsets[0]
    number_samples(run, offsets, config.D)


def check_samples(sizes, durations, flags, config):
    """Duration D, no empty sample, only the first a sync sample (4.7.3, 4.7.5)."""
    if any(d != config.D for d in durations):
        raise Damaged("4.7.3", "duration of a sample is not D")
    if 0 in sizes:
        raise Damaged("4.7.3", f"sample {sizes.index(0)} of 0 bytes")
    if max(sizes) > SAMPLE:
        raise Limit("13.3", f"sample of {max(sizes)} bytes")
    if flags[0] & NON_SYNC or not all(f & NON_SYNC for f in flags[1:]):
        raise Damaged("4.7.5", "not the first sample, and no other, is a sync sample")


def number_samples(run, offsets, D):
    """Presentation numbers (11.2): f = (t + i D + o - T) / D."""
    if run.t % D or any(o % D for o in offsets):
        raise Damaged("11.2.1", "time or composition offset is no multiple of D")
    if run.t + (len(offsets) - 1) * D >= 1 << 64:
        raise Damaged("13.1", "frame number times D reaches 2^64")
    base = run.t - run.track.T
    run.numbers = [(base + o) // D + i for i, o in enumerate(offsets)]


def check_times(fragment, first, config):
    """Fragments tile time: `first` frames came before (11.3), 5.6."""
    counts = {len(run.sizes) for run in fragment.runs.values()}
    if len(counts) != 1:
        raise Damaged("4.7.1", "different numbers of samples in the traf boxes")
    fragment.first, fragment.count = first, counts.pop()
    if config.declared and first + fragment.count > config.declared:
        raise Damaged("5.6", f"frame {first + fragment.count - 1} in a file of "
                             f"{config.declared} declared frames")
    for kind, run in fragment.runs.items():
        if run.t != first * config.D:
            clause = "12.4" if run.t < first * config.D else "11.3"
            raise Damaged(clause, f"{kind} run begins at time {run.t}, not {first * config.D}")
        if sorted(run.numbers) != list(range(first, first + fragment.count)):
            raise Damaged("11.3", f"presentation numbers of the {kind} run are no permutation "
                                  f"of {first} to {first + fragment.count - 1}")


def place_samples(fragment, mdat):
    """Check data offsets and the size of mdat (4.8), and find where samples begin."""
    fragment.mdat = mdat
    offset = fragment.moof.size + mdat.body - mdat.start
    for kind in KINDS:
        run = fragment.runs.get(kind)
        if run is None:
            continue
        if run.offset != offset:
            raise Damaged("4.8.2", f"data offset of the {kind} run is {run.offset}, not {offset}")
        run.starts = []
        for size in run.sizes:
            run.starts.append(fragment.moof.start + offset)
            offset += size
    if fragment.moof.start + offset != mdat.end:
        raise Damaged("4.8.2", f"mdat ends at {mdat.end:#x}, its samples at "
                               f"{fragment.moof.start + offset:#x}")


def check_sums(fragment):
    """CRC-32 of each sample (10.2.2)."""
    for kind, run in fragment.runs.items():
        for start, size, crc, number in zip(run.starts, run.sizes, run.sums, run.numbers):
            if zlib.crc32(fragment.moof.data[start:start + size]) != crc:
                raise Damaged("10.2.2", f"wrong CRC-32 of the {kind} sample of frame {number}",
                              f"offset {start:#x}")
