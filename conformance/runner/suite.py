# SPDX-License-Identifier: MIT
"""The set of vectors: reads the manifest, and tells what is not as it says."""
import fnmatch
import hashlib
import json
import os

FOLDERS = ("core", "extended", "invalid")


def load(manifest):
    """Vectors with their paths, and a list of what is wrong with the set."""
    folder = os.path.dirname(os.path.abspath(manifest))
    with open(manifest, encoding="utf-8") as stream:
        vectors = json.load(stream)["vectors"]
    problems, listed = [], set()
    for vector in vectors:
        vector["path"] = os.path.join(folder, vector["file"])
        if vector["file"] in listed:
            problems.append("%s is in the manifest twice" % vector["file"])
        listed.add(vector["file"])
        problems += _check(vector)
    for name in FOLDERS:
        for root, _, files in os.walk(os.path.join(folder, name)):
            for file in sorted(files):
                path = os.path.relpath(os.path.join(root, file), folder)
                if path not in listed:
                    problems.append("%s is not in the manifest" % path)
    if not vectors:
        problems.append("the manifest names no vectors")
    return vectors, problems


def _check(vector):
    try:
        with open(vector["path"], "rb") as stream:
            digest = hashlib.sha256(stream.read()).hexdigest()
    except OSError as error:
        return ["%s: %s" % (vector["file"], error.strerror)]
    return [] if digest == vector["sha256"] else ["%s is not the file of the manifest: wrong SHA-256" % vector["file"]]


def choose(vectors, pattern):
    """Vectors that match; all without a pattern."""
    return [v for v in vectors if not pattern or fnmatch.fnmatch(v["name"], pattern)]
