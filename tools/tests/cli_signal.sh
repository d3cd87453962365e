#!/bin/sh
# SPDX-License-Identifier: MIT
# An encode that is interrupted ends with status 1 and leaves nothing behind but groups that are finished.
. "$(dirname "$0")/common.sh"

# A capture that takes a few seconds.
mkdir long
for i in 0 1 2 3 4 5 6 7 8 9; do
    for j in 0 1 2 3 4 5 6 7 8 9; do cp capture/00$((j % 3)).off long/$i$j.off; done
done
for signal in INT TERM; do
    # A shell starts background jobs with SIGINT ignored; the program catches it all the same.
    "$gvc" encode -j1 --size 33 --gop 4 long -o out.gvc >stdout.txt 2>stderr.txt </dev/null &
    child=$!
    last="SIG$signal during encode"
    sleep 1
    kill -$signal "$child" || complain "the encode had ended already"
    wait "$child"
    status=$?
    [ "$status" -eq 1 ] || complain "status $status instead of 1: $last"
    says cancelled
    absent out.gvc
    if [ -e out.gvc.part ]; then # a group was finished
        says out.gvc.part --resume
        rm -f out.gvc.part out.gvc.part-journal out.gvc.part-state
    fi
    no_leftovers
done

# A reader that goes away is a write error, not a death by SIGPIPE.
{
    "$gvc" encode $quick capture -o - 2>stderr.txt
    echo $? >status.txt
} | true
last="encode to a closed pipe"
[ "$(cat status.txt)" -eq 1 ] || complain "status $(cat status.txt) instead of 1: $last"
says 'standard output'
finish
