/* SPDX-License-Identifier: MIT */
/**
 * @file align.c
 * Alignment of a chart in time, as a displacement field on a grid over the square: at each of its
 * nodes, how far off in the chart the place is that the node's target is nearest to.
 */
#include "chart/align.h"

#include "base/memory.h"
#include "mesh/distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRID 64 /* most nodes a side: the field is smooth */
/* A target this far (in diagonals) from what a node shows is followed 1/e of the way. */
static const double far_away = 0.02;
/* Nor is a place followed that is further than this share of the square. */
static const double greatest_shift = 0.1;
#define SMOOTHING 10 /* rounds that let trust fall off towards what is not followed */
/* The field is smoothed: a node weighs its neighbours so many times as much as its own measure
 * where that is trusted fully, and is drawn this much to rest. */
static const double stiffness = 8, rest = 0.1;
#define SWEEPS 60
#define INVERSIONS 12
/* The vertices of faces that turn over are held back, by this factor in the first rounds and then
 * altogether, */
static const double hold = 0.8;
#define GENTLE_ROUNDS 20
/* and no vertex goes this much more of its way than a neighbour. */
static const double greatest_step = 0.3;

typedef struct field {
    const gvc_disk *disk;
    const double *uv; /* the chart as it was */
    uint32_t size;    /* of the image */
    size_t nodes;     /* a side */
    double spacing;   /* pixels between nodes */
    double *shift;    /* 2 per node */
    double *trust;    /* per node, 0 .. 1 */
    double *scratch;  /* 2 per node */
} field;

static gvc_result field_allocate(field *f, gvc_error *error) {
    size_t count = f->nodes * f->nodes;
    f->shift = gvc_alloc(count, 2 * sizeof *f->shift);
    f->trust = gvc_alloc(count, sizeof *f->trust);
    f->scratch = gvc_alloc(count, 2 * sizeof *f->scratch);
    return f->shift && f->trust && f->scratch ? GVC_OK : gvc_fail_memory(error);
}

static void field_free(field *f) {
    free(f->shift);
    free(f->trust);
    free(f->scratch);
}

/* The bilinear value of interleaved planes of `stride` values a node at (x, y) in nodes. */
static double interpolate(const double *value, size_t side, size_t stride, double x, double y) {
    double last = (double)side - 1;
    x = fmin(fmax(x, 0), last);
    y = fmin(fmax(y, 0), last);
    size_t i = (size_t)fmin(floor(x), last - 1), j = (size_t)fmin(floor(y), last - 1);
    double s = x - (double)i, t = y - (double)j;
    const double *a = value + stride * (j * side + i), *b = a + stride * side;
    return (1 - t) * ((1 - s) * a[0] + s * a[stride]) + t * ((1 - s) * b[0] + s * b[stride]);
}

/* ------------------------------------------------------------------------------------ the field */

/* What the chart shows at a node now, to judge how far its target is: interpolated from the place
 * found there, not needed exactly. */
static void look_up(field *f, const gvc_bvh *bvh, const double *target, double gate, size_t node) {
    double x = (double)(node % f->nodes) * f->spacing, y = (double)(node / f->nodes) * f->spacing;
    size_t plane = (size_t)f->size * f->size;
    double wanted[3], place[2] = {0, 0};
    gvc_closest found;
    for (size_t c = 0; c < 3; c++) wanted[c] = interpolate(target + c * plane, f->size, 1, x, y);
    if (!gvc_bvh_closest(bvh, wanted, NULL, gate, &found)) return;
    const uint32_t *v = f->disk->mesh.vertex + 3 * (size_t)found.face;
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++)
            place[c] += found.barycentric[k] * f->uv[2 * (size_t)v[k] + (size_t)c];
    double dx = place[0] - x, dy = place[1] - y, limit = greatest_shift * f->size;
    double square = (dx * dx + dy * dy) / (limit * limit);
    if (square >= 1) return;
    f->shift[2 * node] = dx;
    f->shift[2 * node + 1] = dy;
    f->trust[node] = (1 - square) * exp(-pow(found.distance / gate, 2));
}

/* Trust falls off gently towards nodes that have little, and to nothing at the border. */
static void soften_trust(field *f) {
    size_t n = f->nodes;
    for (int round = 0; round < SMOOTHING; round++) {
        memcpy(f->scratch, f->trust, n * n * sizeof *f->scratch);
        for (size_t j = 1; j + 1 < n; j++)
            for (size_t i = 1; i + 1 < n; i++) {
                const double *t = f->scratch + j * n + i;
                double around = (t[-1] + t[1] + *(t - n) + t[n]) / 4;
                f->trust[j * n + i] = fmin(*t, (*t + around) / 2);
            }
    }
}

/* Makes the measured shifts a field whose gradient is small: where it is not, faces turn over. */
static void smooth_shift(field *f) {
    size_t n = f->nodes;
    memcpy(f->scratch, f->shift, 2 * n * n * sizeof *f->scratch);
    for (size_t i = 0; i < 2 * n * n; i++) f->shift[i] *= f->trust[i / 2];
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (size_t j = 1; j + 1 < n; j++)
            for (size_t i = 2; i + 2 < 2 * n; i++) {
                size_t at = 2 * n * j + i;
                double *x = f->shift + at, trust = f->trust[at / 2];
                double around = (x[-2] + x[2] + *(x - 2 * n) + x[2 * n]) / 4;
                *x = (trust * f->scratch[at] + stiffness * around) / (trust + stiffness + rest);
            }
}

static gvc_result measure(field *f, const double *target, const gvc_align_options *options,
                          gvc_error *error) {
    const gvc_halfedges *m = &f->disk->mesh;
    const gvc_mesh view = {m->vertex_count, m->face_count, m->position, m->vertex};
    gvc_bvh *bvh = NULL;
    GVC_TRY(gvc_bvh_create(&view, &bvh, error));
    for (size_t j = 1; j + 1 < f->nodes; j++)
        for (size_t i = 1; i + 1 < f->nodes; i++)
            look_up(f, bvh, target, far_away * options->diagonal, j * f->nodes + i);
    gvc_bvh_destroy(&bvh);
    soften_trust(f);
    smooth_shift(f);
    for (size_t i = 0; i < 2 * f->nodes * f->nodes; i++) f->shift[i] *= options->share;
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- sliding */

/* Pixel q is to show what was at q + shift(q), so what was at p goes to the q where that is p. The
 * border stays. */
static void slide(const field *f, double *moved) {
    for (size_t v = 0; v < f->disk->mesh.vertex_count; v++) {
        const double *p = f->uv + 2 * v;
        double q[2] = {p[0], p[1]}, d[2];
        for (int step = 0; step < INVERSIONS; step++) {
            double x = q[0] / f->spacing, y = q[1] / f->spacing;
            for (size_t c = 0; c < 2; c++) d[c] = interpolate(f->shift + c, f->nodes, 2, x, y);
            for (size_t c = 0; c < 2; c++) q[c] = p[c] - d[c];
        }
        memcpy(moved + 2 * v, q, sizeof q);
    }
    for (size_t i = 0; i < f->disk->border_count; i++) {
        size_t v = f->disk->border[i];
        memcpy(moved + 2 * v, f->uv + 2 * v, 2 * sizeof *moved);
    }
}

static bool turned_over(const double *uv, const uint32_t *v) {
    const double *a = uv + 2 * (size_t)v[0], *b = uv + 2 * (size_t)v[1], *c = uv + 2 * (size_t)v[2];
    return !((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
}

/* Puts every vertex `part` of its way, and lowers that of the vertices of faces that have turned
 * over; returns how many of these can be taken further back. */
static size_t hold_back(const field *f, double factor, const double *slid, double *part,
                        double *moved) {
    const gvc_halfedges *m = &f->disk->mesh;
    size_t flips = 0;
    for (size_t v = 0; v < m->vertex_count; v++)
        for (size_t c = 2 * v; c < 2 * v + 2; c++)
            moved[c] = f->uv[c] + part[v] * (slid[c] - f->uv[c]);
    for (size_t h = 0; h < 3 * m->face_count; h += 3) {
        if (!turned_over(moved, m->vertex + h)) continue;
        bool moving = false;
        for (size_t k = 0; k < 3; k++) {
            moving = moving || part[m->vertex[h + k]] > 0;
            part[m->vertex[h + k]] *= factor;
        }
        flips += moving;
    }
    for (uint32_t h = 0; flips > 0 && h < 3 * m->face_count; h++) {
        double *a = part + m->vertex[h], *b = part + m->vertex[gvc_next(h)];
        *a = fmin(*a, *b + greatest_step);
        *b = fmin(*b, *a + greatest_step);
    }
    return flips;
}

gvc_result gvc_align(const gvc_disk *disk, uint32_t size, const double *target,
                     const gvc_align_options *options, double *uv, gvc_error *error) {
    field f = {.disk = disk, .uv = uv, .size = size, .nodes = size < GRID ? size : GRID};
    size_t vertices = disk->mesh.vertex_count, bytes = 2 * vertices * sizeof *uv;
    f.spacing = (size - 1.0) / ((double)f.nodes - 1);
    double *slid = gvc_alloc(2 * vertices, sizeof *slid);
    double *moved = gvc_alloc(2 * vertices, sizeof *moved);
    double *part = gvc_alloc(vertices, sizeof *part);
    gvc_result result = slid && moved && part ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = field_allocate(&f, error);
    if (result == GVC_OK) result = measure(&f, target, options, error);
    if (result == GVC_OK) {
        slide(&f, slid);
        for (size_t v = 0; v < vertices; v++) part[v] = 1;
        int gentle = GENTLE_ROUNDS;
        /* Ends, as every round after the gentle ones leaves fewer vertices that move at all. */
        while (hold_back(&f, gentle > 0 ? hold : 0, slid, part, moved) > 0) gentle--;
        memcpy(uv, moved, bytes);
    }
    field_free(&f);
    free(slid);
    free(moved);
    free(part);
    return result;
}
