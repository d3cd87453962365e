/* SPDX-License-Identifier: MIT */
/** @file frame.c  One frame from mesh to geometry image. */
#include "encode/frame.h"

#include "chart/layout.h"
#include "chart/sample.h"
#include "encode/scan.h"

#include <stdlib.h>

#define FIT_REGULARIZATION 1e-3

gvc_result gvc_frame_analyse(gvc_frame_work *work, const gvc_source *source, bool weld,
                             gvc_error *error) {
    gvc_features_options options;
    gvc_features_options_init(&options);
    gvc_result result = gvc_load_frame(source, work->number, weld, &work->mesh, NULL, error);
    if (result == GVC_OK) {
        work->diagonal = gvc_mesh_diagonal(work->mesh);
        result = gvc_halfedges_build(work->mesh, 0, &work->halfedges, error);
    }
    if (result == GVC_OK) {
        result = gvc_features_find(&work->halfedges, &options, &work->features, error);
    }
    return gvc_at_frame(error, result, (int64_t)work->number);
}

void gvc_frame_free(gvc_frame_work *work) {
    gvc_mesh_destroy(&work->mesh);
    gvc_halfedges_free(&work->halfedges);
    gvc_features_free(&work->features);
    gvc_cut_graph_free(&work->graph);
}

gvc_result gvc_frame_uncut(gvc_frame_work *work, gvc_error *error) {
    gvc_cut_graph_free(&work->graph);
    gvc_halfedges_free(&work->halfedges);
    return gvc_halfedges_build(work->mesh, 0, &work->halfedges, error);
}

gvc_result gvc_frame_image(const gvc_frame_work *work, const gvc_side_table *sides,
                           const gvc_weld *weld, const gvc_image_options *options, double *image,
                           gvc_parameterize_report *report, gvc_error *error) {
    gvc_disk disk = {0};
    double *uv = NULL;
    gvc_result result = gvc_disk_open(&work->halfedges, &work->graph, &disk, error);
    if (result == GVC_OK) result = gvc_layout_place(&disk, sides, &uv, error);
    if (result == GVC_OK) {
        result = gvc_parameterize(&disk, sides->size, &options->parameterize, uv, report, error);
    }
    if (result == GVC_OK) result = gvc_sample_points(&disk, uv, weld, image, error);
    if (result == GVC_OK && options->fit) {
        result = gvc_sample_fit(&disk, uv, weld, FIT_REGULARIZATION, image, error);
    }
    free(uv);
    gvc_disk_free(&disk);
    return gvc_at_frame(error, result, (int64_t)work->number);
}
