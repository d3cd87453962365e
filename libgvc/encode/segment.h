/* SPDX-License-Identifier: MIT */
/** @file segment.h  What stays fixed over a segment: bounding cube, number of extrema, border
 * layout. */
#ifndef GVC_ENCODE_SEGMENT_H
#define GVC_ENCODE_SEGMENT_H

#include "chart/picture.h"
#include "container/shape_record.h"
#include "encode/frame.h"
#include "encode/scan.h"

typedef struct gvc_segment {
    uint64_t number;
    uint64_t first_frame, end_frame; /**< of the run of frames of one genus it begins in */
    double origin[3], step;          /**< position = origin + step * 16-bit code */
    uint64_t vote_end;               /**< end of the frames whose vote holds */
    size_t extremum_count;
    double trial_rms;    /**< sampling error of the layout chosen, at the size of its trials (or at
                              that of the images: encode/cut.c) */
    gvc_border_run *run; /**< cyclic sequence of border runs of its first frame */
    size_t run_count;
    gvc_side_table sides;
    gvc_weld weld;
    gvc_image_options image_options;
} gvc_segment;

/** Everything but the layout: cube from `facts` over the run of equal genus that begins at `first`,
 * number of extrema by a vote of up to seven frames spread over it (or over more, if it is short),
 * or as in the segment before (what `segment` holds on entry, zero for the first one) where its
 * vote still holds. What `segment` holds is freed. */
gvc_result gvc_segment_begin(const gvc_source *source, const gvc_encode_options *options,
                             const gvc_scan_frame *facts, uint64_t number, uint64_t first,
                             gvc_segment *segment, gvc_error *error);

/** Parts of it, for frames that are no segment: the cube of codes round a cube with this lowest
 * corner and side, with a margin for samples that overshoot, */
void gvc_segment_set_cube(gvc_segment *segment, const double low[3], double side);
/** and how images are made. */
void gvc_segment_set_image_options(gvc_segment *segment, const gvc_encode_options *options);

/** Border layout from the segment's first frame, whose graph has been found: steps in proportion to
 * edge lengths; the place of the square's corners on the loop is the one of least RMS error in
 * trials. `size` 0 leaves the layout at the size of the trials. */
gvc_result gvc_segment_layout(gvc_segment *segment, const gvc_frame_work *work, uint32_t size,
                              unsigned threads, gvc_error *error);

/** The same layout for another image size. */
gvc_result gvc_segment_resize(gvc_segment *segment, const gvc_frame_work *work, uint32_t size,
                              gvc_error *error);

/** RMS error (fraction of the diagonal) of a frame sampled with the segment's layout at another
 * image size, without coding; INFINITY if there is no chart of
 * that size without folds. */
gvc_result gvc_segment_sampling_rms(const gvc_segment *segment, const gvc_frame_work *work,
                                    uint32_t size, size_t samples, double *rms, gvc_error *error);

/** The shape record's content. `shape` is freed by the caller. */
gvc_result gvc_segment_shape(const gvc_segment *segment, const gvc_cut_graph *graph,
                             gvc_shape *shape, gvc_error *error);

/** Quantises an image (3 planes of doubles) to a luma picture of the geometry track, padded by
 * replication. */
void gvc_segment_quantise(const gvc_segment *segment, const double *image,
                          gvc_picture_layout layout, uint16_t *luma);

/** GVC_CODE_SHIFT more bits than the 10 of luma make a 16-bit code. */
#define GVC_LUMA_BITS 10
#define GVC_CODE_SHIFT 6

void gvc_segment_free(gvc_segment *segment);

/** RMS error asked for, as a fraction of a frame's diagonal. */
double gvc_rms_asked(const gvc_encode_options *options, double diagonal);

/** RMS error between a frame's mesh and a rebuilt one, the worse direction, as a fraction of the
 * diagonal. */
gvc_result gvc_frame_rms(const gvc_mesh *original, const gvc_mesh *rebuilt, size_t samples,
                         double *rms, gvc_error *error);

#endif
