/* SPDX-License-Identifier: MIT */
/** @file reeb.h  Reeb graph of mu and the extrema with their persistence and attributes
 * (Sect. 3.1). */
#ifndef GVC_DESCRIPTOR_REEB_H
#define GVC_DESCRIPTOR_REEB_H

#include "mesh/halfedge.h"

/** A region of the surface: one connected component of the part whose normalised mu lies in one of
 *  `levels` equal intervals. */
typedef struct gvc_reeb_node {
    unsigned level;         /**< 0: lowest mu */
    double mu_low, mu_high; /**< range of normalised mu inside */
    double area;            /**< relative to the whole surface */
    unsigned valence;       /**< number of arcs */
} gvc_reeb_node;

typedef struct gvc_reeb_graph {
    unsigned levels;
    size_t node_count, arc_count;
    gvc_reeb_node *node;
    uint32_t (*arc)[2]; /**< nodes joined, of adjacent levels, lower first */
    uint32_t *top_node; /**< per vertex: the node that holds it */
} gvc_reeb_graph;

/** Builds the graph of the piecewise linear function `mu` (normalised to [0,1], per vertex).
 * Triangles are clipped at the interval bounds exactly, so areas and components do not depend on
 * how the surface is triangulated. Free with gvc_reeb_graph_free. */
gvc_result gvc_reeb_graph_build(const gvc_halfedges *mesh, const double *mu, unsigned levels,
                                gvc_reeb_graph *graph, gvc_error *error);
void gvc_reeb_graph_free(gvc_reeb_graph *graph);

/** A maximum of mu: the tip of a limb. */
typedef struct gvc_extremum {
    uint32_t vertex;
    double position[3];
    double persistence; /**< of the range of mu: 1 for the global maximum */
    double mu;          /**< normalised */
    double area; /**< relative area of the limb: where mu is above the highest saddle at which it
                      merges with a higher maximum or with a lower one of persistence 0.2 or more,
                    on the tip's side; so like limbs have like areas whichever is higher. 1 if there
                      is no such saddle */
    unsigned valence; /**< of its Reeb graph leaf's first branching node */
} gvc_extremum;

/** All maxima of persistence >= `least`, most persistent first (ties: smaller vertex first).
 *  Equal values count as lower the greater the vertex; persistence 0 is never listed. The highest
 *  maximum of every component has persistence 1. GVC_ERROR_ARGUMENT if mu is not within [0,1].
 * `*list` is freed by the caller with free(). */
gvc_result gvc_extrema_find(const gvc_halfedges *mesh, const double *mu, double least,
                            gvc_extremum **list, size_t *count, gvc_error *error);

#endif
