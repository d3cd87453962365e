#!/bin/sh
# SPDX-License-Identifier: MIT
# compare --paper: tables, JSON, CSV, plot, and what the command line can get wrong.
. "$(dirname "$0")/common.sh"

small='--size 32 --crf 20 -q'
"$gvc" synth -q --vertices 2000 --seed 0 --frames 3 -o 'other/%03d.off'

# shellcheck disable=SC2086
run 0 "$gvc" compare --paper $small capture --mixed other --paper-row samba --plot plot.svg
[ ! -s stderr.txt ] || complain "-q is not quiet: $last"
for table in 1 2 3; do
    grep -q "^Table $table\." stdout.txt || complain "no table $table from: $last"
done
grep -q 'in the paper: Samba *174 *35302' stdout.txt || complain "no row of the paper from: $last"
present plot.svg
for curve in gis fixed mixed; do
    grep -q ">$curve</text>" plot.svg || complain "no curve $curve from: $last"
done
if command -v python3 >/dev/null; then
    python3 -c 'import sys, xml.dom.minidom as d; d.parse("plot.svg")' 2>stderr.txt || complain "no XML from: $last"
fi

# A plot that is there is kept, and that is told before any work is done.
cp plot.svg before.svg
# shellcheck disable=SC2086
run 1 "$gvc" compare --paper $small --methods fixed --tables 1 capture --plot plot.svg
says plot.svg -f
same plot.svg before.svg
# shellcheck disable=SC2086
run 0 "$gvc" compare --paper $small --methods fixed --tables 1 capture --plot plot.svg -f
[ "$(grep -c '>gis</text>' plot.svg)" -eq 0 ] || complain "a curve that was not asked for: $last"
grep -q '^Table 1' stdout.txt || complain "no table 1 from: $last"
grep -q '^Table [23]' stdout.txt && complain "tables that were not asked for: $last"

# Two captures, part of each, as data. One is named after one of the paper's.
cp -r capture crane_small
# shellcheck disable=SC2086
run 0 "$gvc" compare --paper $small --frames 1-2 --methods fixed,zip --csv capture crane_small
[ "$(grep -c '^capture,fixed,2,' stdout.txt)" -eq 1 ] || complain "no row of two frames from: $last"
[ "$(grep -c '^crane_small,paper gis,173,' stdout.txt)" -eq 1 ] || complain "no row of the paper from: $last"
[ "$(awk -F, '{ print NF }' stdout.txt | sort -u | wc -l)" -eq 1 ] || complain "ragged rows from: $last"
# shellcheck disable=SC2086
run 0 "$gvc" compare --paper $small --methods fixed --tables 3 --json capture/000.off capture/001.off
if command -v python3 >/dev/null; then
    python3 -c 'import json
made = json.load(open("stdout.txt"))["captures"]
assert len(made) == 1 and made[0]["name"] == "capture" and made[0]["frames"] == 2
fixed = made[0]["fixed"]
assert abs(3 * fixed["mse_per_component"] - fixed["mse_summed"]) < 1e-6 * fixed["mse_summed"]
assert fixed["bytes"] > 0 and made[0]["gis"] is None' 2>stderr.txt || complain "wrong figures from: $last"
fi

# Mistakes.
for option in '--tables 4' '--methods draco' '--paper-row moonwalk' '--size 15' '--crf 52' '--gop 0' '--frames 3-9' \
    '--qp 8' '-e 1%' '--mixed other --mixed other' '--json --csv'; do
    # shellcheck disable=SC2086
    run 2 "$gvc" compare --paper -q $option capture
    [ ! -s stdout.txt ] || complain "a complaint is on stdout: $last"
done
for option in '--mixed other' '--plot p.svg' '--tables 1' '--frames 0' '--size 32' '--crf 9' '--gop 2' '--paper-row lock'; do
    # shellcheck disable=SC2086
    run 2 "$gvc" compare -q $option capture
    says --paper
done
absent p.svg
run 1 "$gvc" compare --paper -q missing
says missing
run 1 "$gvc" compare --paper -q --mixed missing --methods mixed capture
says missing
# A frame that is no closed surface is named, by file and by its number in the capture.
mkdir open
cp capture/000.off open/000.off
printf 'OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n' >open/001.off
# shellcheck disable=SC2086
run 1 "$gvc" compare --paper $small --frames 1 --plot p.svg open
says open/001.off 'frame 1'
absent p.svg
finish
