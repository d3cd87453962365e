/* SPDX-License-Identifier: MIT */
/**
 * @file prior.h
 * Distance from a point to a path in the space of geodesic coordinates (Definition 2), which is
 * what the terms E_p and E_d (Eqs. 7 and 8) compare.
 *
 * The coordinates of a point are its normalised geodesic distances to all features, and its
 * position relative to the diagonal, moved along with the surface, at a high weight: it resolves
 * what symmetry leaves open, and is the more exact (docs/adr/0012).
 */
#ifndef GVC_DESCRIPTOR_PRIOR_H
#define GVC_DESCRIPTOR_PRIOR_H

#include "base/result.h"

enum { GVC_PRIOR_SEGMENTS = 64 };

/** A path as a polyline of GVC_PRIOR_SEGMENTS equal steps, with a tree of bounding boxes over them.
 *  Zero-initialise; free with gvc_prior_free. */
typedef struct gvc_prior {
    size_t dimensions;
    double *sample; /**< GVC_PRIOR_SEGMENTS + 1 points */
    double *box;    /**< lower and upper corner per tree node; node i has children 2i and 2i + 1 */
} gvc_prior;

void gvc_prior_free(gvc_prior *prior);

/** Resamples a polyline of `count` >= 1 points, `dimensions` coordinates each, at equal steps of
 *  `length` (cumulated, one per point, ascending from 0). Replaces what was there. */
gvc_result gvc_prior_set(gvc_prior *prior, size_t dimensions, const double *point,
                         const double *length, size_t count, gvc_error *error);

/** Moves every point of the path: `move` changes the coordinates of one. */
void gvc_prior_move(gvc_prior *prior, void (*move)(const void *context, double *point),
                    const void *context);

/** Squared distance to the path, or `limit` if that is smaller. */
double gvc_prior_distance(const gvc_prior *prior, const double *point, double limit);

#endif
