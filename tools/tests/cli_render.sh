#!/bin/sh
# SPDX-License-Identifier: MIT
# Pictures: the three kinds, which frames they show, and that a file is there whole or not at all.
. "$(dirname "$0")/common.sh"

# picture FILE: it is a whole PNG.
picture() {
    present "$1"
    [ "$(head -c 4 "$1" | tail -c 3)" = PNG ] || complain "$1 is no PNG after: $last"
    tail -c 12 "$1" | grep -q IEND || complain "$1 is cut off after: $last"
}

# pixels FILE: width and height, as hexadecimal digits.
pixels() { dd if="$1" bs=1 skip=16 count=8 2>/dev/null | od -An -tx1 | tr -d ' \n'; }

render="$gvc render -q --size 64"
run 0 "$gvc" encode $quick capture -o a.gvc

# --------------------------------------------------------------------------------- surfaces and graphs
run 0 $render capture --frames 0,2 -o graph.png
picture graph.png
run 0 $render -j 1 capture --frames 0,2 -o again.png
same graph.png again.png
run 0 $render --no-graph capture --frames 0,2 -o plain.png
picture plain.png
if cmp -s graph.png plain.png; then complain "the graph is not drawn"; fi
run 0 $render --ambiguity capture --frames 0,2 -o ambiguity.png
picture ambiguity.png
if cmp -s graph.png ambiguity.png; then complain "the ambiguity is not drawn"; fi
run 2 $render --ambiguity --no-graph capture -o ambiguity.png
run 0 $render --no-graph capture --frames 0- -o three.png
run 0 $render --no-graph capture --frames 2,1,0-2/2 -o list.png
same list.png three.png
run 0 $render --no-graph capture -o usual.png
same usual.png three.png
run 0 $render --no-graph capture --frames 0-2/2 -o second.png
same second.png plain.png
run 0 $render --no-graph capture --frames 1 --view 90,0 --up z -o turned.png
run 2 "$gvc" render capture --frames 1-2
says -o
run 0 "$gvc" render --size 64 capture --frames 1 -o said.png
says 'frame 0 begins a segment'

# An open surface has no cut graph, but can be seen.
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >open.off
run 1 $render open.off -o open.png
says open.off --no-graph
absent open.png
run 0 $render --no-graph open.off -o open.png
picture open.png

# ------------------------------------------------------------------------------------------- a file
run 0 $render a.gvc -o images.png
picture images.png
cp a.gvc renamed
run 0 $render renamed --frames 0 -o images0.png
[ "$(pixels images0.png)" != "$(pixels images.png)" ] || complain "--frames is ignored"
run 0 $render a.gvc --against capture -o both.png
picture both.png
run 1 $render a.gvc --against capture/000.off -o less.png
says 'the file has 3 frames, the capture 1'
head -c $(($(wc -c <a.gvc) / 2)) a.gvc >cut.gvc
run 1 $render cut.gvc -o cut.png
says cut.gvc
absent less.png cut.png

# ------------------------------------------------------------------------------------------- output
run 1 $render a.gvc -o images.png
says images.png -f
run 0 $render -f a.gvc -o images.png
run 0 $render a.gvc -o -
same stdout.txt images.png
run 1 $render a.gvc -o missing/picture.png
says missing/picture.png

# -------------------------------------------------------------------------------------------- usage
for option in '--frames 3' '--frames 0,' '--frames 0/0' '--frames 2-1' '--size 10' '--size x' '--view 1' \
    '--view 1,2,3' '--view nan,0' '--view 0,91' '--up w' '--up xy' '-j 1000'; do
    # shellcheck disable=SC2086
    run 2 $render a.gvc -o out.png $option
done
run 2 $render a.gvc -o out.jpg
says .png
run 2 $render a.gvc capture -o out.png
says --against
run 2 $render --against a.gvc -o out.png
absent out.png out.jpg
finish
