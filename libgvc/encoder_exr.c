/* SPDX-License-Identifier: MIT */
/** @file encoder_exr.c  From OpenEXR files of frames back to a lossless file. */
#include "encoder_exr.h"

#include "base/memory.h"
#include "encode/exact.h"
#include "exr_frame.h"

#include <stdlib.h>
#include <string.h>

#define MOST_FRAMES 10000 /* of a group, as in every encode */

typedef struct exr_encoder {
    const gvc_exr_source *source;
    const gvc_sink *sink;
    gvc_encode_options options; /* rate and unit as the frames say */
    gvc_config config;          /* of all frames */
    gvc_segment segment;        /* of the group: affine map and weld */
    gvc_group group;
    size_t capacity;    /* of group.frame */
    uint64_t old_group; /* number of the group's first frame where it came from */
    char name[64];      /* of the group's first frame */
    gvc_writer *writer; /* NULL until the first group is coded */
    gvc_encode_report report;
} exr_encoder;

static void clear_group(exr_encoder *e) {
    gvc_group_clear(&e->group);
    gvc_segment_free(&e->segment);
}

static const char *name_of(void *user, uint64_t frame) {
    (void)frame; /* only the first of a group is asked for */
    const exr_encoder *e = user;
    return e->name[0] ? e->name : NULL;
}

static gvc_result flush_group(exr_encoder *e, gvc_error *error) {
    if (e->group.count == 0) return GVC_OK;
    const gvc_source names = {.user = e, .name = name_of};
    GVC_TRY(gvc_exact_code(&e->group, &e->options, error));
    if (!e->writer) GVC_TRY(gvc_writer_create(e->sink, &e->config, NULL, 0, &e->writer, error));
    GVC_TRY(gvc_group_write(&e->group, &names, e->writer, error));
    e->report.gop_count++;
    e->report.frame_count += e->group.count;
    clear_group(e);
    return GVC_OK;
}

/* Begins a group with what its first frame says; the frame's shape moves to the group. */
static gvc_result begin_group(exr_encoder *e, gvc_exr_frame *frame, uint64_t number,
                              gvc_error *error) {
    const gvc_chart_shape *chart = &frame->shape.chart[0];
    e->group.first_frame = number;
    e->old_group = frame->group;
    memcpy(e->name, frame->facts.source, sizeof e->name);
    e->segment = (gvc_segment){.number = frame->shape.segment, .step = chart->step};
    memcpy(e->segment.origin, chart->origin, sizeof e->segment.origin);
    e->group.shape = frame->shape;
    frame->shape = (gvc_shape){0};
    return gvc_weld_build(&e->group.shape.chart[0].sides, &e->segment.weld, error);
}

/* The configuration is that of the first frame, for as many frames as there are, exact. All others
 * must say the same. */
static gvc_result adopt_config(exr_encoder *e, const gvc_exr_frame *frame, uint64_t number,
                               gvc_error *error) {
    gvc_config config = frame->config;
    config.version_major = GVC_FORMAT_MAJOR;
    config.version_minor = GVC_FORMAT_MINOR;
    config.features = GVC_FEATURE_EXACT;
    config.declared_frames = e->source->frame_count;
    if (number == 0) {
        e->config = config;
        e->options.frame_rate_num = config.frame_rate_num;
        e->options.frame_rate_den = config.frame_rate_den;
        memcpy(e->options.unit, config.unit, sizeof e->options.unit);
        return GVC_OK;
    }
    bool same;
    GVC_TRY(gvc_config_equal(&e->config, &config, &same, error));
    if (same) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_MESH,
                    "the frame comes from another file than the first: its configuration differs");
}

static gvc_result tell_changes(const exr_encoder *e, const gvc_exr_frame *frame, uint64_t number,
                               gvc_error *error) {
    uint8_t digest[8];
    if (!e->options.warn) return GVC_OK;
    GVC_TRY(gvc_exr_frame_digest(frame, digest, error));
    if (memcmp(digest, frame->facts.digest, sizeof digest) != 0) {
        e->options.warn(e->options.user, (int64_t)number,
                        "the image was changed since it was taken out of its file");
    }
    return GVC_OK;
}

static gvc_result add_frame(exr_encoder *e, gvc_exr_frame *frame, uint64_t number,
                            gvc_error *error) {
    GVC_TRY(adopt_config(e, frame, number, error));
    GVC_TRY(tell_changes(e, frame, number, error));
    if (e->group.count > 0 && (frame->group != e->old_group || e->group.count == MOST_FRAMES ||
                               !gvc_shape_equal(&frame->shape, &e->group.shape))) {
        GVC_TRY(flush_group(e, error));
    }
    if (e->group.count == 0) GVC_TRY(begin_group(e, frame, number, error));
    if (!gvc_grow((void **)&e->group.frame, &e->capacity, e->group.count + 1,
                  sizeof *e->group.frame)) {
        return gvc_fail_memory(error);
    }
    e->group.frame[e->group.count++] = (gvc_group_frame){.codes = frame->codes};
    frame->codes = NULL;
    return GVC_OK;
}

static gvc_result read_frame(const exr_encoder *e, uint64_t number, gvc_exr_frame *frame,
                             gvc_error *error) {
    gvc_buffer bytes = {0};
    *frame = (gvc_exr_frame){0};
    gvc_result result = e->source->read(e->source->user, number, &bytes, error);
    if (result == GVC_OK) result = gvc_exr_frame_read(bytes.data, bytes.size, frame, error);
    gvc_buffer_free(&bytes);
    return result;
}

static gvc_result encode_frames(exr_encoder *e, gvc_error *error) {
    for (uint64_t number = 0; number < e->source->frame_count; number++) {
        gvc_exr_frame frame;
        gvc_result result = read_frame(e, number, &frame, error);
        if (result == GVC_OK) result = add_frame(e, &frame, number, error);
        gvc_exr_frame_free(&frame);
        GVC_TRY(gvc_at_frame(error, result, (int64_t)number));
        if (e->options.progress && !e->options.progress(e->options.user, GVC_STAGE_ENCODE,
                                                        number + 1, e->source->frame_count)) {
            return gvc_fail(error, GVC_ERROR_CANCELLED, "cancelled");
        }
    }
    GVC_TRY(flush_group(e, error));
    return gvc_writer_finish(e->writer, error);
}

gvc_result gvc_encode_exr(const gvc_exr_source *source, const gvc_sink *sink,
                          const gvc_encode_options *options, gvc_encode_report *report,
                          gvc_error *error) {
    if (source->frame_count == 0) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there are no frames to encode");
    }
    exr_encoder *e = gvc_alloc(1, sizeof *e);
    if (!e) return gvc_fail_memory(error);
    *e = (exr_encoder){.source = source, .sink = sink, .options = *options};
    e->group = (gvc_group){.segment = &e->segment, .exact = true};
    gvc_result result = encode_frames(e, error);
    if (result == GVC_OK && report) {
        *report = e->report;
        report->byte_count = gvc_writer_byte_count(e->writer);
        report->image_size = e->config.image_size;
    }
    gvc_writer_destroy(&e->writer);
    clear_group(e);
    gvc_group_free(&e->group);
    free(e);
    return gvc_explain(error, result);
}
