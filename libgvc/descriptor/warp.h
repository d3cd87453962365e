/* SPDX-License-Identifier: MIT */
/** @file warp.h  Where points of one frame's surface are in the next frame (registration.h). */
#ifndef GVC_DESCRIPTOR_WARP_H
#define GVC_DESCRIPTOR_WARP_H

#include "mesh/halfedge.h"

typedef struct gvc_warp gvc_warp;

/** Registers `from` with `to`, both closed and not refined, and keeps what gvc_warp_point needs of
 * them. Free with gvc_warp_destroy. */
gvc_result gvc_warp_create(const gvc_halfedges *from, const gvc_halfedges *to, gvc_warp **warp,
                           gvc_error *error);
void gvc_warp_destroy(gvc_warp **warp);

/** Moves a point as the nearest point of the earlier surface has moved. `point` and `moved` may be
 * the same. Thread-safe. */
void gvc_warp_point(const gvc_warp *warp, const double point[3], double moved[3]);

/** The vertex of the later mesh, which may have been split since, at the point of its surface
 * nearest to `point`; made by splits if there is none. */
gvc_result gvc_warp_pin(const gvc_warp *warp, gvc_halfedges *to, const double point[3],
                        uint32_t *vertex, gvc_error *error);

#endif
