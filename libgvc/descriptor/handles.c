/* SPDX-License-Identifier: MIT */
/** @file handles.c  Tree-cotree decomposition, and shortening of the graph it gives. */
#include "descriptor/handles.h"

#include "base/memory.h"
#include "descriptor/graph_edit.h"
#include "descriptor/wall.h"

#include <math.h>
#include <stdlib.h>

/* ---------------------------------------------------------------------------------- tree-cotree */

typedef struct queue_entry {
    double distance;
    uint32_t vertex;
} queue_entry;

typedef struct loop_edge {
    double length; /* of the loop that the edge closes with the tree */
    uint32_t h;
} loop_edge;

typedef struct decomposition {
    double *distance;   /* per vertex, along the edges of the mesh */
    uint32_t *toward;   /* per vertex: halfedge that comes from its parent in the tree */
    queue_entry *queue; /* binary heap */
    size_t queue_count;
    loop_edge *edge; /* those not in the tree, longest loop first */
    size_t edge_count;
    uint32_t *set; /* per face: union-find of the dual tree */
} decomposition;

static void decomposition_free(decomposition *d) {
    free(d->distance);
    free(d->toward);
    free(d->queue);
    free(d->edge);
    free(d->set);
}

static bool decomposition_allocate(decomposition *d, const gvc_halfedges *mesh) {
    d->distance = gvc_alloc(mesh->vertex_count, sizeof *d->distance);
    d->toward = gvc_alloc(mesh->vertex_count, sizeof *d->toward);
    d->queue = gvc_alloc(3 * mesh->face_count + 1, sizeof *d->queue);
    d->edge = gvc_alloc(3 * mesh->face_count, sizeof *d->edge);
    d->set = gvc_alloc(mesh->face_count, sizeof *d->set);
    return d->distance && d->toward && d->queue && d->edge && d->set;
}

static void push(decomposition *d, double distance, uint32_t vertex) {
    size_t place = d->queue_count++;
    for (; place > 0 && d->queue[(place - 1) / 2].distance > distance; place = (place - 1) / 2)
        d->queue[place] = d->queue[(place - 1) / 2];
    d->queue[place] = (queue_entry){distance, vertex};
}

static queue_entry pop(decomposition *d) {
    queue_entry top = d->queue[0], last = d->queue[--d->queue_count];
    size_t place = 0;
    for (;;) {
        size_t child = 2 * place + 1;
        if (child >= d->queue_count) break;
        if (child + 1 < d->queue_count && d->queue[child + 1].distance < d->queue[child].distance)
            child++;
        if (d->queue[child].distance >= last.distance) break;
        d->queue[place] = d->queue[child];
        place = child;
    }
    d->queue[place] = last;
    return top;
}

/* Shortest path tree along mesh edges. Each halfedge is pushed at most once, so the queue is large
 * enough. */
static void grow_tree(decomposition *d, const gvc_halfedges *mesh, uint32_t root) {
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        d->distance[v] = INFINITY;
        d->toward[v] = GVC_NONE;
    }
    d->distance[root] = 0;
    push(d, 0, root);
    while (d->queue_count > 0) {
        queue_entry now = pop(d);
        if (now.distance > d->distance[now.vertex]) continue;
        uint32_t h = mesh->outgoing[now.vertex];
        do {
            uint32_t to = mesh->vertex[gvc_next(h)];
            double through = now.distance + gvc_halfedge_length(mesh, h);
            if (through < d->distance[to]) {
                d->distance[to] = through;
                d->toward[to] = h;
                push(d, through, to);
            }
            h = gvc_turn(mesh, h);
        } while (h != mesh->outgoing[now.vertex]);
    }
}

static int longer_first(const void *left, const void *right) {
    const loop_edge *a = left, *b = right;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    return a->h < b->h ? -1 : a->h > b->h;
}

static void list_loops(decomposition *d, const gvc_halfedges *mesh) {
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        uint32_t a = mesh->vertex[h], b = mesh->vertex[gvc_next(h)];
        if (mesh->twin[h] < h || d->toward[b] == h || d->toward[a] == mesh->twin[h]) continue;
        double length = d->distance[a] + d->distance[b] + gvc_halfedge_length(mesh, h);
        d->edge[d->edge_count++] = (loop_edge){length, h};
    }
    qsort(d->edge, d->edge_count, sizeof *d->edge, longer_first);
}

static uint32_t set_of(decomposition *d, uint32_t face) {
    while (d->set[face] != face) face = d->set[face] = d->set[d->set[face]];
    return face;
}

/* The tree's path from the root to a vertex joins the wall. */
static void mark_branch(const decomposition *d, const gvc_halfedges *mesh, uint32_t vertex,
                        uint8_t *wall) {
    for (uint32_t h = d->toward[vertex]; h != GVC_NONE && !wall[h]; h = d->toward[mesh->vertex[h]])
        wall[h] = wall[mesh->twin[h]] = 1;
}

/* Kruskal's algorithm for the dual tree; the edges it leaves close the 2 * genus loops. */
static void mark_loops(decomposition *d, const gvc_halfedges *mesh, uint8_t *wall) {
    for (uint32_t f = 0; f < mesh->face_count; f++) d->set[f] = f;
    for (size_t i = 0; i < d->edge_count; i++) {
        uint32_t h = d->edge[i].h, twin = mesh->twin[h];
        uint32_t a = set_of(d, h / 3), b = set_of(d, twin / 3);
        if (a != b) {
            d->set[a < b ? b : a] = a < b ? a : b;
            continue;
        }
        mark_branch(d, mesh, mesh->vertex[h], wall);
        mark_branch(d, mesh, mesh->vertex[twin], wall);
        wall[h] = wall[twin] = 1;
    }
}

static gvc_result greedy_loops(const gvc_halfedges *mesh, uint32_t root, gvc_cut_graph *graph,
                               gvc_error *error) {
    decomposition d = {0};
    uint8_t *wall = gvc_alloc(3 * mesh->face_count, 1);
    gvc_result result = GVC_OK;
    if (!wall || !decomposition_allocate(&d, mesh)) GVC_CHECK(gvc_fail_memory(error));
    grow_tree(&d, mesh, root);
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (!isfinite(d.distance[v]))
            GVC_CHECK(gvc_fail(error, GVC_ERROR_MESH,
                               "vertex %zu cannot be reached: the surface has several components",
                               v));
    list_loops(&d, mesh);
    mark_loops(&d, mesh, wall);
    gvc_wall_prune(mesh, wall);
    result = gvc_wall_graph(mesh, wall, graph, error);
cleanup:
    decomposition_free(&d);
    free(wall);
    return result;
}

/* ----------------------------------------------------------------------------------- shortening */

/* Marks every corner met on the border to which halfedge `h` of the graph belongs. */
static void mark_border(gvc_pathfinder *finder, const gvc_halfedges *mesh, uint32_t h,
                        gvc_corner_role role, uint8_t *seen) {
    while (!seen[h]) {
        seen[h] = 1;
        /* The sector between this halfedge, coming in, and the next one, going out, turned through
         * clockwise: its corners are those from the outgoing halfedge counter-clockwise. */
        uint32_t next = gvc_next(h);
        while (!gvc_pathfinder_on_graph(finder, next)) next = gvc_next(mesh->twin[next]);
        gvc_pathfinder_mark_sector(finder, next, role);
        h = next;
    }
}

/* Without one of its edges the graph opens the surface to a ring: one of its borders becomes
 * source, the other target. False if there are not two borders. */
static bool mark_ring(gvc_pathfinder *finder, const gvc_halfedges *mesh, uint8_t *seen) {
    unsigned borders = 0;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        if (!gvc_pathfinder_on_graph(finder, h) || seen[h]) continue;
        mark_border(finder, mesh, h, borders == 0 ? GVC_CORNER_SOURCE : GVC_CORNER_TARGET, seen);
        borders++;
    }
    return borders == 2;
}

static double graph_length(const gvc_halfedges *mesh, const gvc_cut_graph *graph) {
    double length = 0;
    for (size_t e = 0; e < graph->edge_count; e++)
        length += gvc_cut_edge_length(mesh, &graph->edge[e]);
    return length;
}

/* Adds the path to the wall of `rest`; the graph of both replaces `graph`. */
static gvc_result join(gvc_halfedges *mesh, const gvc_cut_graph *rest, const gvc_surface_path *path,
                       gvc_cut_graph *graph, gvc_error *error) {
    uint32_t *chain = NULL;
    size_t count;
    uint8_t *wall = NULL;
    gvc_cut_graph joined = {0};
    gvc_result result = gvc_surface_path_insert(mesh, path, &chain, &count, error);
    if (result != GVC_OK) return result;
    wall = gvc_alloc(3 * mesh->face_count, 1);
    if (!wall) GVC_CHECK(gvc_fail_memory(error));
    gvc_wall_mark(mesh, rest, GVC_NONE, wall);
    for (size_t i = 0; i + 1 < count; i++) {
        uint32_t h = gvc_halfedge_between(mesh, chain[i], chain[i + 1]);
        wall[h] = wall[mesh->twin[h]] = 1;
    }
    GVC_CHECK(gvc_wall_graph(mesh, wall, &joined, error));
    gvc_cut_graph_free(graph);
    *graph = joined;
cleanup:
    free(chain);
    free(wall);
    return result;
}

/* Replaces one edge by the shortest path that joins the two borders of the ring which the rest of
 * the graph opens, if that is worth it; the length before is `*length`. */
static gvc_result shorten_edge(gvc_pathfinder *finder, gvc_halfedges *mesh, uint32_t edge,
                               gvc_cut_graph *graph, double *length, bool *shortened,
                               gvc_error *error) {
    gvc_cut_graph rest = {0};
    gvc_surface_path path = {0};
    uint8_t *mark = gvc_alloc(3 * mesh->face_count, 1);
    gvc_result result = GVC_OK;
    *shortened = false;
    if (!mark) GVC_CHECK(gvc_fail_memory(error));
    gvc_wall_mark(mesh, graph, edge, mark);
    gvc_wall_prune(mesh, mark);
    GVC_CHECK(gvc_wall_graph(mesh, mark, &rest, error));
    GVC_CHECK(gvc_pathfinder_begin(finder, mesh, &rest, error));
    for (size_t h = 0; h < 3 * mesh->face_count; h++) mark[h] = 0;
    if (!mark_ring(finder, mesh, mark))
        GVC_CHECK(
            gvc_fail(error, GVC_ERROR_INTERNAL, "cut edge %u does not join two borders", edge));
    GVC_CHECK(gvc_pathfinder_find(finder, NULL, NULL, &path, error));
    double now = graph_length(mesh, &rest) + path.cost;
    *shortened = path.count > 0 && now < *length * (1 - 1e-3);
    if (*shortened) {
        GVC_CHECK(join(mesh, &rest, &path, graph, error));
        *length = graph_length(mesh, graph);
    }
cleanup:
    gvc_cut_graph_free(&rest);
    gvc_surface_path_free(&path);
    free(mark);
    return result;
}

enum { SHORTENING_ROUNDS = 4 };

gvc_result gvc_handles_cut(gvc_pathfinder *finder, gvc_halfedges *mesh, uint32_t root,
                           gvc_cut_graph *graph, gvc_error *error) {
    *graph = (gvc_cut_graph){0};
    for (size_t h = 0; h < 3 * mesh->face_count; h++)
        if (mesh->twin[h] == GVC_NONE)
            return gvc_fail(error, GVC_ERROR_MESH, "the surface is open: face %zu has a free edge",
                            h / 3);
    gvc_result result = greedy_loops(mesh, root, graph, error);
    double length = graph_length(mesh, graph);
    bool any = true;
    for (int round = 0; result == GVC_OK && any && round < SHORTENING_ROUNDS; round++) {
        any = false;
        /* A new path changes the numbers of the edges: each round just tries as many as there are.
         */
        for (uint32_t e = 0; result == GVC_OK && e < graph->edge_count; e++) {
            bool shortened;
            result = shorten_edge(finder, mesh, e, graph, &length, &shortened, error);
            any = any || shortened;
        }
    }
    if (result != GVC_OK) gvc_cut_graph_free(graph);
    return result;
}
