/* SPDX-License-Identifier: MIT */
/** @file wall.h  A cut graph as a set of mesh edges ("wall"), and back. */
#ifndef GVC_DESCRIPTOR_WALL_H
#define GVC_DESCRIPTOR_WALL_H

#include "descriptor/cut_graph.h"

/** Marks both halfedges of all edges of the graph but `skip` (GVC_NONE: none); `wall` has one byte
 * per halfedge. */
void gvc_wall_mark(const gvc_halfedges *mesh, const gvc_cut_graph *graph, uint32_t skip,
                   uint8_t *wall);
/** Takes off loose ends until every vertex of the wall has at least two of its edges. */
void gvc_wall_prune(const gvc_halfedges *mesh, uint8_t *wall);
/** The graph of a pruned wall: its nodes, all junctions, are the vertices with three edges and
 * more; one vertex of each circle that has none of them becomes one too. */
gvc_result gvc_wall_graph(const gvc_halfedges *mesh, const uint8_t *wall, gvc_cut_graph *graph,
                          gvc_error *error);

#endif
