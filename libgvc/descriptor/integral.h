/* SPDX-License-Identifier: MIT */
/** @file integral.h  The geodesic integral mu (Tung & Matsuyama, Eq. 1). */
#ifndef GVC_DESCRIPTOR_INTEGRAL_H
#define GVC_DESCRIPTOR_INTEGRAL_H

#include "descriptor/geodesic.h"

/** mu(v) = sum over `samples` farthest-point samples s of area(cell of s) * g(v, s), divided by the
 *  surface area, so in the unit of the mesh. `integral` has room for vertex_count. `*greatest` gets
 * the greatest geodesic distance met, which normalises g (Def. 2). Deterministic; neither pose nor
 * vertex order matter, but for ties. More samples than vertices mean all vertices. GVC_ERROR_MESH
 * if the surface is in pieces. */
gvc_result gvc_geodesic_integral(const gvc_halfedges *mesh, size_t samples, double *integral,
                                 double *greatest, gvc_error *error);

#endif
