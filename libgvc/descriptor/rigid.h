/* SPDX-License-Identifier: MIT */
/**
 * @file rigid.h
 * How a surface moved as a whole from one frame to the next: iterated closest points to planes
 * (Chen & Medioni 1992). A body that turns does not say so point by point: without this the surface
 * slides back along itself.
 */
#ifndef GVC_DESCRIPTOR_RIGID_H
#define GVC_DESCRIPTOR_RIGID_H

#include "mesh/distance.h"
#include "mesh/halfedge.h"

/** x moves to rotation * x + shift. */
typedef struct gvc_rigid {
    double rotation[9]; /**< row-major */
    double shift[3];
} gvc_rigid;

/** The rigid motion that takes `count` points, with unit normals, to the surface `to` with its
 * hierarchy. Points further than `gate` from it, or whose closest face looks the other way, do not
 * count. The identity if too few points do. */
void gvc_rigid_follow(const double *point, const double *normal, size_t count,
                      const gvc_halfedges *to, const gvc_bvh *bvh, double gate, gvc_rigid *motion);

void gvc_rigid_apply(const gvc_rigid *motion, const double point[3], double moved[3]);

#endif
