/* SPDX-License-Identifier: MIT */
/** @file batch.h  Frames analysed together, in parallel: all that does not need the cut. */
#ifndef GVC_ENCODE_BATCH_H
#define GVC_ENCODE_BATCH_H

#include "encode/frame.h"

enum { GVC_BATCH = 16 };

/** Consecutive frames. Zero-initialise; free with gvc_batch_free. */
typedef struct gvc_batch {
    uint64_t first;
    size_t count;
    gvc_frame_work work[GVC_BATCH];
    gvc_mesh *before; /**< the frame before `first`, if it has been in an earlier batch */
} gvc_batch;

/** Goes on to frames `first` ... `first` + `count` - 1, at most GVC_BATCH, which follow those of
 * the batch before if there was one: finds the features of each and, unless `options` say
 * otherwise, the warp from the frame before. */
gvc_result gvc_batch_analyse(gvc_batch *batch, const gvc_source *source,
                             const gvc_encode_options *options, uint64_t first, size_t count,
                             gvc_error *error);
void gvc_batch_free(gvc_batch *batch);

#endif
