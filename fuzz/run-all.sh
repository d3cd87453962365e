#!/bin/sh
# SPDX-License-Identifier: MIT
# run-all.sh BUILD SECONDS [HARNESS...]: runs each harness of a build by oss-fuzz-build.sh (its OUT) one after the other
# for so many seconds, with the seeds, dictionary and options there, as nice as can be. What is found is kept:
# BUILD/corpus/NAME grows, BUILD/findings/NAME gets inputs that fail. Prints a line for each; exit status 1 if
# anything was found.
set -eu
[ $# -ge 2 ] || { sed -n '3,6s/^# //p' "$0" >&2; exit 2; }
source=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "$1" && pwd)
seconds=$2
shift 2
[ $# -gt 0 ] || set -- container record exr residual decode incremental mesh encode cycle
export LSAN_OPTIONS="suppressions=$source/cmake/lsan.supp:print_suppressions=0"
export ASAN_OPTIONS="allocator_may_return_null=1"
found=0
for name in "$@"; do
  corpus=$build/corpus/$name
  findings=$build/findings/$name
  mkdir -p "$corpus" "$findings"
  unzip -q -n "$build/fuzz_${name}_seed_corpus.zip" -d "$corpus"
  dictionary=$build/fuzz_$name.dict
  set -- -max_total_time="$seconds" -artifact_prefix="$findings/" -print_final_stats=1 -rss_limit_mb=4096
  [ -f "$dictionary" ] && set -- "$@" -dict="$dictionary"
  for option in max_len timeout; do
    value=$(sed -n "s/^$option = //p" "$build/fuzz_$name.options")
    set -- "$@" "-$option=$value"
    [ $option = max_len ] || set -- "$@" "-report_slow_units=$value"
  done
  nice -n 19 "$build/fuzz_$name" "$@" "$corpus" >"$build/$name.log" 2>&1 || found=1
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$name.log")
  coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$build/$name.log" | tail -n 1)
  printf '%-12s %10s runs, %6s edges, %5s inputs kept, %s findings\n' "$name" "${runs:-?}" "${coverage:-?}" \
         "$(find "$corpus" -type f | wc -l)" "$(find "$findings" -type f | wc -l)"
done
exit $found
