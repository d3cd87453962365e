/* SPDX-License-Identifier: MIT */
/** @file pin.c  A vertex where a point is to be. */
#include "mesh/pin.h"

#include <math.h>
#include <string.h>

/* Nearer to a vertex or an edge than this share of the face, a point is taken to be on it. */
static const double snap = 0.1;

static double closest_in_face(const gvc_halfedges *mesh, size_t face, const double point[3],
                              gvc_closest *closest) {
    double corner[9];
    for (size_t k = 0; k < 3; k++)
        memcpy(corner + 3 * k, mesh->position + 3 * (size_t)mesh->vertex[3 * face + k],
               3 * sizeof *corner);
    closest->face = (uint32_t)face;
    return gvc_closest_on_triangle(point, corner, closest);
}

/* Looks for a nearer point in the faces that splits have made, or have changed. */
static void search_again(const gvc_halfedges *mesh, size_t face_count, const double point[3],
                         gvc_closest *best) {
    double least = closest_in_face(mesh, best->face, point, best);
    for (size_t f = face_count; f < mesh->face_count; f++) {
        gvc_closest found;
        double squared = closest_in_face(mesh, f, point, &found);
        if (squared >= least) continue;
        least = squared;
        *best = found;
    }
}

/* The corner of least share becomes 0 if it is next to nothing; then it is an edge's point. */
static gvc_result insert(gvc_halfedges *mesh, uint32_t face, const double share[3],
                         uint32_t *vertex, gvc_error *error) {
    int least = share[1] < share[0] ? 1 : 0;
    if (share[2] < share[least]) least = 2;
    uint32_t h = 3 * face + (uint32_t)(least + 1) % 3; /* the edge opposite */
    double a = share[(least + 1) % 3], b = share[(least + 2) % 3];
    uint32_t apex = mesh->vertex[3 * face + (uint32_t)least], middle;
    GVC_TRY(gvc_halfedges_split(mesh, h, b / (a + b), &middle, error));
    *vertex = middle;
    if (share[least] < snap) return GVC_OK;
    return gvc_halfedges_split(mesh, gvc_halfedge_between(mesh, middle, apex), share[least], vertex,
                               error);
}

gvc_result gvc_pin(gvc_halfedges *mesh, const gvc_bvh *bvh, size_t face_count,
                   const double point[3], uint32_t *vertex, gvc_error *error) {
    gvc_closest best;
    *vertex = GVC_NONE;
    if (!gvc_bvh_closest(bvh, point, NULL, INFINITY, &best))
        return gvc_fail(error, GVC_ERROR_MESH, "the surface has no points");
    if (mesh->face_count > face_count) search_again(mesh, face_count, point, &best);
    for (uint32_t k = 0; k < 3; k++) {
        if (best.barycentric[k] <= 1 - snap) continue;
        *vertex = mesh->vertex[3 * best.face + k];
        return GVC_OK;
    }
    return insert(mesh, best.face, best.barycentric, vertex, error);
}
