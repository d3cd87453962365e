/* SPDX-License-Identifier: MIT */
/** @file registration.c  As-rigid-as-possible iterated closest points from frame to frame. */
#include "descriptor/registration.h"

#include "base/conjugate_gradient.h"
#include "base/memory.h"
#include "descriptor/bending.h"
#include "descriptor/rigid.h"
#include "mesh/distance.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* On a captured dance of 10,000 vertices 1,500 nodes leave an error of 0.0007 of the diagonal where
 * the mean motion is 0.0039, in 0.07 s; 800 leave 0.0008, 3,000 leave 0.0007 (docs/adr/0012). */
#define NODES 1500
/* Closest points further than this, in diagonals, do not count. */
static const double gate = 0.05;
/* Weight of the distance along the surface beside that from it: it may slide. */
static const double slide = 0.05;
/* Stiff at first, so that limbs find their place, then soft, so that the surface fits. */
static const struct {
    double stiffness;
    int rounds;
} schedule[] = {{30, 6}, {5, 6}, {1, 6}, {0.2, 6}};
/* Relative to absolute coordinates: at 1e-3 the error is a third greater. */
#define TOLERANCE 1e-4
#define MOST_ITERATIONS 100

/* Minimises over the nodes' places x
 *   sum_i a_i (n_i . (x_i - c_i))^2 + slide |x_i - c_i|^2
 *     + stiffness sum_ij |x_i - x_j - (R_i + R_j)/2 (r_i - r_j)|^2
 * with closest points c_i and their normals n_i: the surface may slide along the other one. */
typedef struct problem {
    gvc_bending *bending;
    double stiffness;
    double *plane;   /* 3 per node: normal at its closest point; 0 if it has none */
    double *closest; /* 3 per node */
    double *diagonal, *right;
} problem;

static void apply(void *context, const double *x, double *y) {
    const problem *p = context;
    const gvc_bending *b = p->bending;
    for (size_t i = 0; i < b->node_count; i++) {
        const double *n = p->plane + 3 * i, *at = x + 3 * i;
        double sum[3] = {0}, out = gvc_dot(n, at);
        double along = gvc_dot(n, n) > 0 ? slide : 0;
        for (uint32_t k = b->first[i]; k < b->first[i + 1]; k++) {
            const double *q = x + 3 * (size_t)b->neighbour[k];
            for (int c = 0; c < 3; c++) sum[c] += at[c] - q[c];
        }
        for (int c = 0; c < 3; c++)
            y[3 * i + (size_t)c] = p->stiffness * sum[c] + n[c] * out + along * at[c];
    }
}

/* Right-hand side and diagonal for the rotations and closest points found. */
static void assemble(problem *p) {
    const gvc_bending *b = p->bending;
    for (size_t i = 0; i < b->node_count; i++) {
        const double *n = p->plane + 3 * i, *c = p->closest + 3 * i, *r = b->rotation + 9 * i;
        double sum[3] = {0}, arm[3], out = gvc_dot(n, c);
        double along = gvc_dot(n, n) > 0 ? slide : 0;
        for (uint32_t k = b->first[i]; k < b->first[i + 1]; k++) {
            size_t j = b->neighbour[k];
            const double *s = b->rotation + 9 * j;
            gvc_subtract(b->rest + 3 * i, b->rest + 3 * j, arm);
            for (int a = 0; a < 3; a++)
                sum[a] += (gvc_dot(r + 3 * a, arm) + gvc_dot(s + 3 * a, arm)) / 2;
        }
        double valence = b->first[i + 1] - b->first[i];
        for (int a = 0; a < 3; a++) {
            p->right[3 * i + (size_t)a] = p->stiffness * sum[a] + n[a] * out + along * c[a];
            p->diagonal[3 * i + (size_t)a] = p->stiffness * valence + n[a] * n[a] + along + 1e-12;
        }
    }
}

static void find_closest(problem *p, const gvc_halfedges *to, const gvc_bvh *bvh, double limit) {
    const gvc_bending *b = p->bending;
    for (size_t i = 0; i < b->node_count; i++) {
        double normal[3], *plane = p->plane + 3 * i;
        gvc_closest found;
        memset(plane, 0, 3 * sizeof *plane);
        for (int c = 0; c < 3; c++)
            normal[c] = gvc_dot(b->rotation + 9 * i + 3 * c, b->normal + 3 * i);
        if (!gvc_bvh_closest(bvh, b->place + 3 * i, normal, limit, &found)) continue;
        gvc_face_normal(to, found.face, plane);
        memcpy(p->closest + 3 * i, found.point, sizeof found.point);
    }
}

/* Moves all nodes as the whole body moves. */
static void move_rigidly(gvc_bending *b, const gvc_halfedges *to, const gvc_bvh *bvh,
                         double limit) {
    gvc_rigid motion;
    gvc_rigid_follow(b->rest, b->normal, b->node_count, to, bvh, limit, &motion);
    for (size_t i = 0; i < b->node_count; i++) {
        gvc_rigid_apply(&motion, b->rest + 3 * i, b->place + 3 * i);
        memcpy(b->rotation + 9 * i, motion.rotation, sizeof motion.rotation);
    }
}

static gvc_result bend(problem *p, const gvc_halfedges *to, const gvc_bvh *bvh, double limit,
                       gvc_error *error) {
    move_rigidly(p->bending, to, bvh, limit);
    for (size_t s = 0; s < sizeof schedule / sizeof *schedule; s++) {
        p->stiffness = schedule[s].stiffness;
        for (int i = 0; i < schedule[s].rounds; i++) {
            find_closest(p, to, bvh, limit);
            gvc_bending_rotate(p->bending);
            assemble(p);
            GVC_TRY(gvc_conjugate_gradient(3 * p->bending->node_count, apply, p, p->diagonal,
                                           p->right, TOLERANCE, MOST_ITERATIONS, p->bending->place,
                                           NULL, error));
        }
    }
    return GVC_OK;
}

gvc_result gvc_register(const gvc_halfedges *from, const gvc_halfedges *to, const gvc_bvh *bvh,
                        double *moved, gvc_error *error) {
    gvc_bending bending;
    GVC_TRY(gvc_bending_create(from, NODES, &bending, error));
    size_t n = bending.node_count;
    problem p = {.bending = &bending};
    p.plane = gvc_alloc(n, 3 * sizeof *p.plane);
    p.closest = gvc_alloc(n, 3 * sizeof *p.closest);
    p.diagonal = gvc_alloc(n, 3 * sizeof *p.diagonal);
    p.right = gvc_alloc(n, 3 * sizeof *p.right);
    gvc_result result = GVC_OK;
    if (!p.plane || !p.closest || !p.diagonal || !p.right) GVC_CHECK(gvc_fail_memory(error));
    const gvc_mesh view = {from->vertex_count, from->face_count, from->position, from->vertex};
    GVC_CHECK(bend(&p, to, bvh, gate * gvc_mesh_diagonal(&view), error));
    gvc_bending_rotate(&bending);
    gvc_bending_vertices(&bending, from, moved);
cleanup:
    free(p.plane);
    free(p.closest);
    free(p.diagonal);
    free(p.right);
    gvc_bending_free(&bending);
    return result;
}
