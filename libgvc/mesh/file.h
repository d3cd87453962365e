/* SPDX-License-Identifier: MIT */
/** @file file.h  Loading a whole file. */
#ifndef GVC_MESH_FILE_H
#define GVC_MESH_FILE_H

#include "base/result.h"

/** Reads all of `path` ("-": standard input). `*data` has `*size` bytes; free with free(). */
gvc_result gvc_file_load(const char *path, char **data, size_t *size, gvc_error *error);

#endif
