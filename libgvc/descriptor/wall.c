/* SPDX-License-Identifier: MIT */
/** @file wall.c  A cut graph as a set of mesh edges, and back. */
#include "descriptor/wall.h"

#include "base/memory.h"
#include "descriptor/graph_edit.h"

#include <stdlib.h>
#include <string.h>

void gvc_wall_mark(const gvc_halfedges *mesh, const gvc_cut_graph *graph, uint32_t skip,
                   uint8_t *wall) {
    memset(wall, 0, 3 * mesh->face_count);
    for (uint32_t e = 0; e < graph->edge_count; e++)
        for (size_t i = 0; e != skip && i + 1 < graph->edge[e].vertex_count; i++) {
            uint32_t h =
                gvc_halfedge_between(mesh, graph->edge[e].vertex[i], graph->edge[e].vertex[i + 1]);
            wall[h] = wall[mesh->twin[h]] = 1;
        }
}

/* Number of wall edges at a vertex, and one of them. */
static unsigned degree(const gvc_halfedges *mesh, const uint8_t *wall, uint32_t v, uint32_t *some) {
    unsigned count = 0;
    uint32_t h = mesh->outgoing[v];
    do {
        if (wall[h]) {
            count++;
            *some = h;
        }
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != mesh->outgoing[v]);
    return count;
}

void gvc_wall_prune(const gvc_halfedges *mesh, uint8_t *wall) {
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        /* A loose end is taken off as far as it reaches. */
        uint32_t at = v, h = GVC_NONE;
        while (degree(mesh, wall, at, &h) == 1) {
            at = mesh->vertex[gvc_next(h)];
            wall[h] = wall[mesh->twin[h]] = 0;
        }
    }
}

/* Walks along the wall from halfedge `h` to the next node and adds that edge; `done` marks the
 * halfedges walked, both ways. */
static gvc_result add_edge(const gvc_halfedges *mesh, const uint8_t *wall, const uint32_t *node_of,
                           uint32_t h, uint8_t *done, gvc_cut_graph *graph, gvc_error *error) {
    uint32_t *chain = NULL, first = node_of[mesh->vertex[h]], added;
    size_t count = 0, capacity = 0;
    for (;;) {
        if (!gvc_grow((void **)&chain, &capacity, count + 2, sizeof *chain)) {
            free(chain);
            return gvc_fail_memory(error);
        }
        done[h] = done[mesh->twin[h]] = 1;
        uint32_t v = mesh->vertex[gvc_next(h)];
        chain[count++] = mesh->vertex[h];
        chain[count] = v;
        if (node_of[v] != GVC_NONE) break;
        uint32_t back = mesh->twin[h];
        h = gvc_turn(mesh, back);
        while (!wall[h]) h = gvc_turn(mesh, h);
    }
    gvc_result result = gvc_cut_graph_add_edge(graph, first, node_of[chain[count]], chain,
                                               count + 1, &added, error);
    if (result != GVC_OK) free(chain);
    return result;
}

static gvc_result add_edges_at(const gvc_halfedges *mesh, const uint8_t *wall,
                               const uint32_t *node_of, uint32_t vertex, uint8_t *done,
                               gvc_cut_graph *graph, gvc_error *error) {
    uint32_t h = mesh->outgoing[vertex];
    do {
        if (wall[h] && !done[h]) GVC_TRY(add_edge(mesh, wall, node_of, h, done, graph, error));
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != mesh->outgoing[vertex]);
    return GVC_OK;
}

gvc_result gvc_wall_graph(const gvc_halfedges *mesh, const uint8_t *wall, gvc_cut_graph *graph,
                          gvc_error *error) {
    *graph = (gvc_cut_graph){0};
    uint32_t *node_of = gvc_alloc(mesh->vertex_count, sizeof *node_of);
    uint8_t *done = gvc_alloc(3 * mesh->face_count, 1);
    gvc_result result = GVC_OK;
    if (!node_of || !done) GVC_CHECK(gvc_fail_memory(error));
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t some;
        gvc_cut_node node = {GVC_NODE_JUNCTION, 0, v};
        node_of[v] = GVC_NONE;
        if (degree(mesh, wall, v, &some) > 2)
            GVC_CHECK(gvc_cut_graph_add_node(graph, node, &node_of[v], error));
    }
    size_t forks = graph->node_count;
    for (size_t n = 0; n < forks; n++)
        GVC_CHECK(add_edges_at(mesh, wall, node_of, graph->node[n].vertex, done, graph, error));
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        if (!wall[h] || done[h]) continue;
        gvc_cut_node node = {GVC_NODE_JUNCTION, 0, mesh->vertex[h]};
        GVC_CHECK(gvc_cut_graph_add_node(graph, node, &node_of[node.vertex], error));
        GVC_CHECK(add_edge(mesh, wall, node_of, h, done, graph, error));
    }
cleanup:
    free(node_of);
    free(done);
    if (result != GVC_OK) gvc_cut_graph_free(graph);
    return result;
}
