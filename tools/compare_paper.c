/* SPDX-License-Identifier: MIT */
/** @file compare_paper.c  All the paper's measurements of one capture. */
#include "compare_paper.h"

#include "base/parallel.h"
#include "base/result.h"
#include "encode/scan.h"
#include "simplify.h"

#include <math.h>

#define BATCH 16

void paper_capture_free(paper_capture *capture) {
    for (int m = 0; m < PAPER_METHODS; m++) paper_result_free(&capture->result[m]);
}

static gvc_result measure_zip(const paper_request *request, const paper_options *options,
                              paper_capture *capture, gvc_error *error) {
    compare_row row;
    if (options->progress && !options->progress(options->user, "zip", 0, capture->frame_count)) {
        return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
    }
    GVC_TRY(compare_zip(request->source, request->original_off, &row, error));
    capture->zip_bytes = row.bytes * (double)row.frames;
    return GVC_OK;
}

/* ----------------------------------------------------------------------------------- reference */

typedef struct reference_work {
    const gvc_source *source;
    size_t samples;
    uint64_t first;
    double hausdorff[BATCH];
} reference_work;

static gvc_result reference_frame(void *context, size_t index, gvc_error *error) {
    reference_work *work = context;
    uint64_t frame = work->first + index;
    compare_frame measured;
    gvc_mesh *mesh = NULL, *simple = NULL;
    gvc_result result = gvc_load_frame(work->source, frame, true, &mesh, NULL, error);
    if (result == GVC_OK) result = simplify_mesh(mesh, PAPER_REFERENCE_VERTICES, &simple, error);
    if (result == GVC_OK) result = compare_measure(mesh, simple, work->samples, &measured, error);
    if (result == GVC_OK) work->hausdorff[index] = measured.hausdorff;
    gvc_mesh_destroy(&mesh);
    gvc_mesh_destroy(&simple);
    return gvc_at_frame(error, result, (int64_t)frame);
}

static gvc_result measure_reference(const gvc_source *source, const paper_options *options,
                                    double *hausdorff, gvc_error *error) {
    reference_work work = {.source = source, .samples = options->samples};
    double sum = 0;
    while (work.first < source->frame_count) {
        uint64_t left = source->frame_count - work.first;
        size_t count = left < BATCH ? (size_t)left : BATCH;
        if (options->progress &&
            !options->progress(options->user, "ref", work.first, source->frame_count)) {
            return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        }
        GVC_TRY(gvc_parallel_for(options->threads, count, reference_frame, &work, error));
        for (size_t i = 0; i < count; i++) sum += work.hausdorff[i];
        work.first += count;
    }
    *hausdorff = sum / (double)source->frame_count;
    return GVC_OK;
}

/* ----------------------------------------------------------------------------------- everything */

/* Adds the file of the frame an error is about. */
static gvc_result name_file(const gvc_source *source, gvc_result result, gvc_error *error) {
    if (result == GVC_OK || !error || error->where[0] || error->frame < 0 || !source->name ||
        (uint64_t)error->frame >= source->frame_count) {
        return result;
    }
    return gvc_fail_in(error, result, source->name(source->user, (uint64_t)error->frame));
}

static gvc_result measure_capture(const paper_request *request, const paper_options *options,
                                  paper_capture *capture, gvc_error *error) {
    const gvc_source *source = request->source;
    GVC_TRY(paper_find_cube(source, options, &capture->cube, error));
    if (request->method[PAPER_GIS]) {
        GVC_TRY(
            paper_measure_gis(source, &capture->cube, options, &capture->result[PAPER_GIS], error));
    }
    if (request->method[PAPER_FIXED]) {
        GVC_TRY(paper_measure_ours(source, &capture->cube, "fixed", options,
                                   &capture->result[PAPER_FIXED], error));
    }
    if (request->reference && options->table[1]) {
        GVC_TRY(measure_reference(source, options, &capture->hausdorff_reference, error));
    }
    if (request->zip && options->table[2]) GVC_TRY(measure_zip(request, options, capture, error));
    return GVC_OK;
}

gvc_result paper_measure(const paper_request *request, const paper_options *options,
                         paper_capture *capture, gvc_error *error) {
    capture->frame_count = request->source->frame_count;
    capture->hausdorff_reference = capture->zip_bytes = NAN;
    gvc_result result = measure_capture(request, options, capture, error);
    if (result != GVC_OK) return name_file(request->source, result, error);
    if (!request->method[PAPER_MIXED] || !request->mixed) return GVC_OK;
    result = paper_measure_ours(request->mixed, &capture->cube, "mixed", options,
                                &capture->result[PAPER_MIXED], error);
    return name_file(request->mixed, result, error);
}
