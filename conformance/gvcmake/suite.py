# SPDX-License-Identifier: MIT
"""The list of vectors: bytes of each and what the manifest says of it."""
import hashlib
import json


# Of a level (gvc.md 13.4): image_size, samples of a picture, samples a second.
LEVELS = ((129, 65536, 2097152), (257, 262144, 8388608), (513, 1048576, 33554432), (1025, 4194304, 134217728),
          (2049, 16777216, 536870912))


def profile(kinds):
    """The profile (14.5) of a file with these tracks."""
    if "exact" not in kinds:
        return "lossy"
    return "preview" if "geometry" in kinds else "lossless"


def level(config):
    """The level (13.4) of a file."""
    area = (config.picture_width + 15) // 16 * 16 * ((3 * config.plane_height + 15) // 16 * 16)
    for number, (size, samples, rate) in enumerate(LEVELS, 1):
        if config.image_size <= size and area <= samples and area * config.rate_num <= rate * config.rate_den:
            return number
    return 6


class Suite:
    """Collects vectors. Names are folder/name; the folder is the category: core, extended or invalid."""

    def __init__(self):
        self.files, self.entries = {}, []

    def _add(self, name, data, about, clauses, features, rest):
        if name in self.files:
            raise ValueError("two vectors are called " + name)
        category = name.split("/")[0]
        self.files[name] = data
        self.entries.append({"name": name, "file": name + ".gvc", "sha256": hashlib.sha256(data).hexdigest(),
                             "category": category, "features": sorted(set(features)), "clauses": list(clauses),
                             "about": about, **rest})

    def good(self, name, movie, about, clauses, features):
        """A file that keeps all rules: frames, previews and what gaps state come from the movie."""
        from .movie import Gap
        missing = [f for p in movie.parts if isinstance(p, Gap) for f in range(p.first_frame, p.first_frame + p.count)]
        rest = {"profile": profile(movie.kinds), "level": level(movie.config),
                "frames": [{"frame": f, "digest": r.digest.hex(), "mesh": r.mesh} for f, r in sorted(movie.frames.items())]}
        previews = [{"frame": f, "digest": r.preview[0].hex(), "mesh": r.preview[1]}
                    for f, r in sorted(movie.frames.items()) if r.preview]
        if previews:
            rest["preview"] = previews
        if missing:
            rest["missing"] = missing
        self._add(name, movie.write(), about, clauses, features, rest)

    def recorded(self, name, data, about, clauses, features, facts):
        """A file that was made before: facts are frames and previews."""
        self._add(name, data, about, clauses, features, facts)

    def bad(self, name, movie, about, clauses, features, error="corrupt", good=(), checks=None):
        """A file that breaks one rule. good: frames a decoder may hand out before it notices; "all" or numbers.

        checks: "whole file" if only a check of the whole file (10.5) notices, "preview" if only previews are bad.
        """
        numbers = sorted(movie.frames) if good == "all" else sorted(good)
        frames = movie.frames
        mesh = {f: frames[f].preview[1] if checks == "preview" else frames[f].mesh for f in numbers}
        rest = {"profile": profile(movie.kinds), "error": error, "good": [{"frame": f, "mesh": mesh[f]} for f in numbers]}
        if checks:
            rest["checks"] = checks
        self._add("invalid/" + name, movie.write(), about, clauses, features, rest)

    def manifest(self):
        """The text of manifest.json, entries in the order of their names."""
        entries = sorted(self.entries, key=lambda e: e["name"])
        return json.dumps({"version": 1, "vectors": entries}, indent=1, ensure_ascii=True) + "\n"
