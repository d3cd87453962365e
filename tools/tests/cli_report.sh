#!/bin/sh
# SPDX-License-Identifier: MIT
# info, verify and compare: what they print can be read by programs.
. "$(dirname "$0")/common.sh"

is_json() {
    command -v python3 >/dev/null || return 0
    python3 -m json.tool stdout.txt >/dev/null 2>stderr.txt || complain "no JSON from: $last"
}

run 0 "$gvc" encode $quick --gop 2 --unit mm -r 29.97 capture -o 'a "quoted" name.gvc'
mv 'a "quoted" name.gvc' a.gvc
run 0 "$gvc" info a.gvc
grep -q 'frames *3 at 29.97' stdout.txt || complain "info does not tell the frame rate"
grep -q 'unit *mm' stdout.txt || complain "info does not tell the unit"
grep -q '17 x 17' stdout.txt || complain "info does not tell the size"
run 0 "$gvc" info --frames a.gvc
[ "$(grep -c digest stdout.txt)" -eq 3 ] || complain "info --frames does not list three"
cp a.gvc 'a "quoted" \name.gvc'
run 0 "$gvc" info --json 'a "quoted" \name.gvc'
is_json
grep -q '"frames": 3' stdout.txt || complain "no count of frames in: $last"
# Names that are no UTF-8: a stray byte, an overlong slash, a surrogate, a character cut short.
for name in 'a\377b' 'a\300\257b' 'a\355\240\200b' 'a\342\202'; do
    name=$(printf "$name.gvc")
    cp a.gvc "$name" 2>/dev/null || continue # not all file systems take them
    run 0 "$gvc" info --json "$name"
    is_json
    grep -q "$(printf '"a\357\277\275')" stdout.txt || complain "no U+FFFD from: $last"
done
run 0 "$gvc" info --json --frames a.gvc
is_json
[ "$(grep -c '"digest"' stdout.txt)" -eq 3 ] || complain "three frames expected from: $last"

# The digest is of all bytes but the last 64, for any program to check.
if command -v sha256sum >/dev/null; then
    run 0 "$gvc" info a.gvc
    digest=$(head -c $(($(wc -c <a.gvc) - 64)) a.gvc | sha256sum | cut -d ' ' -f 1)
    grep -q "SHA-256 *$digest" stdout.txt || complain "the digest of the file is not $digest"
    run 0 "$gvc" info --json a.gvc
    grep -q "\"sha256\": \"$digest\"" stdout.txt || complain "no digest in: $last"
fi

run 0 "$gvc" verify a.gvc
grep -q '3 of 3 frames good' stdout.txt || complain "verify does not count"
run 0 "$gvc" verify -q a.gvc
[ ! -s stdout.txt ] || complain "verify -q says something of a good file"
run 0 "$gvc" verify a.gvc --against capture
grep -q Hausdorff stdout.txt || complain "verify --against does not measure"
run 1 "$gvc" verify a.gvc --against capture/000.off
says '3 frames'
run 1 "$gvc" verify a.gvc --against missing
says missing
run 1 "$gvc" verify missing.gvc
says missing.gvc
run 1 "$gvc" info missing.gvc
says missing.gvc

for format in json csv; do
    run 0 "$gvc" compare -q --$format --qp 8 -e 1% capture/000.off capture/001.off
    [ ! -s stderr.txt ] || complain "-q is not quiet: $last"
    [ "$format" = csv ] || is_json
    for method in zip draco gvc; do
        grep -qi "$method" stdout.txt || complain "no row of $method from: $last"
    done
done
[ "$(wc -l <stdout.txt)" -eq 4 ] || complain "a head and three rows expected from: $last"
[ "$(awk -F, '{ print NF }' stdout.txt | sort -u | wc -l)" -eq 1 ] || complain "ragged rows from: $last"
run 1 "$gvc" compare -q --methods zip missing
says missing
finish
