/* SPDX-License-Identifier: MIT */
/** @file frame.h  What the encoder holds of one frame on its way from mesh to geometry image. */
#ifndef GVC_ENCODE_FRAME_H
#define GVC_ENCODE_FRAME_H

#include "chart/open.h"
#include "chart/parameterize.h"
#include "chart/side_table.h"
#include "descriptor/tracking.h"

typedef struct gvc_frame_work {
    uint64_t number;
    double diagonal;
    gvc_mesh *mesh;          /**< cleaned */
    gvc_halfedges halfedges; /**< of the mesh; refined along the cut once it is found */
    gvc_features features;
    gvc_cut_graph graph;
} gvc_frame_work;

/** Loads frame `work->number` and finds its features. */
gvc_result gvc_frame_analyse(gvc_frame_work *work, const gvc_source *source, bool weld,
                             gvc_error *error);
void gvc_frame_free(gvc_frame_work *work);
/** Makes the frame as it was before a cut was tried: mesh not refined, no graph. */
gvc_result gvc_frame_uncut(gvc_frame_work *work, gvc_error *error);

/** How a frame's surface becomes an image. */
typedef struct gvc_image_options {
    gvc_parameterize_options parameterize;
    bool fit; /**< least squares instead of point sampling */
} gvc_image_options;

/** Opens the frame along its graph, lays the border out by `sides`, flattens and samples it: 3
 * planes of size * size coordinates into `image`. `report` may be NULL. */
gvc_result gvc_frame_image(const gvc_frame_work *work, const gvc_side_table *sides,
                           const gvc_weld *weld, const gvc_image_options *options, double *image,
                           gvc_parameterize_report *report, gvc_error *error);

#endif
