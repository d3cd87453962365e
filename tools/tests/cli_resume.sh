#!/bin/sh
# SPDX-License-Identifier: MIT
# cli_resume.sh GVC WORK [KILLS [SEED [FRAMES]]]: an encode that is killed at any moment loses nothing that was finished, and
# --resume goes on to the same bytes as an undisturbed run.
kills=${3:-1}
frames_in=${5:-4}
seed=${4:-$(awk 'BEGIN { srand(); print int(65536 * rand()) }')}
. "$(dirname "$0")/common.sh"
echo "seed $seed, $kills kills"

run 0 "$gvc" synth -q --vertices 1500 --frames "$frames_in" --seed 3 -o 'long/%03d.off'
gop=2
[ "$frames_in" -lt 12 ] || gop=3
options="-q -j1 --size 17 --crf 30 --gop $gop"
began=$(date +%s%N)
run 0 "$gvc" encode $options long -o whole.gvc
took=$(($(date +%s%N) - began))
no_leftovers
run 0 "$gvc" decode -q whole.gvc -o 'whole/%02d.off'

# killed SECONDS ARGUMENT...: an encode that is killed after so long, or ends before.
killed() {
    delay=$1
    shift
    "$gvc" encode $options "$@" long -o k.gvc >stdout.txt 2>stderr.txt </dev/null &
    child=$!
    sleep "$delay"
    kill -KILL "$child" 2>/dev/null
    wait "$child" 2>/dev/null
    last="encode killed after $delay s"
}

# What the partial file holds can be had, and is right.
check_partial() {
    [ -s k.gvc.part ] || return
    rm -rf d fixed.gvc
    "$gvc" decode -q --keep-going k.gvc.part -o 'd/%02d.off' >stdout.txt 2>stderr.txt
    finished=$(grep -c '^group' k.gvc.part-journal)
    frames=$(ls d | wc -l)
    echo "$last: $finished groups, $frames frames"
    least=$((finished * gop))
    [ $least -le "$frames_in" ] || least=$frames_in
    [ "$frames" -ge $least ] || complain "$finished groups but $frames frames: $last"
    for file in d/*; do [ ! -e "$file" ] || same "$file" "whole/${file#d/}"; done
    [ "$frames" -eq 0 ] || {
        run 0 "$gvc" repair -q k.gvc.part -o fixed.gvc
        run 0 "$gvc" verify fixed.gvc
    }
}

i=0
while [ $i -lt "$kills" ]; do
    i=$((i + 1))
    rm -rf k.gvc k.gvc.part* d
    delay=$(awk "BEGIN { srand($seed + $i); print rand() * $took / 1e9 }")
    killed "$delay"
    check_partial
    if [ $((i % 2)) -eq 0 ]; then # a run that resumes may be killed, too
        killed "$delay" --resume -f
        check_partial
    fi
    run 0 "$gvc" encode $options --resume -f long -o k.gvc
    same k.gvc whole.gvc
    no_leftovers
done

# Cut anywhere, as by a disk that lost what was written last: what is whole is taken, the rest is made anew.
# The limit leaves room for all groups but not for the index, nor for a checkpoint.
limit=$((($(wc -c <whole.gvc) - 1) / 512))
(ulimit -f $limit && exec "$gvc" encode $options long -o cut.gvc) >stdout.txt 2>stderr.txt
last='encode to a full disk'
says 'cannot write' cut.gvc.part
present cut.gvc.part cut.gvc.part-journal
absent cut.gvc
run 1 "$gvc" encode $options long -o cut.gvc
says cut.gvc.part --resume -f
cp cut.gvc.part full-part
cp cut.gvc.part-journal full-journal
absent cut.gvc.part-state
size=$(wc -c <full-part)
for cut in 700 $((size - 1)); do
    rm -f cut.gvc
    head -c "$cut" full-part >cut.gvc.part
    cp full-journal cut.gvc.part-journal
    run 0 "$gvc" encode $options --resume long -o cut.gvc
    same cut.gvc whole.gvc
    no_leftovers
done
for cut in $(($(wc -c <full-journal) - 7)); do
    rm -f cut.gvc
    cp full-part cut.gvc.part
    head -c "$cut" full-journal >cut.gvc.part-journal
    run 0 "$gvc" encode $options --resume long -o cut.gvc
    same cut.gvc whole.gvc
done

# ---------------------------------------------------------------------------- what cannot be resumed
restore() {
    rm -f cut.gvc
    cp full-part cut.gvc.part
    cp full-journal cut.gvc.part-journal
}
restore
run 2 "$gvc" encode $options --gop 5 --resume long -o cut.gvc
says 'cannot resume' gop=$gop gop=5
same cut.gvc.part full-part
cp long/002.off kept.off
cp long/003.off long/002.off
run 2 "$gvc" encode $options --resume long -o cut.gvc
says 'cannot resume' frames
same cut.gvc.part full-part
same cut.gvc.part-journal full-journal
mv kept.off long/002.off
run 2 "$gvc" encode $options --resume long -o -
says 'only a file'

# Two runs do not write the same file.
"$gvc" encode $options --resume long -o cut.gvc >/dev/null 2>&1 </dev/null &
child=$!
sleep 0.2
run 1 "$gvc" encode $options --resume long -o cut.gvc
says 'another run'
run 1 "$gvc" encode $options -f long -o cut.gvc
says 'another run'
wait "$child" || complain "a run that went on fails while another tries to"
same cut.gvc whole.gvc

# -f drops what is left, and --resume with nothing left begins.
restore
run 0 "$gvc" encode $options -f long -o cut.gvc
same cut.gvc whole.gvc
run 0 "$gvc" encode $options --resume long -o new.gvc
same new.gvc whole.gvc
finish
