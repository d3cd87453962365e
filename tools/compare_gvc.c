/* SPDX-License-Identifier: MIT */
/** @file compare_gvc.c  This format as a line of the comparison, through the public interface. */
#include "base/memory.h"
#include "base/parallel.h"
#include "base/result.h"
#include "compare.h"
#include "compare_clock.h"

#include <pthread.h>
#include <stdlib.h>

/* Frames decoded before they are measured together: enough for the threads, few for the memory. */
#define BATCH 16

/* --------------------------------------------------------------------------------- encoding */

/* The source, with the CPU time that reading takes, which is not the encoder's. */
typedef struct timed_source {
    const gvc_source *inner;
    pthread_mutex_t lock;
    double seconds;
} timed_source;

static gvc_result timed_read(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    timed_source *source = user;
    double begin = compare_thread_seconds();
    gvc_result result = source->inner->read(source->inner->user, frame, mesh, error);
    double taken = compare_thread_seconds() - begin;
    pthread_mutex_lock(&source->lock);
    source->seconds += taken;
    pthread_mutex_unlock(&source->lock);
    return result;
}

static const char *timed_name(void *user, uint64_t frame) {
    timed_source *source = user;
    return source->inner->name ? source->inner->name(source->inner->user, frame) : NULL;
}

static gvc_result keep_bytes(void *user, const void *data, size_t size, gvc_error *error) {
    gvc_buffer *file = user;
    gvc_write_bytes(file, data, size);
    return file->failed ? gvc_fail_memory(error) : GVC_OK;
}

static gvc_result encode_plainly(void *user, const gvc_source *source, const gvc_sink *sink,
                                 const gvc_encode_options *options, gvc_error *error) {
    (void)user;
    return gvc_encode(source, sink, options, NULL, error);
}

gvc_result compare_encode(const gvc_source *source, const gvc_encode_options *options,
                          compare_encoder encode, void *user, gvc_buffer *file, double *seconds,
                          gvc_error *error) {
    timed_source timed = {.inner = source};
    if (pthread_mutex_init(&timed.lock, NULL) != 0) return gvc_fail_memory(error);
    const gvc_source reading = {&timed, source->frame_count, timed_read,
                                source->name ? timed_name : NULL};
    const gvc_sink sink = {file, keep_bytes};
    double begin = compare_process_seconds();
    gvc_result result = encode(user, &reading, &sink, options, error);
    *seconds = compare_process_seconds() - begin - timed.seconds;
    pthread_mutex_destroy(&timed.lock);
    return result;
}

/* ------------------------------------------------------------------- decoding and measuring */

typedef struct batch {
    const gvc_source *source;
    uint64_t first;
    size_t count;
    gvc_mesh *decoded[BATCH];
    compare_frame *frames; /* of the whole capture */
    size_t samples;
} batch;

static gvc_result measure_frame(void *context, size_t index, gvc_error *error) {
    batch *b = context;
    uint64_t frame = b->first + index;
    gvc_mesh *original = NULL;
    gvc_result result = b->source->read(b->source->user, frame, &original, error);
    if (result == GVC_OK) {
        result = compare_measure(original, b->decoded[index], b->samples, &b->frames[frame], error);
    }
    gvc_mesh_destroy(&original);
    return gvc_at_frame(error, result, (int64_t)frame);
}

/* Decodes and measures frames [first, first + count). */
static gvc_result run_batch(batch *b, gvc_decoder *decoder, unsigned threads, gvc_error *error) {
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < b->count && result == GVC_OK; i++) {
        double begin = compare_process_seconds();
        result = gvc_decoder_frame(decoder, b->first + i, &b->decoded[i], error);
        b->frames[b->first + i].decode_seconds = compare_process_seconds() - begin;
        gvc_at_frame(error, result, (int64_t)(b->first + i));
    }
    if (result == GVC_OK) result = gvc_parallel_for(threads, b->count, measure_frame, b, error);
    for (size_t i = 0; i < b->count; i++) gvc_mesh_destroy(&b->decoded[i]);
    return result;
}

gvc_result compare_decode(const gvc_source *source, const gvc_buffer *file,
                          const compare_options *options, compare_frame *frames, gvc_error *error) {
    gvc_reader *reader = NULL;
    gvc_decoder *decoder = NULL;
    gvc_result result;
    gvc_info info;
    batch b = {.source = source, .frames = frames, .samples = options->samples};
    GVC_CHECK(gvc_reader_open_memory(file->data, file->size, NULL, &reader, error));
    gvc_reader_info(reader, &info);
    if (info.frame_count != source->frame_count) {
        result =
            gvc_fail(error, GVC_ERROR_INTERNAL, "%llu frames went in and %llu came out",
                     (unsigned long long)source->frame_count, (unsigned long long)info.frame_count);
        goto cleanup;
    }
    GVC_CHECK(gvc_decoder_create(reader, &decoder, error));
    while (b.first < source->frame_count) {
        uint64_t left = source->frame_count - b.first;
        b.count = left < BATCH ? (size_t)left : BATCH;
        GVC_CHECK(run_batch(&b, decoder, options->threads, error));
        b.first += b.count;
    }

cleanup:
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    return result;
}

gvc_result compare_gvc(const gvc_source *source, const char *method,
                       const gvc_encode_options *encode, const compare_options *options,
                       compare_row *row, gvc_error *error) {
    if (source->frame_count == 0) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there are no frames to compare");
    }
    gvc_result result;
    gvc_buffer file = {.data = NULL};
    double seconds = 0;
    compare_frame *frames = gvc_alloc(source->frame_count, sizeof *frames);
    if (!frames) return gvc_fail_memory(error);
    GVC_CHECK(compare_encode(source, encode, encode_plainly, NULL, &file, &seconds, error));
    GVC_CHECK(compare_decode(source, &file, options, frames, error));
    compare_summarise(method, frames, source->frame_count, row);
    /* Frames are coded together: their share of the file and of the time is an equal one. */
    row->bytes = (double)file.size / (double)source->frame_count;
    row->encode_seconds = seconds / (double)source->frame_count;

cleanup:
    gvc_buffer_free(&file);
    free(frames);
    return result;
}
