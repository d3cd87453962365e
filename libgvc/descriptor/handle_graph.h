/* SPDX-License-Identifier: MIT */
/** @file handle_graph.h  The graph that cuts the handles of a surface of genus > 0. */
#ifndef GVC_DESCRIPTOR_HANDLE_GRAPH_H
#define GVC_DESCRIPTOR_HANDLE_GRAPH_H

#include "descriptor/loops.h"
#include "descriptor/path.h"

/** Short graph, without loose ends, along which a closed surface of genus > 0 opens to one disk.
 *
 *  Begins with the greedy system of loops (Erickson & Whittlesey 2005): the shortest path tree from
 *  `root` and the 2 * genus edges that neither it nor the dual tree of longest loops uses. Then
 * each edge in turn gives way to the shortest path over the surface that cuts it into one disk
 * again. All nodes are junctions. GVC_ERROR_MESH if the mesh has borders or several components. */
gvc_result gvc_handle_graph(gvc_pathfinder *finder, gvc_halfedges *mesh, uint32_t root,
                            gvc_cut_graph *graph, gvc_error *error);

#endif
