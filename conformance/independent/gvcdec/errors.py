# SPDX-License-Identifier: MIT
"""The three ways in which a file is refused (gvc.md 2.2), with clause and place."""


class Refusal(Exception):
    """A file is not decoded.  clause: of gvc.md; where: offset or frame; reason: text."""

    status = 1
    word = "damaged"

    def __init__(self, clause, reason, where=None):
        super().__init__(reason)
        self.clause = clause
        self.reason = reason
        self.where = where

    def line(self, name):
        """One line for a person: file, kind, clause, place, reason."""
        place = f" {self.where}:" if self.where else ""
        return f"{name}: {self.word}: clause {self.clause}:{place} {self.reason}"


class Damaged(Refusal):
    """The file breaks the format, is cut off, or fails a checksum or digest."""


class Unsupported(Refusal):
    """Well-formed, but the text says "reject as unsupported"."""

    status = 3
    word = "unsupported"


class Limit(Refusal):
    """Well-formed, but more than this decoder wants to give (13.3)."""

    status = 4
    word = "limit"


class placed:
    """Context manager: gives refusals from inside a place if they have none yet."""

    def __init__(self, where):
        self.where = where

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if isinstance(error, Refusal) and error.where is None:
            error.where = self.where() if callable(self.where) else self.where
        return False
