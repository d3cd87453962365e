# SPDX-License-Identifier: MIT
"""Exactly one Zstandard frame with stated content size and no dictionary (gvc.md 4.10.5, 7.1.3)."""

import shutil
import subprocess
import tempfile

from .errors import Damaged, Limit

try:
    import zstandard
except ImportError:
    zstandard = None

MAGIC = b"\x28\xb5\x2f\xfd"
GREATEST_WINDOW = 1 << 27  # what both libraries take unasked


def frame_header(data, clause):
    """(content size, window, bytes of the header, whether a checksum follows), RFC 8878 3.1.1.1."""
    if data[:4] != MAGIC or len(data) < 5:
        raise Damaged(clause, "no Zstandard frame")
    descriptor = data[4]
    single = descriptor >> 5 & 1
    if descriptor & 8:
        raise Damaged(clause, "Zstandard frame with a reserved bit")
    at = 5 + (not single)
    id_size = (0, 1, 2, 4)[descriptor & 3]
    if int.from_bytes(data[at:at + id_size], "little"):
        raise Damaged(clause, "Zstandard frame that needs a dictionary")
    at += id_size
    size = (1 if single else 0, 2, 4, 8)[descriptor >> 6]
    if size == 0:
        raise Damaged(clause, "Zstandard frame without content size")
    if len(data) < at + size:
        raise Damaged(clause, "Zstandard frame ends early")
    stated = int.from_bytes(data[at:at + size], "little") + (256 if size == 2 else 0)
    window = stated
    if not single:
        base = 1 << 10 + (data[5] >> 3)
        window = base + base // 8 * (data[5] & 7)
    return stated, window, at + size, bool(descriptor & 4)


def frame_end(data, at, checksum, clause):
    """Where the frame ends whose blocks begin at `at` (RFC 8878 3.1.1.2)."""
    last = False
    while not last:
        if len(data) - at < 3:
            raise Damaged(clause, "Zstandard frame ends early")
        head = int.from_bytes(data[at:at + 3], "little")
        last, kind, size = head & 1, head >> 1 & 3, head >> 3
        if kind == 3:
            raise Damaged(clause, "Zstandard block of reserved type")
        at += 3 + (1 if kind == 1 else size)
    return at + (4 if checksum else 0)


def expand(data, most, clause, most_window=GREATEST_WINDOW):
    """Content of the frame that data is; more than `most` bytes are refused before expanding."""
    size, window, at, checksum = frame_header(data, clause)
    if size > most:
        raise Damaged(clause, f"Zstandard frame states {size} bytes, at most {most} can be right")
    if window > most_window:
        raise Damaged(clause, f"Zstandard frame with a window of {window} bytes")
    end = frame_end(data, at, checksum, clause)
    if end != len(data):
        raise Damaged(clause, f"Zstandard frame of {end} bytes in {len(data)} bytes")
    try:
        content = run_library(data, size) if zstandard else run_program(data, size)
    except ValueError as error:
        raise Damaged(clause, f"Zstandard frame does not expand: {error}") from None
    if len(content) != size:
        raise Damaged(clause, f"Zstandard frame has {len(content)} bytes, {size} are stated")
    return content


def run_library(data, size):
    """Expand by python3-zstandard."""
    if size == 0:  # max_output_size 0 would be no bound
        return b""
    try:
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
    except zstandard.ZstdError as error:
        raise ValueError(error) from None


def run_program(data, size):
    """Expand by the program zstd; no more than `size` bytes and one are taken from it."""
    if not shutil.which("zstd"):
        raise Limit("7.1.3", "neither python3-zstandard nor the program zstd is installed")
    with tempfile.TemporaryFile() as source, tempfile.TemporaryFile() as errors:
        source.write(data)
        source.seek(0)
        with subprocess.Popen(["zstd", "-d", "-c", "-q", "--memory=128MB"], stdin=source,
                              stdout=subprocess.PIPE, stderr=errors) as process:
            content = process.stdout.read(size + 1)
            process.stdout.close()
        if len(content) > size:
            raise ValueError("more content than stated")
        if process.returncode:
            errors.seek(0)
            raise ValueError(errors.read(200).decode("utf-8", "replace").strip())
    return content
