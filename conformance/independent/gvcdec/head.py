# SPDX-License-Identifier: MIT
"""The file head: ftyp and moov (gvc.md 4.3 to 4.5, 4.9)."""

from .boxes import check_last_gcrc, of_type, one
from .config import read_config
from .errors import Damaged, Unsupported
from .parameters import read_avcc
from .tracks import CLAUSE, check_sizes, check_track, classify, track_id


class Head:
    """What the head says: config, tracks by kind, main (Track), avc (parameter sets or None)."""

    def __init__(self, config, tracks):
        self.config = config
        self.tracks = tracks
        self.main = tracks.get("geometry") or tracks["exact"]
        self.avc = None
        self.by_id = {}

    @property
    def preview(self):
        """Whether every frame has a preview (6.4.1, 7.1.5)."""
        return "geometry" in self.tracks and "exact" in self.tracks


def check_ftyp(box):
    """gvc1 is the major or a compatible brand (4.3.1)."""
    content = box.content()
    if len(content) < 8:
        raise Damaged("4.3.1", "ftyp is too short", box.name)
    brands = [content[0:4]] + [content[i:i + 4] for i in range(8, len(content), 4)]
    if b"gvc1" not in brands:
        raise Unsupported("4.3.1", "no brand gvc1: not a gvc file", box.name)


def find_tracks(traks):
    """Tracks of this document by kind (4.3, 4.3.3, 4.5.2)."""
    tracks = {}
    for trak in traks:
        track = classify(trak)
        if track is None:
            continue
        if track.kind in tracks:
            raise Damaged("4.3.3", f"a second {track.kind} track", trak.name)
        tracks[track.kind] = track
    if "geometry" not in tracks and "exact" not in tracks:
        raise Damaged("4.3", "neither geometry nor exact track")
    return tracks


def read_head(moov):
    """Head of a moov box, checked."""
    parts = moov.children()
    check_last_gcrc(moov, parts, 0)
    tracks = find_tracks(of_type(parts, b"trak"))
    main = tracks.get("geometry") or tracks["exact"]
    config = read_config(one(main.inner, b"gvcC", "4.3.4", main.entry.name))
    head = Head(config, tracks)
    check_features(head)
    if "shape" not in tracks:
        raise Damaged("4.5.2", "no shape track: the file was most likely copied by a tool that "
                               "keeps only tracks it knows")
    main_id = track_id(main.trak, CLAUSE[main.kind])
    for track in tracks.values():
        check_sizes(track)
        check_track(track, head.config, main_id)
    check_ids(head)
    read_defaults(head, one(parts, b"mvex", "4.3", moov.name))
    if "geometry" in tracks:
        geometry = tracks["geometry"]
        avcc = one(geometry.inner, b"avcC", "4.4", geometry.entry.name)
        head.avc = read_avcc(avcc, head.config)
    return head


def check_features(head):
    """Exact track if, and only if, bit 0 of features (4.9.2)."""
    if head.config.exact and "exact" not in head.tracks:
        raise Damaged("4.9.2", "features say that there is an exact track, but there is none: a "
                               "tool that keeps only tracks it knows most likely dropped it")
    if not head.config.exact and "exact" in head.tracks:
        raise Damaged("4.9.2", "an exact track that features do not mention")


def check_ids(head):
    """Tracks of this document have different track_IDs (4.3.3)."""
    for track in head.tracks.values():
        if track.id in head.by_id:
            raise Damaged("4.3.3", f"two tracks have track_ID {track.id}", track.trak.name)
        head.by_id[track.id] = track


def read_defaults(head, mvex):
    """trex of each track: version 0, sample description 1 (4.3)."""
    found = {}
    for trex in of_type(mvex.children(), b"trex"):
        version, _ = trex.full("4.3", 255)
        ident, description, *defaults = trex.fields("IIIII", 4, "4.3")
        if ident not in head.by_id:
            continue
        trex.full("4.3")
        if ident in found:
            raise Damaged("4.3", f"a second trex of track {ident}", trex.name)
        if description != 1:
            raise Damaged("4.3", "default_sample_description_index is not 1", trex.name)
        found[ident] = tuple(defaults)
    for ident, track in head.by_id.items():
        if ident not in found:
            raise Damaged("4.3", f"no trex of track {ident}", mvex.name)
        track.defaults = found[ident]
