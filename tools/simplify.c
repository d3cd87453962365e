/* SPDX-License-Identifier: MIT */
/** @file simplify.c  Quadric error edge collapse (Garland and Heckbert 1997). */
#include "simplify.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "vec3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NO_CORNER UINT32_MAX
#define LEAST_VERTICES 4
/* Determinants less than this share of the product of the diagonal count as singular. */
#define SINGULAR 1e-9

/* Error at p: p' A p + 2 b' p + c, A symmetric. */
typedef struct quadric {
    double xx, xy, xz, yy, yz, zz;
    vec3 b;
    double c;
} quadric;

typedef struct candidate {
    double cost;
    uint32_t from, to;   /* the edge; from < to */
    uint32_t version[2]; /* of both when this was queued; older ones are out of date */
    vec3 place;          /* of the vertex that remains */
} candidate;

typedef struct simplifier {
    size_t vertex_count, face_count; /* as given */
    size_t left;                     /* vertices */
    double *position;
    uint32_t *vertex;       /* per corner, three a face; as they are now */
    bool *gone;             /* per face */
    uint32_t *first, *last; /* per vertex: list of its corners */
    uint32_t *next;         /* per corner */
    quadric *error;         /* per vertex */
    uint32_t *version;      /* per vertex */
    uint32_t *mark;         /* per vertex: number of the last search that met it */
    uint32_t search;
    candidate *heap;
    size_t heap_count, heap_capacity;
} simplifier;

static void simplifier_free(simplifier *s) {
    free(s->position);
    free(s->vertex);
    free(s->gone);
    free(s->first);
    free(s->last);
    free(s->next);
    free(s->error);
    free(s->version);
    free(s->mark);
    free(s->heap);
}

/* ------------------------------------------------------------------------------------- quadrics */

static vec3 position(const simplifier *s, uint32_t vertex) {
    return vec3_load(s->position + 3 * (size_t)vertex);
}

/* Normal of a face, twice its area long. */
static vec3 face_normal(vec3 p, vec3 q, vec3 r) {
    return vec3_cross(vec3_sub(q, p), vec3_sub(r, p));
}

/* Adds the squared distance to a face's plane times its area. */
static void add_plane(quadric *q, vec3 normal, vec3 point) {
    double w = vec3_length(normal) / 2;
    vec3 n = vec3_unit(normal);
    double d = -vec3_dot(n, point);
    q->xx += w * n.x * n.x;
    q->xy += w * n.x * n.y;
    q->xz += w * n.x * n.z;
    q->yy += w * n.y * n.y;
    q->yz += w * n.y * n.z;
    q->zz += w * n.z * n.z;
    q->b = vec3_add(q->b, vec3_scale(n, w * d));
    q->c += w * d * d;
}

static quadric sum(const quadric *p, const quadric *q) {
    return (quadric){p->xx + q->xx, p->xy + q->xy, p->xz + q->xz,        p->yy + q->yy,
                     p->yz + q->yz, p->zz + q->zz, vec3_add(p->b, q->b), p->c + q->c};
}

static double error_at(const quadric *q, vec3 p) {
    double value = p.x * (q->xx * p.x + 2 * (q->xy * p.y + q->xz * p.z + q->b.x)) +
                   p.y * (q->yy * p.y + 2 * (q->yz * p.z + q->b.y)) +
                   p.z * (q->zz * p.z + 2 * q->b.z) + q->c;
    return fmax(value, 0);
}

/* Where the error is least; false if that is not one point. Cramer's rule. */
static bool least_error(const quadric *q, vec3 *place) {
    double c0 = q->yy * q->zz - q->yz * q->yz, c1 = q->xz * q->yz - q->xy * q->zz;
    double c2 = q->xy * q->yz - q->xz * q->yy, c3 = q->xx * q->zz - q->xz * q->xz;
    double c4 = q->xy * q->xz - q->xx * q->yz, c5 = q->xx * q->yy - q->xy * q->xy;
    double determinant = q->xx * c0 + q->xy * c1 + q->xz * c2;
    double trace = (q->xx + q->yy + q->zz) / 3;
    if (!(determinant > SINGULAR * trace * trace * trace)) return false;
    place->x = -(c0 * q->b.x + c1 * q->b.y + c2 * q->b.z) / determinant;
    place->y = -(c1 * q->b.x + c3 * q->b.y + c4 * q->b.z) / determinant;
    place->z = -(c2 * q->b.x + c4 * q->b.y + c5 * q->b.z) / determinant;
    return true;
}

/* ----------------------------------------------------------------------------------------- queue
 */

static bool before(const candidate *a, const candidate *b) {
    if (a->cost != b->cost) return a->cost < b->cost;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static gvc_result push(simplifier *s, const candidate *c, gvc_error *error) {
    if (!gvc_grow((void **)&s->heap, &s->heap_capacity, s->heap_count + 1, sizeof *s->heap)) {
        return gvc_fail_memory(error);
    }
    size_t place = s->heap_count++;
    for (; place > 0 && before(c, &s->heap[(place - 1) / 2]); place = (place - 1) / 2) {
        s->heap[place] = s->heap[(place - 1) / 2];
    }
    s->heap[place] = *c;
    return GVC_OK;
}

static candidate pop(simplifier *s) {
    candidate top = s->heap[0], last = s->heap[--s->heap_count];
    size_t place = 0;
    for (;;) {
        size_t child = 2 * place + 1;
        if (child >= s->heap_count) break;
        if (child + 1 < s->heap_count && before(&s->heap[child + 1], &s->heap[child])) child++;
        if (!before(&s->heap[child], &last)) break;
        s->heap[place] = s->heap[child];
        place = child;
    }
    s->heap[place] = last;
    return top;
}

static gvc_result queue_edge(simplifier *s, uint32_t a, uint32_t b, gvc_error *error) {
    candidate c = {.from = a < b ? a : b, .to = a < b ? b : a};
    quadric both = sum(&s->error[a], &s->error[b]);
    if (!least_error(&both, &c.place)) {
        vec3 p = position(s, a), q = position(s, b);
        c.place = vec3_scale(vec3_add(p, q), 0.5);
        if (error_at(&both, p) < error_at(&both, c.place)) c.place = p;
        if (error_at(&both, q) < error_at(&both, c.place)) c.place = q;
    }
    c.cost = error_at(&both, c.place);
    c.version[0] = s->version[c.from];
    c.version[1] = s->version[c.to];
    return push(s, &c, error);
}

/* Every edge once: it is met in one direction by one of its two faces. */
static gvc_result queue_all(simplifier *s, gvc_error *error) {
    s->heap_count = 0;
    for (size_t f = 0; f < s->face_count; f++) {
        for (int k = 0; k < 3 && !s->gone[f]; k++) {
            uint32_t a = s->vertex[3 * f + k], b = s->vertex[3 * f + (k + 1) % 3];
            if (a < b) GVC_TRY(queue_edge(s, a, b, error));
        }
    }
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------------- collapse
 */

static bool has_vertex(const simplifier *s, size_t face, uint32_t vertex) {
    const uint32_t *v = s->vertex + 3 * face;
    return v[0] == vertex || v[1] == vertex || v[2] == vertex;
}

/* The link condition on a closed surface: an edge may go if its ends have just the two vertices
 * opposite to it as common neighbours. */
static bool keeps_topology(simplifier *s, uint32_t a, uint32_t b) {
    uint32_t near_a = ++s->search, common = ++s->search;
    size_t count = 0;
    for (uint32_t c = s->first[a]; c != NO_CORNER; c = s->next[c]) {
        for (int k = 0; k < 3 && !s->gone[c / 3]; k++) s->mark[s->vertex[c / 3 * 3 + k]] = near_a;
    }
    for (uint32_t c = s->first[b]; c != NO_CORNER; c = s->next[c]) {
        for (int k = 0; k < 3 && !s->gone[c / 3]; k++) {
            uint32_t v = s->vertex[c / 3 * 3 + k];
            if (v == a || v == b || s->mark[v] != near_a) continue;
            s->mark[v] = common;
            count++;
        }
    }
    return count == 2;
}

/* True if no face of `vertex` that stays turns over when the vertex moves to `place`. */
static bool keeps_faces(const simplifier *s, uint32_t vertex, uint32_t other, vec3 place) {
    vec3 p = position(s, vertex);
    for (uint32_t c = s->first[vertex]; c != NO_CORNER; c = s->next[c]) {
        if (s->gone[c / 3] || has_vertex(s, c / 3, other)) continue;
        vec3 q = position(s, s->vertex[c / 3 * 3 + (c + 1) % 3]);
        vec3 r = position(s, s->vertex[c / 3 * 3 + (c + 2) % 3]);
        if (!(vec3_dot(face_normal(p, q, r), face_normal(place, q, r)) > 0)) return false;
    }
    return true;
}

/* Moves vertex `to` into `from`. */
static gvc_result collapse(simplifier *s, const candidate *c, gvc_error *error) {
    uint32_t a = c->from, b = c->to;
    for (uint32_t corner = s->first[b]; corner != NO_CORNER; corner = s->next[corner]) {
        if (has_vertex(s, corner / 3, a)) s->gone[corner / 3] = true;
        s->vertex[corner] = a;
    }
    s->next[s->last[a]] = s->first[b];
    s->last[a] = s->last[b];
    s->first[b] = NO_CORNER;
    s->error[a] = sum(&s->error[a], &s->error[b]);
    const double place[3] = {c->place.x, c->place.y, c->place.z};
    memcpy(s->position + 3 * (size_t)a, place, sizeof place);
    s->version[a]++;
    s->version[b]++;
    s->left--;
    uint32_t met = ++s->search;
    for (uint32_t corner = s->first[a]; corner != NO_CORNER; corner = s->next[corner]) {
        for (int k = 1; k < 3 && !s->gone[corner / 3]; k++) {
            uint32_t v = s->vertex[corner / 3 * 3 + (corner + (uint32_t)k) % 3];
            if (s->mark[v] == met) continue;
            s->mark[v] = met;
            GVC_TRY(queue_edge(s, a, v, error));
        }
    }
    return GVC_OK;
}

/* Collapses what is queued, best first. */
static gvc_result collapse_queued(simplifier *s, size_t wanted, gvc_error *error) {
    while (s->left > wanted && s->heap_count > 0) {
        candidate c = pop(s);
        if (s->version[c.from] != c.version[0] || s->version[c.to] != c.version[1]) continue;
        if (!keeps_topology(s, c.from, c.to) || !keeps_faces(s, c.from, c.to, c.place) ||
            !keeps_faces(s, c.to, c.from, c.place)) {
            continue;
        }
        GVC_TRY(collapse(s, &c, error));
    }
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------------- mesh
 */

static gvc_result begin(simplifier *s, const gvc_mesh *mesh, gvc_error *error) {
    size_t n = mesh->vertex_count, corners = 3 * mesh->face_count;
    if (corners >= NO_CORNER) return gvc_fail(error, GVC_ERROR_LIMIT, "too many faces to simplify");
    s->vertex_count = s->left = n;
    s->face_count = mesh->face_count;
    s->position = gvc_alloc(n, 3 * sizeof *s->position);
    s->vertex = gvc_alloc(corners, sizeof *s->vertex);
    s->gone = gvc_alloc(mesh->face_count, sizeof *s->gone);
    s->first = gvc_alloc(n, sizeof *s->first);
    s->last = gvc_alloc(n, sizeof *s->last);
    s->next = gvc_alloc(corners, sizeof *s->next);
    s->error = gvc_alloc(n, sizeof *s->error);
    s->version = gvc_alloc(n, sizeof *s->version);
    s->mark = gvc_alloc(n, sizeof *s->mark);
    if (!s->position || !s->vertex || !s->gone || !s->first || !s->last || !s->next || !s->error ||
        !s->version || !s->mark) {
        return gvc_fail_memory(error);
    }
    memcpy(s->position, mesh->position, 3 * n * sizeof *s->position);
    memcpy(s->vertex, mesh->face, corners * sizeof *s->vertex);
    for (size_t v = 0; v < n; v++) s->first[v] = s->last[v] = NO_CORNER;
    for (uint32_t c = 0; c < corners; c++) {
        uint32_t v = s->vertex[c];
        s->next[c] = NO_CORNER;
        *(s->first[v] == NO_CORNER ? &s->first[v] : &s->next[s->last[v]]) = c;
        s->last[v] = c;
    }
    for (uint32_t c = 0; c < corners; c++) {
        const uint32_t *face = s->vertex + c / 3 * 3;
        vec3 p = position(s, face[0]);
        vec3 normal = face_normal(p, position(s, face[1]), position(s, face[2]));
        add_plane(&s->error[s->vertex[c]], normal, p);
    }
    return GVC_OK;
}

/* What is left, as a mesh. */
static gvc_result finish(const simplifier *s, gvc_mesh **simple, gvc_error *error) {
    size_t faces = 0, vertices = 0;
    uint32_t *number = s->version; /* no longer needed */
    for (size_t f = 0; f < s->face_count; f++) faces += !s->gone[f];
    GVC_TRY(gvc_mesh_allocate(s->left, faces, simple, error));
    gvc_mesh *mesh = *simple;
    for (size_t v = 0; v < s->vertex_count; v++) {
        if (s->first[v] == NO_CORNER) continue;
        memcpy(mesh->position + 3 * vertices, s->position + 3 * v, 3 * sizeof *mesh->position);
        number[v] = (uint32_t)vertices++;
    }
    faces = 0;
    for (size_t f = 0; f < s->face_count; f++) {
        if (s->gone[f]) continue;
        for (int k = 0; k < 3; k++) mesh->face[3 * faces + k] = number[s->vertex[3 * f + k]];
        faces++;
    }
    return GVC_OK;
}

gvc_result simplify_mesh(const gvc_mesh *mesh, size_t vertices, gvc_mesh **simple,
                         gvc_error *error) {
    simplifier s = {0};
    size_t wanted = vertices > LEAST_VERTICES ? vertices : LEAST_VERTICES, before_pass;
    *simple = NULL;
    gvc_result result = begin(&s, mesh, error);
    do { /* what was not allowed may have become so */
        before_pass = s.left;
        if (result == GVC_OK) result = queue_all(&s, error);
        if (result == GVC_OK) result = collapse_queued(&s, wanted, error);
    } while (result == GVC_OK && s.left > wanted && s.left < before_pass);
    if (result == GVC_OK) result = finish(&s, simple, error);
    simplifier_free(&s);
    return result;
}
