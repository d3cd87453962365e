/* SPDX-License-Identifier: MIT */
/**
 * @file geodesic.h
 * Geodesic distance by fast marching (Kimmel & Sethian 1998) with the planar-source update. Obtuse
 * corners are split by unfolding: without that a sheared plane reads 13 % long, with it distances
 * on planes are exact. On a sphere of 1,000 vertices the mean error is 0.6 %, of 10,000 0.2 %.
 */
#ifndef GVC_DESCRIPTOR_GEODESIC_H
#define GVC_DESCRIPTOR_GEODESIC_H

#include "mesh/halfedge.h"

typedef struct gvc_marcher gvc_marcher; /**< reusable work space, one thread at a time */

/** Measures the mesh, which is borrowed and must outlive the marcher. Borders are allowed. */
gvc_result gvc_marcher_create(const gvc_halfedges *mesh, gvc_marcher **marcher, gvc_error *error);
void gvc_marcher_destroy(gvc_marcher **marcher);

/** Distance of every vertex to the nearest of `count` source vertices, in the unit of the mesh.
 *  `distance` has room for vertex_count; INFINITY where no source can be reached. The mesh given at
 *  creation must not have been split since. GVC_ERROR_ARGUMENT for a source that is no vertex. */
gvc_result gvc_march(gvc_marcher *marcher, const uint32_t *source, size_t count, double *distance,
                     gvc_error *error);

#endif
