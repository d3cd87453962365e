#!/bin/sh
# SPDX-License-Identifier: MIT
# check.sh: installs what is missing, builds with warnings as errors, and runs all tests: with gcc, with clang under
# AddressSanitizer and UndefinedBehaviorSanitizer, the decoder alone, and an example against the installed package.
# Everything goes to build/. Stops at the first failure.
set -eu
cd "$(dirname "$0")/.."
step() { printf '\n== %s\n' "$*"; }

step "dependencies"
tools/install-dependencies.sh clang llvm libclang-rt-14-dev clang-format doxygen mandoc

step "source format"
find libgvc tools fuzz -name '*.[ch]' -print0 | xargs -0 clang-format --dry-run --Werror

step "gcc: build, all warnings are errors"
cmake --preset dev -DCMAKE_C_COMPILER=gcc -DCMAKE_CXX_COMPILER=g++ >/dev/null
cmake --build --preset dev
step "documentation of the interface"
cmake --build --preset dev --target doc
step "gcc: tests"
ctest --preset dev -j"$(nproc)"

step "clang, AddressSanitizer and UndefinedBehaviorSanitizer: build"
cmake --preset asan-ubsan -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >/dev/null
cmake --build --preset asan-ubsan
step "clang, sanitizers: tests"
ctest --preset asan-ubsan -j"$(nproc)"

step "decoder alone"
cmake -S . -B build/decoder -G Ninja -DGVC_ENCODER=OFF -DGVC_TESTS=ON -DGVC_WERROR=ON >/dev/null
cmake --build build/decoder
ctest --test-dir build/decoder -j"$(nproc)" --output-on-failure

step "example against the installed package"
tools/check-install.sh

step "all passed"
