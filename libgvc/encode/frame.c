/* SPDX-License-Identifier: MIT */
/** @file frame.c  One frame from mesh to geometry image. */
#include "encode/frame.h"

#include "base/memory.h"
#include "chart/align.h"
#include "chart/layout.h"
#include "chart/sample.h"
#include "encode/scan.h"
#include "mesh/refine.h"

#include <math.h>
#include <stdlib.h>

/* No more vertices are added than so many times those of a surface of equilateral triangles with
 * the longest edge (2,000 of them at 0.024), for meshes that are all needles. */
#define MOST_ADDED 10

/* Halfedges of the mesh with its long edges split, so that coarse meshes and fine ones offer as
 * many places to the root, to nodes and paths, to integrals and to the chart (docs/adr/0014). */
static gvc_result build_halfedges(const gvc_mesh *mesh, double longest_edge,
                                  gvc_halfedges *halfedges, gvc_error *error) {
    GVC_TRY(gvc_halfedges_build(mesh, 0, halfedges, error));
    double longest = longest_edge * sqrt(gvc_mesh_area(mesh));
    double even = 2 / (sqrt(3) * longest_edge * longest_edge); /* V = F / 2 */
    size_t most = mesh->vertex_count + (size_t)fmin(MOST_ADDED * even, UINT32_MAX / 4);
    return longest > 0 ? gvc_refine(halfedges, longest, most, error) : GVC_OK;
}

gvc_result gvc_frame_analyse(gvc_frame_work *work, const gvc_source *source, bool weld,
                             gvc_error *error) {
    gvc_features_options options;
    gvc_features_options_init(&options);
    gvc_result result = gvc_load_frame(source, work->number, weld, &work->mesh, NULL, error);
    if (result == GVC_OK) {
        work->diagonal = gvc_mesh_diagonal(work->mesh);
        result = build_halfedges(work->mesh, work->longest_edge, &work->halfedges, error);
    }
    if (result == GVC_OK) {
        result = gvc_features_find(&work->halfedges, &options, &work->features, error);
    }
    return gvc_at_frame(error, result, (int64_t)work->number);
}

gvc_result gvc_frame_follow(gvc_frame_work *work, const gvc_mesh *before, gvc_error *error) {
    gvc_halfedges from = {0};
    gvc_result result = build_halfedges(before, work->longest_edge, &from, error);
    if (result == GVC_OK) result = gvc_warp_create(&from, &work->halfedges, &work->warp, error);
    gvc_halfedges_free(&from);
    return gvc_at_frame(error, result, (int64_t)work->number);
}

void gvc_frame_free(gvc_frame_work *work) {
    gvc_mesh_destroy(&work->mesh);
    gvc_halfedges_free(&work->halfedges);
    gvc_features_free(&work->features);
    gvc_cut_graph_free(&work->graph);
    gvc_warp_destroy(&work->warp);
}

gvc_result gvc_frame_uncut(gvc_frame_work *work, gvc_error *error) {
    gvc_cut_graph_free(&work->graph);
    gvc_halfedges_free(&work->halfedges);
    return build_halfedges(work->mesh, work->longest_edge, &work->halfedges, error);
}

/* --------------------------------------------------------------------------------------- image */

void gvc_chart_free(gvc_chart *chart) {
    gvc_disk_free(&chart->disk);
    free(chart->uv);
    chart->uv = NULL;
}

gvc_result gvc_chart_make(const gvc_frame_work *work, const gvc_side_table *sides,
                          const gvc_image_options *options, gvc_chart *chart, gvc_error *error) {
    *chart = (gvc_chart){0};
    gvc_result result = gvc_disk_open(&work->halfedges, &work->graph, &chart->disk, error);
    if (result == GVC_OK) result = gvc_layout_place(&chart->disk, sides, &chart->uv, error);
    if (result == GVC_OK) {
        result = gvc_parameterize(&chart->disk, sides->size, &options->parameterize, chart->uv,
                                  NULL, error);
    }
    if (result != GVC_OK) gvc_chart_free(chart);
    return gvc_at_frame(error, result, (int64_t)work->number);
}

gvc_result gvc_chart_follow(const gvc_frame_work *work, uint32_t size, const double *before,
                            const gvc_image_options *options, gvc_chart *chart, gvc_error *error) {
    size_t plane = (size_t)size * size;
    if (!work->warp || !(options->align > 0)) return GVC_OK;
    double *target = gvc_alloc(3 * plane, sizeof *target);
    if (!target) return gvc_fail_memory(error);
    for (size_t i = 0; i < plane; i++) {
        double point[3] = {before[i], before[plane + i], before[2 * plane + i]};
        gvc_warp_point(work->warp, point, point);
        for (size_t c = 0; c < 3; c++) target[c * plane + i] = point[c];
    }
    const gvc_align_options align = {options->align, work->diagonal};
    gvc_result result = gvc_align(&chart->disk, size, target, &align, chart->uv, error);
    free(target);
    return gvc_at_frame(error, result, (int64_t)work->number);
}

gvc_result gvc_chart_fit(const gvc_frame_work *work, const gvc_chart *chart, const gvc_weld *weld,
                         const gvc_image_options *options, double *image, gvc_error *error) {
    if (!options->fit) return GVC_OK;
    gvc_result result =
        gvc_sample_fit(&chart->disk, chart->uv, weld, GVC_FIT_REGULARIZATION, image, error);
    return gvc_at_frame(error, result, (int64_t)work->number);
}

gvc_result gvc_frame_image(const gvc_frame_work *work, const gvc_side_table *sides,
                           const gvc_weld *weld, const gvc_image_options *options, double *image,
                           gvc_error *error) {
    gvc_chart chart;
    GVC_TRY(gvc_chart_make(work, sides, options, &chart, error));
    gvc_result result = gvc_sample_points(&chart.disk, chart.uv, weld, image, error);
    result = gvc_at_frame(error, result, (int64_t)work->number);
    if (result == GVC_OK) result = gvc_chart_fit(work, &chart, weld, options, image, error);
    gvc_chart_free(&chart);
    return result;
}
