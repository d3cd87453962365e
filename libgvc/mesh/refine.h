/* SPDX-License-Identifier: MIT */
/** @file refine.h  Splits long edges, so that what is found on a surface does not depend on how
 * coarsely it is meshed (docs/adr/0014). */
#ifndef GVC_MESH_REFINE_H
#define GVC_MESH_REFINE_H

#include "mesh/halfedge.h"

/** Default of gvc_encode_options.longest_edge: as a part of the root of the surface's area. */
#define GVC_LONGEST_EDGE 0.024

/** Splits the longest edge in the middle, again and again, until none is longer than `longest` or
 * there are `most` vertices. The surface stays the same, point for point, and so do vertices and
 * their numbers; attributes are interpolated. Longest first, angles do not degenerate: no less than
 * half of the least one given (Rosenberg & Stenger 1975). */
gvc_result gvc_refine(gvc_halfedges *mesh, double longest, size_t most, gvc_error *error);

#endif
