#!/bin/sh
# SPDX-License-Identifier: MIT
# The manual pages: every option the program tells of is in gvc(1), every option there exists, and both pages are sound.
pages=$(cd "$(dirname "$0")/../../docs/man" && pwd)
. "$(dirname "$0")/common.sh"

: >told.txt
for command in encode decode info verify repair extract-exr compare synth render; do
    run 0 "$gvc" "$command" --help
    grep -oE -e '--[a-z][a-z-]+' stdout.txt >>told.txt
    grep -q "^\.Ss gvc $command\$" "$pages/gvc.1" || complain "gvc(1) has no section on $command"
done
run 0 "$gvc" --help
grep -oE -e '--[a-z][a-z-]+' stdout.txt >>told.txt
echo --version >>told.txt
sort -u told.txt >help.txt
grep -E '^\.(It|Nm|Op|Cm|Fl|Pq)? ?.*Fl ' "$pages/gvc.1" | grep -oE 'Fl -[a-z-]+|[,|] -[a-z-]+' | sed 's/^.* -/--/' | sort -u >manual.txt
comm -23 help.txt manual.txt >missing.txt
comm -13 help.txt manual.txt >unknown.txt
[ ! -s missing.txt ] || complain "not in gvc(1): $(tr '\n' ' ' <missing.txt)"
[ ! -s unknown.txt ] || complain "in gvc(1), but not in --help: $(tr '\n' ' ' <unknown.txt)"
[ "$(wc -l <help.txt)" -gt 40 ] || complain "the options were not found"

if command -v mandoc >/dev/null; then
    mandoc -T lint -W warning "$pages/gvc.1" "$pages/gvc.5" >lint.txt || complain "$(cat lint.txt)"
fi
finish
