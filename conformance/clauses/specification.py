# SPDX-License-Identifier: MIT
"""Finds the requirements in the text of spec/gvc.md.

A requirement is a clause with a number in bold that says MUST, a numbered rule of 8.2, written 8.2(1), or a row of a
table of boxes of clause 4 that binds decoders (marked R), written as the number of its section and the box: 4.3 ftyp.
"""
import re
from dataclasses import dataclass, field

CLAUSE = re.compile(r"^\*\*(\d+(?:\.\d+)+)\*\*")
HEADING = re.compile(r"^#+ (?:(\d+(?:\.\d+)*) )?")
RULE = re.compile(r"^(\d+)\. ")
ROW = re.compile(r"^\| (`.*) \|([^|]*)\|(?P<text>.*)\| (?P<binds>[RW; ]*)\|$")
BOX = re.compile(r"`([^`]{4})`")


@dataclass
class Specification:
    """requirements: text of each by its id, in the order of the document. clauses: ids of all clauses and requirements.
    loose: lines with MUST that belong to no clause with a number."""
    requirements: dict = field(default_factory=dict)
    clauses: set = field(default_factory=set)
    loose: list = field(default_factory=list)


@dataclass
class _Place:
    """Where in the document a line is."""
    section: str = ""
    clause: str = ""
    words: list = field(default_factory=list)
    in_code: bool = False


def _close(out, place):
    """The clause has been read."""
    text = " ".join(place.words)
    if place.clause and re.search(r"\bMUST\b", text):
        out.requirements[place.clause] = text
    place.clause, place.words = "", []


def _row(out, place, line):
    match = ROW.match(line)
    if not match or not place.section.startswith("4.") or "R" not in match["binds"]:
        return
    for box in BOX.findall(match[1]):
        name = "%s %s" % (place.section, box)
        out.requirements[name] = "`%s`: %s; %s" % (box, match[2].strip(), match["text"].strip())
        out.clauses.add(name)


def _rule(out, place, line):
    match = RULE.match(line)
    if match and place.section == "8.2":
        name = "8.2(%s)" % match[1]
        out.requirements[name] = line[match.end():]
        out.clauses.add(name)


def read(text):
    """All requirements of the document."""
    out, place = Specification(), _Place()
    for number, line in enumerate(text.split("\n"), 1):
        if line.startswith("```"):
            place.in_code = not place.in_code
        if place.in_code:
            continue
        heading, clause = HEADING.match(line), CLAUSE.match(line)
        if heading:
            _close(out, place)
            place.section = heading[1] or ""
            out.clauses.add(place.section)
        elif clause:
            _close(out, place)
            place.clause = clause[1]
            out.clauses.add(place.clause)
        if place.clause:
            place.words.append(line.strip())
        elif re.search(r"\bMUST\b", line):
            out.loose.append("line %d: %s" % (number, line.strip()))
        _row(out, place, line)
        _rule(out, place, line)
    _close(out, place)
    return out
