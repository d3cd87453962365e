/* SPDX-License-Identifier: MIT */
/** @file mesh.c  The plain triangle mesh. */
#include "mesh/mesh.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

gvc_result gvc_mesh_allocate(size_t vertex_count, size_t face_count, gvc_mesh **mesh,
                             gvc_error *error) {
    *mesh = NULL;
    size_t coordinates, corners;
    if (!gvc_multiply(vertex_count, 3, &coordinates) || !gvc_multiply(face_count, 3, &corners))
        return gvc_fail_memory(error);
    gvc_mesh *made = gvc_alloc(1, sizeof *made);
    if (!made) return gvc_fail_memory(error);
    made->vertex_count = vertex_count;
    made->face_count = face_count;
    made->position = gvc_alloc(coordinates, sizeof *made->position);
    made->face = gvc_alloc(corners, sizeof *made->face);
    if (!made->position || !made->face) {
        gvc_mesh_destroy(&made);
        return gvc_fail_memory(error);
    }
    *mesh = made;
    return GVC_OK;
}

void gvc_mesh_destroy(gvc_mesh **mesh) {
    if (!mesh || !*mesh) return;
    free((*mesh)->position);
    free((*mesh)->face);
    free(*mesh);
    *mesh = NULL;
}

gvc_result gvc_mesh_create(const double *positions, size_t vertex_count, const uint32_t *faces,
                           size_t face_count, gvc_mesh **mesh, gvc_error *error) {
    if (!mesh) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no place for the mesh");
    *mesh = NULL;
    if ((!positions && vertex_count) || (!faces && face_count))
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "no positions or no faces");
    gvc_mesh *made;
    GVC_TRY(gvc_mesh_allocate(vertex_count, face_count, &made, error));
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < 3 * vertex_count && result == GVC_OK; i++) {
        if (!isfinite(positions[i]))
            result =
                gvc_fail(error, GVC_ERROR_MESH, "a coordinate of vertex %zu is not finite", i / 3);
        made->position[i] = positions[i];
    }
    for (size_t i = 0; i < 3 * face_count && result == GVC_OK; i++) {
        if (faces[i] >= vertex_count)
            result = gvc_fail(error, GVC_ERROR_MESH, "face %zu uses vertex %lu of %zu", i / 3,
                              (unsigned long)faces[i], vertex_count);
        made->face[i] = faces[i];
    }
    if (result != GVC_OK) gvc_mesh_destroy(&made);
    *mesh = made;
    return result;
}

size_t gvc_mesh_vertex_count(const gvc_mesh *mesh) { return mesh ? mesh->vertex_count : 0; }
size_t gvc_mesh_face_count(const gvc_mesh *mesh) { return mesh ? mesh->face_count : 0; }
const double *gvc_mesh_positions(const gvc_mesh *mesh) { return mesh ? mesh->position : NULL; }
const uint32_t *gvc_mesh_faces(const gvc_mesh *mesh) { return mesh ? mesh->face : NULL; }

void gvc_mesh_bounds(const gvc_mesh *mesh, double minimum[3], double maximum[3]) {
    if (mesh->face_count == 0) {
        for (int k = 0; k < 3; k++) minimum[k] = maximum[k] = 0;
        return;
    }
    const double *first = mesh->position + 3 * (size_t)mesh->face[0];
    for (int k = 0; k < 3; k++) minimum[k] = maximum[k] = first[k];
    for (size_t i = 1; i < 3 * mesh->face_count; i++) {
        const double *p = mesh->position + 3 * (size_t)mesh->face[i];
        for (int k = 0; k < 3; k++) {
            if (p[k] < minimum[k]) minimum[k] = p[k];
            if (p[k] > maximum[k]) maximum[k] = p[k];
        }
    }
}

double gvc_mesh_diagonal(const gvc_mesh *mesh) {
    double minimum[3], maximum[3];
    gvc_mesh_bounds(mesh, minimum, maximum);
    /* hypot keeps coordinates whose squares overflow or vanish */
    return hypot(hypot(maximum[0] - minimum[0], maximum[1] - minimum[1]), maximum[2] - minimum[2]);
}

static double face_area(const double *a, const double *b, const double *c) {
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        u[k] = b[k] - a[k];
        v[k] = c[k] - a[k];
    }
    double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
           z = u[0] * v[1] - u[1] * v[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}

double gvc_mesh_area(const gvc_mesh *mesh) {
    double area = 0;
    for (size_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = mesh->face + 3 * f;
        area += face_area(mesh->position + 3 * (size_t)v[0], mesh->position + 3 * (size_t)v[1],
                          mesh->position + 3 * (size_t)v[2]);
    }
    return area;
}
