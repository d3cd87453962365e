/* SPDX-License-Identifier: MIT */
/** @file file.h  Loading a whole file, writing a file that appears only when whole, and errors that
 *  name the file. */
#ifndef GVC_MESH_FILE_H
#define GVC_MESH_FILE_H

#include "base/result.h"

/** Puts the file name in error->where (its end, if it is long); returns error's code `result`. */
gvc_result gvc_fail_in(gvc_error *error, gvc_result result, const char *name);
/** GVC_ERROR_IO: "cannot <action>: <text of the errno value>", in file `name`. */
gvc_result gvc_fail_errno(gvc_error *error, const char *action, int number, const char *name);

/** Reads all of `path` ("-": standard input). `*data` has `*size` bytes; free with free(). */
gvc_result gvc_file_load(const char *path, char **data, size_t *size, gvc_error *error);

/** A file being written through a buffer, under a temporary name beside its own. After a failed
 *  write the rest is ignored and gvc_output_end reports it. */
typedef struct gvc_output {
    const char *path; /**< borrowed */
    char *temporary;  /**< NULL when writing to the target itself (standard output, a device) */
    int descriptor;
    int failure; /**< errno of the first failed write, or 0 */
    bool overwrite;
    size_t used;
    char *buffer;
} gvc_output;

/** "-" is standard output. GVC_ERROR_IO if `path` exists and not `overwrite`. On success,
 *  gvc_output_end must follow. */
gvc_result gvc_output_begin(const char *path, bool overwrite, gvc_output *output, gvc_error *error);
/** At least `size` (at most 4096) bytes to fill; tell how many were with gvc_output_advance. */
char *gvc_output_room(gvc_output *output, size_t size);
static inline void gvc_output_advance(gvc_output *output, size_t size) { output->used += size; }
/** Writes what is left and gives the file its name; or removes it after any failure. */
gvc_result gvc_output_end(gvc_output *output, gvc_error *error);

#endif
