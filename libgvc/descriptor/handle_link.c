/* SPDX-License-Identifier: MIT */
/** @file handle_link.c  Puts handles into the cut graph, in a first frame and in those that follow.
 */
#include "descriptor/handle_link.h"

#include "base/memory.h"
#include "descriptor/consistent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OUT = 0, BACK = 1, SECOND = 2, WAY = 3 }; /* the links of a handle */

/* A path round a handle is taken for a wrong one if it is longer than this many times what it was,
 * and so many diagonals. */
static const double greatest_growth = 2, least_growth = 0.02;
/* So is the way to it, which may be short and its end move more. */
static const double greatest_detour = 0.2;

void gvc_handle_link_free(gvc_handle_link *handle) {
    for (int i = 0; i < GVC_HANDLE_POINTS; i++) free(handle->point[i]);
    for (int i = 0; i < GVC_HANDLE_LINKS; i++) gvc_link_free(&handle->link[i]);
    *handle = (gvc_handle_link){0};
}

gvc_result gvc_handle_link_copy(const gvc_handle_link *from, gvc_handle_link *to,
                                gvc_error *error) {
    gvc_result result = GVC_OK;
    size_t n = from->link[OUT].prior.dimensions;
    *to = (gvc_handle_link){.joined = from->joined, .open = from->open, .since = from->since};
    for (int i = 0; i < GVC_HANDLE_POINTS; i++) {
        to->point[i] = gvc_alloc(n, sizeof *to->point[i]);
        if (!to->point[i]) GVC_CHECK(gvc_fail_memory(error));
        memcpy(to->point[i], from->point[i], n * sizeof *to->point[i]);
    }
    for (int i = 0; i < (from->joined ? WAY : GVC_HANDLE_LINKS); i++)
        GVC_CHECK(gvc_link_copy(&from->link[i], &to->link[i], error));
cleanup:
    if (result != GVC_OK) gvc_handle_link_free(to);
    return result;
}

static gvc_result remember_points(const gvc_routing *r, gvc_handle_link *handle, gvc_error *error) {
    for (int i = 0; i < GVC_HANDLE_POINTS; i++) {
        uint32_t vertex = r->graph->node[handle->link[OUT].node[i]].vertex;
        if (!handle->point[i])
            handle->point[i] = gvc_alloc(r->coordinates.dimension, sizeof *handle->point[i]);
        if (!handle->point[i]) return gvc_fail_memory(error);
        gvc_coordinates_of_vertex(r->mesh, &r->coordinates, vertex, handle->point[i]);
    }
    handle->open = true;
    handle->since = 0;
    return GVC_OK;
}

/* Takes what was added last off the graph. No edge may have been split since. */
static void shrink(gvc_cut_graph *graph, size_t nodes, size_t edges) {
    for (size_t e = edges; e < graph->edge_count; e++) free(graph->edge[e].vertex);
    graph->node_count = nodes;
    graph->edge_count = edges;
}

/* ---------------------------------------------------------------------------------- first frame */

static gvc_result add_chain(gvc_cut_graph *graph, uint32_t from, uint32_t to, const uint32_t *chain,
                            size_t count, gvc_error *error) {
    uint32_t edge, *copy = gvc_alloc(count, sizeof *copy);
    if (!copy) return gvc_fail_memory(error);
    memcpy(copy, chain, count * sizeof *copy);
    gvc_result result = gvc_cut_graph_add_edge(graph, from, to, copy, count, &edge, error);
    if (result != GVC_OK) free(copy);
    return result;
}

/* Index of the vertex in the middle of a chain, by length. */
static size_t middle_of(const gvc_halfedges *mesh, const uint32_t *chain, size_t count) {
    const gvc_cut_edge whole = {{0, 0}, (uint32_t *)(uintptr_t)chain, count};
    double half = gvc_cut_edge_length(mesh, &whole) / 2, passed = 0;
    size_t i = 1;
    for (; i + 2 < count; i++) {
        passed += gvc_halfedge_length(mesh, gvc_halfedge_between(mesh, chain[i - 1], chain[i]));
        if (passed >= half) break;
    }
    return i;
}

/* Adds the loops to the graph, and makes links of them. */
static gvc_result add_loops(gvc_routing *r, const gvc_handle *found, gvc_handle_link *handle,
                            gvc_error *error) {
    gvc_cut_graph *graph = r->graph;
    const uint32_t *first = found->loop[0];
    size_t middle = middle_of(r->mesh, first, found->count[0]);
    gvc_cut_node node[] = {{GVC_NODE_JUNCTION, 0, first[0]}, {GVC_NODE_JUNCTION, 0, first[middle]}};
    uint32_t base = 0, half, edge = (uint32_t)graph->edge_count;
    if (!handle->joined) GVC_TRY(gvc_cut_graph_add_node(graph, node[0], &base, error));
    GVC_TRY(gvc_cut_graph_add_node(graph, node[1], &half, error));
    GVC_TRY(add_chain(graph, base, half, first, middle + 1, error));
    GVC_TRY(add_chain(graph, half, base, first + middle, found->count[0] - middle, error));
    GVC_TRY(add_chain(graph, base, base, found->loop[1], found->count[1], error));
    for (uint32_t i = OUT; i <= SECOND; i++)
        GVC_TRY(gvc_link_of_edge(r, edge + i, &handle->link[i], error));
    return remember_points(r, handle, error);
}

/* Makes the way to the loops, which are the last of the graph, from what was there before them. */
static gvc_result add_way(gvc_routing *r, size_t nodes, size_t edges, gvc_link *way,
                          gvc_error *error) {
    bool kept;
    gvc_link_free(way);
    *way = (gvc_link){.tip = GVC_NONE,
                      .parent = GVC_NONE,
                      .node = {GVC_NONE, (uint32_t)nodes},
                      .after = {{GVC_NONE, 0}, {(uint32_t)edges + SECOND, 1}}};
    GVC_TRY(gvc_link_attach(r, nodes, edges, way, &kept, error));
    if (kept) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_INTERNAL, "there is no way to the handle at vertex %u",
                    r->graph->node[nodes].vertex);
}

gvc_result gvc_handle_link_first(gvc_routing *r, const gvc_handle *found, gvc_handle_link *handle,
                                 gvc_error *error) {
    size_t nodes = r->graph->node_count, edges = r->graph->edge_count;
    handle->joined = found->loop[0][0] == r->graph->node[0].vertex;
    GVC_TRY(add_loops(r, found, handle, error));
    if (handle->joined) return GVC_OK;
    return add_way(r, nodes, edges, &handle->link[WAY], error);
}

/* --------------------------------------------------------------------------- frames that follow */

static bool grew(const gvc_handle_link *handle, const double *length_before) {
    for (int i = OUT; i <= SECOND; i++)
        if (handle->link[i].length > greatest_growth * length_before[i] + least_growth) return true;
    return false;
}

/* Places the two loops; the numbers of nodes and edges follow from where they are in the graph. */
static gvc_result place_loops(gvc_routing *r, gvc_handle_link *handle, bool *kept,
                              gvc_error *error) {
    uint32_t half = (uint32_t)r->graph->node_count - 1, base = handle->joined ? 0 : half - 1;
    uint32_t edge = (uint32_t)r->graph->edge_count;
    const gvc_edge_end none = {GVC_NONE, 0};
    const struct {
        uint32_t node[2];
        gvc_edge_end after[2];
    } place[] = {{{base, half}, {none, none}},
                 {{half, base}, {{edge, 1}, {edge, 0}}},
                 {{base, base}, {{edge, 0}, {edge + 1, 1}}}};
    double before[GVC_HANDLE_LINKS] = {0};
    for (int i = OUT; i <= SECOND && *kept; i++) {
        gvc_link *link = &handle->link[i];
        before[i] = link->length;
        memcpy(link->node, place[i].node, sizeof link->node);
        memcpy(link->after, place[i].after, sizeof link->after);
        GVC_TRY(gvc_link_again(r, link, kept, error));
    }
    *kept = *kept && !grew(handle, before);
    return GVC_OK;
}

/* The way is given up if it becomes long: something lies across it. */
static gvc_result place_way(gvc_routing *r, gvc_link *way, bool *kept, gvc_error *error) {
    double before = way->length;
    GVC_TRY(gvc_link_again(r, way, kept, error));
    *kept = *kept && way->length <= greatest_growth * before + greatest_detour;
    return GVC_OK;
}

gvc_result gvc_handle_link_again(gvc_routing *r, const uint32_t *point, bool anew,
                                 gvc_handle_link *handle, bool *kept, gvc_error *error) {
    size_t nodes = r->graph->node_count, edges = r->graph->edge_count;
    gvc_handle_link now;
    GVC_TRY(gvc_handle_link_copy(handle, &now, error));
    gvc_result result = GVC_OK;
    *kept = true;
    for (int i = handle->joined ? 1 : 0; i < GVC_HANDLE_POINTS; i++) {
        gvc_cut_node node = {GVC_NODE_JUNCTION, 0, point[i]};
        uint32_t index;
        GVC_CHECK(gvc_cut_graph_add_node(r->graph, node, &index, error));
    }
    GVC_CHECK(place_loops(r, &now, kept, error));
    if (*kept) {
        GVC_CHECK(remember_points(r, &now, error));
        if (!now.joined && anew) GVC_CHECK(add_way(r, nodes, edges, &now.link[WAY], error));
        if (!now.joined && !anew) GVC_CHECK(place_way(r, &now.link[WAY], kept, error));
    } else {
        shrink(r->graph, nodes, edges);
    }
    if (*kept) {
        gvc_handle_link before = *handle;
        *handle = now;
        now = before;
    }
cleanup:
    gvc_handle_link_free(&now);
    return result;
}

/* ----------------------------------------------------------------------------- another handle */

/* Sum of distances from points of a loop to where the loop was, both walked the same way. */
static double misfit(const gvc_routing *r, const gvc_handle *found, const gvc_handle_link *before) {
    const gvc_coordinates *c = &r->coordinates;
    double sum = 0;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i <= GVC_PRIOR_SEGMENTS; i++) {
            /* the first loop consists of two links */
            size_t step = k == 0 ? 2 * i : i;
            const gvc_link *link = &before->link[k == 1                       ? SECOND
                                                 : step <= GVC_PRIOR_SEGMENTS ? OUT
                                                                              : BACK];
            if (link == &before->link[BACK]) step -= GVC_PRIOR_SEGMENTS;
            size_t place = (found->count[k] - 1) * i / GVC_PRIOR_SEGMENTS;
            const double *p = r->mesh->position + 3 * (size_t)found->loop[k][place];
            double q[3];
            gvc_coordinates_position(c, link->prior.sample + step * c->dimension, q);
            sum += hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        }
    return sum;
}

/* Of the four pairs of loops that are the same handle takes the one most like what was there. */
static void turn_to_fit(const gvc_routing *r, gvc_handle *found, const gvc_handle_link *before) {
    double least = INFINITY;
    int best = 0;
    for (int i = 0; i < 4; i++) {
        double now = misfit(r, found, before);
        if (now < least) {
            least = now;
            best = i;
        }
        gvc_handle_turn(found);
    }
    for (int i = 0; i < best; i++) gvc_handle_turn(found);
}

gvc_result gvc_handle_link_elsewhere(gvc_routing *r, gvc_handle_link *handle, bool *kept,
                                     gvc_error *error) {
    gvc_handle found;
    gvc_obstacles obstacles = r->obstacles;
    obstacles.graph = r->graph;
    uint32_t near = gvc_nearest_vertex(r->mesh, &r->coordinates, handle->point[0]);
    GVC_TRY(gvc_handle_find(r->finder, r->mesh, &obstacles, near, true, &found, error));
    *kept = found.count[0] > 0;
    if (!*kept) return GVC_OK;
    gvc_result result = gvc_handle_rebase(r->finder, r->mesh, &obstacles, near, &found, error);
    if (result == GVC_OK) turn_to_fit(r, &found, handle);
    if (handle->joined) r->graph->node[0].vertex = found.loop[0][0];
    double before[] = {handle->link[OUT].length, handle->link[BACK].length,
                       handle->link[SECOND].length};
    if (result == GVC_OK) result = add_loops(r, &found, handle, error);
    *kept = result == GVC_OK && !grew(handle, before);
    if (*kept && !handle->joined) result = place_way(r, &handle->link[WAY], kept, error);
    gvc_handle_free(&found);
    return result;
}
