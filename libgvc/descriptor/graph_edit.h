/* SPDX-License-Identifier: MIT */
/** @file graph_edit.h  Putting a cut graph together, and the rotation of its edges round its nodes.
 */
#ifndef GVC_DESCRIPTOR_GRAPH_EDIT_H
#define GVC_DESCRIPTOR_GRAPH_EDIT_H

#include "descriptor/cut_graph.h"

/** One end of a cut edge: end 0 is at node[0], end 1 at node[1]. */
typedef struct gvc_edge_end {
    uint32_t edge; /**< GVC_NONE: no edge */
    unsigned end;
} gvc_edge_end;

/** One side of a cut edge as met on the border of the opened surface. */
typedef struct gvc_border_side {
    uint32_t edge;
    bool reversed; /**< walked from node[1] to node[0] */
} gvc_border_side;

gvc_result gvc_cut_graph_add_node(gvc_cut_graph *graph, gvc_cut_node node, uint32_t *index,
                                  gvc_error *error);
/** Takes over `vertex` (allocated) on success. */
gvc_result gvc_cut_graph_add_edge(gvc_cut_graph *graph, uint32_t from, uint32_t to,
                                  uint32_t *vertex, size_t count, uint32_t *index,
                                  gvc_error *error);
/** Makes the inner vertex `place` of an edge a junction. The edge keeps its first part, its second
 *  part becomes the last edge; the junction becomes the last node, `*node`. */
gvc_result gvc_cut_graph_split_edge(gvc_cut_graph *graph, uint32_t edge, size_t place,
                                    uint32_t *node, gvc_error *error);
/** Puts a vertex, by which the mesh edge after `place` was split, into the chain of an edge. */
gvc_result gvc_cut_graph_insert_vertex(gvc_cut_graph *graph, uint32_t edge, size_t place,
                                       uint32_t vertex, gvc_error *error);
/** Where a vertex lies on the graph: `*node`, or else inside `*edge` at `*place`; both GVC_NONE if
 * it does not. */
void gvc_cut_graph_locate(const gvc_cut_graph *graph, uint32_t vertex, uint32_t *node,
                          uint32_t *edge, size_t *place);

/** The first halfedge of an edge seen from one of its ends. */
uint32_t gvc_edge_end_halfedge(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                               gvc_edge_end end);
/** The end first met when turning clockwise from halfedge `h`, itself included, round its start,
 * which is node `node` of a closed mesh; edge GVC_NONE if the node has no edge. */
gvc_edge_end gvc_edge_end_before(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                                 uint32_t node, uint32_t h);

/** Walks the border of the surface cut open along the graph, surface on the left, from the forward
 *  side of edge 0 until it closes. `side` has room for 2 * edge_count. The surface opens to one
 * disk exactly if `*count` is 2 * edge_count and node_count - edge_count is 1 - 2 * genus. */
gvc_result gvc_cut_graph_walk(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                              gvc_border_side *side, size_t *count, gvc_error *error);

/** V - E + F = 2 - 2 genus of a closed mesh of one component. */
size_t gvc_mesh_genus(const gvc_halfedges *mesh);

#endif
