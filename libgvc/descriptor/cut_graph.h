/* SPDX-License-Identifier: MIT */
/** @file cut_graph.h  The graph on the surface along which it is cut open (Sect. 3.3). */
#ifndef GVC_DESCRIPTOR_CUT_GRAPH_H
#define GVC_DESCRIPTOR_CUT_GRAPH_H

#include "mesh/halfedge.h"

typedef enum gvc_node_kind {
    GVC_NODE_ROOT = 0,
    GVC_NODE_EXTREMUM = 1,
    GVC_NODE_JUNCTION = 2
} gvc_node_kind;

typedef struct gvc_cut_node {
    gvc_node_kind kind;
    uint32_t feature; /**< extremum: its number, the same over a whole segment; else 0 */
    uint32_t vertex;  /**< of the refined mesh */
} gvc_cut_node;

/** A path of mesh edges between two nodes, with no node inside. */
typedef struct gvc_cut_edge {
    uint32_t node[2];
    uint32_t *vertex; /**< vertex_count >= 2 vertices from node[0] to node[1] inclusive */
    size_t vertex_count;
} gvc_cut_edge;

/** Cutting the mesh along all edges leaves one disk: node_count - edge_count == 1 - 2 * genus. Node
 * and edge numbers keep their meaning over a segment. */
typedef struct gvc_cut_graph {
    size_t node_count, edge_count;
    gvc_cut_node *node;
    gvc_cut_edge *edge;
} gvc_cut_graph;

void gvc_cut_graph_free(gvc_cut_graph *graph);
/** Length of an edge in the unit of the mesh. */
double gvc_cut_edge_length(const gvc_halfedges *mesh, const gvc_cut_edge *edge);

#endif
