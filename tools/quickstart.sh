#!/bin/sh
# SPDX-License-Identifier: MIT
# quickstart.sh [FOLDER]: installs what is missing, builds gvc, makes a sample capture, encodes it, decodes it, prints
# the comparison with zipped OFF and Draco, and writes a picture. Results go to FOLDER (default build/quickstart).
set -eu
cd "$(dirname "$0")/.."
out=${1:-build/quickstart}

tools/install-dependencies.sh
cmake --preset release >/dev/null
cmake --build --preset release
gvc=build/release/tools/gvc

rm -rf "$out"
mkdir -p "$out"
echo "making a sample capture: a figure in motion, every frame with its own connectivity"
$gvc synth --frames 30 --vertices 6000 -o "$out/frames/%04d.ply"
$gvc encode "$out/frames" -o "$out/capture.gvc"
$gvc info "$out/capture.gvc"
$gvc decode "$out/capture.gvc" -o "$out/decoded/%04d.obj"
$gvc verify "$out/capture.gvc" --against "$out/frames"
$gvc compare "$out/frames"
$gvc render "$out/capture.gvc" --against "$out/frames" -o "$out/picture.png"
echo "the capture, the file, the decoded meshes and picture.png are in $out"
