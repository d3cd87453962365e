/* SPDX-License-Identifier: MIT */
/** @file fuzz_container.c  Fuzzes the demuxer, every sample it finds, and the shape records in
 * them.
 *
 * The first byte picks options and the rest is the file, so that one corpus serves both ways of
 * reading. Checksums are repaired by no one: seeds must be valid, and most mutations of moov and
 * moof end at a checksum. Shape records are therefore also read straight from the input. */
#include "container/demux.h"
#include "container/shape_record.h"

#include <stdlib.h>
#include <string.h>

/* Small limits keep every run short; they are limits of the caller, not of the format. */
#define FUZZ_MEMORY ((size_t)1 << 22)
#define FUZZ_FRAMES 10000u
#define FUZZ_PLANE 256u

#define OPTION_KEEP_GOING 1u
#define OPTION_RECORD 2u /**< the rest is one shape record, not a file */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct input {
    const uint8_t *data;
    size_t size;
} input;

/** Aborts on a read that gvc_io's contract forbids. */
static gvc_result read_input(void *user, uint64_t offset, void *data, size_t size,
                             gvc_error *error) {
    (void)error;
    const input *in = user;
    if (offset > in->size || size > in->size - offset) abort();
    memcpy(data, in->data + offset, size);
    return GVC_OK;
}

static void read_record(const uint8_t *data, size_t size, const gvc_config *config) {
    gvc_shape shape;
    gvc_shape_frame frame;
    if (gvc_shape_record_read(data, size, config, FUZZ_MEMORY, &shape, &frame, NULL) != GVC_OK) {
        return;
    }
    /* What was accepted must survive being written and read. */
    gvc_buffer record = {0};
    gvc_shape back;
    gvc_shape_frame frame_back;
    if (gvc_shape_record_write(&shape, &frame, &record, NULL) != GVC_OK) abort();
    if (gvc_shape_record_read(record.data, record.size, config, FUZZ_MEMORY, &back, &frame_back,
                              NULL) != GVC_OK) {
        abort();
    }
    if (!gvc_shape_equal(&shape, &back) || strcmp(frame.source, frame_back.source) != 0) abort();
    gvc_shape_free(&back);
    gvc_shape_free(&shape);
    gvc_buffer_free(&record);
}

static void read_samples(const gvc_demux *demux, const gvc_io *io) {
    gvc_buffer sample = {0};
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; i < demux->sample_count[kind]; i++) {
            gvc_result result = gvc_demux_read(demux, io, (gvc_track_kind)kind, i, &sample, NULL);
            if (result == GVC_OK && kind == GVC_TRACK_SHAPE) {
                read_record(sample.data, sample.size, &demux->config);
            }
        }
    }
    gvc_buffer_free(&sample);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) return 0;
    uint8_t option = data[0];
    if (option & OPTION_RECORD) {
        const gvc_config config = {
            .picture_width = FUZZ_PLANE, .plane_height = FUZZ_PLANE, .image_size = FUZZ_PLANE};
        read_record(data + 1, size - 1, &config);
        return 0;
    }
    input in = {data + 1, size - 1};
    gvc_io io = {.user = &in, .size = in.size, .read = read_input};
    gvc_read_options options = {.struct_size = sizeof options,
                                .max_memory = FUZZ_MEMORY,
                                .max_image_size = 2049,
                                .max_frames = FUZZ_FRAMES,
                                .keep_going = option & OPTION_KEEP_GOING};
    gvc_demux demux;
    gvc_error error;
    if (gvc_demux_open(&io, &options, &demux, &error) == GVC_OK) read_samples(&demux, &io);
    gvc_demux_free(&demux);
    return 0;
}
