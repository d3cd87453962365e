# SPDX-License-Identifier: MIT
"""Vectors that are not made here: Annex B of the specification, and files of the reference encoder."""
import hashlib
import json
import os
import re

HEX_LINE = re.compile(r"^([0-9a-f]{4})  ([0-9a-f]+)(?:  |$)", re.MULTILINE)


def annex_b(folder):
    """The bytes of the file in Annex B."""
    with open(os.path.join(folder, "..", "spec", "gvc.md"), encoding="utf-8") as stream:
        text = stream.read().split("## Annex B", 1)[1]
    data = b""
    for offset, digits in HEX_LINE.findall(text):
        if int(offset, 16) != len(data):
            raise ValueError("Annex B: bytes at %s do not follow those before" % offset)
        data += bytes.fromhex(digits)
    stated = re.search(r"SHA-256 is\s+`([0-9a-f]{64})`", text)[1]
    if hashlib.sha256(data).hexdigest() != stated:
        raise ValueError("Annex B: the SHA-256 is not the one stated")
    return data


def everything(suite, folder):
    """All of them. Files of the encoder must be those that were recorded."""
    with open(os.path.join(folder, "recorded.json"), encoding="utf-8") as stream:
        entries = json.load(stream)["vectors"]
    for entry in entries:
        path = os.path.join(folder, entry["name"] + ".gvc")
        if entry["name"] == "core/example":
            data = annex_b(folder)
        else:
            with open(path, "rb") as stream:
                data = stream.read()
        if hashlib.sha256(data).hexdigest() != entry["sha256"]:
            raise ValueError(path + " is not the file that was recorded")
        facts = {key: entry[key] for key in ("profile", "level", "frames", "preview") if key in entry}
        suite.recorded(entry["name"], data, "%s (%s)" % (entry["about"], entry["command"]), entry["clauses"], entry["features"], facts)
