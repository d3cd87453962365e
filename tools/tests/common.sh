# SPDX-License-Identifier: MIT
# common.sh: what the command-line tests share. Source it with the program and a working folder as arguments; then the
# shell is in that folder, empty but for `capture`, three small frames.
set -u
gvc=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
LC_ALL=C
export LC_ALL
failures=0

complain() {
    failures=$((failures + 1))
    printf 'FAILED: %s\n' "$*" >&2
    [ ! -s stderr.txt ] || sed 's/^/    | /' stderr.txt >&2
}

# run STATUS COMMAND...: the command must end with this status. Its output is in stdout.txt and stderr.txt.
run() {
    expected=$1
    shift
    last=$*
    "$@" >stdout.txt 2>stderr.txt </dev/null
    status=$?
    [ "$status" -eq "$expected" ] || complain "status $status instead of $expected: $last"
}

# says WORD...: the message on stderr has every WORD.
says() {
    for word; do
        grep -qF -e "$word" stderr.txt || complain "no word of '$word' from: $last"
    done
}

# absent FILE...: none of the files exists.
absent() {
    for file; do
        [ ! -e "$file" ] || complain "$file is there after: $last"
    done
}

present() {
    for file; do
        [ -s "$file" ] || complain "$file is not there after: $last"
    done
}

same() { cmp -s "$1" "$2" || complain "$1 and $2 differ after: $last"; }

# Nothing unfinished lies about.
no_leftovers() {
    left=$(find . -name '*.part*' -o -name '*.tmp-*')
    [ -z "$left" ] || complain "left behind by $last: $left"
}

finish() {
    no_leftovers
    [ "$failures" -eq 0 ] || exit 1
    cd / && rm -rf "$work"
    exit 0
}

run 0 "$gvc" synth -q --vertices 1500 --frames 3 -o 'capture/%03d.off'
quick='--size 17 --crf 30 -q'
