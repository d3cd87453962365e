/* SPDX-License-Identifier: MIT */
/** @file ambiguity.h  How well geodesic distances to some features tell points apart (Fig. 3b). */
#ifndef GVC_DESCRIPTOR_AMBIGUITY_H
#define GVC_DESCRIPTOR_AMBIGUITY_H

#include "mesh/halfedge.h"

/** Tolerance of Definition 2 that shows the differences on a human figure: with five tips its hands
 * are alike to 0.5 % of the surface, rings round head and waist to over 2 %. */
#define GVC_AMBIGUITY_EPSILON 0.1

/** For every vertex, the share (0 .. 1) of the surface's area that is geodesically consistent to
 * it (Definition 2): where the distances to `count` feature vertices, divided by the greatest of
 * all, differ in sum by less than `epsilon`. `share` has room for vertex_count. Takes time
 * proportional to the square of the vertices, whose number is expected to be some 10,000.
 * GVC_ERROR_MESH if a part cannot be reached from the features. */
gvc_result gvc_ambiguity(const gvc_halfedges *mesh, const uint32_t *feature, size_t count,
                         double epsilon, double *share, gvc_error *error);

#endif
