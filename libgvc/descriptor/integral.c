/* SPDX-License-Identifier: MIT */
/** @file integral.c  The geodesic integral by farthest-point quadrature. */
#include "descriptor/integral.h"

#include "base/memory.h"
#include "descriptor/clip.h"

#include <math.h>
#include <stdlib.h>

typedef struct quadrature {
    size_t vertex_count, sample_count;
    double *distance; /* per vertex, to the latest sample */
    double *nearest;  /* per vertex, to the nearest sample */
    uint32_t *owner;  /* per vertex: the nearest sample */
    double *area;     /* per vertex: a third of the faces around it */
    float *all; /* sample_count rows of distances. A sample's weight is known only when all cells
                   are; single precision halves the memory and errs by less than 1e-7 */
} quadrature;

static void quadrature_free(quadrature *q) {
    free(q->distance);
    free(q->nearest);
    free(q->owner);
    free(q->area);
    free(q->all);
}

static gvc_result quadrature_allocate(quadrature *q, size_t vertex_count, size_t sample_count,
                                      gvc_error *error) {
    *q = (quadrature){.vertex_count = vertex_count, .sample_count = sample_count};
    size_t entries;
    if (!gvc_multiply(vertex_count, sample_count, &entries)) return gvc_fail_memory(error);
    q->distance = gvc_alloc(vertex_count, sizeof *q->distance);
    q->nearest = gvc_alloc(vertex_count, sizeof *q->nearest);
    q->owner = gvc_alloc(vertex_count, sizeof *q->owner);
    q->area = gvc_alloc(vertex_count, sizeof *q->area);
    q->all = gvc_alloc(entries, sizeof *q->all);
    if (!q->distance || !q->nearest || !q->owner || !q->area || !q->all) {
        quadrature_free(q);
        return gvc_fail_memory(error);
    }
    return GVC_OK;
}

static void share_areas(const gvc_halfedges *mesh, double *area) {
    for (size_t f = 0; f < mesh->face_count; f++) {
        double third = gvc_face_area(mesh, f) / 3;
        for (int k = 0; k < 3; k++) area[mesh->vertex[3 * f + (size_t)k]] += third;
    }
}

static uint32_t farthest(const double *distance, size_t count) {
    size_t best = 0;
    for (size_t v = 1; v < count; v++)
        if (distance[v] > distance[best]) best = v;
    return (uint32_t)best;
}

/* The vertex farthest in space from the centroid of the surface: a start that does not depend on
 * the order of the vertices. */
static uint32_t farthest_from_centroid(const gvc_halfedges *mesh, const quadrature *q,
                                       double *scratch) {
    double centroid[3] = {0, 0, 0}, total = 0;
    for (size_t v = 0; v < q->vertex_count; v++) {
        total += q->area[v];
        for (int k = 0; k < 3; k++) centroid[k] += q->area[v] * mesh->position[3 * v + (size_t)k];
    }
    for (int k = 0; k < 3; k++) centroid[k] = total > 0 ? centroid[k] / total : 0;
    for (size_t v = 0; v < q->vertex_count; v++) {
        const double *p = mesh->position + 3 * v;
        double x = p[0] - centroid[0], y = p[1] - centroid[1], z = p[2] - centroid[2];
        scratch[v] = x * x + y * y + z * z;
    }
    return farthest(scratch, q->vertex_count);
}

/* Marches from one sample and keeps its distances and its cell. */
static gvc_result add_sample(gvc_marcher *marcher, quadrature *q, size_t sample, uint32_t vertex,
                             double *greatest, gvc_error *error) {
    GVC_TRY(gvc_march(marcher, &vertex, 1, q->distance, error));
    float *row = q->all + sample * q->vertex_count;
    for (size_t v = 0; v < q->vertex_count; v++) {
        double d = q->distance[v];
        if (!isfinite(d))
            return gvc_fail(error, GVC_ERROR_MESH,
                            "the surface is in pieces: no way from vertex %u to vertex %zu",
                            (unsigned)vertex, v);
        row[v] = (float)d;
        if (d > *greatest) *greatest = d;
        if (sample == 0 || d < q->nearest[v]) {
            q->nearest[v] = d;
            q->owner[v] = (uint32_t)sample;
        }
    }
    return GVC_OK;
}

/* Weighs every sample with the area of its Voronoi cell. */
static gvc_result sum_up(const quadrature *q, double *integral, gvc_error *error) {
    double *weight = gvc_alloc(q->sample_count, sizeof *weight), total = 0;
    if (!weight) return gvc_fail_memory(error);
    for (size_t v = 0; v < q->vertex_count; v++) {
        weight[q->owner[v]] += q->area[v];
        total += q->area[v];
    }
    for (size_t v = 0; v < q->vertex_count; v++) integral[v] = 0;
    for (size_t s = 0; s < q->sample_count; s++) {
        const float *row = q->all + s * q->vertex_count;
        double share = total > 0 ? weight[s] / total : 0;
        for (size_t v = 0; v < q->vertex_count; v++) integral[v] += share * (double)row[v];
    }
    free(weight);
    return GVC_OK;
}

gvc_result gvc_geodesic_integral(const gvc_halfedges *mesh, size_t samples, double *integral,
                                 double *greatest, gvc_error *error) {
    if (samples == 0 || mesh->vertex_count == 0)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "%zu samples of a mesh with %zu vertices",
                        samples, mesh->vertex_count);
    if (samples > mesh->vertex_count) samples = mesh->vertex_count;
    gvc_marcher *marcher = NULL;
    quadrature q;
    GVC_TRY(quadrature_allocate(&q, mesh->vertex_count, samples, error));
    gvc_result result = GVC_OK;
    GVC_CHECK(gvc_marcher_create(mesh, &marcher, error));
    share_areas(mesh, q.area);
    /* Farthest twice: an end of the surface's longest extent, whatever its pose. */
    uint32_t start = farthest_from_centroid(mesh, &q, q.distance);
    GVC_CHECK(gvc_march(marcher, &start, 1, q.distance, error));
    uint32_t next = farthest(q.distance, q.vertex_count);
    *greatest = 0;
    for (size_t s = 0; s < samples; s++) {
        GVC_CHECK(add_sample(marcher, &q, s, next, greatest, error));
        next = farthest(q.nearest, q.vertex_count);
    }
    result = sum_up(&q, integral, error);
cleanup:
    gvc_marcher_destroy(&marcher);
    quadrature_free(&q);
    return result;
}
