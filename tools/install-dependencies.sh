#!/bin/sh
# SPDX-License-Identifier: MIT
# install-dependencies.sh [PACKAGE...]: installs what a Debian 12 machine lacks to build, test and try gvc, and the
# packages named. Needs root or sudo only if something is missing.
set -eu

wanted="build-essential cmake ninja-build pkg-config
  libavcodec-dev libavutil-dev libzstd-dev libopenexr-dev libsuitesparse-dev
  libpng-dev libzip-dev liblzma-dev libdraco-dev libcmocka-dev ffmpeg python3 python3-numpy python3-zstandard $*"

missing=""
for package in $wanted; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "as root, install:$missing" >&2; exit 1; }
  as_root=sudo
fi
echo "installing:$missing"
$as_root apt-get update -qq
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $missing >/dev/null
