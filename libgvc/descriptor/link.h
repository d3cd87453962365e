/* SPDX-License-Identifier: MIT */
/**
 * @file link.h
 * Links: the paths of which the cut graph is put together, one after the other, in every frame of a
 * segment in the same order and from the same side, so that its embedding never changes.
 */
#ifndef GVC_DESCRIPTOR_LINK_H
#define GVC_DESCRIPTOR_LINK_H

#include "descriptor/coordinates.h"
#include "descriptor/graph_edit.h"
#include "descriptor/handles.h"
#include "descriptor/path.h"
#include "descriptor/prior.h"
#include "descriptor/tracking.h"

/** A path from a node of the graph, or from a junction made on one of its edges, to a tip or to
 * another node. Edges and nodes are numbered as they are when the link is added. */
typedef struct gvc_link {
    uint32_t tip;     /**< number of the tip it leads to, or GVC_NONE */
    uint32_t parent;  /**< edge on which its junction is made, or GVC_NONE */
    uint32_t node[2]; /**< first and last node */
    gvc_edge_end
        after[2];     /**< at each: the edge end that comes before the path counter-clockwise */
    double *junction; /**< coordinates of the first node in the frame before */
    double deviation; /**< of E_d and E_p, in normalised coordinates */
    double length;    /**< of the path in the frame before, in diagonals */
    gvc_prior prior;  /**< the path in the frame before */
} gvc_link;

void gvc_link_free(gvc_link *link);
gvc_result gvc_link_copy(const gvc_link *from, gvc_link *to, gvc_error *error);

/** The frame in which links are placed. */
typedef struct gvc_routing {
    const gvc_tracker_options *options;
    gvc_pathfinder *finder;
    gvc_halfedges *mesh;
    gvc_cut_graph *graph;
    gvc_coordinates coordinates;
    const uint32_t *tip; /**< their vertices; those not linked yet are kept clear of paths */
    bool *linked;
    size_t tip_count;
    gvc_obstacles obstacles; /**< what else they are kept clear of, such as handles to come */
} gvc_routing;

/** Links the tip nearest to the graph by the shortest path (Eq. 5). GVC_ERROR_MESH if no tip can be
 *  reached. */
gvc_result gvc_link_nearest(gvc_routing *routing, gvc_link *link, gvc_error *error);

/** Links the node `link->node[1]`, on the side after `link->after[1]`, to the nearest of the first
 * `nodes` nodes and `edges` edges of the graph by the shortest path, whose first node becomes
 * link->node[0]. `*kept` is false if there is no way. */
gvc_result gvc_link_attach(gvc_routing *routing, size_t nodes, size_t edges, gvc_link *link,
                           bool *kept, gvc_error *error);

/** Places a link of the frame before by Eqs. 6 to 10. `*kept` is false if there is no way, or only
 * one far from where it was. */
gvc_result gvc_link_again(gvc_routing *routing, gvc_link *link, bool *kept, gvc_error *error);

/** Links the tip of a link of the frame before to a graph that may be another one up to there, by
 * the path nearest to the one before. `*kept` is false if there is none. */
gvc_result gvc_link_resume(gvc_routing *routing, gvc_link *link, bool *kept, gvc_error *error);

/** Makes a link of an edge of a graph that came about in another way: as if the edges before it had
 * been there and those after it had not. What the link held is freed. */
gvc_result gvc_link_of_edge(const gvc_routing *routing, uint32_t edge, gvc_link *link,
                            gvc_error *error);

#endif
