#!/bin/sh
# SPDX-License-Identifier: MIT
# Damaged and cut-off files: what is told of them, and what can still be had.
. "$(dirname "$0")/common.sh"

run 0 "$gvc" encode $quick --gop 1 capture -o a.gvc
run 0 "$gvc" decode -q a.gvc -o 'good/%d.off'
size=$(wc -c <a.gvc)

# offset_of TYPE N: where the Nth box of this type begins.
offset_of() {
    LC_ALL=C grep -abo "$1" a.gvc | sed -n "${2}s/:.*//p" | {
        read -r place
        echo $((place - 4))
    }
}

# damaged OFFSET: bad.gvc is a.gvc with four bytes changed there.
damaged() {
    cp a.gvc bad.gvc
    printf '\377\377\377\377' | dd of=bad.gvc bs=1 seek="$1" conv=notrunc 2>/dev/null
}

# -------------------------------------------------------------------------- the structure of group 1
moof=$(offset_of moof 2)
damaged $((moof + 12))
run 1 "$gvc" decode -q bad.gvc -o 'd/%d.off'
says bad.gvc "byte $moof"
absent d
run 1 "$gvc" info bad.gvc
says bad.gvc byte
run 1 "$gvc" verify bad.gvc
says bad.gvc byte 'frame 1'
grep -q '2 of 3 frames good' stdout.txt || complain "verify does not count"
run 1 "$gvc" decode -q --keep-going bad.gvc -o 'd/%d.off'
says 'frame 1' '1 of 3 frames lost'
absent d/1.off
same d/0.off good/0.off
same d/2.off good/2.off
run 1 "$gvc" info --keep-going --frames --json bad.gvc
if command -v python3 >/dev/null; then
    python3 -m json.tool stdout.txt >/dev/null || complain "broken JSON of a damaged file"
fi

# ---------------------------------------------------------------------------- the structure of group 0
damaged $(($(offset_of moof 1) + 12))
run 1 "$gvc" info --keep-going --frames --json bad.gvc
if command -v python3 >/dev/null; then
    python3 -m json.tool stdout.txt >/dev/null || complain "broken JSON of a file without frame 0"
fi
run 1 "$gvc" decode -q --keep-going bad.gvc -o 'd0/%d.off'
absent d0/0.off
same d0/1.off good/1.off

# ------------------------------------------------------------------------------- a picture of group 1
end=$(offset_of moof 3)
damaged $((end - 4))
run 0 "$gvc" info bad.gvc
run 1 "$gvc" decode -q bad.gvc -o 'p/%d.off'
says bad.gvc 'frame 1' byte checksum
same p/0.off good/0.off
absent p/1.off p/2.off
run 1 "$gvc" decode -q -f --keep-going bad.gvc -o 'p/%d.off'
says 'frame 1' '1 of 3 frames lost'
absent p/1.off
same p/2.off good/2.off
run 0 "$gvc" decode -q bad.gvc --frames 2 -o p2.off
same p2.off good/2.off
run 1 "$gvc" verify bad.gvc
says 'frame 1'

# -------------------------------------------------------------------------------- verify and repair
run 1 "$gvc" verify bad.gvc
says 'fragment 2, geometry track, frame 1, byte' 'checksum of a picture'
run 0 "$gvc" repair bad.gvc -o good.gvc
says 'lost: frame 1' '2 of 3 frames saved'
run 0 "$gvc" verify good.gvc
grep -q '2 of 3 frames good, 1 lost before it was repaired' stdout.txt || complain "verify does not tell of the gap"
run 0 "$gvc" info good.gvc
grep -q 'lost *1 frames' stdout.txt || complain "info does not tell of the gap"
run 0 "$gvc" decode -q good.gvc -o 'r/%d.off'
says '1 of 3 frames were lost'
absent r/1.off
same r/0.off good/0.off
same r/2.off good/2.off
run 1 "$gvc" decode -q good.gvc --frames 1 -o r1.off
says 'frame 1' 'lost before'
absent r1.off
run 0 "$gvc" extract-exr -q good.gvc -o 'e/%d.exr'
says '1 of 3 frames were lost'
present e/0.exr e/2.exr
absent e/1.exr
run 1 "$gvc" extract-exr -q good.gvc --frames 1 -o e1.exr
says 'frame 1' 'lost before'
absent e1.exr
run 1 "$gvc" repair bad.gvc -o good.gvc
says good.gvc -f
run 1 "$gvc" repair missing.gvc -o x.gvc
says missing.gvc
absent x.gvc
run 2 "$gvc" repair bad.gvc
run 0 "$gvc" repair -q -f good.gvc -o again.gvc
same again.gvc good.gvc
damaged 100 # the head, of which there is a copy
run 1 "$gvc" verify bad.gvc
says 'head, byte 0-'
grep -q '3 of 3 frames good' stdout.txt || complain "the head is not taken from its copy"
run 0 "$gvc" repair -q -f bad.gvc -o good.gvc
same good.gvc a.gvc

# --------------------------------------------------------------------------------------- cut off
for cut in 3 $((moof + 8)) $((end - 1)) "$end" $((size - 1)); do
    head -c "$cut" a.gvc >cut.gvc
    rm -rf c
    run 1 "$gvc" info cut.gvc
    says cut.gvc
    run 1 "$gvc" decode -q cut.gvc -o 'c/%d.off'
    says cut.gvc
    absent c
    run 1 "$gvc" decode -q --keep-going cut.gvc -o 'c/%d.off'
    run 1 "$gvc" verify cut.gvc
    for frame in 0 1 2; do
        [ ! -e c/$frame.off ] || same c/$frame.off good/$frame.off
    done
done
same c/2.off good/2.off
head -c "$end" a.gvc >cut.gvc
rm -rf c
run 1 "$gvc" decode -q --keep-going cut.gvc -o 'c/%d.off'
says 'frame 2' '1 of 3 frames lost'
present c/0.off c/1.off
absent c/2.off
: >empty.gvc
run 1 "$gvc" decode -q --keep-going empty.gvc -o 'c/%d.off'
says empty.gvc
finish
