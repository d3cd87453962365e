/* SPDX-License-Identifier: MIT */
/** @file compare_paper.c  All the paper's measurements of one capture. */
#include "compare_paper.h"

#include "base/memory.h"
#include "base/result.h"

#include <math.h>
#include <stdlib.h>

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

gvc_result paper_measure(const paper_request *request, const paper_options *options,
                         paper_capture *capture, gvc_error *error) {
    capture->frame_count = request->source->frame_count;
    capture->hausdorff_reference = capture->zip_bytes = NAN;
    GVC_TRY(paper_find_cube(request->source, options, &capture->cube, error));
    if (request->method[PAPER_GIS]) {
        GVC_TRY(paper_measure_gis(request->source, &capture->cube, options,
                                  &capture->result[PAPER_GIS], error));
    }
    if (request->method[PAPER_FIXED]) {
        GVC_TRY(paper_measure_ours(request->source, &capture->cube, "fixed", options,
                                   &capture->result[PAPER_FIXED], error));
    }
    if (request->method[PAPER_MIXED] && request->mixed) {
        GVC_TRY(paper_measure_ours(request->mixed, &capture->cube, "mixed", options,
                                   &capture->result[PAPER_MIXED], error));
    }
    if (request->zip && options->coded) GVC_TRY(measure_zip(request, options, capture, error));
    return GVC_OK;
}
