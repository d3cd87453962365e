/* SPDX-License-Identifier: MIT */
/** @file tracked.h  What a tracker holds. */
#ifndef GVC_DESCRIPTOR_TRACKED_H
#define GVC_DESCRIPTOR_TRACKED_H

#include "descriptor/consistent.h"
#include "descriptor/handle_link.h"
#include "descriptor/tracking.h"

/* What is known of the frame cut last. */
typedef struct gvc_tracked {
    bool started;
    bool single;          /* nothing else is known, by intention */
    size_t genus, wanted; /* extrema asked for */
    unsigned search;      /* gvc_handle_search */
    /* Of the first frame: each frame is compared with the one before it, and a normalisation of its
     * own would only add the noise of two greatest distances. */
    double diagonal, scale;
    size_t tip_count,
        matched_count;  /* tips made up for want of extrema come after the matched ones */
    gvc_extremum *tip;  /* as last seen */
    double *tip_point;  /* their coordinates */
    double *root_point; /* distances as in the segment's first frame, so that nothing drifts along
                           with small errors; position as last seen */
    size_t link_count;
    gvc_link *link; /* one per tip */
    size_t handle_count;
    gvc_handle_link *handle; /* `genus` of them are open */
    size_t side_count;       /* the border of the opened surface */
    gvc_border_side *side;
} gvc_tracked;

struct gvc_tracker {
    gvc_tracker_options options;
    gvc_pathfinder *finder;
    gvc_tracked known, aside;
    bool lost; /* the frame seen last could not be cut like that */
};

#endif
