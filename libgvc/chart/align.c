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
#define INVERSIONS 12
#define ATTEMPTS 6

typedef struct field {
    const gvc_disk *disk;
    const double *uv; /* the chart as it was */
    uint32_t size;    /* of the image */
    size_t nodes;     /* a side */
    double spacing;   /* pixels between nodes */
    double *shift;    /* 2 per node */
    double *trust;    /* per node, 0 .. 1 */
    double *scratch;  /* per node */
} field;

static gvc_result field_allocate(field *f, gvc_error *error) {
    size_t count = f->nodes * f->nodes;
    f->shift = gvc_alloc(count, 2 * sizeof *f->shift);
    f->trust = gvc_alloc(count, sizeof *f->trust);
    f->scratch = gvc_alloc(count, sizeof *f->scratch);
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
    for (size_t i = 0; i < 2 * f->nodes * f->nodes; i++)
        f->shift[i] *= options->share * f->trust[i / 2];
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- sliding */

/* Pixel q is to show what was at q + shift(q), so what was at p goes to the q where that is p. */
static void slide(const field *f, const double *damping, double *moved) {
    for (size_t v = 0; v < f->disk->mesh.vertex_count; v++) {
        const double *p = f->uv + 2 * v;
        double q[2] = {p[0], p[1]}, d[2];
        for (int step = 0; step < INVERSIONS; step++) {
            double x = q[0] / f->spacing, y = q[1] / f->spacing;
            double factor = interpolate(damping, f->nodes, 1, x, y);
            for (size_t c = 0; c < 2; c++)
                d[c] = factor * interpolate(f->shift + c, f->nodes, 2, x, y);
            for (size_t c = 0; c < 2; c++) q[c] = p[c] - d[c];
        }
        memcpy(moved + 2 * v, q, sizeof q);
    }
    for (size_t i = 0; i < f->disk->border_count; i++) {
        size_t v = f->disk->border[i];
        memcpy(moved + 2 * v, f->uv + 2 * v, 2 * sizeof *moved);
    }
}

/* Lets the field fade where triangles have flipped; returns how many there are. */
static size_t damp_flips(const field *f, const double *moved, double *damping) {
    const gvc_halfedges *m = &f->disk->mesh;
    size_t flips = 0, n = f->nodes;
    for (size_t h = 0; h < 3 * m->face_count; h += 3) {
        const double *a = moved + 2 * (size_t)m->vertex[h];
        const double *b = moved + 2 * (size_t)m->vertex[h + 1];
        const double *c = moved + 2 * (size_t)m->vertex[h + 2];
        if ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0) continue;
        flips++;
        double x = fmin(fmax(a[0] / f->spacing, 0), (double)n - 1);
        double y = fmin(fmax(a[1] / f->spacing, 0), (double)n - 1);
        for (int dj = -2; dj <= 2; dj++)
            for (int di = -2; di <= 2; di++) {
                double i = round(x) + di, j = round(y) + dj;
                if (i < 0 || j < 0 || i >= (double)n || j >= (double)n) continue;
                damping[(size_t)j * n + (size_t)i] *= di || dj ? 0.8 : 0.5;
            }
    }
    return flips;
}

gvc_result gvc_align(const gvc_disk *disk, uint32_t size, const double *target,
                     const gvc_align_options *options, double *uv, gvc_error *error) {
    field f = {.disk = disk, .uv = uv, .size = size, .nodes = size < GRID ? size : GRID};
    size_t vertices = disk->mesh.vertex_count, count = f.nodes * f.nodes;
    f.spacing = (size - 1.0) / ((double)f.nodes - 1);
    double *moved = gvc_alloc(2 * vertices, sizeof *moved);
    double *damping = gvc_alloc(count, sizeof *damping);
    gvc_result result = moved && damping ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = field_allocate(&f, error);
    if (result == GVC_OK) result = measure(&f, target, options, error);
    bool good = false;
    for (size_t i = 0; result == GVC_OK && i < count; i++) damping[i] = 1;
    for (int attempt = 0; result == GVC_OK && !good && attempt < ATTEMPTS; attempt++) {
        slide(&f, damping, moved);
        good = damp_flips(&f, moved, damping) == 0;
    }
    if (good) memcpy(uv, moved, 2 * vertices * sizeof *uv);
    field_free(&f);
    free(moved);
    free(damping);
    return result;
}
