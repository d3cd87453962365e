/* SPDX-License-Identifier: MIT */
/** @file fuzz_record.c  Fuzzes the reader of shape records, and the welding of what they say.
 *
 * The input is one record, of a file with planes of 256 x 256 samples. */
#include "container/shape_record.h"

#include "live_memory.h"
#include "require.h"

#define MAX_MEMORY ((size_t)1 << 22)
#define PLANE 256u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/** What was accepted must be written, and read again, as the same. */
static void write_and_read(const gvc_shape *shape, const gvc_shape_frame *frame,
                           const gvc_config *config) {
    gvc_error error;
    gvc_buffer record = {0};
    gvc_shape back;
    gvc_shape_frame frame_back;
    gvc_error_init(&error);
    REQUIRE(succeeded(gvc_shape_record_write(shape, frame, &record, &error), &error));
    REQUIRE(succeeded(gvc_shape_record_read(record.data, record.size, config, MAX_MEMORY, &back,
                                            &frame_back, &error),
                      &error));
    REQUIRE(gvc_shape_equal(shape, &back));
    REQUIRE(strcmp(frame->source, frame_back.source) == 0 && frame->same == frame_back.same);
    REQUIRE(memcmp(frame->digest, frame_back.digest, sizeof frame->digest) == 0);
    gvc_shape_free(&back);
    gvc_buffer_free(&record);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    const gvc_config config = {.picture_width = PLANE, .plane_height = PLANE, .image_size = PLANE};
    gvc_shape shape;
    gvc_shape_frame frame;
    gvc_error error;
    gvc_error_init(&error);
    memory_begin();
    gvc_result result =
        gvc_shape_record_read(data, size, &config, MAX_MEMORY, &shape, &frame, &error);
    REQUIRE(memory_peak() <= MAX_MEMORY + MEMORY_ALLOWANCE);
    if (succeeded(result, &error)) {
        write_and_read(&shape, &frame, &config);
    } else {
        REQUIRE(blames_input(result) && shape.chart_count == 0);
    }
    gvc_shape_free(&shape);
    return 0;
}
