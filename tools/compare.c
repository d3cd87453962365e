/* SPDX-License-Identifier: MIT */
/** @file compare.c  Measuring frames, summing them up, and the methods to compare with. */
#include "compare.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "compare_draco.h"
#include "compare_zip.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* -------------------------------------------------------------------------------- measuring */

gvc_result compare_measure(const gvc_mesh *original, const gvc_mesh *decoded, size_t samples,
                           compare_frame *frame, gvc_error *error) {
    gvc_distance distance;
    GVC_TRY(gvc_mesh_distance(original, decoded, samples, &distance, error));
    frame->mean = fmax(distance.mean[0], distance.mean[1]) / distance.diagonal;
    frame->rms = fmax(distance.rms[0], distance.rms[1]) / distance.diagonal;
    frame->hausdorff = fmax(distance.maximum[0], distance.maximum[1]) / distance.diagonal;
    return GVC_OK;
}

void compare_summarise(const char *method, const compare_frame *frames, uint64_t count,
                       compare_row *row) {
    *row = (compare_row){.frames = count};
    snprintf(row->method, sizeof row->method, "%s", method);
    for (uint64_t i = 0; i < count; i++) {
        const compare_frame *frame = &frames[i];
        row->bytes += (double)frame->bytes;
        row->mean += frame->mean;
        row->rms += frame->rms * frame->rms;
        row->hausdorff_max = fmax(row->hausdorff_max, frame->hausdorff);
        row->hausdorff_mean += frame->hausdorff;
        row->encode_seconds += frame->encode_seconds;
        row->decode_seconds += frame->decode_seconds;
    }
    double n = (double)count;
    row->bytes /= n;
    row->mean /= n;
    row->rms = sqrt(row->rms / n);
    row->hausdorff_mean /= n;
    row->encode_seconds /= n;
    row->decode_seconds /= n;
}

static gvc_result need_frames(const gvc_source *source, gvc_error *error) {
    if (source->frame_count > 0) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_ARGUMENT, "there are no frames to compare");
}

/* -------------------------------------------------------------------------------------- zip */

typedef struct zip_frames {
    const gvc_source *source;
    gvc_result (*original)(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error);
} zip_frames;

static gvc_result off_of_frame(void *user, uint64_t index, gvc_buffer *bytes, gvc_error *error) {
    const zip_frames *frames = user;
    void *source = frames->source->user;
    if (frames->original) {
        gvc_result result = frames->original(source, index, bytes, error);
        if (result != GVC_OK) return gvc_at_frame(error, result, (int64_t)index);
        if (bytes->size > 0) return GVC_OK;
    }
    gvc_mesh *mesh = NULL;
    gvc_result result = frames->source->read(source, index, &mesh, error);
    if (result == GVC_OK) compare_off_text(mesh, bytes);
    gvc_mesh_destroy(&mesh);
    return gvc_at_frame(error, result, (int64_t)index);
}

gvc_result compare_zip(const gvc_source *source,
                       gvc_result (*original)(void *user, uint64_t frame, gvc_buffer *bytes,
                                              gvc_error *error),
                       compare_row *row, gvc_error *error) {
    GVC_TRY(need_frames(source, error));
    zip_frames frames = {source, original};
    compare_zip_entries entries = {&frames, source->frame_count, off_of_frame};
    compare_zip_cost cost;
    GVC_TRY(compare_zip_measure(&entries, &cost, error));
    double n = (double)source->frame_count;
    *row = (compare_row){.method = "zip -9",
                         .frames = source->frame_count,
                         .bytes = (double)cost.size / n,
                         .encode_seconds = cost.deflate_seconds / n,
                         .decode_seconds = cost.inflate_seconds / n};
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ Draco */

typedef struct draco_work {
    const gvc_source *source;
    int bits;
    size_t samples;
    compare_frame *frames;
} draco_work;

static gvc_result draco_frame(void *context, size_t index, gvc_error *error) {
    const draco_work *work = context;
    compare_frame *frame = &work->frames[index];
    gvc_mesh *original = NULL, *decoded = NULL;
    unsigned char *data = NULL;
    size_t size = 0;
    gvc_result result;
    GVC_CHECK(work->source->read(work->source->user, index, &original, error));
    GVC_CHECK(
        compare_draco_encode(original, work->bits, &data, &size, &frame->encode_seconds, error));
    GVC_CHECK(compare_draco_decode(data, size, &decoded, &frame->decode_seconds, error));
    frame->bytes = size;
    GVC_CHECK(compare_measure(original, decoded, work->samples, frame, error));

cleanup:
    free(data);
    gvc_mesh_destroy(&original);
    gvc_mesh_destroy(&decoded);
    return gvc_at_frame(error, result, (int64_t)index);
}

gvc_result compare_draco(const gvc_source *source, int bits, const compare_options *options,
                         compare_row *row, gvc_error *error) {
    GVC_TRY(need_frames(source, error));
    draco_work work = {.source = source, .bits = bits, .samples = options->samples};
    work.frames = gvc_alloc(source->frame_count, sizeof *work.frames);
    if (!work.frames) return gvc_fail_memory(error);
    gvc_result result =
        gvc_parallel_for(options->threads, source->frame_count, draco_frame, &work, error);
    if (result == GVC_OK) {
        char method[32];
        snprintf(method, sizeof method, "draco qp %d", bits);
        compare_summarise(method, work.frames, source->frame_count, row);
    }
    free(work.frames);
    return result;
}
