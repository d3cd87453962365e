/* SPDX-License-Identifier: MIT */
/**
 * @file checkpoint.h
 * What an encode hands on from one group to the next: where it can begin again without looking at
 * the frames before (docs/adr/0018).
 */
#ifndef GVC_CHECKPOINT_H
#define GVC_CHECKPOINT_H

#include "descriptor/tracking.h"
#include "encode/segment.h"

/** Points at the variables of an encode. */
typedef struct gvc_checkpoint {
    uint64_t *next_frame; /**< begins a group */
    uint32_t *size;       /**< of the images */
    double *crf;
    double **followed; /**< 3 * size * size point samples of the last frame, or NULL */
    gvc_encode_report *report;
    gvc_segment *segment;
    gvc_tracker *tracker;
} gvc_checkpoint;

/** Hands it to options->checkpoint, if there is one. */
gvc_result gvc_checkpoint_save(const gvc_checkpoint *checkpoint, const gvc_encode_options *options,
                               gvc_error *error);

/** Takes up a checkpoint; `*loaded` is false, and everything as it was, if the bytes are not whole
 * or of another build. The segment must be all zero, the tracker new. */
gvc_result gvc_checkpoint_load(const gvc_checkpoint *checkpoint, const void *data, size_t size,
                               bool *loaded, gvc_error *error);

/** Frame that a checkpoint goes on with; false if it is not whole. */
bool gvc_checkpoint_frame(const void *data, size_t size, uint64_t *frame);

#endif
