/* SPDX-License-Identifier: MIT */
/** @file mesh.h  The plain triangle mesh and its small helpers. */
#ifndef GVC_MESH_MESH_H
#define GVC_MESH_MESH_H

#include "base/result.h"

struct gvc_mesh {
    size_t vertex_count, face_count;
    double *position; /**< 3 * vertex_count */
    uint32_t *face;   /**< 3 * face_count */
};

/** A mesh with room for the counts, everything zero. */
gvc_result gvc_mesh_allocate(size_t vertex_count, size_t face_count, gvc_mesh **mesh,
                             gvc_error *error);

/** Bounding box; undefined for a mesh without vertices. Unreferenced vertices are left out. */
void gvc_mesh_bounds(const gvc_mesh *mesh, double minimum[3], double maximum[3]);
/** Length of the bounding box's diagonal. */
double gvc_mesh_diagonal(const gvc_mesh *mesh);
double gvc_mesh_area(const gvc_mesh *mesh);

/** Makes a mesh ready for coding: drops unreferenced vertices and degenerate or duplicate faces,
 * and, if `weld` and the mesh as given is not closed (captures split along texture seams), merges
 * exactly equal positions, unless that makes non-manifold edges or vertices that were not there
 * before (a lattice-quantised capture). `*welded` tells how many vertices were merged. The input is
 * unchanged. */
gvc_result gvc_mesh_clean(const gvc_mesh *mesh, bool weld, gvc_mesh **clean, size_t *welded,
                          gvc_error *error);

#endif
