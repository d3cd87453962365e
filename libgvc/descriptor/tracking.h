/* SPDX-License-Identifier: MIT */
/** @file tracking.h  Keeps the cut graph where it was from frame to frame. */
#ifndef GVC_DESCRIPTOR_TRACKING_H
#define GVC_DESCRIPTOR_TRACKING_H

#include "base/state.h"
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

typedef struct gvc_tracker gvc_tracker; /**< what is remembered of the frame cut last */

gvc_result gvc_tracker_create(const gvc_tracker_options *options, gvc_tracker **tracker,
                              gvc_error *error);
void gvc_tracker_destroy(gvc_tracker **tracker);

/** Where the loops that cut handles are looked for in a first frame. Short ones are best for most
 * surfaces, but may leave parts of others behind narrow necks, where a chart folds. */
typedef enum gvc_handle_search {
    GVC_HANDLES_SHORT = 0,     /**< all over the surface, the shortest ones */
    GVC_HANDLES_GRAPH = 1,     /**< all handles by one short graph that has no part for each of
                                    them: good charts, but frames that follow cannot be cut alike */
    GVC_HANDLES_NEAR_ROOT = 2, /**< the shortest through or round the root */
    GVC_HANDLES_NEAR_TIP = 3   /**< + i: the shortest through or round tip i, or the last one */
} gvc_handle_search;

/** First frame of a segment. Cuts `mesh` (refining it by splits) from features->root to the
 *  `extremum_count` first extrema of `features`, shortest first (Eq. 5), and to loops
 * that cut its handles, which are found first (`search`: a gvc_handle_search). Without handles
 * there are at least two tips: the point farthest from the only one (or from the root) is added,
 * with the next free number. Forgets any earlier frame. */
gvc_result gvc_tracker_start(gvc_tracker *tracker, const gvc_features *features,
                             size_t extremum_count, unsigned search, gvc_halfedges *mesh,
                             gvc_cut_graph *graph, gvc_error *error);

/** Any later frame: finds the same graph near where `warp` moves that of the frame before (NULL:
 * the surface is taken not to have moved). `*kept` is false, and the graph is empty, if this frame
 * does not allow that (an extremum cannot be matched, another genus, paths that cannot be laid in
 * the same cyclic order): then a new segment must start here. `mesh` may have been split all the
 * same. */
gvc_result gvc_tracker_next(gvc_tracker *tracker, const gvc_features *features,
                            const gvc_warp *warp, gvc_halfedges *mesh, gvc_cut_graph *graph,
                            bool *kept, gvc_error *error);

/** First frame of a segment that differs from the one before in its handles: root, tips and the
 * paths to them stay where they were in the frame cut last, and so do handles that are still there;
 * one that is gone is remembered for some frames, in case it returns. `*kept` is false, and the
 * graph empty, if that is not possible, the genus is the same, or another number of extrema was cut
 * to. */
gvc_result gvc_tracker_resume(gvc_tracker *tracker, const gvc_features *features,
                              const gvc_warp *warp, size_t extremum_count, gvc_halfedges *mesh,
                              gvc_cut_graph *graph, bool *kept, gvc_error *error);

/** Puts what is known of the frame cut last aside, to try another cut of the same frame, */
void gvc_tracker_set_aside(gvc_tracker *tracker);
/** and goes back to it. */
void gvc_tracker_take_back(gvc_tracker *tracker);

/** Saves what is known of the frame cut last, or loads it into a new tracker of the same options.
 */
void gvc_tracker_state(gvc_tracker *tracker, gvc_state *state);

#endif
