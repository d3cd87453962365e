#!/bin/sh
# SPDX-License-Identifier: MIT
# Lossless files: with and without preview, out to OpenEXR and back.
. "$(dirname "$0")/common.sh"
exact='--lossless --size 20 --gop 2 -q'

run 0 "$gvc" encode $exact capture -o a.gvc
run 0 "$gvc" verify a.gvc --against capture
run 0 "$gvc" info a.gvc
grep -q 'profile *lossless, level 1$' stdout.txt || complain "no profile in: $last"
grep -q 'track *exact, [1-9]' stdout.txt || complain "no bytes of the exact track in: $last"
grep -q 'H.264' stdout.txt && complain "a track of video in: $last"
run 0 "$gvc" info --json a.gvc
grep -q '"profile": "lossless"' stdout.txt || complain "no profile in: $last"
run 2 "$gvc" decode -q --preview a.gvc -o 'x/%d.off'
says 'no preview'
absent x/0.off

run 0 "$gvc" encode $exact --with-preview --crf 30 capture -o b.gvc
run 0 "$gvc" info b.gvc
grep -q 'profile *lossless with preview' stdout.txt || complain "no profile in: $last"
run 0 "$gvc" verify b.gvc
grep -q '3 of 3 frames good' stdout.txt || complain "frames not checked by: $last"
grep -q '3 of 3 previews good' stdout.txt || complain "previews not checked by: $last"
run 0 "$gvc" decode -q a.gvc -o 'a/%d.off'
run 0 "$gvc" decode -q b.gvc -o 'b/%d.off'
run 0 "$gvc" decode -q --preview b.gvc -o 'p/%d.off'
same a/0.off b/0.off
same a/2.off b/2.off
cmp -s p/2.off b/2.off && complain "the preview is no preview"

# Out and back: the same bytes.
run 0 "$gvc" extract-exr -q a.gvc -o 'exr/%03d.exr'
present exr/000.exr exr/001.exr exr/002.exr
run 0 "$gvc" encode -q --from-exr exr -o back.gvc
same back.gvc a.gvc
run 0 "$gvc" encode -q --from-exr 'exr/%03d.exr' -o - -j 1
same stdout.txt a.gvc
run 0 "$gvc" extract-exr -q b.gvc -o 'exr-b/%03d.exr'
run 0 "$gvc" encode -q --from-exr exr-b -o back-b.gvc
run 0 "$gvc" decode -q back-b.gvc -o 'back-b/%d.off'
same back-b/1.off a/1.off
run 0 "$gvc" extract-exr -q --keyframes a.gvc -o 'key/%d.exr'
present key/0.exr key/2.exr
absent key/1.exr
same key/2.exr exr/002.exr
run 1 "$gvc" encode -q --from-exr key -o key.gvc
says 'frames are missing'
run 0 "$gvc" encode -q --from-exr --any-order key -o key.gvc
run 0 "$gvc" decode -q key.gvc --frames 1 -o second.off
same second.off a/2.off
run 0 "$gvc" extract-exr -q --preview b.gvc --frames 2 -o p.exr
run 0 "$gvc" encode -q --from-exr p.exr -o p.gvc
run 0 "$gvc" decode -q p.gvc -o p.off
same p.off p/2.off

# What cannot be.
run 1 "$gvc" extract-exr -q a.gvc -o 'exr/%03d.exr'
says 'not overwritten'
run 2 "$gvc" extract-exr -q a.gvc -o plain.exr
run 2 "$gvc" encode --with-preview capture -o no.gvc
run 2 "$gvc" encode --lossless --crf 20 capture -o no.gvc
run 2 "$gvc" encode --from-exr --size 20 exr -o no.gvc
run 1 "$gvc" encode -q --from-exr capture/000.off -o no.gvc
says 000.off 'no OpenEXR file'
run 1 "$gvc" encode -q --from-exr capture -o no.gvc
says '.exr'
dd if=a.gvc of=inner.exr bs=1 skip="$(grep -abo 'v/1' a.gvc | head -1 | cut -d: -f1)" 2>/dev/null
run 1 "$gvc" encode -q --from-exr inner.exr -o no.gvc
says inner.exr gvcConfig
head -c 3000 exr/000.exr >cut.exr
run 1 "$gvc" encode -q --from-exr cut.exr -o no.gvc
says cut.exr
run 0 "$gvc" encode $exact --size 24 capture -o other.gvc
run 0 "$gvc" extract-exr -q other.gvc --frames 0 -o other.exr
run 1 "$gvc" encode -q --any-order --from-exr exr/000.exr other.exr -o no.gvc
says other.exr 'another file'
absent no.gvc

# Beside other ways to keep the same codes.
run 0 "$gvc" compare -q --lossless --size 20 --gop 2 --csv capture
for method in 'gvc lossless' 'before rounding' 'OpenEXR, PIZ' 'zstd -19 of codes' 'xz -9 of codes' 'draco qp 16' 'zip -9'; do
    grep -qF "$method" stdout.txt || complain "no line of '$method' from: $last"
done
cut -d, -f2,3 stdout.txt | grep -q "3,$(($(wc -c <a.gvc) / 3))" || complain "not the bytes of a.gvc: $last"
run 2 "$gvc" compare -q --lossless --paper capture
run 2 "$gvc" compare -q --lossless --qp 9 capture
run 2 "$gvc" compare -q --size 20 capture
finish
