/* SPDX-License-Identifier: MIT */
/** @file ambiguity.c  Ambiguity of geodesic consistency. */
#include "descriptor/ambiguity.h"

#include "base/memory.h"
#include "descriptor/geodesic.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>

/* Distances to the features, one row per vertex, divided by the greatest. */
static gvc_result measure(const gvc_halfedges *mesh, const uint32_t *feature, size_t count,
                          double *row, gvc_error *error) {
    gvc_marcher *marcher = NULL;
    size_t vertices = mesh->vertex_count;
    double greatest = 0, *distance = gvc_alloc(vertices, sizeof *distance);
    gvc_result result = distance ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_marcher_create(mesh, &marcher, error);
    for (size_t k = 0; k < count && result == GVC_OK; k++) {
        result = gvc_march(marcher, feature + k, 1, distance, error);
        for (size_t v = 0; v < vertices; v++) {
            row[v * count + k] = distance[v];
            greatest = fmax(greatest, distance[v]);
        }
    }
    if (result == GVC_OK && !isfinite(greatest))
        result = gvc_fail(error, GVC_ERROR_MESH, "the surface has several components");
    for (size_t i = 0; i < vertices * count && greatest > 0; i++) row[i] /= greatest;
    gvc_marcher_destroy(&marcher);
    free(distance);
    return result;
}

/* A third of the area of the faces round each vertex; returns their sum. */
static double measure_areas(const gvc_halfedges *mesh, double *area) {
    double sum = 0;
    for (size_t h = 0; h < 3 * mesh->face_count; h += 3) {
        double normal[3];
        gvc_face_area_normal(mesh, h / 3, normal);
        double third = sqrt(gvc_dot(normal, normal)) / 6;
        for (size_t k = 0; k < 3; k++) area[mesh->vertex[h + k]] += third;
        sum += 3 * third;
    }
    return sum;
}

static bool consistent(const double *a, const double *b, size_t count, double epsilon) {
    double sum = 0;
    for (size_t k = 0; k < count && sum < epsilon; k++) sum += fabs(a[k] - b[k]);
    return sum < epsilon;
}

gvc_result gvc_ambiguity(const gvc_halfedges *mesh, const uint32_t *feature, size_t count,
                         double epsilon, double *share, gvc_error *error) {
    size_t vertices = mesh->vertex_count;
    double *row = gvc_alloc(vertices * count, sizeof *row);
    double *area = gvc_alloc(vertices, sizeof *area);
    gvc_result result = row && area ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = measure(mesh, feature, count, row, error);
    if (result == GVC_OK) {
        double whole = measure_areas(mesh, area);
        for (size_t v = 0; v < vertices; v++) share[v] = 0;
        for (size_t v = 0; v < vertices; v++) {
            share[v] += area[v];
            for (size_t w = v + 1; w < vertices; w++) {
                if (!consistent(row + v * count, row + w * count, count, epsilon)) continue;
                share[v] += area[w];
                share[w] += area[v];
            }
        }
        for (size_t v = 0; v < vertices && whole > 0; v++) share[v] /= whole;
    }
    free(row);
    free(area);
    return result;
}
