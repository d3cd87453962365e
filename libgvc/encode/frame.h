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
    double longest_edge; /**< of gvc_encode_options; set beforehand */
    double diagonal;
    gvc_mesh *mesh;          /**< cleaned */
    gvc_warp *warp;          /**< from the frame before; NULL if there is none */
    gvc_halfedges halfedges; /**< of the mesh; refined along the cut once it is found */
    gvc_features features;
    gvc_cut_graph graph;
} gvc_frame_work;

/** Loads frame `work->number` and finds its features. */
gvc_result gvc_frame_analyse(gvc_frame_work *work, const gvc_source *source, bool weld,
                             gvc_error *error);
/** Sets `work->warp` from `before` to a frame that has been analysed but not been cut. */
gvc_result gvc_frame_follow(gvc_frame_work *work, const gvc_mesh *before, gvc_error *error);
void gvc_frame_free(gvc_frame_work *work);
/** Makes the frame as it was before a cut was tried: mesh not refined, no graph. */
gvc_result gvc_frame_uncut(gvc_frame_work *work, gvc_error *error);

/** How a frame's surface becomes an image. */
typedef struct gvc_image_options {
    gvc_parameterize_options parameterize;
    bool fit;     /**< least squares instead of point sampling */
    double align; /**< how far a chart follows that of the frame before; 0: not at all */
} gvc_image_options;

/** Pull of the least squares fit towards the point samples. */
#define GVC_FIT_REGULARIZATION 1e-3

/** A frame's surface opened and flattened. Zero-initialise; free with gvc_chart_free. */
typedef struct gvc_chart {
    gvc_disk disk;
    double *uv; /**< 2 per vertex of the disk, pixels */
} gvc_chart;
void gvc_chart_free(gvc_chart *chart);

/** Opens the frame along its graph, lays the border out by `sides` and flattens it. */
gvc_result gvc_chart_make(const gvc_frame_work *work, const gvc_side_table *sides,
                          const gvc_image_options *options, gvc_chart *chart, gvc_error *error);

/** Slides the chart to where `work->warp` takes the samples of the frame before (3 planes of size *
 * size coordinates, from gvc_sample_points). Does nothing without a warp, or if `options` say so.
 */
gvc_result gvc_chart_follow(const gvc_frame_work *work, uint32_t size, const double *before,
                            const gvc_image_options *options, gvc_chart *chart, gvc_error *error);

/** The chart's point samples, fitted to the surface if `options` say so: changes `image`. */
gvc_result gvc_chart_fit(const gvc_frame_work *work, const gvc_chart *chart, const gvc_weld *weld,
                         const gvc_image_options *options, double *image, gvc_error *error);

/** The image of a frame on its own, 3 planes of size * size coordinates: chart, point samples, fit.
 */
gvc_result gvc_frame_image(const gvc_frame_work *work, const gvc_side_table *sides,
                           const gvc_weld *weld, const gvc_image_options *options, double *image,
                           gvc_error *error);

#endif
