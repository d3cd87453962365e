/* SPDX-License-Identifier: MIT */
/** @file render_track.h  Finds the cut graphs of a capture as the encoder does. */
#ifndef GVC_TOOLS_RENDER_TRACK_H
#define GVC_TOOLS_RENDER_TRACK_H

#include "descriptor/cut_graph.h"
#include "mesh/mesh.h"

/** A frame with its cut. `halfedges` is the mesh, refined along the graph. */
typedef struct render_tracked {
    size_t index; /**< in the list of frames asked for */
    uint64_t frame;
    uint64_t segment; /**< 0-based, counted from the first one followed */
    const gvc_mesh *mesh;
    const gvc_halfedges *halfedges;
    const gvc_cut_graph *graph;
    const double *ambiguity; /**< per vertex of `mesh`, from the tips; NULL if not asked for */
} render_tracked;

typedef struct render_track_hooks {
    void *user;
    bool ambiguity; /**< wanted (descriptor/ambiguity.h) */
    /** One of the frames asked for, in order. */
    gvc_result (*picture)(void *user, const render_tracked *tracked, gvc_error *error);
    /** A segment begins with `frame`: its graph is another one than before. */
    void (*segment)(void *user, uint64_t frame, const gvc_cut_graph *graph);
    /** False to cancel. The capture is scanned first, then followed. */
    bool (*progress)(void *user, gvc_stage stage, uint64_t done, uint64_t total);
} render_track_hooks;

/** Follows the cut from the first frame of the run of equal genus that frame[0] lies in up to
 * the last of `count` frames (ascending). All frames of `source` are scanned, as the encoder does
 * before it decides on the graph. GVC_ERROR_UNSUPPORTED in builds without encoder. */
gvc_result render_track(const gvc_source *source, bool weld, unsigned threads,
                        const uint64_t *frame, size_t count, const render_track_hooks *hooks,
                        gvc_error *error);

#endif
