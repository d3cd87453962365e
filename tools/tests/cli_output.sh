#!/bin/sh
# SPDX-License-Identifier: MIT
# Output appears whole under its name or not at all; what is there is not replaced without -f.
. "$(dirname "$0")/common.sh"

run 0 "$gvc" encode $quick capture -o a.gvc
present a.gvc
run 0 "$gvc" encode $quick capture -o j1.gvc -j1
same j1.gvc a.gvc
run 0 "$gvc" encode $quick capture -o j2.gvc -j2
same j2.gvc a.gvc
run 0 "$gvc" encode $quick capture -o -
same stdout.txt a.gvc
run 0 "$gvc" encode $quick capture -o - -f
same stdout.txt a.gvc

# ------------------------------------------------------------------------------ what is there stays
echo precious >kept.gvc
cp kept.gvc copy
run 1 "$gvc" encode $quick capture -o kept.gvc
says kept.gvc -f
same kept.gvc copy
no_leftovers
run 1 "$gvc" encode $quick -f missing.off -o kept.gvc
same kept.gvc copy
run 0 "$gvc" encode $quick -f capture -o kept.gvc
same kept.gvc a.gvc
ln -s nowhere dangling.gvc
run 1 "$gvc" encode $quick capture -o dangling.gvc
absent nowhere
mkdir folder.gvc
run 1 "$gvc" encode $quick capture -o folder.gvc
says folder.gvc
run 1 "$gvc" encode $quick -f capture -o folder.gvc
says folder.gvc
[ -d folder.gvc ] || complain "a folder was replaced"
run 1 "$gvc" encode $quick capture -o none/a.gvc
says none/a.gvc

run 0 "$gvc" decode -q a.gvc -o 'd/%d.obj'
present d/0.obj d/1.obj d/2.obj
rm d/1.obj
cp d/2.obj copy
run 1 "$gvc" decode -q a.gvc -o 'd/%d.obj'
says d/0.obj
absent d/1.obj
rm d/0.obj
run 1 "$gvc" decode -q a.gvc -o 'd/%d.obj'
says d/2.obj
absent d/0.obj d/1.obj
run 0 "$gvc" decode -q -f a.gvc -o 'd/%d.obj'
present d/0.obj d/1.obj
same d/2.obj copy

cp capture/001.off copy
run 1 "$gvc" synth -q --vertices 1500 --frames 4 --seed 5 -o 'capture/%03d.off'
says 000.off
absent capture/003.off
same capture/001.off copy
run 0 "$gvc" synth -q --vertices 1500 --frames 1 --seed 5 -f -o 'capture/%03d.off'

# ---------------------------------------------------------------------------------------- full disk
# limited BLOCKS COMMAND...: with files of at most so many blocks of 512 bytes.
limited() {
    blocks=$1
    shift
    (ulimit -f "$blocks" && exec "$@")
}
run 1 limited 2 "$gvc" encode $quick capture -o full.gvc
says full.gvc 'cannot write'
absent full.gvc
no_leftovers
run 1 limited 2 "$gvc" decode -q a.gvc -o 'full/%d.obj'
says full/0.obj 'cannot write'
absent full/0.obj
no_leftovers
run 1 limited 2 "$gvc" synth -q --vertices 1500 --frames 1 -o 'full/%d.off'
says full/0.off 'cannot write'
absent full/0.off
no_leftovers
if [ -c /dev/full ]; then
    ln -s /dev/full full.gvc
    run 1 "$gvc" encode $quick capture -o full.gvc
    says full.gvc 'cannot write'
    run 1 "$gvc" encode $quick -f capture -o full.gvc
    says full.gvc 'cannot write'
    [ -c full.gvc ] || complain "a device was replaced by a file"
    for arguments in 'encode -q --size 17 --crf 30 capture -o -' 'decode -q a.gvc --frames 1 -o -' 'info a.gvc' \
        'info --json a.gvc' 'verify a.gvc' 'encode --help' '--help'; do
        # shellcheck disable=SC2086
        "$gvc" $arguments >/dev/full 2>stderr.txt
        status=$?
        last="gvc $arguments >/dev/full"
        [ "$status" -eq 1 ] || complain "status $status instead of 1: $last"
        says 'standard output'
    done
fi
ln -s /dev/null null.gvc
run 0 "$gvc" encode $quick -f capture -o null.gvc
[ -c null.gvc ] || complain "a device was replaced by a file"
finish
