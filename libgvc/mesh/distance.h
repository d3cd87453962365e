/* SPDX-License-Identifier: MIT */
/** @file distance.h  Exact closest points on a triangle mesh through a bounding volume hierarchy.
 */
#ifndef GVC_MESH_DISTANCE_H
#define GVC_MESH_DISTANCE_H

#include "mesh/mesh.h"

typedef struct gvc_bvh gvc_bvh;

/** Builds a hierarchy over the faces; the mesh is borrowed and must outlive it. */
gvc_result gvc_bvh_create(const gvc_mesh *mesh, gvc_bvh **bvh, gvc_error *error);
void gvc_bvh_destroy(gvc_bvh **bvh);

typedef struct gvc_closest {
    uint32_t face;
    double barycentric[3];
    double point[3];
    double distance;
} gvc_closest;

/** Closest surface point to `point`. Faces whose normal has a negative scalar product with `normal`
 *  are left out if `normal` is given; faces further than `limit` are not looked for. Returns false
 * if no face qualifies. Exact, deterministic (ties: smallest face index not guaranteed).
 * Thread-safe. */
bool gvc_bvh_closest(const gvc_bvh *bvh, const double point[3], const double *normal, double limit,
                     gvc_closest *closest);

/** Closest point of one triangle, given by 3 coordinates per corner; returns the squared distance
 * and sets point and barycentric coordinates, nothing else. */
double gvc_closest_on_triangle(const double point[3], const double corner[9], gvc_closest *closest);

/** `count` points spread over the surface by area, deterministically: a low-discrepancy sequence
 * over the cumulated areas; consecutive points lie on the same or consecutive faces. `points` has
 * room for 3 * count. GVC_ERROR_MESH if the area is zero or overflows, unless `count` is 0. */
gvc_result gvc_mesh_sample(const gvc_mesh *mesh, size_t count, double *points, gvc_error *error);

#endif
