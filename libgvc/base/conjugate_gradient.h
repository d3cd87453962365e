/* SPDX-License-Identifier: MIT */
/** @file conjugate_gradient.h  Preconditioned conjugate gradients, free of any matrix format. */
#ifndef GVC_BASE_CONJUGATE_GRADIENT_H
#define GVC_BASE_CONJUGATE_GRADIENT_H

#include "base/result.h"

/** y = A x for a symmetric positive definite A of `n` rows; must write all of y. */
typedef void (*gvc_operator)(void *context, const double *x, double *y);

/** Solves A x = b from the start value in `x`, preconditioned by the diagonal of A (Jacobi), whose
 * entries are positive. Stops when the preconditioned residual has fallen to `tolerance` times
 * that of x = 0, or after `most` iterations: both are good enough for what is smoothed or fitted
 * here, so only a lack of memory fails. `iterations` may be NULL. */
gvc_result gvc_conjugate_gradient(size_t n, gvc_operator apply, void *context,
                                  const double *diagonal, const double *b, double tolerance,
                                  unsigned most, double *x, unsigned *iterations, gvc_error *error);

#endif
