/* SPDX-License-Identifier: MIT */
/** @file conjugate_gradient.c  Preconditioned conjugate gradients, free of any matrix format. */
#include "base/conjugate_gradient.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

static double dot(size_t n, const double *a, const double *b) {
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/** Square of the residual's norm in the preconditioner's metric. */
static double precondition(size_t n, const double *diagonal, const double *residual, double *z) {
    for (size_t i = 0; i < n; i++) z[i] = residual[i] / diagonal[i];
    return dot(n, residual, z);
}

gvc_result gvc_conjugate_gradient(size_t n, gvc_operator apply, void *context,
                                  const double *diagonal, const double *b, double tolerance,
                                  unsigned most, double *x, unsigned *iterations,
                                  gvc_error *error) {
    if (iterations) *iterations = 0;
    double *residual = gvc_alloc(n, sizeof *residual), *z = gvc_alloc(n, sizeof *z);
    double *direction = gvc_alloc(n, sizeof *direction), *image = gvc_alloc(n, sizeof *image);
    gvc_result result = GVC_OK;
    if (!residual || !z || !direction || !image) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    double goal = tolerance * tolerance * precondition(n, diagonal, b, z);
    apply(context, x, image);
    for (size_t i = 0; i < n; i++) residual[i] = b[i] - image[i];
    double rho = precondition(n, diagonal, residual, z);
    for (size_t i = 0; i < n; i++) direction[i] = z[i];
    for (unsigned step = 1; step <= most && rho > goal; step++) {
        apply(context, direction, image);
        double curvature = dot(n, direction, image);
        if (!(curvature > 0)) break; /* rounding has used up the direction */
        double length = rho / curvature;
        for (size_t i = 0; i < n; i++) x[i] += length * direction[i];
        for (size_t i = 0; i < n; i++) residual[i] -= length * image[i];
        double next = precondition(n, diagonal, residual, z), turn = next / rho;
        for (size_t i = 0; i < n; i++) direction[i] = z[i] + turn * direction[i];
        rho = next;
        if (iterations) *iterations = step;
    }
cleanup:
    free(residual);
    free(z);
    free(direction);
    free(image);
    return result;
}
