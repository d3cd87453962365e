/* SPDX-License-Identifier: MIT */
/** @file curvature.h  How strongly the surface bends, for spending more samples where it does. */
#ifndef GVC_CHART_CURVATURE_H
#define GVC_CHART_CURVATURE_H

#include "chart/open.h"

/** Relative curvature per disk vertex: the turn of the normal per length (Frobenius norm of the
 * normal's gradient), smoothed over the uncut surface by diffusion to a standard deviation of a
 * fixed fraction of the bounding box's diagonal, divided by its area-weighted mean and clipped to
 * 1/4 .. 4. Integrals are taken over faces, so the result hardly depends on the triangulation.
 * All ones for a flat surface. `curvature` has room for every disk vertex. */
gvc_result gvc_curvature(const gvc_disk *disk, double *curvature, gvc_error *error);

#endif
