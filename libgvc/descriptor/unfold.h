/* SPDX-License-Identifier: MIT */
/** @file unfold.h  Triangles laid out in the plane, and the splitting of obtuse corners by
 * unfolding (Kimmel & Sethian 1998, Sect. 4), which fast marching needs on irregular meshes. */
#ifndef GVC_DESCRIPTOR_UNFOLD_H
#define GVC_DESCRIPTOR_UNFOLD_H

#include "mesh/halfedge.h"

/** A triangle with its base from (0, 0) to (length, 0) and its third corner, the apex, above it. */
typedef struct gvc_apex {
    double length, inverse_length; /**< of the base; the inverse is 0 for a base of length 0 */
    double x, y;                   /**< of the apex; y >= 0 */
} gvc_apex;

/** From the length of the base, the length of the side from its start to the apex, and the scalar
 *  product of the two. */
gvc_apex gvc_apex_make(double base, double side, double product);

/** An obtuse corner, split into two acute ones by the line to a vertex found by unfolding the faces
 *  opposite the corner into its plane. */
typedef struct gvc_split {
    uint32_t corner, far;
    uint32_t near[2];  /**< the other corners of the obtuse face */
    double far_length; /**< of the line from the corner to `far` */
    gvc_apex apex[2];  /**< the corner over the base from near[i] to `far` */
} gvc_split;

/** All splits of a mesh, and for each vertex those in which it is near or far. */
typedef struct gvc_unfolding {
    size_t split_count;
    gvc_split *split;
    uint32_t *first;    /**< vertex_count + 1: where each vertex' part of `incident` begins */
    uint32_t *incident; /**< 3 * split_count */
} gvc_unfolding;

/** `apex` holds, per halfedge, the third corner of its face over it. Free with gvc_unfolding_free;
 *  empty on failure. */
gvc_result gvc_unfold(const gvc_halfedges *mesh, const gvc_apex *apex, gvc_unfolding *unfolding,
                      gvc_error *error);
void gvc_unfolding_free(gvc_unfolding *unfolding);

#endif
