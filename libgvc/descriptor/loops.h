/* SPDX-License-Identifier: MIT */
/** @file loops.h  The greedy system of loops of a surface with handles (Erickson & Whittlesey
 * 2005).
 */
#ifndef GVC_DESCRIPTOR_LOOPS_H
#define GVC_DESCRIPTOR_LOOPS_H

#include "descriptor/cut_graph.h"

/** What loops must keep clear of; everything is borrowed. Cut along the graph, each part of
 * which is a tree or a handle, the surface must be in one piece. */
typedef struct gvc_obstacles {
    const gvc_cut_graph *graph;
    const uint32_t *vertex; /**< others besides; GVC_NONE for one that does not count any more */
    size_t vertex_count;
} gvc_obstacles;

/** An edge that closes a loop with the tree. */
typedef struct gvc_loop_edge {
    double length; /**< of the loop, through the root */
    uint32_t h;
} gvc_loop_edge;

/** The shortest path tree from a root along the edges of a mesh, and the edges that neither it nor
 * the dual tree of longest loops uses. */
typedef struct gvc_loops {
    const gvc_halfedges *mesh; /**< borrowed */
    uint8_t *blocked;          /**< per vertex: belongs to the obstacles */
    double *distance;    /**< per vertex: from the root; INFINITY where the tree does not go */
    uint32_t *toward;    /**< per vertex: halfedge that comes from its parent in the tree */
    gvc_loop_edge *edge; /**< longest loop first */
    size_t edge_count;   /**< twice as many as there are handles outside the obstacles */
    struct gvc_loop_search *search; /**< work space */
} gvc_loops;

/** Makes room for the loops of a closed mesh, which is refined where obstacles leave no way between
 * them. Free with gvc_loops_free; empty on failure. */
gvc_result gvc_loops_prepare(gvc_halfedges *mesh, const gvc_obstacles *obstacles, gvc_loops *loops,
                             gvc_error *error);
void gvc_loops_free(gvc_loops *loops);
/** Finds the loops from a root that is not blocked. GVC_ERROR_MESH if that does not reach all of
 * the surface. */
gvc_result gvc_loops_find(gvc_loops *loops, uint32_t root, gvc_error *error);

#endif
