/* SPDX-License-Identifier: MIT */
/**
 * @file sample.c
 * Point sampling of a parameterized disk: inner pixels by rasterising triangles, border pixels
 * along the border polyline.
 */
#include "chart/sample.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

typedef struct raster {
    const gvc_halfedges *mesh;
    const double *uv;
    uint32_t size;
    uint32_t *face; /* per pixel: the face that covers it, GVC_NONE: none yet */
    double *image;
} raster;

/** Twice the signed area of (a, b, p). The edge is always taken from its smaller vertex, so that
 * its two triangles see values that are exactly opposite and no point falls between them. */
static double side_of_edge(const double *uv, uint32_t a, uint32_t b, const double p[2]) {
    bool swapped = a > b;
    const double *from = uv + 2 * (swapped ? b : a), *to = uv + 2 * (swapped ? a : b);
    double side = (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
    return swapped ? -side : side;
}

/** Mixes the corners of a face by `weight`, not negative; a sum of 0 gives the centroid. */
static void set_pixel(const raster *r, size_t pixel, uint32_t face, const double weight[3]) {
    const uint32_t *v = r->mesh->vertex + 3 * (size_t)face;
    size_t plane = (size_t)r->size * r->size;
    double sum = weight[0] + weight[1] + weight[2];
    r->face[pixel] = face;
    for (int c = 0; c < 3; c++) {
        double mixed = 0;
        for (int k = 0; k < 3; k++)
            mixed += (sum > 0 ? weight[k] / sum : 1.0 / 3) * r->mesh->position[3 * v[k] + c];
        r->image[(size_t)c * plane + pixel] = mixed;
    }
}

/** First and last inner pixel in [low, high]; false if there is none. */
static bool inner_range(uint32_t size, double low, double high, uint32_t *first, uint32_t *last) {
    low = fmax(ceil(low), 1);
    high = fmin(floor(high), size - 2.0);
    if (!(low <= high)) return false;
    *first = (uint32_t)low;
    *last = (uint32_t)high;
    return true;
}

/** Gives the face all inner pixels inside or on its edges that no earlier face has taken. */
static void rasterise_face(const raster *r, uint32_t face) {
    const uint32_t *v = r->mesh->vertex + 3 * (size_t)face;
    const double *a = r->uv + 2 * v[0], *b = r->uv + 2 * v[1], *c = r->uv + 2 * v[2];
    uint32_t x0, x1, y0, y1;
    if (!inner_range(r->size, fmin(a[0], fmin(b[0], c[0])), fmax(a[0], fmax(b[0], c[0])), &x0,
                     &x1) ||
        !inner_range(r->size, fmin(a[1], fmin(b[1], c[1])), fmax(a[1], fmax(b[1], c[1])), &y0, &y1))
        return;
    for (uint32_t y = y0; y <= y1; y++)
        for (uint32_t x = x0; x <= x1; x++) {
            size_t pixel = (size_t)y * r->size + x;
            if (r->face[pixel] != GVC_NONE) continue;
            double p[2] = {x, y};
            double weight[3] = {side_of_edge(r->uv, v[1], v[2], p),
                                side_of_edge(r->uv, v[2], v[0], p),
                                side_of_edge(r->uv, v[0], v[1], p)};
            if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0)
                set_pixel(r, pixel, face, weight);
        }
}

/** Squared distance from p to the segment from `a` to `b`, and where the nearest point is. */
static double segment_distance(const double a[2], const double b[2], const double p[2], double *t) {
    double e[2] = {b[0] - a[0], b[1] - a[1]}, d[2] = {p[0] - a[0], p[1] - a[1]};
    double squared = e[0] * e[0] + e[1] * e[1];
    *t = squared > 0 ? fmin(fmax((d[0] * e[0] + d[1] * e[1]) / squared, 0), 1) : 0;
    d[0] -= *t * e[0];
    d[1] -= *t * e[1];
    return d[0] * d[0] + d[1] * d[1];
}

/** A pixel that rounding left between the faces around a vertex takes the nearest edge point. */
static void fill_gap(const raster *r, size_t pixel) {
    double p[2] = {(double)(pixel % r->size), (double)(pixel / r->size)};
    double least = INFINITY, weight[3] = {0, 0, 0}, t;
    uint32_t face = 0;
    for (uint32_t h = 0; h < 3 * r->mesh->face_count; h++) {
        const double *a = r->uv + 2 * r->mesh->vertex[h];
        const double *b = r->uv + 2 * r->mesh->vertex[gvc_next(h)];
        double distance = segment_distance(a, b, p, &t);
        if (!(distance < least)) continue;
        least = distance;
        face = h / 3;
        weight[h % 3] = 1 - t;
        weight[gvc_next(h) % 3] = t;
        weight[gvc_prev(h) % 3] = 0;
    }
    set_pixel(r, pixel, face, weight);
}

static void rasterise(const raster *r) {
    size_t plane = (size_t)r->size * r->size;
    for (size_t i = 0; i < plane; i++) r->face[i] = GVC_NONE;
    for (uint32_t f = 0; f < r->mesh->face_count; f++) rasterise_face(r, f);
    for (uint32_t y = 1; y + 1 < r->size; y++)
        for (uint32_t x = 1; x + 1 < r->size; x++)
            if (r->face[(size_t)y * r->size + x] == GVC_NONE) fill_gap(r, (size_t)y * r->size + x);
}

/* -------------------------------------------------------------------------------------- border */

/** Border position, 0 .. P, of a point on the border of the square (see side_table.h). */
static double border_position(uint32_t size, const double uv[2]) {
    double last = size - 1.0;
    double top = fabs(uv[1]), right = fabs(last - uv[0]), bottom = fabs(last - uv[1]);
    double left = fabs(uv[0]), least = fmin(fmin(top, right), fmin(bottom, left));
    if (top == least) return uv[0];
    if (right == least) return last + uv[1];
    if (bottom == least) return 2 * last + (last - uv[0]);
    return 3 * last + (last - uv[1]);
}

/** Surface points at all whole border positions that the border edge from a to b covers, its end
 * left out. `from` and `to` are the edge's border positions, from <= to. */
static void sample_border_edge(const double *a, const double *b, double from, double to,
                               uint32_t border_count, double *point) {
    for (double at = ceil(from); at < to; at++) {
        double t = (at - from) / (to - from);
        size_t p = (size_t)at % border_count;
        for (int c = 0; c < 3; c++) point[3 * p + c] = (1 - t) * a[c] + t * b[c];
    }
}

/** Surface points at all border positions, 3 per position. */
static void sample_border(const gvc_disk *disk, const double *uv, const gvc_weld *weld,
                          double *point) {
    double loop = weld->border_count;
    for (size_t i = 0; i < disk->border_count; i++) {
        uint32_t a = disk->border[i], b = disk->border[(i + 1) % disk->border_count];
        double from = border_position(weld->size, uv + 2 * a);
        double to = border_position(weld->size, uv + 2 * b);
        if (to < from - loop / 2) to += loop; /* over position 0 */
        sample_border_edge(disk->mesh.position + 3 * a, disk->mesh.position + 3 * b, from, to,
                           weld->border_count, point);
    }
}

/** Writes the border pixels. Every welded vertex takes its point from the first of its samples: the
 * other ones differ from it by rounding only. */
static void weld_border(const gvc_weld *weld, const double *point, uint32_t *first, double *image) {
    size_t plane = (size_t)weld->size * weld->size;
    for (uint32_t v = 0; v < weld->vertex_count; v++) first[v] = UINT32_MAX;
    for (uint32_t p = 0; p < weld->border_count; p++) {
        uint32_t x, y;
        gvc_border_pixel(weld->size, p, &x, &y);
        size_t pixel = (size_t)y * weld->size + x;
        uint32_t v = weld->vertex[pixel];
        if (first[v] == UINT32_MAX) first[v] = p;
        for (int c = 0; c < 3; c++)
            image[(size_t)c * plane + pixel] = point[3 * (size_t)first[v] + c];
    }
}

gvc_result gvc_sample_points(const gvc_disk *disk, const double *uv, const gvc_weld *weld,
                             double *image, gvc_error *error) {
    gvc_result result = GVC_OK;
    size_t plane = (size_t)weld->size * weld->size;
    double *point = gvc_alloc(weld->border_count, 3 * sizeof *point);
    uint32_t *first = gvc_alloc(weld->vertex_count, sizeof *first);
    raster r = {.mesh = &disk->mesh, .uv = uv, .size = weld->size, .image = image};
    r.face = gvc_alloc(plane, sizeof *r.face);
    if (!point || !first || !r.face) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    rasterise(&r);
    sample_border(disk, uv, weld, point);
    weld_border(weld, point, first, image);
cleanup:
    free(point);
    free(first);
    free(r.face);
    return result;
}
