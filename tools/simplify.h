/* SPDX-License-Identifier: MIT */
/** @file simplify.h  Meshes with fewer vertices: the paper's reference for errors (Table 2). */
#ifndef GVC_TOOLS_SIMPLIFY_H
#define GVC_TOOLS_SIMPLIFY_H

#include "gvc/gvc.h"

/** Simplifies a closed manifold mesh to `vertices` vertices by collapsing edges in the order of
 * quadric error (Garland and Heckbert 1997), quadrics weighted by area, new vertices where the
 * error is least. A collapse that would change the topology or turn a face over is left out, so
 * more vertices may remain, at least 4. Deterministic. The caller destroys `*simple`. */
gvc_result simplify_mesh(const gvc_mesh *mesh, size_t vertices, gvc_mesh **simple,
                         gvc_error *error);

#endif
