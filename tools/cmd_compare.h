/* SPDX-License-Identifier: MIT */
/** @file cmd_compare.h  The command line of `gvc compare`, and its two kinds of comparison. */
#ifndef GVC_TOOLS_CMD_COMPARE_H
#define GVC_TOOLS_CMD_COMPARE_H

#include "cli.h"

#include "base/bytes.h"

#include <stddef.h>

/** Rate factor of --paper. */
#define COMPARE_PAPER_CRF "20"

/** Arguments of an option that may be given once for every capture. */
typedef struct compare_list {
    char *item[32];
    int count;
} compare_list;

typedef struct compare_arguments {
    const char *methods; /**< NULL: all */
    bool json, csv, any_order, quiet;
    unsigned threads;
    /* only without --paper, qp only without --lossless; NULL: not given */
    const char *qp, *max_rms;
    bool lossless;
    /* only with --paper */
    bool paper;
    const char *frames, *tables, *plot; /**< NULL: not given */
    bool force;
    /* of --paper and --lossless */
    uint32_t size, gop; /**< 0: not given */
    double crf;         /**< NaN: not given */
    compare_list mixed, row;
} compare_arguments;

/** Copies the next item of a comma-separated list; false at its end. */
bool compare_next_item(const char **list, char *item, size_t room);

/** compare_zip's source of frames that came as OFF files, whose bytes go into the archive as they
 * are; `user` is a frame_list. */
gvc_result compare_original_off(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error);

/** `gvc compare --paper` of `count` captures, or of one whose frames are all named; exit status. */
int compare_paper_command(const compare_arguments *arguments, char *const *frames, int count);

#endif
