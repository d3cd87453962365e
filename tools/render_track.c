/* SPDX-License-Identifier: MIT */
/** @file render_track.c  The encoder's flow (libgvc/encoder.c) as far as the cut graphs. */
#include "render_track.h"

#include "base/memory.h"
#include "descriptor/ambiguity.h"
#include "encode/batch.h"
#include "encode/cut.h"

#include <stdlib.h>

typedef struct follower {
    const gvc_source *source;
    gvc_encode_options options;
    const render_track_hooks *hooks;
    const uint64_t *frame; /* asked for */
    size_t count, shown;

    gvc_scan_frame *facts;
    gvc_tracker *tracker;
    gvc_segment segment;
    uint64_t segment_count;

    gvc_batch batch;
} follower;

/* Shows a frame with the ambiguity of its tips. Vertices of the mesh are the first of the
 * halfedges'. */
static gvc_result show_ambiguity(const follower *f, render_tracked *tracked, gvc_error *error) {
    const gvc_cut_graph *graph = tracked->graph;
    size_t tips = 0;
    uint32_t *tip = gvc_alloc(graph->node_count, sizeof *tip);
    double *share = gvc_alloc(tracked->halfedges->vertex_count, sizeof *share);
    gvc_result result = tip && share ? GVC_OK : gvc_fail_memory(error);
    for (size_t n = 0; result == GVC_OK && n < graph->node_count; n++)
        if (graph->node[n].kind == GVC_NODE_EXTREMUM) tip[tips++] = graph->node[n].vertex;
    if (result == GVC_OK)
        result = gvc_ambiguity(tracked->halfedges, tip, tips, GVC_AMBIGUITY_EPSILON, share, error);
    tracked->ambiguity = share;
    if (result == GVC_OK) result = f->hooks->picture(f->hooks->user, tracked, error);
    free(tip);
    free(share);
    return result;
}

static gvc_result follow(follower *f, gvc_frame_work *work, gvc_error *error) {
    const gvc_cutter cutter = {
        .source = f->source, .options = &f->options, .facts = f->facts, .tracker = f->tracker};
    bool continues;
    GVC_TRY(gvc_cut_follow(&cutter, &f->segment, work, &continues, error));
    if (!continues) {
        GVC_TRY(gvc_cut_begin(&cutter, f->segment_count++, work, &f->segment, error));
        f->hooks->segment(f->hooks->user, work->number, &work->graph);
    }
    if (f->shown == f->count || work->number != f->frame[f->shown]) return GVC_OK;
    render_tracked tracked = {.index = f->shown++,
                              .frame = work->number,
                              .segment = f->segment.number,
                              .mesh = work->mesh,
                              .halfedges = &work->halfedges,
                              .graph = &work->graph};
    return f->hooks->ambiguity ? show_ambiguity(f, &tracked, error)
                               : f->hooks->picture(f->hooks->user, &tracked, error);
}

static gvc_result follow_batch(follower *f, uint64_t first, size_t count, gvc_error *error) {
    GVC_TRY(gvc_batch_analyse(&f->batch, f->source, &f->options, first, count, error));
    for (size_t i = 0; i < count; i++) {
        gvc_result result = follow(f, &f->batch.work[i], error);
        if (result != GVC_OK) return gvc_at_frame(error, result, (int64_t)(first + i));
    }
    return GVC_OK;
}

static gvc_result follow_all(follower *f, gvc_error *error) {
    uint64_t first = f->frame[0], end = f->frame[f->count - 1] + 1;
    GVC_TRY(gvc_scan(f->source, &f->options, f->facts, error));
    /* A cut is resumed across changes of genus: as the encoder, this begins at the first frame. */
    bool handles = false;
    for (uint64_t i = 0; i < end; i++) handles = handles || f->facts[i].genus > 0;
    while (first > 0 && (handles || f->facts[first - 1].genus == f->facts[first].genus)) first--;
    for (uint64_t frame = first; frame < end; frame += GVC_BATCH) {
        size_t count = end - frame < GVC_BATCH ? (size_t)(end - frame) : GVC_BATCH;
        if (!f->hooks->progress(f->hooks->user, GVC_STAGE_ENCODE, frame - first, end - first)) {
            return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        }
        GVC_TRY(follow_batch(f, frame, count, error));
    }
    return GVC_OK;
}

gvc_result render_track(const gvc_source *source, bool weld, unsigned threads,
                        const uint64_t *frame, size_t count, const render_track_hooks *hooks,
                        gvc_error *error) {
    if (count == 0) return GVC_OK;
    follower *f = gvc_alloc(1, sizeof *f);
    if (!f) return gvc_fail_memory(error);
    *f = (follower){.source = source, .hooks = hooks, .frame = frame, .count = count};
    gvc_encode_options_init(&f->options);
    f->options.weld = weld;
    f->options.threads = threads;
    f->options.progress = hooks->progress;
    f->options.user = hooks->user;
    f->facts = gvc_alloc((size_t)source->frame_count, sizeof *f->facts);
    gvc_result result = f->facts ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_cut_tracker(&f->options, &f->tracker, error);
    if (result == GVC_OK) result = follow_all(f, error);
    gvc_batch_free(&f->batch);
    gvc_segment_free(&f->segment);
    gvc_tracker_destroy(&f->tracker);
    free(f->facts);
    free(f);
    return result;
}
