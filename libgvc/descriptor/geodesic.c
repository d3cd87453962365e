/* SPDX-License-Identifier: MIT */
/** @file geodesic.c  Geodesic distance by fast marching with the planar-source update. */
#include "descriptor/geodesic.h"

#include "base/memory.h"
#include "descriptor/unfold.h"

#include <math.h>
#include <stdlib.h>

/* Where a vertex is; any other value is its place in the heap. */
enum { STATE_FAR = UINT32_MAX, STATE_FINAL = UINT32_MAX - 1 };

/* A vertex of the front, with its key beside it: sifting then never leaves the heap's memory. */
typedef struct front_entry {
    double distance;
    uint32_t vertex;
} front_entry;

struct gvc_marcher {
    const gvc_halfedges *mesh; /* borrowed */
    gvc_apex *apex;            /* per halfedge: the third corner of its face as seen from it */
    gvc_unfolding unfolding;   /* the triangles that split obtuse corners */
    uint32_t *state;           /* per vertex */
    front_entry *heap;         /* 4-ary, least distance first */
    size_t heap_count;
};

/* ------------------------------------------------------------------------------------ the front */

enum { ARITY = 4 };

static void heap_put(gvc_marcher *m, size_t place, front_entry entry) {
    m->heap[place] = entry;
    m->state[entry.vertex] = (uint32_t)place;
}

static void sift_up(gvc_marcher *m, size_t place, front_entry entry) {
    while (place > 0) {
        size_t parent = (place - 1) / ARITY;
        if (m->heap[parent].distance <= entry.distance) break;
        heap_put(m, place, m->heap[parent]);
        place = parent;
    }
    heap_put(m, place, entry);
}

static void sift_down(gvc_marcher *m, size_t place, front_entry entry) {
    for (;;) {
        size_t first = place * ARITY + 1;
        if (first >= m->heap_count) break;
        size_t end = first + ARITY < m->heap_count ? first + ARITY : m->heap_count;
        size_t least = first;
        for (size_t child = first + 1; child < end; child++)
            if (m->heap[child].distance < m->heap[least].distance) least = child;
        if (m->heap[least].distance >= entry.distance) break;
        heap_put(m, place, m->heap[least]);
        place = least;
    }
    heap_put(m, place, entry);
}

static uint32_t pop_nearest(gvc_marcher *m) {
    uint32_t vertex = m->heap[0].vertex;
    front_entry last = m->heap[--m->heap_count];
    if (m->heap_count > 0) sift_down(m, 0, last);
    m->state[vertex] = STATE_FINAL;
    return vertex;
}

/* Lowers the distance of a vertex that is not final, if `candidate` is lower. */
static void offer(gvc_marcher *m, double *distance, uint32_t vertex, double candidate) {
    /* Written so that a NaN (coordinates whose squares overflow) is never taken. */
    if (!(candidate < distance[vertex])) return;
    distance[vertex] = candidate;
    size_t place = m->state[vertex];
    if (place == STATE_FAR) place = m->heap_count++;
    sift_up(m, place, (front_entry){candidate, vertex});
}

/* ----------------------------------------------------------------------------------- the update */

/* The planar-source update: with the base of a triangle on the x axis from (0, 0) to (length, 0)
 * and distances `a`, `b` known at its ends, the wave comes from the one point below the base that
 * has those distances; the apex is straight above it if the ray between them crosses the base.
 * Exact where the strip of triangles between source and apex is flat, unlike the update of Kimmel
 * and Sethian, whose planar wave front is wrong near the source. Returns INFINITY where the ray
 * misses the base: then the way along an edge is the shortest through this triangle. */
static double distance_through(const gvc_apex *apex, double a, double b) {
    double source_x = 0.5 * ((a - b) * (a + b) * apex->inverse_length + apex->length);
    double square = (a - source_x) * (a + source_x);
    if (!(square >= 0))
        return INFINITY; /* the triangle inequality does not hold for a, b, length */
    double depth = sqrt(square), height = apex->y + depth;
    double crossing = source_x * apex->y + apex->x * depth; /* times height */
    if (crossing <= 0 || crossing >= apex->length * height) return INFINITY;
    double dx = apex->x - source_x;
    return sqrt(dx * dx + height * height);
}

static bool is_final(const gvc_marcher *m, uint32_t vertex) {
    return m->state[vertex] == STATE_FINAL;
}

/* The triangles that split an obtuse corner, whose far vertex is no neighbour of the corner. */
static void pass_on_unfolded(gvc_marcher *m, double *distance, uint32_t vertex) {
    const gvc_unfolding *u = &m->unfolding;
    for (uint32_t i = u->first[vertex]; i < u->first[vertex + 1]; i++) {
        const gvc_split *split = &u->split[u->incident[i]];
        uint32_t far = split->far, corner = split->corner;
        if (is_final(m, corner) || !is_final(m, far)) continue;
        if (far == vertex) offer(m, distance, corner, distance[vertex] + split->far_length);
        for (int side = 0; side < 2; side++) {
            uint32_t near = split->near[side];
            if ((far == vertex || near == vertex) && is_final(m, near))
                offer(m, distance, corner,
                      distance_through(&split->apex[side], distance[near], distance[far]));
        }
    }
}

/* Passes the wave on from a vertex that has just become final: along its edges, and across the base
 * of every face whose other base vertex is final, too. */
static void pass_on(gvc_marcher *m, double *distance, uint32_t vertex) {
    const gvc_halfedges *mesh = m->mesh;
    const double here = distance[vertex];
    uint32_t first = mesh->outgoing[vertex], h = first;
    do {
        /* The face is (vertex, ahead, behind); `behind` is `ahead` of the next face, if any. */
        uint32_t back = gvc_prev(h);
        uint32_t ahead = mesh->vertex[gvc_next(h)], behind = mesh->vertex[back];
        bool ahead_final = is_final(m, ahead), behind_final = is_final(m, behind);
        if (!ahead_final) {
            offer(m, distance, ahead, here + m->apex[h].length);
            if (behind_final)
                offer(m, distance, ahead, distance_through(&m->apex[back], distance[behind], here));
        }
        if (!behind_final) {
            if (mesh->twin[back] == GVC_NONE)
                offer(m, distance, behind, here + m->apex[back].length);
            if (ahead_final)
                offer(m, distance, behind, distance_through(&m->apex[h], here, distance[ahead]));
        }
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first);
    pass_on_unfolded(m, distance, vertex);
}

/* ---------------------------------------------------------------------------------- the marcher */

static void measure_faces(const gvc_halfedges *mesh, gvc_apex *apex) {
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        const double *a = mesh->position + 3 * mesh->vertex[h];
        const double *b = mesh->position + 3 * mesh->vertex[gvc_next(h)];
        const double *c = mesh->position + 3 * mesh->vertex[gvc_prev(h)];
        double base = 0, side = 0, along = 0;
        for (int k = 0; k < 3; k++) {
            base += (b[k] - a[k]) * (b[k] - a[k]);
            side += (c[k] - a[k]) * (c[k] - a[k]);
            along += (b[k] - a[k]) * (c[k] - a[k]);
        }
        apex[h] = gvc_apex_make(sqrt(base), sqrt(side), along);
    }
}

gvc_result gvc_marcher_create(const gvc_halfedges *mesh, gvc_marcher **marcher, gvc_error *error) {
    *marcher = NULL;
    /* Keeps heap places and halfedge numbers apart from the two special states and GVC_NONE. */
    if (mesh->vertex_count >= STATE_FINAL || mesh->face_count >= UINT32_MAX / 3)
        return gvc_fail(error, GVC_ERROR_LIMIT, "%zu vertices and %zu faces are too many",
                        mesh->vertex_count, mesh->face_count);
    gvc_marcher *m = gvc_alloc(1, sizeof *m);
    if (!m) return gvc_fail_memory(error);
    m->mesh = mesh;
    m->apex = gvc_alloc(3 * mesh->face_count, sizeof *m->apex);
    m->state = gvc_alloc(mesh->vertex_count, sizeof *m->state);
    m->heap = gvc_alloc(mesh->vertex_count, sizeof *m->heap);
    gvc_result result = GVC_OK;
    if (!m->apex || !m->state || !m->heap) {
        result = gvc_fail_memory(error);
    } else {
        measure_faces(mesh, m->apex);
        result = gvc_unfold(mesh, m->apex, &m->unfolding, error);
    }
    if (result != GVC_OK) {
        gvc_marcher_destroy(&m);
        return result;
    }
    *marcher = m;
    return GVC_OK;
}

void gvc_marcher_destroy(gvc_marcher **marcher) {
    if (!marcher || !*marcher) return;
    gvc_marcher *m = *marcher;
    free(m->apex);
    gvc_unfolding_free(&m->unfolding);
    free(m->state);
    free(m->heap);
    free(m);
    *marcher = NULL;
}

gvc_result gvc_march(gvc_marcher *marcher, const uint32_t *source, size_t count, double *distance,
                     gvc_error *error) {
    size_t vertex_count = marcher->mesh->vertex_count;
    for (size_t i = 0; i < count; i++)
        if (source[i] >= vertex_count)
            return gvc_fail(error, GVC_ERROR_ARGUMENT,
                            "source vertex %u of a mesh with %zu vertices", (unsigned)source[i],
                            vertex_count);
    for (size_t v = 0; v < vertex_count; v++) {
        distance[v] = INFINITY;
        marcher->state[v] = STATE_FAR;
    }
    marcher->heap_count = 0;
    for (size_t i = 0; i < count; i++) offer(marcher, distance, source[i], 0);
    while (marcher->heap_count > 0) pass_on(marcher, distance, pop_nearest(marcher));
    return GVC_OK;
}
