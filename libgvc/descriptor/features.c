/* SPDX-License-Identifier: MIT */
/** @file features.c  All that is found on one frame by itself. */
#include "descriptor/features.h"

#include "base/memory.h"
#include "descriptor/clip.h"
#include "descriptor/integral.h"

#include <math.h>
#include <stdlib.h>

static void measure_surface(const gvc_halfedges *mesh, gvc_features *features) {
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double square = 0;
    for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
        low[i % 3] = fmin(low[i % 3], mesh->position[i]);
        high[i % 3] = fmax(high[i % 3], mesh->position[i]);
    }
    for (int k = 0; k < 3; k++) square += (high[k] - low[k]) * (high[k] - low[k]);
    features->diagonal = sqrt(square);
    for (size_t f = 0; f < mesh->face_count; f++) features->area += gvc_face_area(mesh, f);
}

/* Scales mu to [0,1] and takes its least vertex for the root. A constant mu becomes 0. */
static void normalise(gvc_features *features, size_t count) {
    double *mu = features->mu, low = mu[0], high = mu[0];
    for (size_t v = 1; v < count; v++) {
        if (mu[v] < low) {
            low = mu[v];
            features->root = (uint32_t)v;
        }
        high = fmax(high, mu[v]);
    }
    double range = high - low;
    for (size_t v = 0; v < count; v++) mu[v] = range > 0 ? (mu[v] - low) / range : 0;
}

void gvc_features_options_init(gvc_features_options *options) {
    *options = (gvc_features_options){.integral_samples = 60, .candidate_persistence = 0.01};
}

gvc_result gvc_features_find(const gvc_halfedges *mesh, const gvc_features_options *options,
                             gvc_features *features, gvc_error *error) {
    *features = (gvc_features){0};
    if (mesh->vertex_count == 0) return gvc_fail(error, GVC_ERROR_MESH, "the mesh has no vertices");
    gvc_result result = GVC_OK;
    measure_surface(mesh, features);
    features->mu = gvc_alloc(mesh->vertex_count, sizeof *features->mu);
    if (!features->mu) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(gvc_geodesic_integral(mesh, options->integral_samples, features->mu,
                                    &features->geodesic_scale, error));
    normalise(features, mesh->vertex_count);
    result = gvc_extrema_find(mesh, features->mu, options->candidate_persistence,
                              &features->extremum, &features->extremum_count, error);
cleanup:
    if (result != GVC_OK) gvc_features_free(features);
    return result;
}

void gvc_features_free(gvc_features *features) {
    free(features->mu);
    free(features->extremum);
    *features = (gvc_features){0};
}
