/* SPDX-License-Identifier: MIT */
/**
 * @file rigid.h
 * How the surface round a point moved from one frame to the next: iterated closest points between a
 * patch of the frame before and the surface now (point to plane: Chen & Medioni 1992). Geodesic
 * distances hardly tell the front of a body from its back; its motion does.
 */
#ifndef GVC_DESCRIPTOR_RIGID_H
#define GVC_DESCRIPTOR_RIGID_H

#include "mesh/halfedge.h"

/** Points of a surface with normals and the areas they stand for. */
typedef struct gvc_patch {
    size_t count;
    double *point, *normal; /**< 3 each */
    double *area;
} gvc_patch;

/** x moves to rotation * x + shift. */
typedef struct gvc_rigid {
    double rotation[9]; /**< row-major */
    double shift[3];
} gvc_rigid;

/** The vertices whose `distance` (one value every `stride` doubles) is at most `radius`. Free with
 *  gvc_patch_free; empty on failure. */
gvc_result gvc_patch_take(const gvc_halfedges *mesh, const double *distance, size_t stride,
                          double radius, gvc_patch *patch, gvc_error *error);
void gvc_patch_free(gvc_patch *patch);

/** The rigid motion that takes the patch to the surface `mesh`. Points further than `gate` from it,
 * or whose closest face looks the other way, do not count. The identity if too few points do. */
gvc_result gvc_patch_follow(const gvc_patch *patch, const gvc_halfedges *mesh, double gate,
                            gvc_rigid *motion, gvc_error *error);

void gvc_rigid_apply(const gvc_rigid *motion, const double point[3], double moved[3]);

#endif
