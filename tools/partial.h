/* SPDX-License-Identifier: MIT */
/** @file partial.h  A .gvc file being encoded, and its journal: what is finished of it survives. */
#ifndef GVC_TOOLS_PARTIAL_H
#define GVC_TOOLS_PARTIAL_H

#include "base/bytes.h"
#include "base/output.h"

/* "capture.gvc" is written as "capture.gvc.part", readable at any time with --keep-going, and gets
 * its name at the end. "capture.gvc.part-journal" and "capture.gvc.part-state" lie beside it for
 * --resume. */
typedef struct partial_file {
    gvc_output output, journal;
    gvc_io io; /**< what an earlier run left, read through the descriptor that holds the lock */
    gvc_reader *reader; /**< of it; NULL if there is nothing to resume */
    char *journal_text; /**< of it */
    gvc_buffer state;   /**< its last checkpoint; empty if there is none */
    char *state_path, *state_temporary;
    uint64_t lines; /**< of the journal that are on the disk */
    bool resumed;   /**< an earlier run has left something */
} partial_file;

/** Without `resume`, what an earlier run has left is refused or, with `force`, dropped. */
gvc_result partial_begin(const char *path, bool force, bool resume, partial_file *partial,
                         gvc_error *error);

/** gvc_encode_options.journal, with the partial_file as `user`: the groups that it tells of are on
 * the disk first. */
gvc_result partial_note(partial_file *partial, const char *line, gvc_error *error);

/** For gvc_encode_options.checkpoint: replaces the one before when it is on the disk. If there is
 * no room for it that stays, and resuming takes longer. */
void partial_checkpoint(partial_file *partial, const void *data, size_t size);

/** Gives the finished file its name and removes what lay beside it; if that fails all is kept. */
gvc_result partial_end(partial_file *partial, gvc_error *error);

/** After a failure. Keeps what is finished, if anything is and `worth_keeping`, or if an earlier
 * run had left it; then true. */
bool partial_leave(partial_file *partial, bool worth_keeping);

#endif
