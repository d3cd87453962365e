/* SPDX-License-Identifier: MIT */
/** @file handle_graph.c  The greedy system of loops as a graph, and its shortening. */
#include "descriptor/handle_graph.h"

#include "base/memory.h"
#include "descriptor/graph_edit.h"
#include "descriptor/wall.h"

#include <math.h>
#include <stdlib.h>

/* The tree's path from the root to a vertex joins the wall. */
static void mark_branch(const gvc_loops *loops, uint32_t vertex, uint8_t *wall) {
    const gvc_halfedges *mesh = loops->mesh;
    uint32_t h = loops->toward[vertex];
    for (; h != GVC_NONE && !wall[h]; h = loops->toward[mesh->vertex[h]])
        wall[h] = wall[mesh->twin[h]] = 1;
}

static gvc_result greedy_loops(gvc_halfedges *mesh, uint32_t root, gvc_cut_graph *graph,
                               gvc_error *error) {
    const gvc_cut_graph none = {0};
    const gvc_obstacles obstacles = {.graph = &none};
    gvc_loops loops;
    GVC_TRY(gvc_loops_prepare(mesh, &obstacles, &loops, error));
    uint8_t *wall = gvc_alloc(3 * mesh->face_count, 1);
    gvc_result result = wall ? gvc_loops_find(&loops, root, error) : gvc_fail_memory(error);
    for (size_t i = 0; result == GVC_OK && i < loops.edge_count; i++) {
        uint32_t h = loops.edge[i].h, twin = mesh->twin[h];
        mark_branch(&loops, mesh->vertex[h], wall);
        mark_branch(&loops, mesh->vertex[twin], wall);
        wall[h] = wall[twin] = 1;
    }
    if (result == GVC_OK) gvc_wall_prune(mesh, wall);
    if (result == GVC_OK) result = gvc_wall_graph(mesh, wall, graph, error);
    gvc_loops_free(&loops);
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

gvc_result gvc_handle_graph(gvc_pathfinder *finder, gvc_halfedges *mesh, uint32_t root,
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
