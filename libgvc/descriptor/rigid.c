/* SPDX-License-Identifier: MIT */
/** @file rigid.c  Rigid motion of a surface by iterated closest points. */
#include "descriptor/rigid.h"

#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ITERATIONS 12
#define STRIDE 3
#define LEAST_POINTS 12

void gvc_rigid_apply(const gvc_rigid *motion, const double point[3], double moved[3]) {
    double p[3] = {point[0], point[1], point[2]};
    for (int k = 0; k < 3; k++) moved[k] = gvc_dot(motion->rotation + 3 * k, p) + motion->shift[k];
}

/* Normal equations of the linearised problem: six unknowns, turn about the centre and shift. */
typedef struct equations {
    double matrix[6][6], right[6];
    size_t count;
} equations;

static void add_plane(equations *e, const double arm[3], const double normal[3], double offset) {
    double row[6];
    gvc_cross(arm, normal, row);
    memcpy(row + 3, normal, 3 * sizeof *normal);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) e->matrix[i][j] += row[i] * row[j];
        e->right[i] += row[i] * offset;
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

/* motion = (turn about `center`, then shift) after motion */
static void compose(gvc_rigid *motion, const double turn[3], const double shift[3],
                    const double center[3]) {
    double rotation[9], before[9], moved[3];
    gvc_rotation_about(turn, rotation);
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

/* What is followed: every `STRIDE`th point. */
typedef struct cloud {
    const double *point, *normal;
    size_t count;
} cloud;

static void center_of(const cloud *c, const gvc_rigid *motion, double center[3]) {
    double sum[3] = {0}, moved[3];
    for (size_t i = 0; i < c->count; i += STRIDE) {
        gvc_rigid_apply(motion, c->point + 3 * i, moved);
        for (int k = 0; k < 3; k++) sum[k] += moved[k];
    }
    double taken = (double)((c->count + STRIDE - 1) / STRIDE);
    for (int k = 0; k < 3; k++) center[k] = sum[k] / taken;
}

static void gather(const cloud *c, const gvc_halfedges *to, const gvc_bvh *bvh, double gate,
                   const gvc_rigid *motion, const double center[3], equations *e) {
    gvc_rigid turn = *motion;
    memset(turn.shift, 0, sizeof turn.shift);
    for (size_t i = 0; i < c->count; i += STRIDE) {
        double p[3], n[3], arm[3], away[3], plane[3];
        gvc_closest found;
        gvc_rigid_apply(motion, c->point + 3 * i, p);
        gvc_rigid_apply(&turn, c->normal + 3 * i, n);
        if (!gvc_bvh_closest(bvh, p, n, gate, &found)) continue;
        gvc_face_normal(to, found.face, plane);
        gvc_subtract(p, center, arm);
        gvc_subtract(found.point, p, away);
        add_plane(e, arm, plane, gvc_dot(plane, away));
    }
}

void gvc_rigid_follow(const double *point, const double *normal, size_t count,
                      const gvc_halfedges *to, const gvc_bvh *bvh, double gate, gvc_rigid *motion) {
    const cloud c = {point, normal, count};
    *motion = (gvc_rigid){.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    for (int i = 0; i < ITERATIONS && count > 0; i++) {
        equations e = {.count = 0};
        double center[3], x[6];
        center_of(&c, motion, center);
        gather(&c, to, bvh, gate, motion, center, &e);
        if (e.count < LEAST_POINTS || !solve(&e, x)) break;
        compose(motion, x, x + 3, center);
    }
}
