/* SPDX-License-Identifier: MIT */
/** @file delaunay.c  Intrinsic Delaunay triangulation by edge flips. */
#include "chart/delaunay.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Angles opposite an edge that sum to pi but for rounding must not be flipped to and fro. */
#define COTANGENT_TOLERANCE 1e-9
/* Flips come to an end by themselves, as each makes the triangulation better, but rounding on
 * slivers could see to it that they do not. Captures need 0.2 an edge. */
#define MOST_FLIPS_PER_HALFEDGE 10
#define MOST_COTANGENT 1e6

/* Edges that may have to be flipped, by number of a halfedge. */
typedef struct work_list {
    uint32_t *halfedge;
    uint8_t *listed; /* per halfedge */
    size_t count;
} work_list;

static void list_edge(work_list *list, const gvc_intrinsic *t, uint32_t h) {
    if (t->twin[h] == GVC_NONE || list->listed[h] || list->listed[t->twin[h]]) return;
    list->listed[h] = 1;
    list->halfedge[list->count++] = h;
}

/* Sixteen times the squared area of a triangle, in Kahan's order of operations, which is exact
 * enough on slivers. Not positive if there is no such triangle. */
static double squared_area(double a, double b, double c) {
    double high = fmax(a, fmax(b, c)), low = fmin(a, fmin(b, c));
    double middle = fmax(fmin(a, b), fmin(fmax(a, b), c));
    return (high + (middle + low)) * (low - (high - middle)) * (low + (high - middle)) *
           (high + (middle - low));
}

double gvc_intrinsic_cotangent(const gvc_intrinsic *t, uint32_t h) {
    double a = t->length[h], b = t->length[gvc_next(h)], c = t->length[gvc_prev(h)];
    double root = sqrt(fmax(squared_area(a, b, c), 0)), product = b * b + c * c - a * a;
    if (fabs(product) < MOST_COTANGENT * root) return product / root;
    return product > 0 ? MOST_COTANGENT : -MOST_COTANGENT;
}

/* Where the corner over an edge of length `base` lies, the other sides being `left` and `right`. */
static void lay(double base, double left, double right, double *x, double *y) {
    *x = (base * base + (left - right) * (left + right)) / (2 * base);
    *y = sqrt(fmax((left - *x) * (left + *x), 0));
}

void gvc_intrinsic_lay(const gvc_intrinsic *t, uint32_t h, double a[2], double b[2]) {
    a[0] = t->length[h];
    a[1] = b[0] = b[1] = 0;
    if (a[0] > 0) lay(a[0], t->length[gvc_prev(h)], t->length[gvc_next(h)], &b[0], &b[1]);
}

/* Length of the other diagonal of the two triangles at `h`, unfolded into a plane. */
static double other_diagonal(const gvc_intrinsic *t, uint32_t h) {
    uint32_t g = t->twin[h];
    double x, y, u, v;
    lay(t->length[h], t->length[gvc_prev(h)], t->length[gvc_next(h)], &x, &y);
    lay(t->length[h], t->length[gvc_next(g)], t->length[gvc_prev(g)], &u, &v);
    return sqrt((x - u) * (x - u) + (y + v) * (y + v));
}

/* Puts the halfedge that was at `from` to `to`. */
static void move_halfedge(gvc_intrinsic *t, uint32_t from, uint32_t to, uint32_t twin) {
    uint32_t start = t->vertex[from];
    t->vertex[to] = start;
    t->length[to] = t->length[from];
    t->twin[to] = twin;
    if (twin != GVC_NONE) t->twin[twin] = to;
    if (t->outgoing[start] == from) t->outgoing[start] = to;
}

/* Turns the edge h = (a b) of faces (a b c) and (b a d) into (d c). Of the four sides two stay
 * where they are, (a d) takes the place of h and (b c) that of its twin; the new edge takes theirs.
 */
static void flip(gvc_intrinsic *t, uint32_t h) {
    uint32_t g = t->twin[h], bc = gvc_next(h), ad = gvc_next(g);
    uint32_t beyond_ad = t->twin[ad], beyond_bc = t->twin[bc];
    uint32_t c = t->vertex[gvc_prev(h)], d = t->vertex[gvc_prev(g)];
    double diagonal = other_diagonal(t, h);
    if (beyond_ad == bc) { /* they are one edge, both of whose halfedges move */
        beyond_ad = g;
        beyond_bc = h;
    }
    move_halfedge(t, ad, h, beyond_ad);
    move_halfedge(t, bc, g, beyond_bc);
    t->vertex[bc] = d;
    t->vertex[ad] = c;
    t->length[bc] = t->length[ad] = diagonal;
    t->twin[bc] = ad;
    t->twin[ad] = bc;
}

static bool must_flip(const gvc_intrinsic *t, uint32_t h) {
    uint32_t g = t->twin[h];
    if (h / 3 == g / 3) return false; /* both sides are one face, which encloses a vertex */
    return gvc_intrinsic_cotangent(t, h) + gvc_intrinsic_cotangent(t, g) < -COTANGENT_TOLERANCE;
}

static gvc_result flip_all(gvc_intrinsic *t, gvc_error *error) {
    size_t halfedges = 3 * t->face_count, left = MOST_FLIPS_PER_HALFEDGE * halfedges;
    work_list list = {gvc_alloc(halfedges, sizeof *list.halfedge), gvc_alloc(halfedges, 1), 0};
    gvc_result result = list.halfedge && list.listed ? GVC_OK : gvc_fail_memory(error);
    for (size_t h = halfedges; result == GVC_OK && h-- > 0;) list_edge(&list, t, (uint32_t)h);
    while (list.count > 0 && left > 0) {
        uint32_t h = list.halfedge[--list.count], g = t->twin[h];
        list.listed[h] = 0;
        if (g == GVC_NONE || !must_flip(t, h)) continue;
        left--;
        flip(t, h);
        list_edge(&list, t, h);
        list_edge(&list, t, gvc_prev(h));
        list_edge(&list, t, g);
        list_edge(&list, t, gvc_prev(g));
    }
    free(list.halfedge);
    free(list.listed);
    return result;
}

gvc_result gvc_delaunay(const gvc_halfedges *mesh, gvc_intrinsic *t, gvc_error *error) {
    size_t halfedges = 3 * mesh->face_count;
    *t = (gvc_intrinsic){.face_count = mesh->face_count};
    t->outgoing = gvc_alloc(mesh->vertex_count, sizeof *t->outgoing);
    t->vertex = gvc_alloc(halfedges, sizeof *t->vertex);
    t->twin = gvc_alloc(halfedges, sizeof *t->twin);
    t->length = gvc_alloc(halfedges, sizeof *t->length);
    gvc_result result = GVC_OK;
    if (!t->outgoing || !t->vertex || !t->twin || !t->length) {
        result = gvc_fail_memory(error);
    } else if (halfedges > 0) {
        memcpy(t->outgoing, mesh->outgoing, mesh->vertex_count * sizeof *t->outgoing);
        memcpy(t->vertex, mesh->vertex, halfedges * sizeof *t->vertex);
        memcpy(t->twin, mesh->twin, halfedges * sizeof *t->twin);
        for (size_t h = 0; h < halfedges; h++)
            t->length[h] = gvc_halfedge_length(mesh, (uint32_t)h);
        result = flip_all(t, error);
    }
    if (result != GVC_OK) gvc_intrinsic_free(t);
    return result;
}

void gvc_intrinsic_free(gvc_intrinsic *t) {
    free(t->outgoing);
    free(t->vertex);
    free(t->twin);
    free(t->length);
    *t = (gvc_intrinsic){0};
}
