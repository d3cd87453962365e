/* SPDX-License-Identifier: MIT */
/** @file refine.c  Longest-edge bisection of a mesh. */
#include "mesh/refine.h"

#include "base/memory.h"

#include <stdlib.h>

/* An edge as it was when it was put on the heap. Splits renumber halfedges: an entry is good as
 * long as its halfedge has its length. */
typedef struct long_edge {
    double length;
    uint32_t halfedge;
} long_edge;

typedef struct queue {
    long_edge *heap; /* greatest length first, then least halfedge */
    size_t count, capacity;
} queue;

static bool before(const long_edge *a, const long_edge *b) {
    if (a->length != b->length) return a->length > b->length;
    return a->halfedge < b->halfedge;
}

static gvc_result push(queue *q, long_edge edge, gvc_error *error) {
    void *heap = q->heap;
    if (!gvc_grow(&heap, &q->capacity, q->count + 1, sizeof *q->heap))
        return gvc_fail_memory(error);
    q->heap = heap;
    size_t place = q->count++;
    while (place > 0 && before(&edge, &q->heap[(place - 1) / 2])) {
        q->heap[place] = q->heap[(place - 1) / 2];
        place = (place - 1) / 2;
    }
    q->heap[place] = edge;
    return GVC_OK;
}

static long_edge pop(queue *q) {
    long_edge top = q->heap[0], last = q->heap[--q->count];
    size_t place = 0;
    for (size_t child = 1; child < q->count; child = 2 * place + 1) {
        if (child + 1 < q->count && before(&q->heap[child + 1], &q->heap[child])) child++;
        if (!before(&q->heap[child], &last)) break;
        q->heap[place] = q->heap[child];
        place = child;
    }
    q->heap[place] = last;
    return top;
}

/* Puts the edge of `h` on the heap if it is too long. */
static gvc_result consider(queue *q, const gvc_halfedges *mesh, uint32_t h, double longest,
                           gvc_error *error) {
    double length = gvc_halfedge_length(mesh, h);
    return length > longest ? push(q, (long_edge){length, h}, error) : GVC_OK;
}

/* The edges of all faces round a new vertex: those that are new, and those that have a new number.
 */
static gvc_result consider_round(queue *q, const gvc_halfedges *mesh, uint32_t vertex,
                                 double longest, gvc_error *error) {
    uint32_t first = mesh->outgoing[vertex], h = first;
    do {
        for (uint32_t k = 0; k < 3; k++) GVC_TRY(consider(q, mesh, h / 3 * 3 + k, longest, error));
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first);
    return GVC_OK;
}

gvc_result gvc_refine(gvc_halfedges *mesh, double longest, size_t most, gvc_error *error) {
    queue q = {0};
    gvc_result result = GVC_OK;
    if (!(longest > 0))
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "cannot split edges to a length of %g", longest);
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        bool second = mesh->twin[h] != GVC_NONE && mesh->twin[h] < h;
        if (!second) GVC_CHECK(consider(&q, mesh, h, longest, error));
    }
    while (q.count > 0 && mesh->vertex_count < most) {
        uint32_t vertex;
        long_edge edge = pop(&q);
        if (gvc_halfedge_length(mesh, edge.halfedge) != edge.length) continue;
        GVC_CHECK(gvc_halfedges_split(mesh, edge.halfedge, 0.5, &vertex, error));
        GVC_CHECK(consider_round(&q, mesh, vertex, longest, error));
    }
cleanup:
    free(q.heap);
    return result;
}
