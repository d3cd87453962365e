/* SPDX-License-Identifier: MIT */
/** @file bending.c  A surface that bends as rigidly as possible. */
#include "descriptor/bending.h"

#include "base/memory.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void gvc_bending_free(gvc_bending *b) {
    free(b->rest);
    free(b->normal);
    free(b->place);
    free(b->rotation);
    free(b->first);
    free(b->neighbour);
    free(b->influence);
    free(b->weight);
    *b = (gvc_bending){0};
}

/* ----------------------------------------------------------------------------- spreading nodes */

/* Discs round nodes, measured along mesh edges: a heap of vertices by distance. */
typedef struct item {
    double distance;
    uint32_t vertex;
} item;

typedef struct spreader {
    const gvc_halfedges *mesh;
    double *distance; /* per vertex, of the disc being grown; INFINITY: not reached */
    uint32_t *reached;
    size_t reached_count;
    item *heap;
    size_t heap_count;
    double *near; /* GVC_BENDING_INFLUENCES distances per vertex, ascending */
    bool *covered;
} spreader;

static void push(spreader *s, double distance, uint32_t vertex) {
    size_t i = s->heap_count++;
    while (i > 0 && s->heap[(i - 1) / 2].distance > distance) {
        s->heap[i] = s->heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    s->heap[i] = (item){distance, vertex};
}

static item pop(spreader *s) {
    item top = s->heap[0], last = s->heap[--s->heap_count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= s->heap_count) break;
        if (child + 1 < s->heap_count && s->heap[child + 1].distance < s->heap[child].distance)
            child++;
        if (s->heap[child].distance >= last.distance) break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return top;
}

static void reach(spreader *s, double distance, uint32_t vertex) {
    if (distance >= s->distance[vertex]) return;
    if (isinf(s->distance[vertex])) s->reached[s->reached_count++] = vertex;
    s->distance[vertex] = distance;
    push(s, distance, vertex);
}

/* Enters a node into the list of nearest ones of a vertex. */
static void influence(gvc_bending *b, spreader *s, uint32_t vertex, uint32_t node,
                      double distance) {
    size_t k = GVC_BENDING_INFLUENCES;
    double *near = s->near + k * vertex;
    uint32_t *list = b->influence + k * vertex;
    size_t at = k;
    while (at > 0 && near[at - 1] > distance) at--;
    if (at == k) return;
    for (size_t i = k - 1; i > at; i--) {
        near[i] = near[i - 1];
        list[i] = list[i - 1];
    }
    near[at] = distance;
    list[at] = node;
}

/* Covers the disc of `radius` round a new node; vertices up to twice as far feel it. */
static void grow(gvc_bending *b, spreader *s, uint32_t node, uint32_t vertex, double radius) {
    const gvc_halfedges *m = s->mesh;
    s->reached_count = s->heap_count = 0;
    reach(s, 0, vertex);
    while (s->heap_count > 0) {
        item top = pop(s);
        if (top.distance > s->distance[top.vertex]) continue;
        influence(b, s, top.vertex, node, top.distance);
        if (top.distance < radius) s->covered[top.vertex] = true;
        uint32_t h = m->outgoing[top.vertex];
        do {
            double d = top.distance + gvc_halfedge_length(m, h);
            if (d < 2 * radius) reach(s, d, m->vertex[gvc_next(h)]);
            h = gvc_turn(m, h);
        } while (h != GVC_NONE && h != m->outgoing[top.vertex]);
    }
    for (size_t i = 0; i < s->reached_count; i++) s->distance[s->reached[i]] = INFINITY;
}

static gvc_result spread(gvc_bending *b, spreader *s, double radius, gvc_error *error) {
    size_t n = s->mesh->vertex_count;
    s->distance = gvc_alloc(n, sizeof *s->distance);
    s->reached = gvc_alloc(n, sizeof *s->reached);
    s->heap = gvc_alloc(3 * s->mesh->face_count + 1, sizeof *s->heap);
    s->near = gvc_alloc(n, GVC_BENDING_INFLUENCES * sizeof *s->near);
    s->covered = gvc_alloc(n, sizeof *s->covered);
    if (!s->distance || !s->reached || !s->heap || !s->near || !s->covered)
        return gvc_fail_memory(error);
    for (size_t v = 0; v < n; v++) s->distance[v] = INFINITY;
    for (size_t i = 0; i < n * GVC_BENDING_INFLUENCES; i++) {
        s->near[i] = INFINITY;
        b->influence[i] = GVC_NONE;
    }
    for (uint32_t v = 0; v < n; v++) {
        if (s->covered[v]) continue;
        memcpy(b->rest + 3 * b->node_count, s->mesh->position + 3 * (size_t)v, 3 * sizeof(double));
        grow(b, s, (uint32_t)b->node_count++, v, radius);
    }
    return GVC_OK;
}

/* Influence falls to nothing at twice the radius (Sumner et al., Eq. 4). */
static void weigh(gvc_bending *b, const spreader *s, double radius) {
    for (size_t v = 0; v < b->vertex_count; v++) {
        const double *near = s->near + GVC_BENDING_INFLUENCES * v;
        double *weight = b->weight + GVC_BENDING_INFLUENCES * v, sum = 0;
        for (int k = 0; k < GVC_BENDING_INFLUENCES; k++) {
            double part = isinf(near[k]) ? 0 : 1 - near[k] / (2 * radius);
            weight[k] = part * part;
            sum += weight[k];
        }
        for (int k = 0; k < GVC_BENDING_INFLUENCES; k++) weight[k] /= sum;
    }
}

/* ----------------------------------------------------------------------------------- the graph */

static int compare_pairs(const void *a, const void *b) {
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Nodes are neighbours where their Voronoi cells meet. */
static gvc_result join(gvc_bending *b, const gvc_halfedges *mesh, gvc_error *error) {
    size_t count = 0, kept = 0;
    uint64_t *pair = gvc_alloc(3 * mesh->face_count, sizeof *pair);
    if (!pair) return gvc_fail_memory(error);
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        uint64_t a = b->influence[GVC_BENDING_INFLUENCES * (size_t)mesh->vertex[h]];
        uint64_t c = b->influence[GVC_BENDING_INFLUENCES * (size_t)mesh->vertex[gvc_next(h)]];
        if (a != c) pair[count++] = a << 32 | c;
    }
    qsort(pair, count, sizeof *pair, compare_pairs);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || pair[i] != pair[i - 1]) pair[kept++] = pair[i];
    b->edge_count = kept;
    b->neighbour = gvc_alloc(kept, sizeof *b->neighbour);
    if (!b->neighbour) {
        free(pair);
        return gvc_fail_memory(error);
    }
    for (size_t i = 0; i < kept; i++) {
        b->neighbour[i] = (uint32_t)pair[i];
        b->first[(pair[i] >> 32) + 1]++;
    }
    for (size_t i = 0; i < b->node_count; i++) b->first[i + 1] += b->first[i];
    free(pair);
    return GVC_OK;
}

/* The area-weighted normal of a node's cell. */
static void orient(gvc_bending *b, const gvc_halfedges *mesh) {
    for (size_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = mesh->vertex + 3 * f;
        double n[3];
        gvc_face_area_normal(mesh, f, n);
        for (int k = 0; k < 3; k++) {
            double *normal =
                b->normal + 3 * (size_t)b->influence[GVC_BENDING_INFLUENCES * (size_t)v[k]];
            for (int c = 0; c < 3; c++) normal[c] += n[c];
        }
    }
    for (size_t i = 0; i < b->node_count; i++) {
        double *n = b->normal + 3 * i, length = sqrt(gvc_dot(n, n));
        for (int c = 0; c < 3; c++) n[c] = length > 0 ? n[c] / length : 0;
    }
}

static double area_of(const gvc_halfedges *mesh) {
    double area = 0;
    for (size_t f = 0; f < mesh->face_count; f++) {
        double n[3];
        gvc_face_area_normal(mesh, f, n);
        area += sqrt(gvc_dot(n, n)) / 2;
    }
    return area;
}

gvc_result gvc_bending_create(const gvc_halfedges *mesh, size_t nodes, gvc_bending *b,
                              gvc_error *error) {
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    size_t n = mesh->vertex_count;
    double radius = sqrt(area_of(mesh) / (double)nodes);
    spreader s = {.mesh = mesh};
    gvc_result result = GVC_OK;
    *b = (gvc_bending){.vertex_count = n};
    b->rest = gvc_alloc(n, 3 * sizeof *b->rest);
    b->normal = gvc_alloc(n, 3 * sizeof *b->normal);
    b->place = gvc_alloc(n, 3 * sizeof *b->place);
    b->rotation = gvc_alloc(n, 9 * sizeof *b->rotation);
    b->first = gvc_alloc(n + 1, sizeof *b->first);
    b->influence = gvc_alloc(n, GVC_BENDING_INFLUENCES * sizeof *b->influence);
    b->weight = gvc_alloc(n, GVC_BENDING_INFLUENCES * sizeof *b->weight);
    if (!b->rest || !b->normal || !b->place || !b->rotation || !b->first || !b->influence ||
        !b->weight)
        GVC_CHECK(gvc_fail_memory(error));
    GVC_CHECK(spread(b, &s, radius, error));
    weigh(b, &s, radius);
    GVC_CHECK(join(b, mesh, error));
    orient(b, mesh);
    memcpy(b->place, b->rest, 3 * b->node_count * sizeof *b->place);
    for (size_t i = 0; i < b->node_count; i++)
        memcpy(b->rotation + 9 * i, identity, sizeof identity);
cleanup:
    free(s.distance);
    free(s.reached);
    free(s.heap);
    free(s.near);
    free(s.covered);
    if (result != GVC_OK) gvc_bending_free(b);
    return result;
}

/* ----------------------------------------------------------------------------------- rotations */

/* Turns `rotation` towards the rotation part of `matrix` (rows: what rest vectors become, summed):
 * Mueller et al. 2016, "A robust method to extract the rotational part of deformations". It starts
 * from what it was, so few steps do. */
static void extract_rotation(const double matrix[9], double rotation[9]) {
    for (int step = 0; step < 4; step++) {
        double turn[3] = {0}, scale = 1e-300, spin[9], next[9];
        for (int c = 0; c < 3; c++) {
            const double r[3] = {rotation[c], rotation[3 + c], rotation[6 + c]};
            const double a[3] = {matrix[c], matrix[3 + c], matrix[6 + c]};
            double cross[3];
            gvc_cross(r, a, cross);
            for (int k = 0; k < 3; k++) turn[k] += cross[k];
            scale += gvc_dot(r, a);
        }
        for (int k = 0; k < 3; k++) turn[k] /= fabs(scale);
        double angle = sqrt(gvc_dot(turn, turn));
        if (angle < 1e-9) return;
        gvc_rotation_about(turn, spin);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                next[3 * i + j] = spin[3 * i] * rotation[j] + spin[3 * i + 1] * rotation[3 + j] +
                                  spin[3 * i + 2] * rotation[6 + j];
        memcpy(rotation, next, sizeof next);
    }
}

void gvc_bending_rotate(gvc_bending *b) {
    for (size_t i = 0; i < b->node_count; i++) {
        double matrix[9] = {0}, before[3], now[3];
        for (uint32_t k = b->first[i]; k < b->first[i + 1]; k++) {
            size_t j = b->neighbour[k];
            gvc_subtract(b->rest + 3 * j, b->rest + 3 * i, before);
            gvc_subtract(b->place + 3 * j, b->place + 3 * i, now);
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++) matrix[3 * r + c] += now[r] * before[c];
        }
        extract_rotation(matrix, b->rotation + 9 * i);
    }
}

void gvc_bending_vertices(const gvc_bending *b, const gvc_halfedges *mesh, double *moved) {
    for (size_t v = 0; v < b->vertex_count; v++) {
        double *p = moved + 3 * v, arm[3];
        memset(p, 0, 3 * sizeof *p);
        for (size_t k = GVC_BENDING_INFLUENCES * v; k < GVC_BENDING_INFLUENCES * (v + 1); k++) {
            if (b->influence[k] == GVC_NONE) continue;
            size_t i = b->influence[k];
            gvc_subtract(mesh->position + 3 * v, b->rest + 3 * i, arm);
            for (int c = 0; c < 3; c++)
                p[c] += b->weight[k] *
                        (b->place[3 * i + (size_t)c] + gvc_dot(b->rotation + 9 * i + 3 * c, arm));
        }
    }
}
