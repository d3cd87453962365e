/* SPDX-License-Identifier: MIT */
/** @file consistent.h  Finds the point of a surface that is geodesically consistent to another
 * (Def. 2). */
#ifndef GVC_DESCRIPTOR_CONSISTENT_H
#define GVC_DESCRIPTOR_CONSISTENT_H

#include "descriptor/coordinates.h"

/** Vertex at the point whose first `features` coordinates differ least from those of `wanted` (sum
 * of absolute differences, Def. 2), with a term for position, which decides where symmetry does
 * not; made by an edge split if the point is inside an edge. Never one of the `taken` vertices;
 * GVC_NONE if there is no other. `wanted` holds all coordinates. */
gvc_result gvc_consistent_vertex(gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                                 size_t features, const double *wanted, const uint32_t *taken,
                                 size_t taken_count, uint32_t *vertex, gvc_error *error);

/** The vertex nearest to the position that coordinates hold. */
uint32_t gvc_nearest_vertex(const gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                            const double *point);

#endif
