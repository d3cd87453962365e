/* SPDX-License-Identifier: MIT */
/** @file clip.c  Areas of faces and of their parts below a level of a linear function. */
#include "descriptor/clip.h"

#include <math.h>

double gvc_face_area(const gvc_halfedges *mesh, size_t face) {
    const double *a = mesh->position + 3 * mesh->vertex[3 * face];
    const double *b = mesh->position + 3 * mesh->vertex[3 * face + 1];
    const double *c = mesh->position + 3 * mesh->vertex[3 * face + 2];
    double u[3], v[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
           z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

double gvc_part_below(const double value[3], double level) {
    double low = fmin(value[0], fmin(value[1], value[2]));
    double high = fmax(value[0], fmax(value[1], value[2]));
    double middle = fmax(fmin(value[0], value[1]), fmin(fmax(value[0], value[1]), value[2]));
    if (level <= low) return 0;
    if (level >= high) return 1;
    /* The corner cut off is similar in both directions: the part is a product of two ratios. */
    if (level < middle) return (level - low) / (middle - low) * ((level - low) / (high - low));
    return 1 - (high - level) / (high - middle) * ((high - level) / (high - low));
}
