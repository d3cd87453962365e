/* SPDX-License-Identifier: MIT */
/** @file sample.h  Samples of a geometry image from a parameterized disk. */
#ifndef GVC_CHART_SAMPLE_H
#define GVC_CHART_SAMPLE_H

#include "chart/open.h"
#include "chart/side_table.h"

/** Point sampling: `image` (3 planes of size * size, x first) gets the surface point at each pixel.
 * Border samples lie exactly on the cut, so samples of one welded vertex are equal to the bit. */
gvc_result gvc_sample_points(const gvc_disk *disk, const double *uv, const gvc_weld *weld,
                             double *image, gvc_error *error);

/** Least squares: changes `image` (from gvc_sample_points; samples of one welded vertex stay equal)
 * so that the bilinear surface through it is nearest to the mesh in the area-weighted mean square
 * sense at corresponding parameters, with a weak pull (`regularization`, about 1e-3) to the point
 * samples. By conjugate gradients from the point samples. Deterministic. */
gvc_result gvc_sample_fit(const gvc_disk *disk, const double *uv, const gvc_weld *weld,
                          double regularization, double *image, gvc_error *error);

#endif
