/* SPDX-License-Identifier: MIT */
/**
 * @file halfedge.h
 * Halfedges of a triangle mesh in corner-table form: halfedge h = 3 * face + corner starts at
 * vertex[h] and ends at vertex[next(h)]; its twin runs the other way in the neighbouring face.
 * Grows by edge splits, which keep every existing vertex, face and surface point where it is.
 */
#ifndef GVC_MESH_HALFEDGE_H
#define GVC_MESH_HALFEDGE_H

#include "mesh/mesh.h"

#define GVC_NONE UINT32_MAX

typedef struct gvc_halfedges {
    size_t vertex_count, face_count;
    size_t vertex_capacity, face_capacity;
    size_t attribute_count; /**< doubles carried per vertex, interpolated by splits */
    double *position;       /**< 3 per vertex */
    double *attribute;      /**< attribute_count per vertex; NULL if that is 0 */
    uint32_t *outgoing; /**< per vertex: one halfedge that starts there (on a border: the one that
                           has no twin, so that gvc_turn meets every face from it) */
    uint32_t *vertex;   /**< per halfedge: the vertex it starts at */
    uint32_t *twin;     /**< per halfedge: GVC_NONE on a border */
} gvc_halfedges;

static inline uint32_t gvc_next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
static inline uint32_t gvc_prev(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

/** Builds halfedges of an edge-manifold, vertex-manifold, consistently oriented mesh (borders
 * allowed) without unreferenced vertices. GVC_ERROR_MESH otherwise. `attribute_count` channels
 * start as zero. On failure `halfedges` is empty. Free with gvc_halfedges_free. */
gvc_result gvc_halfedges_build(const gvc_mesh *mesh, size_t attribute_count,
                               gvc_halfedges *halfedges, gvc_error *error);
void gvc_halfedges_free(gvc_halfedges *halfedges);
gvc_result gvc_halfedges_copy(const gvc_halfedges *from, gvc_halfedges *to, gvc_error *error);

/** Splits the edge of `h` at start + t * (end - start), 0 < t < 1. The new vertex is the last one;
 * its position and attributes are interpolated. `h` then ends at the new vertex, and keeps its
 * face. The new faces are appended (two, or one on a border). */
gvc_result gvc_halfedges_split(gvc_halfedges *halfedges, uint32_t h, double t, uint32_t *vertex,
                               gvc_error *error);

/** The halfedge from `from` to `to`, or GVC_NONE. */
uint32_t gvc_halfedge_between(const gvc_halfedges *halfedges, uint32_t from, uint32_t to);
double gvc_halfedge_length(const gvc_halfedges *halfedges, uint32_t h);
/** Its length is twice the area of the face; it points outwards. */
void gvc_face_area_normal(const gvc_halfedges *halfedges, size_t face, double normal[3]);
/** Unit length, or 0 for a face without area. */
void gvc_face_normal(const gvc_halfedges *halfedges, size_t face, double normal[3]);

/** Turns to the next halfedge that starts at the same vertex (counter-clockwise seen from outside);
 *  GVC_NONE at a border. Iterate:
 *  `uint32_t h = m->outgoing[v]; do { ... h = gvc_turn(m, h); } while (h != GVC_NONE && h !=
 * m->outgoing[v]);` */
static inline uint32_t gvc_turn(const gvc_halfedges *m, uint32_t h) { return m->twin[gvc_prev(h)]; }

#endif
