/* SPDX-License-Identifier: MIT */
/** @file loops.c  Tree-cotree decomposition. */
#include "descriptor/loops.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

typedef struct queue_entry {
    double distance;
    uint32_t vertex;
} queue_entry;

struct gvc_loop_search {
    uint8_t *wall;      /* per halfedge: belongs to the obstacles */
    queue_entry *queue; /* binary heap */
    size_t queue_count;
    uint32_t *set; /* per face: union-find of the dual tree */
};

void gvc_loops_free(gvc_loops *loops) {
    struct gvc_loop_search *s = loops->search;
    if (s) {
        free(s->wall);
        free(s->queue);
        free(s->set);
        free(s);
    }
    free(loops->blocked);
    free(loops->distance);
    free(loops->toward);
    free(loops->edge);
    *loops = (gvc_loops){0};
}

static void mark_obstacles(const gvc_halfedges *mesh, const gvc_obstacles *obstacles, uint8_t *wall,
                           uint8_t *blocked) {
    const gvc_cut_graph *graph = obstacles->graph;
    for (size_t n = 0; n < graph->node_count; n++) blocked[graph->node[n].vertex] = 1;
    for (size_t i = 0; i < obstacles->vertex_count; i++)
        if (obstacles->vertex[i] != GVC_NONE) blocked[obstacles->vertex[i]] = 1;
    for (size_t e = 0; e < graph->edge_count; e++)
        for (size_t i = 0; i + 1 < graph->edge[e].vertex_count; i++) {
            const uint32_t *v = graph->edge[e].vertex + i;
            uint32_t h = gvc_halfedge_between(mesh, v[0], v[1]);
            blocked[v[0]] = blocked[v[1]] = 1;
            wall[h] = wall[mesh->twin[h]] = 1;
        }
}

/* Splits the edges between two blocked vertices that are no obstacles themselves. Then loops along
 * the edges between free vertices go everywhere where loops on the surface can go. */
static gvc_result loosen(gvc_halfedges *mesh, const gvc_obstacles *obstacles, gvc_error *error) {
    size_t halfedges = 3 * mesh->face_count, count = 0;
    uint8_t *wall = gvc_alloc(halfedges, 1), *blocked = gvc_alloc(mesh->vertex_count, 1);
    uint32_t *end = gvc_alloc(halfedges, sizeof *end); /* two per edge */
    gvc_result result = wall && blocked && end ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) mark_obstacles(mesh, obstacles, wall, blocked);
    for (uint32_t h = 0; result == GVC_OK && h < halfedges; h++) {
        uint32_t a = mesh->vertex[h], b = mesh->vertex[gvc_next(h)];
        if (mesh->twin[h] < h || !blocked[a] || !blocked[b] || wall[h]) continue;
        end[count++] = a;
        end[count++] = b;
    }
    for (size_t i = 0; result == GVC_OK && i < count; i += 2) {
        uint32_t middle, h = gvc_halfedge_between(mesh, end[i], end[i + 1]);
        result = gvc_halfedges_split(mesh, h, 0.5, &middle, error);
    }
    free(wall);
    free(blocked);
    free(end);
    return result;
}

gvc_result gvc_loops_prepare(gvc_halfedges *mesh, const gvc_obstacles *obstacles, gvc_loops *loops,
                             gvc_error *error) {
    *loops = (gvc_loops){0};
    GVC_TRY(loosen(mesh, obstacles, error));
    size_t vertices = mesh->vertex_count, halfedges = 3 * mesh->face_count;
    struct gvc_loop_search *s = loops->search = gvc_alloc(1, sizeof *s);
    gvc_result result = GVC_OK;
    if (!s) GVC_CHECK(gvc_fail_memory(error));
    loops->mesh = mesh;
    loops->blocked = gvc_alloc(vertices, 1);
    loops->distance = gvc_alloc(vertices, sizeof *loops->distance);
    loops->toward = gvc_alloc(vertices, sizeof *loops->toward);
    loops->edge = gvc_alloc(halfedges, sizeof *loops->edge);
    s->wall = gvc_alloc(halfedges, 1);
    s->queue = gvc_alloc(halfedges + 1, sizeof *s->queue);
    s->set = gvc_alloc(mesh->face_count, sizeof *s->set);
    if (!loops->blocked || !loops->distance || !loops->toward || !loops->edge || !s->wall ||
        !s->queue || !s->set)
        GVC_CHECK(gvc_fail_memory(error));
    mark_obstacles(mesh, obstacles, s->wall, loops->blocked);
cleanup:
    if (result != GVC_OK) gvc_loops_free(loops);
    return result;
}

static void push(gvc_loops *d, double distance, uint32_t vertex) {
    size_t place = d->search->queue_count++;
    for (; place > 0 && d->search->queue[(place - 1) / 2].distance > distance;
         place = (place - 1) / 2)
        d->search->queue[place] = d->search->queue[(place - 1) / 2];
    d->search->queue[place] = (queue_entry){distance, vertex};
}

static queue_entry pop(gvc_loops *d) {
    queue_entry top = d->search->queue[0], last = d->search->queue[--d->search->queue_count];
    size_t place = 0;
    for (;;) {
        size_t child = 2 * place + 1;
        if (child >= d->search->queue_count) break;
        if (child + 1 < d->search->queue_count &&
            d->search->queue[child + 1].distance < d->search->queue[child].distance)
            child++;
        if (d->search->queue[child].distance >= last.distance) break;
        d->search->queue[place] = d->search->queue[child];
        place = child;
    }
    d->search->queue[place] = last;
    return top;
}

/* Shortest path tree along edges between free vertices. Each halfedge is pushed at most once, so
 * the queue is large enough. */
static void grow_tree(gvc_loops *d, uint32_t root) {
    const gvc_halfedges *mesh = d->mesh;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        d->distance[v] = INFINITY;
        d->toward[v] = GVC_NONE;
    }
    d->distance[root] = 0;
    d->search->queue_count = 0;
    push(d, 0, root);
    while (d->search->queue_count > 0) {
        queue_entry now = pop(d);
        if (now.distance > d->distance[now.vertex]) continue;
        uint32_t h = mesh->outgoing[now.vertex];
        do {
            uint32_t to = mesh->vertex[gvc_next(h)];
            double through = now.distance + gvc_halfedge_length(mesh, h);
            if (!d->blocked[to] && through < d->distance[to]) {
                d->distance[to] = through;
                d->toward[to] = h;
                push(d, through, to);
            }
            h = gvc_turn(mesh, h);
        } while (h != mesh->outgoing[now.vertex]);
    }
}

static int longer_first(const void *left, const void *right) {
    const gvc_loop_edge *a = left, *b = right;
    if (a->length != b->length) return a->length > b->length ? -1 : 1;
    return a->h < b->h ? -1 : a->h > b->h;
}

static void list_edges(gvc_loops *d) {
    const gvc_halfedges *mesh = d->mesh;
    d->edge_count = 0;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        uint32_t a = mesh->vertex[h], b = mesh->vertex[gvc_next(h)];
        if (mesh->twin[h] < h || d->toward[b] == h || d->toward[a] == mesh->twin[h]) continue;
        if (d->search->wall[h]) continue;
        double length = d->distance[a] + d->distance[b] + gvc_halfedge_length(mesh, h);
        d->edge[d->edge_count++] = (gvc_loop_edge){length, h};
    }
    qsort(d->edge, d->edge_count, sizeof *d->edge, longer_first);
}

static uint32_t set_of(gvc_loops *d, uint32_t face) {
    while (d->search->set[face] != face)
        face = d->search->set[face] = d->search->set[d->search->set[face]];
    return face;
}

/* Kruskal's algorithm for the dual tree; the edges it leaves close the loops, those of handles and
 * one round each part of the obstacles, which is of infinite length. */
gvc_result gvc_loops_find(gvc_loops *d, uint32_t root, gvc_error *error) {
    const gvc_halfedges *mesh = d->mesh;
    size_t loops = 0;
    grow_tree(d, root);
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (!d->blocked[v] && !isfinite(d->distance[v]))
            return gvc_fail(error, GVC_ERROR_MESH,
                            "vertex %zu cannot be reached: the surface has several components", v);
    list_edges(d);
    for (uint32_t f = 0; f < mesh->face_count; f++) d->search->set[f] = f;
    for (size_t i = 0; i < d->edge_count; i++) {
        uint32_t a = set_of(d, d->edge[i].h / 3), b = set_of(d, mesh->twin[d->edge[i].h] / 3);
        if (a != b)
            d->search->set[a < b ? b : a] = a < b ? a : b;
        else if (isfinite(d->edge[i].length))
            d->edge[loops++] = d->edge[i];
    }
    d->edge_count = loops;
    return GVC_OK;
}
