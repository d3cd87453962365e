/* SPDX-License-Identifier: MIT */
/** @file warp.c  Where points of one frame's surface are in the next frame. */
#include "descriptor/warp.h"

#include "base/memory.h"
#include "descriptor/registration.h"
#include "mesh/pin.h"

#include <math.h>
#include <stdlib.h>

struct gvc_warp {
    gvc_mesh *from;
    gvc_bvh *from_bvh, *to_bvh;
    size_t to_faces;
    double *moved;
};

static gvc_result create(gvc_warp *w, const gvc_halfedges *from, const gvc_halfedges *to,
                         gvc_error *error) {
    const gvc_mesh later = {to->vertex_count, to->face_count, to->position, to->vertex};
    GVC_TRY(gvc_mesh_create(from->position, from->vertex_count, from->vertex, from->face_count,
                            &w->from, error));
    GVC_TRY(gvc_bvh_create(w->from, &w->from_bvh, error));
    GVC_TRY(gvc_bvh_create(&later, &w->to_bvh, error));
    w->to_faces = to->face_count;
    w->moved = gvc_alloc(from->vertex_count, 3 * sizeof *w->moved);
    if (!w->moved) return gvc_fail_memory(error);
    return gvc_register(from, to, w->to_bvh, w->moved, error);
}

gvc_result gvc_warp_create(const gvc_halfedges *from, const gvc_halfedges *to, gvc_warp **warp,
                           gvc_error *error) {
    gvc_warp *w = gvc_alloc(1, sizeof *w);
    *warp = w;
    if (!w) return gvc_fail_memory(error);
    gvc_result result = create(w, from, to, error);
    if (result != GVC_OK) gvc_warp_destroy(warp);
    return result;
}

void gvc_warp_destroy(gvc_warp **warp) {
    if (!warp || !*warp) return;
    gvc_bvh_destroy(&(*warp)->from_bvh);
    gvc_bvh_destroy(&(*warp)->to_bvh);
    gvc_mesh_destroy(&(*warp)->from);
    free((*warp)->moved);
    free(*warp);
    *warp = NULL;
}

void gvc_warp_point(const gvc_warp *warp, const double point[3], double moved[3]) {
    gvc_closest found;
    if (!gvc_bvh_closest(warp->from_bvh, point, NULL, INFINITY, &found)) {
        for (int k = 0; k < 3; k++) moved[k] = point[k];
        return;
    }
    const uint32_t *v = warp->from->face + 3 * (size_t)found.face;
    for (int k = 0; k < 3; k++) {
        double at = point[k] - found.point[k];
        for (int i = 0; i < 3; i++) at += found.barycentric[i] * warp->moved[3 * (size_t)v[i] + k];
        moved[k] = at;
    }
}

gvc_result gvc_warp_pin(const gvc_warp *warp, gvc_halfedges *to, const double point[3],
                        uint32_t *vertex, gvc_error *error) {
    return gvc_pin(to, warp->to_bvh, warp->to_faces, point, vertex, error);
}
