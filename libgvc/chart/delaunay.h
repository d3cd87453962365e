/* SPDX-License-Identifier: MIT */
/** @file delaunay.h  Intrinsic Delaunay triangulation: the vertices and the surface of a mesh, but
 * other edges, which run straight across its faces (Bobenko & Springborn 2007). */
#ifndef GVC_CHART_DELAUNAY_H
#define GVC_CHART_DELAUNAY_H

#include "mesh/halfedge.h"

/** Triangles with their edge lengths, numbered and joined as in gvc_halfedges. Two vertices may be
 * joined by several edges, and an edge may end where it began. */
typedef struct gvc_intrinsic {
    size_t face_count;
    uint32_t *outgoing, *vertex, *twin; /**< see gvc_halfedges */
    double *length;                     /**< per halfedge */
} gvc_intrinsic;

/** Starts from the mesh's own triangles and flips edges until every edge is locally Delaunay: the
 * two angles opposite it sum to pi at most. Edges of the border stay. Free with
 * gvc_intrinsic_free; empty on failure. */
gvc_result gvc_delaunay(const gvc_halfedges *mesh, gvc_intrinsic *intrinsic, gvc_error *error);
void gvc_intrinsic_free(gvc_intrinsic *intrinsic);

/** Cotangent of the angle opposite a halfedge in its face, at most 1e6 either way. */
double gvc_intrinsic_cotangent(const gvc_intrinsic *intrinsic, uint32_t h);
/** Lays the face of halfedge `h` into the plane: `a` and `b` get x and y of its sides from the
 * start of `h` to the other two corners. */
void gvc_intrinsic_lay(const gvc_intrinsic *intrinsic, uint32_t h, double a[2], double b[2]);

#endif
