/* SPDX-License-Identifier: MIT */
/** @file distance.c  Distance between two surfaces: mean, RMS and maximum, both ways. */
#include "mesh/distance.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

#define DEFAULT_SAMPLES 20000

/* Distances of points met one after the other, which tend to be neighbours. A distance changes by
 * no more than the step between two points, so the previous one bounds the search for the next. */
typedef struct walk {
    const gvc_bvh *bvh;
    double point[3], distance;
    bool begun;
} walk;

static double walk_to(walk *w, const double point[3]) {
    gvc_closest closest = {.distance = 0};
    double limit = HUGE_VAL;
    if (w->begun) {
        double step = 0;
        for (int k = 0; k < 3; k++) step += (point[k] - w->point[k]) * (point[k] - w->point[k]);
        limit = (w->distance + sqrt(step)) * (1 + 1e-9);
    }
    /* The bound holds but for rounding; then search without it. */
    if (!gvc_bvh_closest(w->bvh, point, NULL, limit, &closest) &&
        !gvc_bvh_closest(w->bvh, point, NULL, HUGE_VAL, &closest)) {
        closest.distance = HUGE_VAL;
    }
    for (int k = 0; k < 3; k++) w->point[k] = point[k];
    w->distance = closest.distance;
    w->begun = true;
    return closest.distance;
}

/* The largest distance of a vertex that some face uses. */
static gvc_result vertex_maximum(const gvc_mesh *from, const gvc_bvh *to, double *maximum,
                                 gvc_error *error) {
    unsigned char *used = gvc_alloc(from->vertex_count, 1);
    if (!used) return gvc_fail_memory(error);
    for (size_t h = 0; h < 3 * from->face_count; h++) used[from->face[h]] = 1;
    walk w = {.bvh = to};
    for (size_t v = 0; v < from->vertex_count; v++) {
        if (!used[v]) continue;
        double distance = walk_to(&w, from->position + 3 * v);
        if (distance > *maximum) *maximum = distance;
    }
    free(used);
    return GVC_OK;
}

/* Fills direction `way` of `distance`; `points` has room for `samples` points. */
static gvc_result one_way(const gvc_mesh *from, const gvc_mesh *to, size_t samples, double *points,
                          gvc_distance *distance, int way, gvc_error *error) {
    gvc_result result;
    gvc_bvh *bvh = NULL;
    GVC_CHECK(gvc_mesh_sample(from, samples, points, error));
    GVC_CHECK(gvc_bvh_create(to, &bvh, error));

    walk w = {.bvh = bvh};
    double sum = 0, squares = 0, maximum = 0;
    for (size_t i = 0; i < samples; i++) {
        double d = walk_to(&w, points + 3 * i);
        sum += d;
        squares += d * d;
        if (d > maximum) maximum = d;
    }
    GVC_CHECK(vertex_maximum(from, bvh, &maximum, error));
    distance->mean[way] = sum / (double)samples;
    distance->rms[way] = sqrt(squares / (double)samples);
    distance->maximum[way] = maximum;

cleanup:
    gvc_bvh_destroy(&bvh);
    return result;
}

gvc_result gvc_mesh_distance(const gvc_mesh *first, const gvc_mesh *second, size_t samples,
                             gvc_distance *distance, gvc_error *error) {
    if (!first || !second || !distance) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT,
                        "gvc_mesh_distance needs two meshes and a "
                        "place for the distance");
    }
    *distance = (gvc_distance){.diagonal = 0};
    if (samples == 0) samples = DEFAULT_SAMPLES;
    double *points = gvc_alloc(samples, 3 * sizeof *points);
    if (!points) return gvc_fail_memory(error);

    gvc_result result;
    gvc_distance measured = {.diagonal = 0};
    GVC_CHECK(one_way(first, second, samples, points, &measured, 0, error));
    GVC_CHECK(one_way(second, first, samples, points, &measured, 1, error));
    measured.diagonal = gvc_mesh_diagonal(first);
    *distance = measured;

cleanup:
    free(points);
    return result;
}
