/* SPDX-License-Identifier: MIT */
/** @file unfold.c  Splitting of obtuse corners by unfolding (Kimmel & Sethian 1998, Sect. 4). */
#include "descriptor/unfold.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Faces unfolded before a corner is left unsplit. Captures need 1 to 3; only slivers need more. */
enum { MOST_FACES = 16 };

typedef struct point {
    double x, y;
} point;

static double dot(point a, point b) { return a.x * b.x + a.y * b.y; }
static double cross(point a, point b) { return a.x * b.y - a.y * b.x; }
static point minus(point a, point b) { return (point){a.x - b.x, a.y - b.y}; }

gvc_apex gvc_apex_make(double base, double side, double product) {
    gvc_apex apex = {.length = base};
    apex.inverse_length = base > 0 ? 1 / base : 0;
    apex.x = product * apex.inverse_length;
    double square = (side - apex.x) * (side + apex.x);
    apex.y = square > 0 ? sqrt(square) : 0;
    return apex;
}

/* The apex given over the base a-b, in the plane of a and b, on the side left of a-b. */
static point lay(const gvc_apex *apex, point a, point b) {
    point along = minus(b, a);
    double x = apex->x * apex->inverse_length, y = apex->y * apex->inverse_length;
    return (point){a.x + x * along.x - y * along.y, a.y + x * along.y + y * along.x};
}

static point bisector(point a, point b) {
    double scale = sqrt(dot(a, a) / dot(b, b));
    return (point){a.x + scale * b.x, a.y + scale * b.y};
}

/* The corner, in the origin, over the base from `near` to `far`. */
static gvc_apex corner_over(point near, point far) {
    point base = minus(far, near), side = {-near.x, -near.y};
    return gvc_apex_make(sqrt(dot(base, base)), sqrt(dot(side, side)), dot(base, side));
}

/* Unfolds the faces opposite the corner over halfedge `h` until a vertex sees it at acute angles to
 * both sides of the corner. The window h always spans that sector, so the line to the vertex stays
 * on the unfolded faces. */
static bool split_corner(const gvc_halfedges *mesh, const gvc_apex *apex, uint32_t h,
                         gvc_split *split) {
    /* The corner is the origin, the start of h on the positive x axis, its end above that axis. */
    const gvc_apex *face = &apex[gvc_prev(h)]; /* the end of h over the base corner - start */
    point start = {face->length, 0}, end = {face->x, face->y};
    if (dot(start, end) >= 0) return false;
    *split = (gvc_split){.corner = mesh->vertex[gvc_prev(h)],
                         .near = {mesh->vertex[h], mesh->vertex[gvc_next(h)]}};
    point middle = bisector(start, end), window[2] = {start, end};
    for (int step = 0; step < MOST_FACES; step++) {
        uint32_t twin = mesh->twin[h]; /* runs from window[1] to window[0], its face beyond */
        if (twin == GVC_NONE) return false;
        point far = lay(&apex[twin], window[1], window[0]);
        if (dot(start, far) > 0 && dot(end, far) > 0) {
            split->far = mesh->vertex[gvc_prev(twin)];
            split->far_length = sqrt(dot(far, far));
            split->apex[0] = corner_over(start, far);
            split->apex[1] = corner_over(end, far);
            return cross(start, far) > 0 && cross(far, end) > 0;
        }
        /* Look on through the half of the window that spans the sector: the twin's next halfedge
         * runs from window[0] to far, the one before it from far to window[1]. */
        if (cross(middle, far) > 0) {
            h = gvc_next(twin);
            window[1] = far;
        } else {
            h = gvc_prev(twin);
            window[0] = far;
        }
    }
    return false;
}

/* Lists the splits by their near and far vertices. */
static gvc_result index_splits(const gvc_halfedges *mesh, gvc_unfolding *u, gvc_error *error) {
    u->first = gvc_alloc(mesh->vertex_count + 1, sizeof *u->first);
    u->incident = gvc_alloc(3 * u->split_count, sizeof *u->incident);
    if (!u->first || !u->incident) return gvc_fail_memory(error);
    for (size_t i = 0; i < u->split_count; i++) {
        const gvc_split *s = &u->split[i];
        u->first[s->far]++, u->first[s->near[0]]++, u->first[s->near[1]]++;
    }
    uint32_t end = 0;
    for (size_t v = 0; v <= mesh->vertex_count; v++) u->first[v] = end += u->first[v];
    /* Filling from the back leaves every `first` at its beginning. */
    for (size_t i = u->split_count; i-- > 0;) {
        const gvc_split *s = &u->split[i];
        u->incident[--u->first[s->far]] = (uint32_t)i;
        u->incident[--u->first[s->near[0]]] = (uint32_t)i;
        u->incident[--u->first[s->near[1]]] = (uint32_t)i;
    }
    return GVC_OK;
}

gvc_result gvc_unfold(const gvc_halfedges *mesh, const gvc_apex *apex, gvc_unfolding *unfolding,
                      gvc_error *error) {
    *unfolding = (gvc_unfolding){0};
    size_t capacity = 0;
    gvc_result result = GVC_OK;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        gvc_split split;
        if (!split_corner(mesh, apex, h, &split)) continue;
        void *data = unfolding->split;
        if (!gvc_grow(&data, &capacity, unfolding->split_count + 1, sizeof split)) {
            result = gvc_fail_memory(error);
            goto cleanup;
        }
        unfolding->split = data;
        unfolding->split[unfolding->split_count++] = split;
    }
    result = index_splits(mesh, unfolding, error);
cleanup:
    if (result != GVC_OK) gvc_unfolding_free(unfolding);
    return result;
}

void gvc_unfolding_free(gvc_unfolding *unfolding) {
    free(unfolding->split);
    free(unfolding->first);
    free(unfolding->incident);
    *unfolding = (gvc_unfolding){0};
}
