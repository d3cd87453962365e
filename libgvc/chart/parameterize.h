/* SPDX-License-Identifier: MIT */
/** @file parameterize.h  Interior of the parameterization: harmonic map (Pinkall & Polthier 1993),
 * one stretch-reducing step (Yoshizawa et al. 2004), curvature weight. */
#ifndef GVC_CHART_PARAMETERIZE_H
#define GVC_CHART_PARAMETERIZE_H

#include "chart/open.h"

typedef struct gvc_parameterize_options {
    double stretch_exponent;   /**< eta; 1.0 */
    double curvature_exponent; /**< kp; 0.5; 0: area only */
} gvc_parameterize_options;

typedef struct gvc_parameterize_report {
    double stretch; /**< L2 stretch, area-normalised: 1 is an isometry */
    size_t flipped; /**< triangles of non-positive area in the result; 0 on success */
    unsigned
        fallback; /**< 0: asked-for map; 1: no curvature; 2: harmonic only; 3: uniform weights */
} gvc_parameterize_report;

/** Border vertices of `disk` have their place in `uv` (pixels, 0 .. size-1, from gvc_layout_place);
 * fills the inner ones. Falls back step by step until no triangle is flipped; uniform weights
 * (Tutte) cannot flip but for rounding. GVC_ERROR_MESH if even that fails. `report` may be NULL. */
gvc_result gvc_parameterize(const gvc_disk *disk, uint32_t size,
                            const gvc_parameterize_options *options, double *uv,
                            gvc_parameterize_report *report, gvc_error *error);

#endif
