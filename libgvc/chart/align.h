/* SPDX-License-Identifier: MIT */
/**
 * @file align.h
 * Alignment of a chart in time. A parameterization made for one frame alone spreads the surface a
 * little differently in each; where the samples of the frame before have gone is known to a
 * thousandth of the diagonal. The chart slides over the square, its border held, until its samples
 * are nearer to those places: part of the way, so that errors do not add up.
 */
#ifndef GVC_CHART_ALIGN_H
#define GVC_CHART_ALIGN_H

#include "chart/open.h"

typedef struct gvc_align_options {
    double share;    /**< of the way to `target` that is gone, 0 to 1 */
    double diagonal; /**< of the frame: scale of what is too far to be followed */
} gvc_align_options;

/** Changes `uv` (of gvc_parameterize) of the inner vertices so that pixel (x, y) of an image of
 * `size` samples a side shows what is nearest to its `target`, 3 planes of coordinates. Where that
 * is far from what it shows now, or on the other side of the cut, the chart stays. No triangle
 * flips. */
gvc_result gvc_align(const gvc_disk *disk, uint32_t size, const double *target,
                     const gvc_align_options *options, double *uv, gvc_error *error);

#endif
