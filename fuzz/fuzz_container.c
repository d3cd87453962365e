/* SPDX-License-Identifier: MIT */
/** @file fuzz_container.c  Fuzzes the demuxer: a file, all its samples, and the shape records in
 * them.
 *
 * The input is the file. It is read strictly and, if that fails, as far as it is undamaged. */
#include "container/demux.h"
#include "container/shape_record.h"

#include "live_memory.h"
#include "require.h"

/* Small limits keep every run short; they are limits of the caller, not of the format. */
#define MAX_MEMORY ((size_t)1 << 22)
#define MAX_FRAMES 10000u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct input {
    const uint8_t *data;
    size_t size;
} input;

/** A read that gvc_io's contract forbids is a finding. */
static gvc_result read_input(void *user, uint64_t offset, void *data, size_t size,
                             gvc_error *error) {
    (void)error;
    const input *in = user;
    REQUIRE(offset <= in->size && size <= in->size - offset);
    memcpy(data, in->data + offset, size);
    return GVC_OK;
}

static void read_samples(const gvc_demux *demux, const gvc_io *io, gvc_error *error) {
    gvc_buffer sample = {0};
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; i < demux->sample_count[kind]; i++) {
            gvc_result result =
                gvc_demux_read(demux, io, (gvc_track_kind)kind, i, UINT64_MAX, &sample, error);
            if (!succeeded(result, error) || kind != GVC_TRACK_SHAPE) continue;
            gvc_shape shape;
            gvc_shape_frame frame;
            result = gvc_shape_record_read(sample.data, sample.size, &demux->config, MAX_MEMORY,
                                           &shape, &frame, error);
            if (!succeeded(result, error)) REQUIRE(shape.chart_count == 0 && !shape.chart);
            gvc_shape_free(&shape);
        }
    }
    gvc_buffer_free(&sample);
}

static bool read_file(const input *in, bool keep_going) {
    gvc_io io = {.user = (void *)(uintptr_t)in, .size = in->size, .read = read_input};
    gvc_read_options options = {.struct_size = sizeof options,
                                .max_memory = MAX_MEMORY,
                                .max_image_size = 2049,
                                .max_frames = MAX_FRAMES,
                                .keep_going = keep_going};
    gvc_demux demux;
    gvc_error error;
    gvc_error_init(&error);
    memory_begin();
    gvc_result result = gvc_demux_open(&io, &options, &demux, &error);
    bool opened = succeeded(result, &error);
    REQUIRE(opened || blames_input(result));
    REQUIRE(memory_peak() <= MAX_MEMORY + MEMORY_ALLOWANCE);
    if (opened) {
        REQUIRE(keep_going || (demux.damage_count == 0 && demux.complete));
        read_samples(&demux, &io, &error);
    }
    gvc_demux_free(&demux);
    return opened;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input in = {data, size};
    if (!read_file(&in, false)) read_file(&in, true);
    return 0;
}
