/* SPDX-License-Identifier: MIT */
/** @file cut.h  Which cut a frame gets: that of the frame before it, or the first of a new segment.
 */
#ifndef GVC_ENCODE_CUT_H
#define GVC_ENCODE_CUT_H

#include "encode/segment.h"

/** What cuts are found with; everything is borrowed. */
typedef struct gvc_cutter {
    const gvc_source *source;
    const gvc_encode_options *options;
    const gvc_scan_frame *facts; /**< one per frame of the source */
    gvc_tracker *tracker;
    uint32_t size; /**< of the images, which the cut must fit; 0 if not settled yet */
} gvc_cutter;

/** The tracker for a capture. */
gvc_result gvc_cut_tracker(const gvc_encode_options *options, gvc_tracker **tracker,
                           gvc_error *error);

/** Finds the cut of the next frame, in order. `*continues` is false, and nothing is kept, if a new
 * segment must start with it; so it is for a segment that is all zero. */
gvc_result gvc_cut_follow(const gvc_cutter *cutter, const gvc_segment *segment,
                          gvc_frame_work *work, bool *continues, gvc_error *error);

/** Begins segment `number` with this frame: gvc_segment_begin, its cut, and its border layout. What
 * `segment` holds is freed. GVC_ERROR_MESH if every cut tried gives charts that fold over
 * themselves or do not fit. */
gvc_result gvc_cut_begin(const gvc_cutter *cutter, uint64_t number, gvc_frame_work *work,
                         gvc_segment *segment, gvc_error *error);

#endif
