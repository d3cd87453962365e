/* SPDX-License-Identifier: MIT */
/** @file cut.c  Which cut a frame gets (docs/adr/0011, 0013). */
#include "encode/cut.h"

#include <math.h>

#define LAYOUT_SAMPLES 4000

/* More tips must lower the sampling error at least to this share. */
#define WORTH_A_TIP 0.95
/* So must a cut that has nothing to do with the one before, */
#define WORTH_A_NEW_CUT 0.8
/* and one that the frames to come cannot have. */
#define WORTH_A_SINGLE_CUT 0.5

gvc_result gvc_cut_tracker(const gvc_encode_options *options, gvc_tracker **tracker,
                           gvc_error *error) {
    const gvc_tracker_options tracking = {.prior_weight = options->prior_weight,
                                          .shortest_weight = options->shortest_weight,
                                          .lambda = options->lambda};
    return gvc_tracker_create(&tracking, tracker, error);
}

gvc_result gvc_cut_follow(const gvc_cutter *cutter, const gvc_segment *segment,
                          gvc_frame_work *work, bool *continues, gvc_error *error) {
    *continues = false;
    if (work->number >= segment->end_frame) return GVC_OK;
    return gvc_tracker_next(cutter->tracker, &work->features, work->warp, &work->halfedges,
                            &work->graph, continues, error);
}

/* Lays the border of the first frame out; the layout is tried at a size of its own, and must do at
 * that of the images too. */
static gvc_result lay_out(const gvc_cutter *cutter, gvc_frame_work *work, gvc_segment *segment,
                          gvc_error *error) {
    double rms;
    GVC_TRY(gvc_segment_layout(segment, work, cutter->size, cutter->options->threads, error));
    if (cutter->size == 0) return GVC_OK;
    GVC_TRY(gvc_segment_sampling_rms(segment, work, cutter->size, LAYOUT_SAMPLES, &rms, error));
    segment->trial_rms = rms; /* at 64 samples a part left out hardly shows */
    if (isfinite(rms)) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_MESH,
                    "the surface cut open folds over itself at %u samples a side", cutter->size);
}

/* How a first frame is cut. */
typedef struct cut_choice {
    size_t extrema;
    unsigned search; /* gvc_handle_search */
} cut_choice;

static gvc_result try_cut(const gvc_cutter *cutter, gvc_frame_work *work, cut_choice choice,
                          gvc_segment *segment, gvc_error *error) {
    GVC_TRY(gvc_frame_uncut(work, error));
    GVC_TRY(gvc_tracker_start(cutter->tracker, &work->features, choice.extrema, choice.search,
                              &work->halfedges, &work->graph, error));
    return lay_out(cutter, work, segment, error);
}

/* A chart that folds over itself, or a cut too long for the image, may come out well with other
 * tips, or with other loops round handles. */
static gvc_result cut_somehow(const gvc_cutter *cutter, gvc_frame_work *work, unsigned search,
                              gvc_segment *segment, gvc_error *error) {
    static const struct {
        int more;
        unsigned search;
    } attempt[] = {
        {0, GVC_HANDLES_SHORT},        {1, GVC_HANDLES_SHORT},    {2, GVC_HANDLES_SHORT},
        {-1, GVC_HANDLES_SHORT},       {0, GVC_HANDLES_NEAR_TIP}, {0, GVC_HANDLES_NEAR_TIP + 1},
        {0, GVC_HANDLES_GRAPH},        {1, GVC_HANDLES_GRAPH},    {2, GVC_HANDLES_GRAPH},
        {0, GVC_HANDLES_NEAR_TIP + 2}, {0, GVC_HANDLES_NEAR_ROOT}};
    bool handles = cutter->facts[work->number].genus > 0;
    gvc_error trouble;
    gvc_result result = GVC_ERROR_MESH;
    for (size_t i = 0; i < sizeof attempt / sizeof *attempt && result == GVC_ERROR_MESH; i++) {
        int more = attempt[i].more;
        if (more < 0 && segment->extremum_count == 0) continue;
        if (!handles && attempt[i].search != GVC_HANDLES_SHORT) continue;
        cut_choice choice = {segment->extremum_count + (size_t)more, attempt[i].search};
        if (choice.search == GVC_HANDLES_SHORT) choice.search = search;
        if (i > 0 && choice.extrema > work->features.extremum_count) continue;
        gvc_error_init(&trouble);
        result = try_cut(cutter, work, choice, segment, &trouble);
    }
    /* Rather a poor cut than none, where the border of the image has no room for all tips. */
    for (size_t fewer = segment->extremum_count / 2; result == GVC_ERROR_MESH && fewer > 0;
         fewer /= 2) {
        gvc_error_init(&trouble);
        result = try_cut(cutter, work, (cut_choice){fewer, search}, segment, &trouble);
    }
    return gvc_hand_on(error, result, &trouble);
}

/* A frame that is a segment by itself has nothing to be consistent with, so slighter extrema may be
 * cut to as well, such as ears and horns, if that lowers the error: on a cow from 2.1 to 0.5 %
 * Hausdorff. */
static gvc_result cut_still(const gvc_cutter *cutter, gvc_frame_work *work, unsigned search,
                            gvc_segment *segment, gvc_error *error) {
    static const double slighter[] = {0.14, 0.1, 0.07};
    const gvc_features *features = &work->features;
    GVC_TRY(cut_somehow(cutter, work, search, segment, error));
    double least = segment->trial_rms;
    size_t voted = segment->extremum_count, best = voted, tried = voted;
    for (size_t i = 0; i < sizeof slighter / sizeof *slighter; i++) {
        size_t extrema = tried;
        while (extrema < features->extremum_count &&
               features->extremum[extrema].persistence >= slighter[i]) {
            extrema++;
        }
        if (extrema == tried) continue;
        tried = extrema;
        gvc_error trouble;
        gvc_error_init(&trouble);
        gvc_result result = try_cut(cutter, work, (cut_choice){extrema, search}, segment, &trouble);
        if (result != GVC_ERROR_MESH) GVC_TRY(gvc_hand_on(error, result, &trouble));
        if (result != GVC_OK || segment->trial_rms > WORTH_A_TIP * least) continue;
        least = segment->trial_rms;
        best = extrema;
    }
    if (tried == best) return GVC_OK;
    return best == voted ? cut_somehow(cutter, work, search, segment, error)
                         : try_cut(cutter, work, (cut_choice){best, search}, segment, error);
}

/* Cuts the first frame of a segment as the frame before, but for its handles. `*done` is false if
 * that cannot be, or gives no chart. */
static gvc_result cut_again(const gvc_cutter *cutter, gvc_frame_work *work, gvc_segment *segment,
                            bool *done, gvc_error *error) {
    gvc_error trouble;
    gvc_error_init(&trouble);
    GVC_TRY(gvc_frame_uncut(work, error));
    GVC_TRY(gvc_tracker_resume(cutter->tracker, &work->features, work->warp,
                               segment->extremum_count, &work->halfedges, &work->graph, done,
                               error));
    if (!*done) return GVC_OK;
    gvc_result result = lay_out(cutter, work, segment, &trouble);
    *done = result == GVC_OK;
    if (result == GVC_ERROR_MESH) return GVC_OK;
    return gvc_hand_on(error, result, &trouble);
}

/* A segment may do better with another cut than the one it has, such as that of the frame before.
 */
static gvc_result try_instead(const gvc_cutter *cutter, gvc_frame_work *work, unsigned search,
                              double worth, gvc_segment *segment, gvc_error *error) {
    const cut_choice choice = {segment->extremum_count, search};
    gvc_halfedges halfedges = work->halfedges;
    gvc_cut_graph graph = work->graph;
    gvc_segment other = *segment;
    gvc_error trouble;
    gvc_error_init(&trouble);
    work->halfedges = (gvc_halfedges){0};
    work->graph = (gvc_cut_graph){0};
    other.run = NULL;
    other.sides = (gvc_side_table){0};
    other.weld = (gvc_weld){0};
    gvc_tracker_set_aside(cutter->tracker);
    gvc_result result = try_cut(cutter, work, choice, &other, &trouble);
    bool better = result == GVC_OK && other.trial_rms < worth * segment->trial_rms;
    if (better) {
        gvc_segment worse = *segment;
        *segment = other;
        other = worse;
        gvc_halfedges_free(&halfedges);
        gvc_cut_graph_free(&graph);
    } else {
        gvc_halfedges_free(&work->halfedges);
        gvc_cut_graph_free(&work->graph);
        work->halfedges = halfedges;
        work->graph = graph;
        gvc_tracker_take_back(cutter->tracker);
    }
    gvc_segment_free(&other);
    if (result == GVC_ERROR_MESH) return GVC_OK;
    return gvc_hand_on(error, result, &trouble);
}

gvc_result gvc_cut_begin(const gvc_cutter *cutter, uint64_t number, gvc_frame_work *work,
                         gvc_segment *segment, gvc_error *error) {
    GVC_TRY(gvc_segment_begin(cutter->source, cutter->options, cutter->facts, number, work->number,
                              segment, error));
    bool alone = segment->end_frame == segment->first_frame + 1, done = false;
    /* the first frame of a capture is, with luck, resumed from */
    bool still = alone && (work->number > 0 || cutter->source->frame_count == 1);
    bool handles = cutter->facts[work->number].genus > 0;
    unsigned search = alone && handles ? GVC_HANDLES_GRAPH : GVC_HANDLES_SHORT;
    gvc_result result = cut_again(cutter, work, segment, &done, error);
    if (result == GVC_OK && done)
        result = try_instead(cutter, work, GVC_HANDLES_SHORT, WORTH_A_NEW_CUT, segment, error);
    if (result == GVC_OK && !done)
        result = still ? cut_still(cutter, work, search, segment, error)
                       : cut_somehow(cutter, work, search, segment, error);
    bool poor =
        cutter->size > 0 && segment->trial_rms > gvc_rms_asked(cutter->options, work->diagonal);
    if (result == GVC_OK && handles && (done || !alone))
        result = try_instead(cutter, work, GVC_HANDLES_GRAPH,
                             alone  ? 1
                             : poor ? WORTH_A_NEW_CUT
                                    : WORTH_A_SINGLE_CUT,
                             segment, error);
    return gvc_at_frame(error, result, (int64_t)work->number);
}
