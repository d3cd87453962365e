/* SPDX-License-Identifier: MIT */
/** @file order.h  Sorting edges and faces of a mesh by their vertices in linear time. */
#ifndef GVC_MESH_ORDER_H
#define GVC_MESH_ORDER_H

#include "mesh/mesh.h"

/** Every halfedge (3 * face + corner, from that corner to the next) of the mesh, sorted by smaller
 *  end, then greater end, then index, so that the halfedges of one edge are neighbours. `*order`
 *  holds 3 * face_count indices; free with free(). GVC_ERROR_MESH if there are too many faces. */
gvc_result gvc_order_halfedges(const gvc_mesh *mesh, uint32_t **order, gvc_error *error);

/** Sets repeated[f] for each face f that has the same three vertices as an earlier one, and clears
 * it for the others. */
gvc_result gvc_mark_repeated_faces(const gvc_mesh *mesh, bool *repeated, gvc_error *error);

/** The two ends of halfedge h of a mesh, and the same in ascending order. */
static inline uint32_t gvc_start_of(const gvc_mesh *mesh, uint32_t h) { return mesh->face[h]; }
static inline uint32_t gvc_end_of(const gvc_mesh *mesh, uint32_t h) {
    return mesh->face[h % 3 == 2 ? h - 2 : h + 1];
}
static inline bool gvc_same_edge(const gvc_mesh *mesh, uint32_t g, uint32_t h) {
    uint32_t a = gvc_start_of(mesh, g), b = gvc_end_of(mesh, g);
    uint32_t c = gvc_start_of(mesh, h), d = gvc_end_of(mesh, h);
    return (a == c && b == d) || (a == d && b == c);
}
static inline bool gvc_is_degenerate(const gvc_mesh *mesh, uint32_t face) {
    const uint32_t *v = mesh->face + 3 * (size_t)face;
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

#endif
