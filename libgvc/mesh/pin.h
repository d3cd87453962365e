/* SPDX-License-Identifier: MIT */
/** @file pin.h  A vertex where a point is to be. */
#ifndef GVC_MESH_PIN_H
#define GVC_MESH_PIN_H

#include "mesh/distance.h"
#include "mesh/halfedge.h"

/** The vertex of `mesh` at the point of its surface that is nearest to `point`: one that is there
 * already (to a tenth of an edge), or a new one made by splits. `bvh` is of the mesh when it had
 * `face_count` faces; it may have been split since. */
gvc_result gvc_pin(gvc_halfedges *mesh, const gvc_bvh *bvh, size_t face_count,
                   const double point[3], uint32_t *vertex, gvc_error *error);

#endif
