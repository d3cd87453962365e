/* SPDX-License-Identifier: MIT */
/** @file cut_graph.c  The cut graph as a data structure. */
#include "descriptor/cut_graph.h"

#include "base/memory.h"
#include "descriptor/graph_edit.h"

#include <stdlib.h>
#include <string.h>

void gvc_cut_graph_free(gvc_cut_graph *graph) {
    for (size_t e = 0; e < graph->edge_count; e++) free(graph->edge[e].vertex);
    free(graph->node);
    free(graph->edge);
    *graph = (gvc_cut_graph){0};
}

double gvc_cut_edge_length(const gvc_halfedges *mesh, const gvc_cut_edge *edge) {
    double length = 0;
    for (size_t i = 0; i + 1 < edge->vertex_count; i++) {
        uint32_t h = gvc_halfedge_between(mesh, edge->vertex[i], edge->vertex[i + 1]);
        if (h != GVC_NONE) length += gvc_halfedge_length(mesh, h);
    }
    return length;
}

size_t gvc_mesh_genus(const gvc_halfedges *mesh) {
    size_t euler_with_faces_first = mesh->vertex_count + mesh->face_count;
    size_t edges = 3 * mesh->face_count / 2;
    return edges + 2 < euler_with_faces_first ? 0 : (edges + 2 - euler_with_faces_first) / 2;
}

/* ------------------------------------------------------------------------------------ editing */

gvc_result gvc_cut_graph_add_node(gvc_cut_graph *graph, gvc_cut_node node, uint32_t *index,
                                  gvc_error *error) {
    gvc_cut_node *grown = realloc(graph->node, (graph->node_count + 1) * sizeof *grown);
    if (!grown) return gvc_fail_memory(error);
    graph->node = grown;
    grown[graph->node_count] = node;
    *index = (uint32_t)graph->node_count++;
    return GVC_OK;
}

gvc_result gvc_cut_graph_add_edge(gvc_cut_graph *graph, uint32_t from, uint32_t to,
                                  uint32_t *vertex, size_t count, uint32_t *index,
                                  gvc_error *error) {
    gvc_cut_edge *grown = realloc(graph->edge, (graph->edge_count + 1) * sizeof *grown);
    if (!grown) return gvc_fail_memory(error);
    graph->edge = grown;
    grown[graph->edge_count] = (gvc_cut_edge){{from, to}, vertex, count};
    *index = (uint32_t)graph->edge_count++;
    return GVC_OK;
}

gvc_result gvc_cut_graph_split_edge(gvc_cut_graph *graph, uint32_t edge, size_t place,
                                    uint32_t *node, gvc_error *error) {
    size_t count = graph->edge[edge].vertex_count - place;
    uint32_t *second = gvc_alloc(count, sizeof *second), added;
    if (!second) return gvc_fail_memory(error);
    memcpy(second, graph->edge[edge].vertex + place, count * sizeof *second);
    gvc_cut_node junction = {GVC_NODE_JUNCTION, 0, second[0]};
    gvc_result result = gvc_cut_graph_add_node(graph, junction, node, error);
    if (result == GVC_OK)
        result = gvc_cut_graph_add_edge(graph, *node, graph->edge[edge].node[1], second, count,
                                        &added, error);
    if (result != GVC_OK) {
        free(second);
        return result;
    }
    graph->edge[edge].node[1] = *node;
    graph->edge[edge].vertex_count = place + 1;
    return GVC_OK;
}

gvc_result gvc_cut_graph_insert_vertex(gvc_cut_graph *graph, uint32_t edge, size_t place,
                                       uint32_t vertex, gvc_error *error) {
    gvc_cut_edge *e = &graph->edge[edge];
    uint32_t *grown = realloc(e->vertex, (e->vertex_count + 1) * sizeof *grown);
    if (!grown) return gvc_fail_memory(error);
    e->vertex = grown;
    memmove(grown + place + 2, grown + place + 1, (e->vertex_count - place - 1) * sizeof *grown);
    grown[place + 1] = vertex;
    e->vertex_count++;
    return GVC_OK;
}

void gvc_cut_graph_locate(const gvc_cut_graph *graph, uint32_t vertex, uint32_t *node,
                          uint32_t *edge, size_t *place) {
    *node = *edge = GVC_NONE;
    *place = 0;
    for (uint32_t n = 0; n < graph->node_count; n++)
        if (graph->node[n].vertex == vertex) {
            *node = n;
            return;
        }
    for (uint32_t e = 0; e < graph->edge_count; e++)
        for (size_t i = 1; i + 1 < graph->edge[e].vertex_count; i++)
            if (graph->edge[e].vertex[i] == vertex) {
                *edge = e;
                *place = i;
                return;
            }
}

/* ------------------------------------------------------------------------------------- rotation */

uint32_t gvc_edge_end_halfedge(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                               gvc_edge_end end) {
    const gvc_cut_edge *e = &graph->edge[end.edge];
    size_t last = e->vertex_count - 1;
    return end.end == 0 ? gvc_halfedge_between(mesh, e->vertex[0], e->vertex[1])
                        : gvc_halfedge_between(mesh, e->vertex[last], e->vertex[last - 1]);
}

/* The end at `node` whose first halfedge is `h`. */
static gvc_edge_end end_at(const gvc_halfedges *mesh, const gvc_cut_graph *graph, uint32_t node,
                           uint32_t h) {
    for (uint32_t e = 0; e < graph->edge_count; e++)
        for (unsigned end = 0; end < 2; end++) {
            gvc_edge_end candidate = {e, end};
            if (graph->edge[e].node[end] == node &&
                gvc_edge_end_halfedge(mesh, graph, candidate) == h)
                return candidate;
        }
    return (gvc_edge_end){GVC_NONE, 0};
}

gvc_edge_end gvc_edge_end_before(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                                 uint32_t node, uint32_t h) {
    uint32_t first = h;
    do {
        gvc_edge_end end = end_at(mesh, graph, node, h);
        if (end.edge != GVC_NONE) return end;
        h = mesh->twin[h] == GVC_NONE ? GVC_NONE : gvc_next(mesh->twin[h]);
    } while (h != first && h != GVC_NONE);
    return (gvc_edge_end){GVC_NONE, 0};
}

gvc_result gvc_cut_graph_walk(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                              gvc_border_side *side, size_t *count, gvc_error *error) {
    *count = 0;
    if (graph->edge_count == 0) return GVC_OK;
    gvc_border_side now = {0, false};
    do {
        if (*count == 2 * graph->edge_count)
            return gvc_fail(error, GVC_ERROR_INTERNAL,
                            "the border of the cut surface never closes");
        side[(*count)++] = now;
        uint32_t node = graph->edge[now.edge].node[now.reversed ? 0 : 1];
        /* With the surface on the left the border goes on with the edge that comes first clockwise
         * after the one it arrived on. */
        gvc_edge_end arrived = {now.edge, now.reversed ? 0 : 1};
        uint32_t h = gvc_edge_end_halfedge(mesh, graph, arrived);
        if (h == GVC_NONE || mesh->twin[h] == GVC_NONE)
            return gvc_fail(error, GVC_ERROR_INTERNAL, "cut edge %u is not made of mesh edges",
                            now.edge);
        gvc_edge_end next = gvc_edge_end_before(mesh, graph, node, gvc_next(mesh->twin[h]));
        now = (gvc_border_side){next.edge, next.end == 1};
    } while (now.edge != GVC_NONE && (now.edge != 0 || now.reversed));
    return GVC_OK;
}
