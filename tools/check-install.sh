#!/bin/sh
# SPDX-License-Identifier: MIT
# check-install.sh: installs the dev build into build/prefix and builds the example against it, by CMake package and by
# pkg-config, then runs it on a file the installed gvc makes.
set -eu
cd "$(dirname "$0")/.."
prefix=$PWD/build/prefix
work=$PWD/build/example
rm -rf "$prefix" "$work"
cmake --install build/dev --prefix "$prefix" >/dev/null
library=$(dirname "$(find "$prefix" -name 'libgvc.so')")
test -s "$prefix/share/man/man1/gvc.1" && test -s "$prefix/share/man/man5/gvc.5"
export LD_LIBRARY_PATH="$library"

cmake -S tools/example -B "$work/cmake" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >/dev/null
cmake --build "$work/cmake"
sed -i "s|^prefix=.*|prefix=$prefix|" "$library/pkgconfig/gvc.pc"
cc -std=c11 -Wall -Wextra -Werror tools/example/first_frame.c -o "$work/by_pkgconfig" \
  $(PKG_CONFIG_PATH="$library/pkgconfig" pkg-config --cflags --libs gvc)

"$prefix/bin/gvc" synth --frames 3 --vertices 2000 -o "$work/frames/%04d.ply" -q
"$prefix/bin/gvc" encode "$work/frames" -o "$work/sample.gvc" -q
for program in "$work/cmake/first_frame" "$work/by_pkgconfig"; do
  "$program" "$work/sample.gvc" "$work/first.ply"
  test -s "$work/first.ply"
  rm "$work/first.ply"
done
