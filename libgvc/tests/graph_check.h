/* SPDX-License-Identifier: MIT */
/** @file graph_check.h  Checks of a cut graph that share no code with what makes it. */
#ifndef GVC_TESTS_GRAPH_CHECK_H
#define GVC_TESTS_GRAPH_CHECK_H

#include "descriptor/cut_graph.h"

#include <stdlib.h>

/** Marks the mesh edges of the graph, and checks that it is embedded: made of mesh edges, none used
 *  twice, and no vertex shared by edges other than as a node of both. */
static inline uint8_t *checked_wall(const gvc_halfedges *mesh, const gvc_cut_graph *graph) {
    uint8_t *wall = calloc(3 * mesh->face_count, 1), *used = calloc(mesh->vertex_count, 1);
    for (size_t n = 0; n < graph->node_count; n++) {
        assert_true(graph->node[n].vertex < mesh->vertex_count);
        assert_int_equal(used[graph->node[n].vertex]++, 0);
    }
    for (size_t e = 0; e < graph->edge_count; e++) {
        const gvc_cut_edge *edge = &graph->edge[e];
        size_t last = edge->vertex_count - 1;
        assert_true(edge->vertex_count >= 2);
        assert_int_equal(edge->vertex[0], graph->node[edge->node[0]].vertex);
        assert_int_equal(edge->vertex[last], graph->node[edge->node[1]].vertex);
        for (size_t i = 0; i < last; i++) {
            uint32_t h = gvc_halfedge_between(mesh, edge->vertex[i], edge->vertex[i + 1]);
            assert_int_not_equal(h, GVC_NONE);
            assert_int_equal(wall[h], 0);
            wall[h] = wall[mesh->twin[h]] = 1;
            if (i > 0) assert_int_equal(used[edge->vertex[i]]++, 0);
        }
    }
    free(used);
    return wall;
}

/** Checks that cutting a closed mesh along the graph leaves one disk: the faces stay in one piece,
 *  whose Euler characteristic, every vertex counted once per piece of its neighbourhood, is 1. */
static inline void check_opens_to_disk(const gvc_halfedges *mesh, const gvc_cut_graph *graph) {
    uint8_t *wall = checked_wall(mesh, graph), *seen = calloc(mesh->face_count, 1);
    uint32_t *stack = calloc(mesh->face_count, sizeof *stack);
    size_t reached = 1, waiting = 1;
    seen[0] = 1;
    while (waiting > 0) {
        uint32_t f = stack[--waiting];
        for (uint32_t h = 3 * f; h < 3 * f + 3; h++) {
            uint32_t g = mesh->twin[h] / 3;
            if (wall[h] || seen[g]) continue;
            seen[g] = 1;
            reached++;
            stack[waiting++] = g;
        }
    }
    assert_int_equal(reached, mesh->face_count);
    int64_t vertices = 0, edges = 0;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        int64_t cuts = 0;
        uint32_t h = mesh->outgoing[v];
        do {
            cuts += wall[h];
            h = gvc_turn(mesh, h);
        } while (h != mesh->outgoing[v]);
        vertices += cuts > 1 ? cuts : 1;
    }
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) edges += wall[h] ? 2 : 1;
    assert_int_equal(vertices - edges / 2 + (int64_t)mesh->face_count, 1);
    free(wall), free(seen), free(stack);
}

/** node_count - edge_count == 1 - 2 * genus, one root, and each tip once. */
static inline void check_structure(const gvc_cut_graph *graph, size_t genus, size_t tips) {
    size_t roots = 0, extrema = 0;
    assert_int_equal(graph->node_count + 2 * genus, graph->edge_count + 1);
    for (size_t n = 0; n < graph->node_count; n++) {
        roots += graph->node[n].kind == GVC_NODE_ROOT;
        if (graph->node[n].kind != GVC_NODE_EXTREMUM) continue;
        extrema++;
        for (size_t m = 0; m < n; m++)
            assert_false(graph->node[m].kind == GVC_NODE_EXTREMUM &&
                         graph->node[m].feature == graph->node[n].feature);
    }
    assert_int_equal(roots, 1);
    assert_int_equal(extrema, tips);
}

#endif
