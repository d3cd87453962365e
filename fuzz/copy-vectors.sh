#!/bin/sh
# SPDX-License-Identifier: MIT
# copy-vectors.sh FOLDER VECTORS...: copies the small .gvc files of the folders VECTORS to FOLDER.
set -eu
to=$1
shift
find "$@" -name '*.gvc' -size -64k -exec cp {} "$to" \;
