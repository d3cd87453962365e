/* SPDX-License-Identifier: MIT */
/**
 * @file compare_paper_gis.c
 * The unstabilised method as a sequence: frames cut by themselves, coded as one H.264 stream with
 * prediction between them, like the frames of this method. A file of this format keeps one layout
 * over a fragment, so a layout for every frame is counted by its shape record; boxes are not
 * counted.
 */
#include "compare_paper.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "chart/rebuild.h"
#include "encode/group.h"
#include "encode/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BATCH 16 /* frames made, or measured, in parallel */
#define BLOCK 16 /* pictures are padded to whole macroblocks */

typedef struct sequence {
    const gvc_source *source;
    const paper_options *options;
    gvc_encode_options encode;
    gvc_segment cube; /* without layout */
    paper_images images;
    gvc_group group;
    gvc_shape *shape; /* of each frame of the group */
    compare_frame *frames;
    uint64_t stream_bytes, record_bytes;
    bool configured; /* parameter sets are counted */
    uint64_t first;  /* frame of the batch being worked on */
} sequence;

/* ------------------------------------------------------------------------------------- pictures */

static gvc_result sample_frame(sequence *s, gvc_frame_work *work, gvc_segment *segment,
                               gvc_error *error) {
    size_t place = (size_t)(work->number - s->group.first_frame);
    gvc_picture_layout layout = s->group.layout;
    size_t samples = (size_t)PAPER_COMPONENTS * s->options->size * s->options->size;
    double *image = gvc_alloc(samples, sizeof *image);
    uint16_t *luma = gvc_alloc((size_t)3 * layout.width * layout.plane_height, sizeof *luma);
    gvc_result result = image && luma ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        result = gvc_reference_frame(s->source, s->encode.weld, s->options->size, work, segment,
                                     image, NULL, error);
    }
    if (result == GVC_OK) {
        paper_images_set(&s->images, work->number, image);
        gvc_segment_quantise(segment, image, layout, luma);
        s->group.frame[place].luma = luma;
        luma = NULL;
        result = gvc_segment_shape(segment, &work->graph, &s->shape[place], error);
    }
    free(image);
    free(luma);
    return result;
}

static gvc_result make_frame(void *context, size_t index, gvc_error *error) {
    sequence *s = context;
    gvc_frame_work work = {.number = s->first + index};
    gvc_segment segment = s->cube;
    gvc_result result = sample_frame(s, &work, &segment, error);
    gvc_frame_free(&work);
    gvc_segment_free(&segment);
    return gvc_at_frame(error, result, (int64_t)(s->first + index));
}

/* --------------------------------------------------------------------------------------- coding */

static gvc_result count_bytes(sequence *s, gvc_error *error) {
    gvc_buffer record = {0};
    const gvc_shape_frame facts = {.same = false};
    for (size_t i = 0; i < s->group.count; i++) {
        s->stream_bytes += s->group.coded.packet[i].size;
        gvc_buffer_clear(&record);
        gvc_result result = gvc_shape_record_write(&s->shape[i], &facts, &record, error);
        if (result == GVC_OK && record.failed) result = gvc_fail_memory(error);
        s->record_bytes += record.size;
        if (result != GVC_OK) {
            gvc_buffer_free(&record);
            return result;
        }
    }
    if (!s->configured) s->stream_bytes += s->group.coded.config_size;
    s->configured = true;
    gvc_buffer_free(&record);
    return GVC_OK;
}

static gvc_result rebuild_frame(const sequence *s, size_t place, gvc_mesh **mesh,
                                gvc_error *error) {
    const gvc_chart_shape *chart = &s->shape[place].chart[0];
    gvc_weld weld = {0};
    uint32_t size = chart->sides.size;
    uint16_t *plane = gvc_alloc((size_t)3 * size * size, sizeof *plane);
    gvc_result result =
        plane ? gvc_weld_build(&chart->sides, &weld, error) : gvc_fail_memory(error);
    if (result == GVC_OK) {
        gvc_picture_cut(s->group.layout, s->group.frame[place].decoded, 0, 0, size, GVC_CODE_SHIFT,
                        plane);
        result = gvc_rebuild_mesh(&weld, plane, chart->origin, chart->step, mesh, error);
    }
    gvc_weld_free(&weld);
    free(plane);
    return result;
}

static gvc_result measure_frame(void *context, size_t index, gvc_error *error) {
    sequence *s = context;
    uint64_t frame = s->group.first_frame + index;
    gvc_mesh *original = NULL, *decoded = NULL;
    gvc_result result = rebuild_frame(s, index, &decoded, error);
    if (result == GVC_OK) result = s->source->read(s->source->user, frame, &original, error);
    if (result == GVC_OK) {
        result = compare_measure(original, decoded, s->options->samples, &s->frames[frame], error);
    }
    gvc_mesh_destroy(&original);
    gvc_mesh_destroy(&decoded);
    return gvc_at_frame(error, result, (int64_t)frame);
}

static gvc_result code_group(sequence *s, gvc_error *error) {
    GVC_TRY(gvc_group_code(&s->group, &s->encode, s->options->crf, error));
    GVC_TRY(count_bytes(s, error));
    return gvc_parallel_for(s->options->threads, s->group.count, measure_frame, s, error);
}

/* ------------------------------------------------------------------------------------- sequence */

static void clear_group(sequence *s) {
    for (size_t i = 0; s->shape && i < s->group.capacity; i++) gvc_shape_free(&s->shape[i]);
    /* frames of a batch that failed are not counted yet, but may have their picture */
    s->group.count = s->group.capacity;
    gvc_group_clear(&s->group);
}

static gvc_result begin(sequence *s, const paper_cube *cube, gvc_error *error) {
    const paper_options *o = s->options;
    uint32_t padded = (o->size + BLOCK - 1) / BLOCK * BLOCK;
    uint64_t frames = s->source->frame_count;
    size_t capacity = frames < o->gop ? (size_t)frames : o->gop;
    gvc_encode_options_init(&s->encode);
    gvc_segment_set_cube(&s->cube, cube->origin, cube->side);
    gvc_segment_set_image_options(&s->cube, &s->encode);
    s->frames = gvc_alloc((size_t)frames, sizeof *s->frames);
    s->shape = gvc_alloc(capacity, sizeof *s->shape);
    if (!s->frames || !s->shape) return gvc_fail_memory(error);
    GVC_TRY(paper_images_create(frames, o->size, cube, &s->images, error));
    return gvc_group_create(capacity, (gvc_picture_layout){padded, padded}, &s->group, error);
}

/* Makes the frames of one group, and codes and measures them if asked for. */
static gvc_result run_group(sequence *s, gvc_error *error) {
    uint64_t total = s->source->frame_count, end = s->group.first_frame + s->group.capacity;
    if (end > total) end = total;
    for (s->first = s->group.first_frame; s->first < end;) {
        size_t count = end - s->first < BATCH ? (size_t)(end - s->first) : BATCH;
        if (s->options->progress &&
            !s->options->progress(s->options->user, "gis", s->first, total)) {
            return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        }
        GVC_TRY(gvc_parallel_for(s->options->threads, count, make_frame, s, error));
        s->first += count;
    }
    s->group.count = (size_t)(end - s->group.first_frame);
    return paper_codes(s->options) ? code_group(s, error) : GVC_OK;
}

static gvc_result run(sequence *s, gvc_error *error) {
    while (s->group.first_frame < s->source->frame_count) {
        GVC_TRY(run_group(s, error));
        clear_group(s);
        s->group.first_frame += s->group.capacity;
    }
    return GVC_OK;
}

gvc_result paper_measure_gis(const gvc_source *source, const paper_cube *cube,
                             const paper_options *options, paper_result *made, gvc_error *error) {
    sequence s = {.source = source, .options = options};
    compare_row row;
    gvc_result result;
    *made = (paper_result){.hausdorff = NAN, .rms = NAN, .bytes = NAN};
    GVC_CHECK(begin(&s, cube, error));
    GVC_CHECK(run(&s, error));
    GVC_CHECK(paper_result_set_mse(made, &s.images, error));
    made->segment_count = source->frame_count;
    if (paper_codes(options)) {
        compare_summarise("", s.frames, source->frame_count, &row);
        made->hausdorff = row.hausdorff_mean;
        made->rms = row.rms;
        made->bytes = (double)(s.stream_bytes + s.record_bytes);
    }
    made->measured = true;
cleanup:
    if (s.group.frame) clear_group(&s);
    gvc_group_free(&s.group);
    paper_images_free(&s.images);
    free(s.shape);
    free(s.frames);
    if (result != GVC_OK) paper_result_free(made);
    return result;
}
