#!/bin/sh
# SPDX-License-Identifier: MIT
# Exit status 0 for help, 2 for what the command line gets wrong, and where each goes.
. "$(dirname "$0")/common.sh"

for command in encode decode info verify compare synth render; do
    run 0 "$gvc" "$command" --help
    grep -q "usage: gvc $command" stdout.txt || complain "no help on stdout: $last"
    [ ! -s stderr.txt ] || complain "help is on stderr: $last"
    run 2 "$gvc" "$command" --no-such-option
    says "gvc $command --help"
    [ ! -s stdout.txt ] || complain "a complaint is on stdout: $last"
    run 2 "$gvc" "$command"
    says "gvc $command"
done

run 0 "$gvc" --help
grep -q encode stdout.txt || complain "gvc --help does not name its commands"
run 0 "$gvc" --version
run 2 "$gvc"
run 2 "$gvc" dance
says dance

run 2 "$gvc" encode capture
says -o
for option in '--size 15' '--size 2050' '--size x' '--crf 52' '--crf -13' '--crf nan' '--gop 0' '--rate 0' '--rate x' \
    '-e 0' '-e -1%' '-e 5x' '-j -1' '-j 1000' '--unit 0123456789abcdef' '--persistence 2' '--prior -1'; do
    # shellcheck disable=SC2086
    run 2 "$gvc" encode capture -o out.gvc $option
    absent out.gvc
done
run 0 "$gvc" encode $quick capture -o c.gvc
run 2 "$gvc" decode c.gvc
run 2 "$gvc" decode c.gvc -o one.obj
says '%d'
for pattern in 'd/%s.obj' 'd/%d-%d.obj' 'd/%.3d.obj' 'd/%'; do
    run 2 "$gvc" decode c.gvc -o "$pattern"
done
absent d
run 2 "$gvc" decode c.gvc -o 'd/%d.obj' --format stl
for range in 3 2-5 2-1 -1 x 1-x ''; do
    run 2 "$gvc" decode c.gvc -o 'd/%d.obj' --frames "$range"
done
absent d
run 2 "$gvc" decode c.gvc c.gvc -o 'd/%d.obj'
run 2 "$gvc" info c.gvc c.gvc
run 2 "$gvc" verify c.gvc capture
run 2 "$gvc" verify c.gvc --against
run 2 "$gvc" synth -o plain.off
run 2 "$gvc" synth -o 's/%d.off' --vertices 10
run 2 "$gvc" synth -o 's/%d.off' --genus 5
run 2 "$gvc" synth -o 's/%d.off' extra
run 2 "$gvc" compare --json --csv capture
run 2 "$gvc" compare --methods paper capture
run 2 "$gvc" compare --methods draco --qp 0 capture
run 2 "$gvc" compare --methods gvc -e 0 capture
finish
