#!/bin/bash -eu
# SPDX-License-Identifier: MIT
# oss-fuzz-build.sh: the build of an OSS-Fuzz project, with the variables that its builders set: CC, CXX, CFLAGS,
# CXXFLAGS, LIB_FUZZING_ENGINE, SRC (gvc is in $SRC/gvc, or is where this script is), OUT. Each harness NAME comes
# out as fuzz_NAME with fuzz_NAME_seed_corpus.zip, fuzz_NAME.dict and fuzz_NAME.options. Without the variables it
# builds with clang and libFuzzer to build/oss-fuzz.
here=$(cd "$(dirname "$0")" && pwd)
source=$(dirname "$here")
[ -n "${SRC:-}" ] && [ -d "$SRC/gvc" ] && source=$SRC/gvc
: "${CC:=clang}" "${CXX:=clang++}" "${LIB_FUZZING_ENGINE:=-fsanitize=fuzzer}"
: "${CFLAGS:=-O2 -g -fno-omit-frame-pointer -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=all}"
: "${CXXFLAGS:=$CFLAGS}" "${OUT:=$source/build/oss-fuzz}" "${WORK:=$source/build/oss-fuzz-work}"
export CC CXX CFLAGS CXXFLAGS
mkdir -p "$OUT" "$WORK"

cmake -S "$source" -B "$WORK" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DGVC_FUZZ=ON -DGVC_TOOLS=OFF -DGVC_TESTS=OFF \
      "-DGVC_FUZZING_ENGINE=$LIB_FUZZING_ENGINE"
cmake --build "$WORK" --target fuzz/all
# Seeds are made by programs that leak what x264 leaks.
LSAN_OPTIONS=suppressions=$source/cmake/lsan.supp cmake --build "$WORK" --target fuzz_seeds

for harness in container record exr residual decode incremental mesh encode cycle; do
  cp "$WORK/fuzz/fuzz_$harness" "$OUT/"
  case $harness in
    container) seeds="container file" ;;
    decode | incremental | cycle) seeds=file ;;
    *) seeds=$harness ;;
  esac
  corpus=$(mktemp -d)
  for folder in $seeds; do cp "$WORK/fuzz/seeds/$folder/"* "$corpus/"; done
  [ -d "$source/fuzz/corpus/$harness" ] && cp "$source/fuzz/corpus/$harness/"* "$corpus/"
  rm -f "$OUT/fuzz_${harness}_seed_corpus.zip"
  (cd "$corpus" && zip -q "$OUT/fuzz_${harness}_seed_corpus.zip" ./*)
  rm -r "$corpus"
  dictionary=gvc
  [ $harness = mesh ] && dictionary=mesh
  [ $harness = encode ] || cp "$source/fuzz/$dictionary.dict" "$OUT/fuzz_$harness.dict"
  case $harness in # seconds an input may take
    encode | cycle) timeout=300 length=1024 ;;
    *) timeout=30 length=65536 ;;
  esac
  [ $harness = cycle ] && length=16384
  printf '[libfuzzer]\nmax_len = %s\ntimeout = %s\n' $length $timeout >"$OUT/fuzz_$harness.options"
  if [ $harness = encode ] || [ $harness = cycle ]; then # x264 never frees 32 bytes for a zone
    printf 'detect_leaks = 0\n' >>"$OUT/fuzz_$harness.options"
  fi
done
