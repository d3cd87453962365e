/* SPDX-License-Identifier: MIT */
/** @file output.h  An output file that appears under its name only when whole. */
#ifndef GVC_BASE_OUTPUT_H
#define GVC_BASE_OUTPUT_H

#include "base/result.h"

#include <stdint.h>

/** A file being written through a buffer, under a temporary name beside its own ("<path>.tmp-..."),
 *  which it gets at the end. A device or pipe is written to directly. After a failed write the rest
 *  is ignored. */
typedef struct gvc_output {
    const char *path; /**< borrowed */
    char *temporary;  /**< NULL when writing to the target itself (standard output, a device) */
    int descriptor;   /**< -1 if not open */
    int failure;      /**< errno of the first failed write, or 0 */
    uint64_t written; /**< bytes that have gone to the file */
    uint64_t there; /**< bytes of an earlier run in the file, which are compared instead of written
                         as long as they are the same */
    bool overwrite;
    bool known;    /**< begun by gvc_output_begin_known */
    bool standard; /**< the descriptor is that of standard output, which stays open */
    size_t used;
    char *buffer;
} gvc_output;

/** Whether this is "-", a device or a pipe. */
bool gvc_output_is_stream(const char *path);

/** Whether something has this name that writing there would replace; not so for "-", a device or a
 *  pipe. */
bool gvc_output_in_the_way(const char *path);

/** "-" is standard output. GVC_ERROR_IO if `path` exists as a file and not `overwrite`, or cannot
 * be written. On success, gvc_output_end or gvc_output_discard must follow. */
gvc_result gvc_output_begin(const char *path, bool overwrite, gvc_output *output, gvc_error *error);

/** What to do with a file that an earlier run has left under the temporary name. */
typedef enum gvc_leftover {
    GVC_LEFTOVER_REFUSE, /**< GVC_ERROR_IO */
    GVC_LEFTOVER_DROP,
    GVC_LEFTOVER_KEEP /**< what is written is compared with it, and from the first difference on
                           replaces it */
} gvc_leftover;

/** Begins a file whose temporary name is `path` and `suffix`, so that it can be found again if this
 * run does not come to its end, and locks it against other runs (GVC_ERROR_IO if one is writing
 * it). `path` must not be "-" or a device. Otherwise like gvc_output_begin. */
gvc_result gvc_output_begin_known(const char *path, const char *suffix, bool overwrite,
                                  gvc_leftover leftover, gvc_output *output, gvc_error *error);

/** Closes it and leaves it under its temporary name. */
void gvc_output_leave(gvc_output *output);

/** At least `size` (at most 4096) bytes to fill; tell how many were with gvc_output_advance. A
 *  failure to write is told by gvc_output_end. */
char *gvc_output_room(gvc_output *output, size_t size);
static inline void gvc_output_advance(gvc_output *output, size_t size) { output->used += size; }

/** Writes bytes of any number, as gvc_sink.write does, and tells of a failure as soon as it is
 *  known. What goes to a pipe is not held back. */
gvc_result gvc_output_write(void *output, const void *data, size_t size, gvc_error *error);

/** Sees to it that a file survives a crash of the machine once it has its name; costs a wait for
 * the disk. Call it before gvc_output_end, which tells of a failure. */
void gvc_output_sync(gvc_output *output);

/** Writes what is left and gives the file its name; or removes it after any failure, but leaves it
 * under a known temporary name. */
gvc_result gvc_output_end(gvc_output *output, gvc_error *error);

/** Removes what was written. Fine after a failed begin and after gvc_output_end, too. */
void gvc_output_discard(gvc_output *output);

#endif
