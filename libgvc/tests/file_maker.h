/* SPDX-License-Identifier: MIT */
/** @file file_maker.h  Files for container tests: written to memory, read from exact-size memory.
 */
#ifndef GVC_TESTS_FILE_MAKER_H
#define GVC_TESTS_FILE_MAKER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "container/demux.h"
#include "container/writer.h"
#include "memory_file.h"

static inline gvc_read_options options_make(bool keep_going) {
    return (gvc_read_options){.struct_size = sizeof(gvc_read_options),
                              .max_memory = (uint64_t)1 << 26,
                              .max_image_size = 2049,
                              .max_frames = 1000000,
                              .keep_going = keep_going};
}

static inline gvc_config config_make(uint64_t declared_frames) {
    gvc_config config = {.version_minor = GVC_FORMAT_MINOR,
                         .picture_width = 64,
                         .plane_height = 48,
                         .image_size = 33,
                         .code_bits = 10,
                         .code_shift = 6,
                         .frame_rate_num = 30000,
                         .frame_rate_den = 1001,
                         .declared_frames = declared_frames};
    strcpy(config.unit, "m");
    strcpy(config.encoder, "test");
    return config;
}

#define MADE_AVC_CONFIG "\001\156\000\052\377"
#define MADE_GROUP 4u /**< most frames of a group made here */

/** Content of a made sample: depends on track, frame and place. Returns its size. Shape records are
 * made of any bytes, but the first byte tells whether they are whole (0) or say "same" (1). */
static inline size_t sample_bytes(unsigned track, uint64_t frame, bool first, uint8_t *data) {
    size_t size = track ? 9 + frame % 3 : 20 + frame * 7 % 11;
    for (size_t i = 0; i < size; i++) data[i] = (uint8_t)(frame * 31 + i * 7 + track * 101);
    if (track) data[0] = !first;
    return size;
}

/** Presentation minus decoding order of a group coded I P B B (fewer: a prefix that permutes). */
static inline int32_t made_order(size_t count, size_t i) {
    static const int32_t four[4] = {0, 2, -1, -1};
    return count == 4 ? four[i] : 0;
}

/** Writes a group of `count` <= MADE_GROUP frames. */
static inline gvc_result write_group(gvc_writer *writer, uint64_t first_frame, size_t count,
                                     gvc_error *error) {
    static uint8_t bytes[2][MADE_GROUP][64];
    gvc_sample sample[2][MADE_GROUP];
    for (size_t i = 0; i < count; i++) {
        int32_t order = made_order(count, i);
        uint64_t shown = first_frame + i + (uint64_t)(int64_t)order;
        bool first = i == 0;
        size_t size = sample_bytes(0, shown, first, bytes[0][i]);
        sample[0][i] = (gvc_sample){bytes[0][i], size, order, first};
        size = sample_bytes(1, first_frame + i, first, bytes[1][i]);
        sample[1][i] = (gvc_sample){bytes[1][i], size, 0, first};
    }
    gvc_fragment fragment = {first_frame, count, sample[0], sample[1], NULL};
    return gvc_writer_fragment(writer, &fragment, error);
}

/** A whole file of groups of the sizes given, ended by 0. */
static inline gvc_buffer file_make(const size_t *group, bool declare) {
    uint64_t frames = 0;
    for (size_t i = 0; group[i]; i++) frames += group[i];
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_config config = config_make(declare ? frames : 0);
    gvc_writer *writer;
    assert_int_equal(gvc_writer_create(&sink, &config, (const uint8_t *)MADE_AVC_CONFIG,
                                       sizeof MADE_AVC_CONFIG - 1, &writer, NULL),
                     GVC_OK);
    uint64_t first = 0;
    for (size_t i = 0; group[i]; first += group[i++]) {
        assert_int_equal(write_group(writer, first, group[i], NULL), GVC_OK);
    }
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    assert_int_equal(gvc_writer_byte_count(writer), file.size);
    gvc_writer_destroy(&writer);
    assert_false(file.failed);
    return file;
}

/** Opens exactly `size` bytes and reads every sample. Frames are counted in `*frames` if given. */
static inline gvc_result read_all(const uint8_t *data, size_t size, bool keep_going, size_t *frames,
                                  bool *complete, gvc_error *error) {
    uint8_t *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, data, size);
    gvc_io io = io_of(exact, size);
    gvc_read_options options = options_make(keep_going);
    gvc_demux demux;
    gvc_buffer sample = {0};
    gvc_result result = gvc_demux_open(&io, &options, &demux, error);
    if (result == GVC_OK) {
        if (frames) *frames = demux.sample_count[GVC_TRACK_SHAPE];
        if (complete) *complete = demux.complete;
    }
    for (unsigned kind = 0; result == GVC_OK && kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; result == GVC_OK && i < demux.sample_count[kind]; i++) {
            result =
                gvc_demux_read(&demux, &io, (gvc_track_kind)kind, i, UINT64_MAX, &sample, error);
        }
    }
    gvc_buffer_free(&sample);
    gvc_demux_free(&demux);
    free(exact);
    return result;
}

#endif
