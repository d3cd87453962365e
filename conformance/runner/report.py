# SPDX-License-Identifier: MIT
"""Prints how a decoder did: a table by feature, then what failed."""


def _table(vectors, results, out):
    """Passed, failed and skipped vectors of each category and feature."""
    by_name = {r.vector["name"]: r for r in results}
    rows = {}
    for vector in vectors:
        result = by_name.get(vector["name"])
        column = 2 if result is None else 1 if result.failures else 0
        for key in ["%s, all" % vector["category"]] + ["%s, %s" % (vector["category"], f) for f in vector["features"]]:
            rows.setdefault(key, [0, 0, 0])[column] += 1
    width = max([len(k) for k in rows], default=0)
    print("%-*s  passed  failed  skipped" % (width, "feature"), file=out)
    for key in sorted(rows):
        print("%-*s  %6d  %6d  %7d" % (width, key, *rows[key]), file=out)


def show(vectors, results, problems, args, out):
    """Prints everything and gives the exit status."""
    _table(vectors, results, out)
    failed = [r for r in results if r.failures]
    for result in results:
        if args.verbose and not result.failures:
            print("passed  %s" % result.vector["name"], file=out)
    for problem in problems:
        print("SET     %s" % problem, file=out)
    for result in failed:
        print("FAILED  %s: %s\n        (%s)" % (result.vector["name"], "; ".join(result.failures),
                                                result.vector["about"]), file=out)
    lost = {}
    for result in results:
        for name in result.skipped:
            lost.setdefault(name, []).append(result.vector["name"])
    for name, names in lost.items():
        print("SKIPPED %d checks that need --%s: %s%s" % (len(names), name, ", ".join(names[:3]),
                                                          ", ..." if len(names) > 3 else ""), file=out)
    skipped = len(vectors) - len(results)
    if skipped:
        print("SKIPPED %d of %d vectors" % (skipped, len(vectors)), file=out)
    print("%d vectors: %d passed, %d failed, %d skipped, %d problems of the set"
          % (len(vectors), len(results) - len(failed), len(failed), skipped, len(problems)), file=out)
    if failed or problems:
        return 1
    return 3 if skipped or lost else 0
