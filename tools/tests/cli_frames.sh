#!/bin/sh
# SPDX-License-Identifier: MIT
# Which files are taken as frames, and how each unsuitable one is refused: by name, frame and reason, status 1, without
# a trace of the output.
. "$(dirname "$0")/common.sh"

# refused WORDS... -- ARGUMENTS...: encoding the arguments must fail and say the words.
refused() {
    words=
    while [ "$1" != -- ]; do
        words="$words|$1"
        shift
    done
    shift
    run 1 "$gvc" encode $quick -o out.gvc "$@"
    absent out.gvc
    no_leftovers
    old_ifs=$IFS
    IFS='|'
    # shellcheck disable=SC2086
    set -- ${words#|}
    IFS=$old_ifs
    says "$@"
}

encodes() {
    rm -f out.gvc
    run 0 "$gvc" encode $quick -o out.gvc "$@"
    present out.gvc
    mv -f out.gvc last.gvc
}

# ------------------------------------------------------------------------------- finding the files
encodes capture
cp last.gvc reference.gvc
encodes capture/000.off capture/001.off capture/002.off
same last.gvc reference.gvc
encodes 'capture/%03d.off'
same last.gvc reference.gvc
encodes capture/
same last.gvc reference.gvc
(cd capture && "$gvc" encode $quick -o ../here.gvc '%03d.off') || complain "a pattern without folder"
same here.gvc reference.gvc

refused missing.off 'No such file' -- capture/000.off missing.off
refused none/ 'No such file' -- 'none/%d.off'
refused 'no file matches' 'capture/x%d.off' -- 'capture/x%d.off'
mkdir empty
refused empty 'no .obj, .off or .ply' -- empty
mkdir gap && cp capture/000.off capture/002.off gap
refused gap missing 'number 0 is followed by 2' -- gap
refused missing -- 'gap/%03d.off'
encodes --any-order gap
mkdir two && cp capture/000.off two/a0.off && cp capture/001.off two/b1.off
refused two 'more than one series' a0.off b1.off -- two
encodes --any-order two
refused 'out of order' 001.off 000.off -- capture/001.off capture/000.off
encodes --any-order capture/001.off capture/000.off
mkdir sorted && for i in 8 9 10; do cp capture/000.off sorted/f$i.off; done
encodes sorted
refused 'out of order' -- sorted/f10.off sorted/f8.off sorted/f9.off

# ------------------------------------------------------------------------------------ names, stdin
mkdir 'a folder' 'Füße' && cp capture/* 'a folder' && cp capture/* 'Füße'
encodes 'a folder'
same last.gvc reference.gvc
encodes 'Füße'
same last.gvc reference.gvc
cp capture/000.off ./-first.off
encodes -- -first.off
encodes ./-first.off
"$gvc" encode $quick - -o stdin.gvc <capture/000.off 2>stderr.txt || complain "a frame on stdin"
for name in stdin last; do run 0 "$gvc" decode -q -f $name.gvc -o $name.obj; done # a name is recorded, a pipe has none
same stdin.obj last.obj
long=$(printf '%0100d' 0)
mkdir "$long" && cp capture/000.off "$long/000.off" && echo OFF >"$long/001.off"
refused /001.off 'frame 1' -- "$long"

# --------------------------------------------------------------------------------------- bad meshes
# Frame 1 of three is replaced by what comes on stdin.
with_bad() {
    rm -rf bad
    cp -r capture bad
    cat >bad/001.off
}
head -c 20000 capture/001.off | with_bad
refused bad/001.off 'frame 1' line -- bad
: | with_bad
refused bad/001.off 'frame 1' -- bad
echo 'This is no mesh' | with_bad
refused bad/001.off 'frame 1' -- bad
sed '3s/.*/nan 0 0/' capture/001.off | with_bad
refused bad/001.off 'frame 1' -- bad
sed '3s/.*/1e999 0 0/' capture/001.off | with_bad
refused bad/001.off 'frame 1' -- bad
sed '$s/.*/3 0 1 999999/' capture/001.off | with_bad
refused bad/001.off 'frame 1' 999999 -- bad
printf 'OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n' | with_bad
refused bad/001.off 'frame 1' 'no faces' -- bad
tetrahedron='1 1 1\n-1 -1 1\n-1 1 -1\n1 -1 -1\n'
faces='3 0 2 1\n3 0 1 3\n3 0 3 2\n'
printf "OFF\n4 3 0\n$tetrahedron$faces" | with_bad
refused bad/001.off 'frame 1' '3 boundary edges in 1 loop' -- bad
printf "OFF\n4 4 0\n$tetrahedron${faces}3 1 3 2\n" | with_bad
refused bad/001.off 'frame 1' orient -- bad
second='3 4 6 5\n3 4 5 7\n3 4 7 6\n3 5 6 7\n'
printf "OFF\n8 8 0\n$tetrahedron${tetrahedron}${faces}3 1 2 3\n$second" | sed '7,10s/1/3/g' | with_bad
refused bad/001.off 'frame 1' -- bad
printf "OFF\n8 8 0\n${tetrahedron}9 9 9\n7 7 9\n7 9 7\n9 7 7\n${faces}3 1 2 3\n$second" | with_bad
refused bad/001.off 'frame 1' '2 components' -- bad
printf "OFF\n5 7 0\n${tetrahedron}3 3 3\n${faces}3 1 2 3\n3 0 1 4\n3 1 2 4\n3 2 0 4\n" | with_bad
refused bad/001.off 'frame 1' manifold -- bad
mkdir bad/003.off
refused 'bad/00' -- bad
finish
