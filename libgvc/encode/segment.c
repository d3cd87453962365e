/* SPDX-License-Identifier: MIT */
/** @file segment.c  What stays fixed over a segment. */
#include "encode/segment.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "chart/layout.h"
#include "chart/rebuild.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define VOTES 7
/* Frames that vote at least, be the genus what it is: a limb does not go because a hand touches a
 * hip, and where handles come and go the number of extrema must not come and go with them. */
#define VOTE_SPAN 60
#define LUMA_MAX ((1 << GVC_LUMA_BITS) - 1)
/* Samples fitted by least squares overshoot the surface a little. */
#define CUBE_MARGIN 0.01
#define TRIAL_SIZE 64
#define TRIALS 16
#define TRIAL_SAMPLES 4000

/* ---------------------------------------------------------------------------------------- cube */

static void set_cube(gvc_segment *segment, const gvc_scan_frame *facts) {
    double low[3], high[3], extent = 0;
    memcpy(low, facts[segment->first_frame].minimum, sizeof low);
    memcpy(high, facts[segment->first_frame].maximum, sizeof high);
    for (uint64_t f = segment->first_frame + 1; f < segment->end_frame; f++) {
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], facts[f].minimum[k]);
            high[k] = fmax(high[k], facts[f].maximum[k]);
        }
    }
    for (int k = 0; k < 3; k++) extent = fmax(extent, high[k] - low[k]);
    for (int k = 0; k < 3; k++) low[k] = (low[k] + high[k] - extent) / 2;
    gvc_segment_set_cube(segment, low, extent);
}

void gvc_segment_set_cube(gvc_segment *segment, const double low[3], double side) {
    segment->step = side * (1 + 2 * CUBE_MARGIN) / (LUMA_MAX << GVC_CODE_SHIFT);
    for (int k = 0; k < 3; k++) segment->origin[k] = low[k] - CUBE_MARGIN * side;
}

/* ---------------------------------------------------------------------------------------- vote */

typedef struct vote_context {
    const gvc_source *source;
    bool weld;
    uint64_t first, count; /* frames that votes are taken from */
    size_t votes;
    double persistence, longest_edge;
    size_t extrema[VOTES];
} vote_context;

static gvc_result vote_one(void *user, size_t index, gvc_error *error) {
    vote_context *context = user;
    size_t spread = context->votes > 1 ? context->votes - 1 : 1;
    gvc_frame_work work = {.number = context->first + (context->count - 1) * index / spread,
                           .longest_edge = context->longest_edge};
    gvc_result result = gvc_frame_analyse(&work, context->source, context->weld, error);
    size_t n = 0;
    while (result == GVC_OK && n < work.features.extremum_count &&
           work.features.extremum[n].persistence >= context->persistence) {
        n++;
    }
    context->extrema[index] = n;
    gvc_frame_free(&work);
    return result;
}

static int compare_sizes(const void *a, const void *b) {
    size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return x < y ? -1 : x > y;
}

/* The median of what frames spread over the run say: one wrong tip ruins a sequence. It holds for
 * all segments that begin there. */
static gvc_result vote(gvc_segment *segment, const gvc_source *source,
                       const gvc_encode_options *options, gvc_error *error) {
    uint64_t first = segment->first_frame, end = segment->end_frame;
    uint64_t left = source->frame_count - first;
    if (end - first < VOTE_SPAN) end = first + (left < VOTE_SPAN ? left : VOTE_SPAN);
    vote_context context = {.source = source,
                            .weld = options->weld,
                            .first = first,
                            .count = end - first,
                            .persistence = options->persistence,
                            .longest_edge = options->longest_edge};
    segment->vote_end = end;
    context.votes = context.count < VOTES ? (size_t)context.count : VOTES;
    GVC_TRY(gvc_parallel_for(options->threads, context.votes, vote_one, &context, error));
    qsort(context.extrema, context.votes, sizeof *context.extrema, compare_sizes);
    segment->extremum_count = context.extrema[context.votes / 2];
    return GVC_OK;
}

void gvc_segment_set_image_options(gvc_segment *segment, const gvc_encode_options *options) {
    segment->image_options = (gvc_image_options){
        .parameterize = {.stretch_exponent = 1.0, .curvature_exponent = options->curvature_weight},
        .fit = true,
        .align = options->interior_share};
}

gvc_result gvc_segment_begin(const gvc_source *source, const gvc_encode_options *options,
                             const gvc_scan_frame *facts, uint64_t number, uint64_t first,
                             gvc_segment *segment, gvc_error *error) {
    uint64_t vote_end = segment->vote_end;
    size_t extremum_count = segment->extremum_count;
    gvc_segment_free(segment);
    *segment = (gvc_segment){.number = number, .first_frame = first, .end_frame = first + 1};
    while (segment->end_frame < source->frame_count &&
           facts[segment->end_frame].genus == facts[first].genus) {
        segment->end_frame++;
    }
    gvc_segment_set_image_options(segment, options);
    set_cube(segment, facts);
    if (first < vote_end) {
        segment->vote_end = vote_end;
        segment->extremum_count = extremum_count;
        return GVC_OK;
    }
    return vote(segment, source, options, error);
}

/* -------------------------------------------------------------------------------------- layout */

double gvc_rms_asked(const gvc_encode_options *options, double diagonal) {
    return options->max_rms_length > 0 ? options->max_rms_length / diagonal : options->max_rms;
}

gvc_result gvc_frame_rms(const gvc_mesh *original, const gvc_mesh *rebuilt, size_t samples,
                         double *rms, gvc_error *error) {
    gvc_distance distance;
    gvc_error failure;
    gvc_error_init(&failure);
    gvc_result result = gvc_mesh_distance(original, rebuilt, samples, &distance, &failure);
    if (result == GVC_ERROR_MESH) {
        /* The coarsest quantisers may leave a surface without area, from which no samples can be
         * taken: nothing of the frame is left. */
        *rms = 1;
        return GVC_OK;
    }
    if (result == GVC_OK) *rms = fmax(distance.rms[0], distance.rms[1]) / distance.diagonal;
    return gvc_hand_on(error, result, &failure);
}

/* An error without bound where no chart without folds is found: another try may do better. */
static gvc_result allow_folds(gvc_result result, const gvc_error *trouble, double *rms,
                              gvc_error *error) {
    if (result == GVC_OK) return GVC_OK;
    if (result != GVC_ERROR_MESH) return gvc_hand_on(error, result, trouble);
    *rms = INFINITY;
    return GVC_OK;
}

/* Error of the frame sampled by `sides`, at 16-bit codes. */
static gvc_result measure_sampling(const gvc_segment *segment, const gvc_frame_work *work,
                                   const gvc_side_table *sides, bool fit, size_t samples,
                                   double *rms, gvc_error *error) {
    size_t count = 3 * (size_t)sides->size * sides->size;
    gvc_image_options options = segment->image_options;
    options.fit = fit;
    gvc_weld weld = {0};
    gvc_mesh *rebuilt = NULL;
    double *image = gvc_alloc(count, sizeof *image);
    uint16_t *plane = gvc_alloc(count, sizeof *plane);
    gvc_result result = image && plane ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_weld_build(sides, &weld, error);
    if (result == GVC_OK) {
        result = gvc_frame_image(work, sides, &weld, &options, image, error);
    }
    if (result == GVC_OK) {
        for (size_t i = 0; i < count; i++) {
            double code = (image[i] - segment->origin[3 * i / count]) / segment->step;
            plane[i] = (uint16_t)lrint(fmin(fmax(code, 0), UINT16_MAX));
        }
        result = gvc_rebuild_mesh(&weld, plane, segment->origin, segment->step, &rebuilt, error);
    }
    if (result == GVC_OK) result = gvc_frame_rms(work->mesh, rebuilt, samples, rms, error);
    gvc_mesh_destroy(&rebuilt);
    gvc_weld_free(&weld);
    free(image);
    free(plane);
    return result;
}

static gvc_result sampling_rms(const gvc_segment *segment, const gvc_frame_work *work,
                               const gvc_side_table *sides, bool fit, size_t samples, double *rms,
                               gvc_error *error) {
    gvc_error trouble;
    gvc_error_init(&trouble);
    gvc_result result = measure_sampling(segment, work, sides, fit, samples, rms, &trouble);
    return allow_folds(result, &trouble, rms, error);
}

/* Resizing rounds, so the start may no longer be allowed: the nearest that is takes its place. */
static gvc_result mend_start(gvc_side_table *sides, gvc_error *error) {
    uint32_t loop = 4 * (sides->size - 1), nearest = loop;
    size_t count;
    uint32_t *starts = gvc_alloc(loop, sizeof *starts);
    if (!starts) return gvc_fail_memory(error);
    gvc_result result = gvc_layout_starts(sides, starts, &count, error);
    uint32_t before = sides->start;
    for (size_t i = 0; result == GVC_OK && i < count; i++) {
        uint32_t apart = starts[i] > before ? starts[i] - before : before - starts[i];
        if (loop - apart < apart) apart = loop - apart;
        if (apart >= nearest) continue;
        nearest = apart;
        sides->start = starts[i];
    }
    free(starts);
    if (result == GVC_OK && nearest == loop) {
        result = gvc_fail(error, GVC_ERROR_MESH,
                          "no layout of the cut fits an image of %u samples a side", sides->size);
    }
    return result;
}

static gvc_result resize_layout(const gvc_side_table *sides, const gvc_cut_graph *graph,
                                uint32_t size, gvc_side_table *resized, gvc_error *error) {
    GVC_TRY(gvc_layout_resize(sides, graph, size, resized, error));
    gvc_result result = mend_start(resized, error);
    if (result != GVC_OK) gvc_side_table_free(resized);
    return result;
}

gvc_result gvc_segment_sampling_rms(const gvc_segment *segment, const gvc_frame_work *work,
                                    uint32_t size, size_t samples, double *rms, gvc_error *error) {
    gvc_side_table sides = {0};
    gvc_error trouble;
    gvc_error_init(&trouble);
    gvc_result result = resize_layout(&segment->sides, &work->graph, size, &sides, &trouble);
    if (result != GVC_OK) return allow_folds(result, &trouble, rms, error);
    result = sampling_rms(segment, work, &sides, true, samples, rms, error);
    gvc_side_table_free(&sides);
    return result;
}

typedef struct trial_context {
    const gvc_segment *segment;
    const gvc_frame_work *work;
    const gvc_side_table *sides;
    uint32_t start[TRIALS];
    double rms[TRIALS];
} trial_context;

static gvc_result try_start(void *user, size_t index, gvc_error *error) {
    trial_context *context = user;
    gvc_side_table sides = *context->sides; /* shares its arrays, which are only read */
    sides.start = context->start[index];
    return sampling_rms(context->segment, context->work, &sides, false, TRIAL_SAMPLES,
                        &context->rms[index], error);
}

/* Where the square's corners fall on the loop matters: a factor of two in the error
 * (docs/adr/0006). Turning the square by a quarter changes nothing, so the starts of one side of
 * the square are all there is. */
static gvc_result choose_start(gvc_segment *segment, const gvc_frame_work *work,
                               gvc_side_table *sides, unsigned threads, gvc_error *error) {
    size_t count, kept = 0, quarter = 0;
    uint32_t *starts = gvc_alloc(4 * (size_t)(sides->size - 1), sizeof *starts);
    if (!starts) return gvc_fail_memory(error);
    trial_context context = {.segment = segment, .work = work, .sides = sides};
    gvc_result result = gvc_layout_starts(sides, starts, &count, error);
    if (result == GVC_OK) {
        while (quarter < count && starts[quarter] < sides->size - 1) quarter++;
        kept = quarter < TRIALS ? quarter : TRIALS;
        for (size_t i = 0; i < kept; i++) context.start[i] = starts[quarter * i / kept];
        if (kept == 0) {
            result =
                gvc_fail(error, GVC_ERROR_MESH,
                         "no layout of the cut fits an image of %u samples a side", sides->size);
        }
    }
    free(starts);
    if (result == GVC_OK) result = gvc_parallel_for(threads, kept, try_start, &context, error);
    size_t best = 0;
    for (size_t i = 1; i < kept; i++) {
        if (context.rms[i] < context.rms[best]) best = i;
    }
    if (result == GVC_OK && !isfinite(context.rms[best])) {
        result = gvc_fail(error, GVC_ERROR_MESH,
                          "the surface cut open folds over itself in every chart tried");
    }
    if (result == GVC_OK) {
        sides->start = context.start[best];
        segment->trial_rms = context.rms[best];
    }
    return result;
}

/* Fails, before anything is measured, if the border of the image is too short for the cut. */
static gvc_result check_room(const gvc_side_table *sides, const gvc_cut_graph *graph, uint32_t size,
                             gvc_error *error) {
    gvc_side_table resized = {0};
    gvc_result result = gvc_layout_resize(sides, graph, size, &resized, error);
    gvc_side_table_free(&resized);
    return result;
}

static gvc_result edge_lengths(const gvc_frame_work *work, double **length, gvc_error *error) {
    *length = gvc_alloc(work->graph.edge_count, sizeof **length);
    if (!*length) return gvc_fail_memory(error);
    for (size_t e = 0; e < work->graph.edge_count; e++) {
        (*length)[e] = gvc_cut_edge_length(&work->halfedges, &work->graph.edge[e]);
    }
    return GVC_OK;
}

gvc_result gvc_segment_resize(gvc_segment *segment, const gvc_frame_work *work, uint32_t size,
                              gvc_error *error) {
    gvc_side_table resized = {0};
    GVC_TRY(resize_layout(&segment->sides, &work->graph, size, &resized, error));
    gvc_side_table_free(&segment->sides);
    gvc_weld_free(&segment->weld);
    segment->sides = resized;
    return gvc_weld_build(&segment->sides, &segment->weld, error);
}

gvc_result gvc_segment_layout(gvc_segment *segment, const gvc_frame_work *work, uint32_t size,
                              unsigned threads, gvc_error *error) {
    gvc_disk disk = {0};
    gvc_side_table trial = {0};
    double *length = NULL;
    gvc_result result = gvc_disk_open(&work->halfedges, &work->graph, &disk, error);
    if (result == GVC_OK) {
        free(segment->run);
        segment->run = disk.run;
        segment->run_count = disk.run_count;
        disk.run = NULL;
        result = edge_lengths(work, &length, error);
    }
    gvc_disk_free(&disk);
    if (result == GVC_OK) {
        result = gvc_layout_make(segment->run, segment->run_count, &work->graph, length, TRIAL_SIZE,
                                 &trial, error);
    }
    if (result == GVC_OK && size) result = check_room(&trial, &work->graph, size, error);
    if (result == GVC_OK) result = choose_start(segment, work, &trial, threads, error);
    if (result == GVC_OK) {
        gvc_side_table_free(&segment->sides);
        segment->sides = trial;
        trial = (gvc_side_table){0};
        result = gvc_segment_resize(segment, work, size ? size : TRIAL_SIZE, error);
    }
    free(length);
    gvc_side_table_free(&trial);
    return gvc_at_frame(error, result, (int64_t)work->number);
}

/* -------------------------------------------------------------------------------- what is coded */

gvc_result gvc_segment_shape(const gvc_segment *segment, const gvc_cut_graph *graph,
                             gvc_shape *shape, gvc_error *error) {
    *shape = (gvc_shape){.segment = segment->number};
    shape->chart = gvc_alloc(1, sizeof *shape->chart);
    if (!shape->chart) return gvc_fail_memory(error);
    shape->chart_count = 1;
    gvc_chart_shape *chart = &shape->chart[0];
    chart->genus = segment->weld.genus;
    memcpy(chart->origin, segment->origin, sizeof chart->origin);
    chart->step = segment->step;
    chart->node = gvc_alloc(graph->node_count, sizeof *chart->node);
    chart->edge = gvc_alloc(graph->edge_count, sizeof *chart->edge);
    gvc_result result = chart->node && chart->edge ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_side_table_copy(&segment->sides, &chart->sides, error);
    if (result != GVC_OK) {
        gvc_shape_free(shape);
        return result;
    }
    chart->node_count = graph->node_count;
    chart->edge_count = graph->edge_count;
    for (size_t n = 0; n < graph->node_count; n++) {
        chart->node[n] = (gvc_shape_node){.kind = (uint8_t)graph->node[n].kind,
                                          .feature = graph->node[n].feature};
    }
    for (size_t e = 0; e < graph->edge_count; e++) {
        memcpy(chart->edge[e].node, graph->edge[e].node, sizeof chart->edge[e].node);
    }
    return GVC_OK;
}

void gvc_segment_quantise(const gvc_segment *segment, const double *image,
                          gvc_picture_layout layout, uint16_t *luma) {
    uint32_t size = segment->sides.size;
    double luma_step = segment->step * (1 << GVC_CODE_SHIFT);
    for (uint32_t p = 0; p < 3; p++) {
        const double *plane = image + (size_t)p * size * size;
        for (uint32_t y = 0; y < layout.plane_height; y++) {
            const double *row = plane + (size_t)(y < size ? y : size - 1) * size;
            uint16_t *out = luma + ((size_t)p * layout.plane_height + y) * layout.width;
            for (uint32_t x = 0; x < layout.width; x++) {
                double code = (row[x < size ? x : size - 1] - segment->origin[p]) / luma_step;
                out[x] = (uint16_t)lrint(fmin(fmax(code, 0), LUMA_MAX));
            }
        }
    }
}

void gvc_segment_free(gvc_segment *segment) {
    free(segment->run);
    gvc_side_table_free(&segment->sides);
    gvc_weld_free(&segment->weld);
    *segment = (gvc_segment){0};
}
