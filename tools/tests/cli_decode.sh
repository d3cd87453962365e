#!/bin/sh
# SPDX-License-Identifier: MIT
# Decoding: patterns, ranges, formats, single frames and standard output.
. "$(dirname "$0")/common.sh"

run 0 "$gvc" encode $quick --gop 2 capture -o a.gvc
run 0 "$gvc" decode -q a.gvc -o 'all/%03d.off'
present all/000.off all/001.off all/002.off
run 0 "$gvc" decode -q a.gvc --frames 1-2 -o 'some/%d.off'
absent some/0.off
same some/1.off all/001.off
same some/2.off all/002.off
run 0 "$gvc" decode -q a.gvc --frames 1- -o 'rest/%d.off'
absent rest/0.off
same rest/2.off all/002.off
run 0 "$gvc" decode -q a.gvc --frames 2 -o one.off
same one.off all/002.off
run 0 "$gvc" decode -q a.gvc --frames 2 --format off -o -
same stdout.txt all/002.off
run 0 "$gvc" decode -q a.gvc --frames 0 -o first.obj
run 0 "$gvc" decode -q a.gvc --frames 0 -o -
same stdout.txt first.obj
run 2 "$gvc" decode -q a.gvc -o -

for format in off obj ply ply-ascii; do
    ending=${format%-ascii}
    run 0 "$gvc" decode -q a.gvc --format $format -o "$format/%d.$ending"
    present $format/0.$ending $format/1.$ending $format/2.$ending
    # What is decoded is a capture that can be coded in turn; all formats hold the same meshes. Decimal coordinates
    # are read to more digits than float32, so binary PLY alone may differ in last bits.
    run 0 "$gvc" encode $quick $format -o $format.gvc
    if [ $format = ply ]; then
        run 0 "$gvc" verify ply.gvc --against off
        continue
    fi
    run 0 "$gvc" info --frames $format.gvc
    grep -o 'digest [0-9a-f]*' stdout.txt >$format.txt
    same $format.txt off.txt
done
run 0 "$gvc" decode -q a.gvc -o 'by-name/%d.ply'
same by-name/1.ply ply/1.ply
run 0 "$gvc" decode -q a.gvc --format ply --frames 0 -o no-ending
same no-ending ply/0.ply
run 0 "$gvc" decode -q a.gvc --no-output
[ ! -s stdout.txt ] || complain "--no-output wrote something"

run 0 "$gvc" decode -q a.gvc -o 'a folder/frame of %d.obj'
present 'a folder/frame of 2.obj'
cp a.gvc -- -a.gvc
run 0 "$gvc" decode -q -o 'dash/%d.obj' -- -a.gvc
present dash/0.obj
cp a.gvc 'größer.gvc'
run 0 "$gvc" decode -q 'größer.gvc' -o 'ü/%d.obj'
present ü/0.obj
run 1 "$gvc" decode -q missing.gvc -o 'x/%d.obj'
says missing.gvc 'No such file'
absent x
run 1 "$gvc" decode -q capture -o 'x/%d.obj'
says capture
run 1 "$gvc" decode -q capture/000.off -o 'x/%d.obj'
says 'not a .gvc file'

# A limit of memory: what needs more is refused before it is taken.
run 1 "$gvc" decode -q --max-memory 4K a.gvc -o 'm/%d.off'
says a.gvc 'the limit is 4096'
absent m/0.off
run 1 "$gvc" verify --max-memory 4K a.gvc
says a.gvc 'the limit is 4096'
run 0 "$gvc" decode -q --max-memory 1G a.gvc -o 'm/%d.off'
run 2 "$gvc" decode -q --max-memory 1Q a.gvc -o 'n/%d.off'
says 1Q
finish
