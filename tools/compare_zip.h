/* SPDX-License-Identifier: MIT */
/** @file compare_zip.h  Zipped OFF files, what captures are usually shipped as. */
#ifndef GVC_TOOLS_COMPARE_ZIP_H
#define GVC_TOOLS_COMPARE_ZIP_H

#include "base/bytes.h"
#include "gvc/gvc.h"

/** Appends the mesh as ASCII OFF: the line "OFF", the line "V F 0", a line "x y z" per vertex and a
 *  line "3 a b c" per face. A coordinate is the shortest text that reads back to the same value
 *  (gvc_format_double), so nothing is lost and no digit is wasted. Out of memory shows in
 *  `text->failed`. */
void compare_off_text(const gvc_mesh *mesh, gvc_buffer *text);

/** What goes into an archive. */
typedef struct compare_zip_entries {
    void *user;
    uint64_t count;
    /** Appends the bytes of an entry to an empty buffer. Called from the calling thread only, in
     *  order, and one at a time, so that only one entry is in memory. */
    gvc_result (*read)(void *user, uint64_t index, gvc_buffer *bytes, gvc_error *error);
} compare_zip_entries;

typedef struct compare_zip_cost {
    uint64_t size;          /**< of the archive, directory and all, in bytes */
    double deflate_seconds; /**< CPU time to write the archive, without reading the entries */
    double inflate_seconds; /**< CPU time to read it again and parse each entry as a mesh */
} compare_zip_cost;

/** Writes an archive of the entries, deflated at level 9 (`zip -9`), to a temporary file in $TMPDIR
 * or /tmp, reads it again and removes it. Errors: those of `read`; GVC_ERROR_IO from libzip,
 * GVC_ERROR_MESH if an entry read back is no mesh. */
gvc_result compare_zip_measure(const compare_zip_entries *entries, compare_zip_cost *cost,
                               gvc_error *error);

#endif
