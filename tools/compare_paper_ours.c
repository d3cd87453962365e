/* SPDX-License-Identifier: MIT */
/** @file compare_paper_ours.c  This method: images tapped from the encoder, bytes of its file. */
#include "compare_paper.h"

#include "base/memory.h"
#include "base/result.h"
#include "encode/tap.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct ours {
    const paper_options *options;
    const char *what;
    paper_images images;
    gvc_buffer file;
} ours;

static gvc_result take_image(void *user, uint64_t frame, const double *image, uint32_t size,
                             gvc_error *error) {
    ours *o = user;
    (void)size, (void)error;
    paper_images_set(&o->images, frame, image);
    return GVC_OK;
}

static gvc_result keep_bytes(void *user, const void *data, size_t size, gvc_error *error) {
    ours *o = user;
    gvc_write_bytes(&o->file, data, size);
    return o->file.failed ? gvc_fail_memory(error) : GVC_OK;
}

static bool show_progress(void *user, gvc_stage stage, uint64_t done, uint64_t total) {
    const ours *o = user;
    if (!o->options->progress) return true;
    char what[80];
    snprintf(what, sizeof what, "%s%s", o->what, stage == GVC_STAGE_SCAN ? ": reading" : "");
    return o->options->progress(o->options->user, what, done, total);
}

static gvc_result encode(ours *o, const gvc_source *source, gvc_encode_report *report,
                         gvc_error *error) {
    const gvc_image_tap tap = {o, take_image};
    const gvc_sink sink = {o, keep_bytes};
    gvc_encode_options options;
    gvc_encode_options_init(&options);
    options.image_size = o->options->size;
    options.crf = o->options->crf;
    options.gop = o->options->gop;
    options.threads = o->options->threads;
    options.progress = show_progress;
    options.user = o;
    return gvc_encode_tapped(source, &sink, &options, &tap, report, error);
}

/* Distances of the decoded frames. */
static gvc_result measure(ours *o, const gvc_source *source, paper_result *made, gvc_error *error) {
    const compare_options measuring = {o->options->threads, o->options->samples};
    compare_row row;
    compare_frame *frames = gvc_alloc((size_t)source->frame_count, sizeof *frames);
    if (!frames) return gvc_fail_memory(error);
    gvc_result result = compare_decode(source, &o->file, &measuring, frames, error);
    if (result == GVC_OK) {
        compare_summarise("", frames, source->frame_count, &row);
        made->hausdorff = row.hausdorff_mean;
        made->rms = row.rms;
    }
    free(frames);
    return result;
}

gvc_result paper_measure_ours(const gvc_source *source, const paper_cube *cube, const char *what,
                              const paper_options *options, paper_result *made, gvc_error *error) {
    gvc_encode_report report;
    gvc_result result;
    ours o = {.options = options, .what = what};
    *made = (paper_result){.hausdorff = NAN, .rms = NAN, .bytes = NAN};
    GVC_CHECK(paper_images_create(source->frame_count, options->size, cube, &o.images, error));
    GVC_CHECK(encode(&o, source, &report, error));
    GVC_CHECK(paper_result_set_mse(made, &o.images, error));
    made->segment_count = report.segment_count;
    if (paper_codes(options)) {
        made->bytes = (double)report.byte_count;
        GVC_CHECK(measure(&o, source, made, error));
    }
    made->measured = true;
cleanup:
    paper_images_free(&o.images);
    gvc_buffer_free(&o.file);
    if (result != GVC_OK) paper_result_free(made);
    return result;
}
