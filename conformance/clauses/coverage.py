# SPDX-License-Identifier: MIT
"""Compares requirements with vectors, and prints the table of both."""
import re

MOST = 12  # names in a row of the table


def by_clause(vectors):
    """Names of vectors by the ids they name."""
    out = {}
    for vector in vectors:
        for clause in vector["clauses"]:
            out.setdefault(clause, []).append(vector["name"])
    return out


def problems(spec, vectors, untested):
    """What is wrong, as sentences."""
    named = by_clause(vectors)
    out = ["MUST outside of a clause with a number, " + line for line in spec.loose]
    out += ["%s is named by %s, but the specification does not have it" % (c, named[c][0])
            for c in sorted(named) if c not in spec.clauses]
    out += ["%s is in untested.json, but is no requirement" % c for c in sorted(untested) if c not in spec.requirements]
    out += ["%s has no reason in untested.json" % c for c in sorted(untested) if not untested[c].strip()]
    out += ["%s is tried by vectors, and is in untested.json" % c for c in sorted(untested) if c in named]
    return out + ["%s is covered by no vector and not in untested.json" % c for c in spec.requirements
                  if c not in named and c not in untested]


def _short(text):
    """The beginning of a requirement, for a cell of a table."""
    text = re.sub(r"^\*\*[\d.]+\*\* ", "", text).replace("|", "\\|")
    return text if len(text) <= 90 else text[:90].rsplit(" ", 1)[0] + " ..."


def _names(names):
    shown = ", ".join(names[:MOST])
    return shown if len(names) <= MOST else "%s and %d more" % (shown, len(names) - MOST)


def table(spec, vectors, untested):
    """The text of matrix.md."""
    named = by_clause(vectors)
    counts = {}
    for vector in vectors:
        counts[vector["category"]] = counts.get(vector["category"], 0) + 1
    lines = ["# Requirements and vectors", "",
             "Made by `conformance/matrix` from [gvc.md](../spec/gvc.md), `manifest.json` and `untested.json`; not to be edited.", "",
             "%d requirements; %d vectors: %s. `4.3 ftyp` is the row of that box in the table of 4.3, `8.2(1)` the first rule of 8.2."
             % (len(spec.requirements), len(vectors), ", ".join("%d %s" % (n, c) for c, n in sorted(counts.items()))), "",
             "| requirement | begins | vectors |", "|---|---|---|"]
    for clause, text in spec.requirements.items():
        what = _names(sorted(named[clause])) if clause in named else "none: " + untested.get(clause, "not covered")
        lines.append("| %s | %s | %s |" % (clause, _short(text), what))
    return "\n".join(lines) + "\n"
