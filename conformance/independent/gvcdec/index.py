# SPDX-License-Identifier: MIT
"""The index mfra: tfra, ghed, gdig, mfro (gvc.md 4.10, 10.1, 10.4)."""

import hashlib
import struct

from .boxes import at_most_one, check_gcrc, is_gcrc, of_type, one
from .errors import Damaged, placed
from .limits import HEAD_COPY
from .zstdframe import expand


def check_index(mfra, head, fragments, head_end):
    """Check mfra against the fragments and the file; head_end: where moov ends."""
    data, end = mfra.data, mfra.end
    children = mfra.children()
    last = [(b.type, b.start) for b in children[-3:]]
    if last != [(b"gdig", end - 76), (b"gcrc", end - 32), (b"mfro", end - 16)] \
            or not is_gcrc(data, end - 32):
        raise Damaged("4.10", "last children are not gdig, gcrc and mfro", mfra.name)
    check_gcrc(data, mfra.start, end - 32, "mfra")
    size, kind, flags, whole = struct.unpack_from(">I4sII", data, end - 16)
    children[-1].full("4.10")
    if size != 16 or flags or whole != mfra.size:
        raise Damaged("4.10", "mfro does not state the size of mfra", children[-1].name)
    for kind in (b"gdig", b"mfro"):
        one(children, kind, "4.10", mfra.name)
    check_entries(children, head, fragments, mfra.name)
    check_copy(at_most_one(children, b"ghed", "4.10", mfra.name), data, head_end)
    check_digest(children[-3], data)


def check_entries(children, head, fragments, name):
    """One tfra of the main track with one right entry per fragment (4.10.1, 4.10.3)."""
    found = []
    for tfra in of_type(children, b"tfra"):
        if tfra.fields("I", 4, "4.10.1")[0] == head.main.id:
            found.append(tfra)
    if len(found) != 1:
        raise Damaged("4.10", f"{len(found)} boxes tfra of the main track", name)
    tfra = found[0]
    with placed(tfra.name):
        version, _ = tfra.full("4.10", 1)
        lengths, count = tfra.fields("II", 8, "4.10.1")
        widths = [1 + (lengths >> shift & 3) for shift in (4, 2, 0)]
        entry = (16 if version else 8) + sum(widths)
        if tfra.end - tfra.body != 16 + entry * count:
            raise Damaged("4.10.1", f"tfra cannot hold exactly {count} entries")
        if count != len(fragments):
            raise Damaged("4.10.3", f"index has {count} entries, the file {len(fragments)} "
                                    "fragments")
        for i, fragment in enumerate(fragments):
            check_entry(tfra, 16 + i * entry, version, widths, fragment, head.main.kind)


def check_entry(tfra, at, version, widths, fragment, kind):
    """Compare one entry, `at` bytes into the body, with its fragment (4.10.1)."""
    time, offset = tfra.fields("QQ" if version else "II", at, "4.10.1")
    at += 16 if version else 8
    numbers = []
    for width in widths:
        place = tfra.body + at
        numbers.append(int.from_bytes(tfra.data[place:place + width], "big"))
        at += width
    run = fragment.runs[kind]
    if time != run.t + run.first_offset or offset != fragment.moof.start or numbers[1:] != [1, 1]:
        raise Damaged("4.10.3", f"entry of frame {fragment.first} does not match the fragment "
                                f"at {fragment.moof.start:#x}")


def check_copy(ghed, data, head_end):
    """ghed expands to the head of the file (4.10.5): this MAY be checked.  Flags are ignored."""
    if ghed is None or head_end > HEAD_COPY:
        return
    with placed(ghed.name):
        if ghed.fields("I", 0, "4.10.5")[0] >> 24:
            return
        if expand(ghed.content(4), HEAD_COPY, "4.10.5") != bytes(data[:head_end]):
            raise Damaged("4.10.5", "copy of the head is not the head of the file")


def check_digest(gdig, data):
    """SHA-256 of all but the last 64 bytes of the file (10.4)."""
    with placed(gdig.name):
        gdig.full("10.4")  # flags are ignored (14.4)
        if gdig.body != gdig.start + 8:
            raise Damaged("10.4", "gdig has not the form of clause 10.4")
        digest, step = hashlib.sha256(), 1 << 24
        for at in range(0, len(data) - 64, step):
            digest.update(data[at:min(at + step, len(data) - 64)])
        if digest.digest() != gdig.content(4):
            raise Damaged("10.4.2", "wrong digest of the file")
