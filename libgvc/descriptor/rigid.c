/* SPDX-License-Identifier: MIT */
/** @file rigid.c  Rigid motion of a patch by iterated closest points. */
#include "descriptor/rigid.h"

#include "base/memory.h"
#include "mesh/distance.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ITERATIONS 12
#define LEAST_POINTS 12

void gvc_rigid_apply(const gvc_rigid *motion, const double point[3], double moved[3]) {
    double p[3] = {point[0], point[1], point[2]};
    for (int k = 0; k < 3; k++) moved[k] = gvc_dot(motion->rotation + 3 * k, p) + motion->shift[k];
}

/* --------------------------------------------------------------------------------------- patch */

/* Twice the area and direction of the faces round a vertex, a third of it being the vertex's own.
 */
static void vertex_normal(const gvc_halfedges *mesh, uint32_t vertex, double normal[3]) {
    const double *p = mesh->position + 3 * (size_t)vertex;
    uint32_t h = mesh->outgoing[vertex];
    memset(normal, 0, 3 * sizeof *normal);
    do {
        const double *q = mesh->position + 3 * (size_t)mesh->vertex[gvc_next(h)];
        const double *r = mesh->position + 3 * (size_t)mesh->vertex[gvc_prev(h)];
        double a[3], b[3], n[3];
        for (int k = 0; k < 3; k++) {
            a[k] = q[k] - p[k];
            b[k] = r[k] - p[k];
        }
        gvc_cross(a, b, n);
        for (int k = 0; k < 3; k++) normal[k] += n[k];
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != mesh->outgoing[vertex]);
}

gvc_result gvc_patch_take(const gvc_halfedges *mesh, const double *distance, size_t stride,
                          double radius, gvc_patch *patch, gvc_error *error) {
    size_t count = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) count += distance[v * stride] <= radius;
    *patch = (gvc_patch){0};
    patch->point = gvc_alloc(3 * count, sizeof *patch->point);
    patch->normal = gvc_alloc(3 * count, sizeof *patch->normal);
    patch->area = gvc_alloc(count, sizeof *patch->area);
    if (!patch->point || !patch->normal || !patch->area) {
        gvc_patch_free(patch);
        return gvc_fail_memory(error);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!(distance[v * stride] <= radius)) continue;
        double *normal = patch->normal + 3 * patch->count;
        vertex_normal(mesh, v, normal);
        double length = sqrt(gvc_dot(normal, normal));
        if (!(length > 0)) continue;
        for (int k = 0; k < 3; k++) normal[k] /= length;
        memcpy(patch->point + 3 * patch->count, mesh->position + 3 * (size_t)v, 3 * sizeof(double));
        patch->area[patch->count++] = length / 6;
    }
    return GVC_OK;
}

void gvc_patch_free(gvc_patch *patch) {
    free(patch->point);
    free(patch->normal);
    free(patch->area);
    *patch = (gvc_patch){0};
}

/* --------------------------------------------------------------------------------------- motion */

/* Normal equations of the linearised problem: six unknowns, turn about the centre and shift. */
typedef struct equations {
    double matrix[6][6], right[6];
    size_t count;
} equations;

static void add_plane(equations *e, const double arm[3], const double normal[3], double offset,
                      double weight) {
    double row[6];
    gvc_cross(arm, normal, row);
    memcpy(row + 3, normal, 3 * sizeof *normal);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) e->matrix[i][j] += weight * row[i] * row[j];
        e->right[i] += weight * row[i] * offset;
    }
    e->count++;
}

/* Cholesky, with a little stiffness against motions that the surface does not feel, such as the
 * turn of a round body about its axis. */
static bool solve(equations *e, double x[6]) {
    double l[6][6] = {{0}};
    for (int i = 0; i < 6; i++) {
        int block = i < 3 ? 0 : 3;
        double trace = 0;
        for (int k = 0; k < 3; k++) trace += e->matrix[block + k][block + k];
        for (int j = 0; j <= i; j++) {
            double sum = e->matrix[i][j] + (i == j ? 1e-3 * trace : 0);
            for (int k = 0; k < j; k++) sum -= l[i][k] * l[j][k];
            if (i == j && !(sum > 0)) return false;
            l[i][j] = i == j ? sqrt(sum) : sum / l[j][j];
        }
    }
    for (int i = 0; i < 6; i++) {
        x[i] = e->right[i];
        for (int k = 0; k < i; k++) x[i] -= l[i][k] * x[k];
        x[i] /= l[i][i];
    }
    for (int i = 5; i >= 0; i--) {
        for (int k = i + 1; k < 6; k++) x[i] -= l[k][i] * x[k];
        x[i] /= l[i][i];
    }
    return true;
}

/* Rodrigues' rotation about `turn` by its length. */
static void rotation_of(const double turn[3], double rotation[9]) {
    double angle = sqrt(gvc_dot(turn, turn));
    double s = angle > 1e-12 ? sin(angle) / angle : 1;
    double c = angle > 1e-12 ? (1 - cos(angle)) / (angle * angle) : 0.5;
    const double skew[9] = {0, -turn[2], turn[1], turn[2], 0, -turn[0], -turn[1], turn[0], 0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double square = 0;
            for (int k = 0; k < 3; k++) square += skew[3 * i + k] * skew[3 * k + j];
            rotation[3 * i + j] = (i == j) + s * skew[3 * i + j] + c * square;
        }
    }
}

/* motion = (turn about `center`, then shift) after motion */
static void compose(gvc_rigid *motion, const double turn[3], const double shift[3],
                    const double center[3]) {
    double rotation[9], before[9], moved[3];
    rotation_of(turn, rotation);
    memcpy(before, motion->rotation, sizeof before);
    for (int i = 0; i < 3; i++) {
        moved[i] = center[i] + shift[i];
        for (int j = 0; j < 3; j++) {
            moved[i] += rotation[3 * i + j] * (motion->shift[j] - center[j]);
            motion->rotation[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) {
                motion->rotation[3 * i + j] += rotation[3 * i + k] * before[3 * k + j];
            }
        }
    }
    memcpy(motion->shift, moved, sizeof moved);
}

static void center_of(const gvc_patch *patch, const gvc_rigid *motion, double center[3]) {
    double sum[3] = {0}, total = 0, moved[3];
    for (size_t i = 0; i < patch->count; i++) {
        gvc_rigid_apply(motion, patch->point + 3 * i, moved);
        for (int k = 0; k < 3; k++) sum[k] += patch->area[i] * moved[k];
        total += patch->area[i];
    }
    for (int k = 0; k < 3; k++) center[k] = total > 0 ? sum[k] / total : 0;
}

static void face_normal(const gvc_mesh *mesh, uint32_t face, double normal[3]) {
    const uint32_t *v = mesh->face + 3 * (size_t)face;
    double a[3], b[3];
    for (int k = 0; k < 3; k++) {
        double p = mesh->position[3 * (size_t)v[0] + k];
        a[k] = mesh->position[3 * (size_t)v[1] + k] - p;
        b[k] = mesh->position[3 * (size_t)v[2] + k] - p;
    }
    gvc_cross(a, b, normal);
    double length = sqrt(gvc_dot(normal, normal));
    for (int k = 0; k < 3; k++) normal[k] = length > 0 ? normal[k] / length : 0;
}

static void gather(const gvc_patch *patch, const gvc_mesh *mesh, const gvc_bvh *bvh, double gate,
                   const gvc_rigid *motion, const double center[3], equations *e) {
    gvc_rigid turn = *motion;
    memset(turn.shift, 0, sizeof turn.shift);
    for (size_t i = 0; i < patch->count; i++) {
        double p[3], n[3], arm[3], away[3], plane[3];
        gvc_closest found;
        gvc_rigid_apply(motion, patch->point + 3 * i, p);
        gvc_rigid_apply(&turn, patch->normal + 3 * i, n);
        if (!gvc_bvh_closest(bvh, p, n, gate, &found)) continue;
        face_normal(mesh, found.face, plane);
        for (int k = 0; k < 3; k++) {
            arm[k] = p[k] - center[k];
            away[k] = found.point[k] - p[k];
        }
        add_plane(e, arm, plane, gvc_dot(plane, away), patch->area[i]);
    }
}

gvc_result gvc_patch_follow(const gvc_patch *patch, const gvc_halfedges *mesh, double gate,
                            gvc_rigid *motion, gvc_error *error) {
    /* a view of the halfedges as a plain mesh: halfedge 3 f + i starts at corner i of face f */
    const gvc_mesh view = {mesh->vertex_count, mesh->face_count, mesh->position, mesh->vertex};
    gvc_bvh *bvh = NULL;
    *motion = (gvc_rigid){.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    GVC_TRY(gvc_bvh_create(&view, &bvh, error));
    for (int i = 0; i < ITERATIONS; i++) {
        equations e = {.count = 0};
        double center[3], x[6];
        center_of(patch, motion, center);
        gather(patch, &view, bvh, gate, motion, center, &e);
        if (e.count < LEAST_POINTS || !solve(&e, x)) break;
        compose(motion, x, x + 3, center);
    }
    gvc_bvh_destroy(&bvh);
    return GVC_OK;
}
