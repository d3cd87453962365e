/* SPDX-License-Identifier: MIT */
/** @file sample.c  Evenly spread points on the surface of a mesh. */
#include "mesh/distance.h"

#include <math.h>

/* Powers 1/g and 1/g^2 of the plastic number, g^3 = g + 1: their multiples modulo 1 spread best
 * over the square (the R2 sequence of M. Roberts). With the position along the cumulated areas as a
 * third coordinate, i / count, the points form a Hammersley-like set of low discrepancy. */
#define STEP_1 0.7548776662466927
#define STEP_2 0.5698402909980532

static double face_area(const gvc_mesh *mesh, size_t f) {
    const double *a = mesh->position + 3 * (size_t)mesh->face[3 * f];
    const double *b = mesh->position + 3 * (size_t)mesh->face[3 * f + 1];
    const double *c = mesh->position + 3 * (size_t)mesh->face[3 * f + 2];
    double u[3], v[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    double x = u[1] * v[2] - u[2] * v[1];
    double y = u[2] * v[0] - u[0] * v[2];
    double z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

/* The point of face f at (s, t) of the unit square, by the area-preserving map that folds the
 * square's side s = 0 onto the first corner. */
static void point_on_face(const gvc_mesh *mesh, size_t f, double s, double t, double point[3]) {
    double root = sqrt(s);
    double weight[3] = {1 - root, root * (1 - t), root * t};
    for (int k = 0; k < 3; k++) {
        point[k] = 0;
        for (int c = 0; c < 3; c++) {
            point[k] += weight[c] * mesh->position[3 * (size_t)mesh->face[3 * f + c] + k];
        }
    }
}

gvc_result gvc_mesh_sample(const gvc_mesh *mesh, size_t count, double *points, gvc_error *error) {
    if (count == 0) return GVC_OK;
    double total = 0;
    for (size_t f = 0; f < mesh->face_count; f++) total += face_area(mesh, f);
    if (!isfinite(total) || !(total > 0)) {
        return gvc_fail(error, GVC_ERROR_MESH,
                        "cannot take samples: the area of the %zu faces is %s", mesh->face_count,
                        total > 0 ? "too large to compute" : "zero");
    }
    /* The areas are summed a second time in the same order, so `reached` ends exactly at `total`
     * and the last face needs no special care beyond the bound. */
    size_t f = 0;
    double reached = face_area(mesh, 0), first = 0, second = 0;
    for (size_t i = 0; i < count; i++) {
        double target = ((double)i + 0.5) / (double)count * total;
        while (target >= reached && f + 1 < mesh->face_count) reached += face_area(mesh, ++f);
        first += STEP_1;
        second += STEP_2;
        first -= floor(first);
        second -= floor(second);
        point_on_face(mesh, f, first, second, points + 3 * i);
    }
    return GVC_OK;
}
