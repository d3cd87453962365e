/* SPDX-License-Identifier: MIT */
/** @file tracking.h  Keeps the cut graph where it was from frame to frame of a segment. */
#ifndef GVC_DESCRIPTOR_TRACKING_H
#define GVC_DESCRIPTOR_TRACKING_H

#include "descriptor/cut_graph.h"
#include "descriptor/features.h"
#include "descriptor/warp.h"

typedef struct gvc_tracker_options {
    double prior_weight;    /**< of E_p (Eq. 8); 1 */
    double shortest_weight; /**< of E_d (Eq. 7); 0.05 (docs/adr/0012) */
    double lambda;          /**< Eq. 10; 0.95: where the junction was is known ten times as well as
                               where the shortest path meets the edge; 0 cancels the prior on nodes */
} gvc_tracker_options;

/** The values named there. */
void gvc_tracker_options_init(gvc_tracker_options *options);

typedef struct gvc_tracker gvc_tracker; /**< what is remembered of the previous frame */

gvc_result gvc_tracker_create(const gvc_tracker_options *options, gvc_tracker **tracker,
                              gvc_error *error);
void gvc_tracker_destroy(gvc_tracker **tracker);

/** First frame of a segment. Cuts `mesh` (refining it by splits) from features->root to the
 *  `extremum_count` first extrema of `features`, shortest first (Eq. 5); for a surface with handles
 *  begins with a graph that cuts them, whose node nearest to features->root becomes the root.
 *  Without handles there are at least two tips: the point farthest from the only one (or from the
 *  root) is added, with the next free number. Extrema that lie on the graph already are left out,
 * and those after them move up. Forgets any earlier frame. */
gvc_result gvc_tracker_start(gvc_tracker *tracker, const gvc_features *features,
                             size_t extremum_count, gvc_halfedges *mesh, gvc_cut_graph *graph,
                             gvc_error *error);

/** Any later frame: finds the same graph near where `warp` moves that of the frame before (NULL:
 * the surface is taken not to have moved). `*kept` is false, and the graph is empty, if this frame
 * does not allow that (an extremum cannot be matched, another genus, edges in another cyclic
 * order): then a new segment must start here. `mesh` may have been split all the same. */
gvc_result gvc_tracker_next(gvc_tracker *tracker, const gvc_features *features,
                            const gvc_warp *warp, gvc_halfedges *mesh, gvc_cut_graph *graph,
                            bool *kept, gvc_error *error);

#endif
