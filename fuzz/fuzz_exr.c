/* SPDX-License-Identifier: MIT */
/** @file fuzz_exr.c  Fuzzes the readers of OpenEXR keyframes, and of frames as OpenEXR files.
 *
 * The first byte picks the image size and whether the rest is a file or the codes of an image. An
 * image or a frame that is read, or made of the input, must come out of its own file unchanged. */
#include "codec/exr.h"
#include "exr_frame.h"
#include "require.h"

#define LEAST_SIZE 16u
#define SIZES 64u /* 16 .. 79: more than one chunk of 16 lines */
#define OPTION_CODES 64u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void write_and_read(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts) {
    size_t count = 3 * (size_t)size * size;
    uint16_t *back = calloc(count, sizeof *back);
    gvc_exr_facts facts_back;
    gvc_buffer file = {0};
    gvc_error error;
    gvc_error_init(&error);
    REQUIRE(back && succeeded(gvc_exr_encode(size, codes, facts, &file, &error), &error));
    REQUIRE(
        succeeded(gvc_exr_decode(file.data, file.size, size, back, &facts_back, &error), &error));
    REQUIRE(memcmp(codes, back, count * sizeof *back) == 0);
    REQUIRE(facts_back.step == facts->step && strcmp(facts_back.unit, facts->unit) == 0);
    gvc_buffer_free(&file);
    free(back);
}

/** The file as that of a frame. */
static void read_frame(const uint8_t *data, size_t size) {
    gvc_exr_frame frame, back;
    gvc_buffer file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_exr_frame_read(data, size, &frame, &error);
    if (!succeeded(result, &error)) {
        REQUIRE(blames_input(result) && !frame.codes && !frame.shape.chart);
        return;
    }
    REQUIRE(succeeded(gvc_exr_frame_write(&frame, &file, &error), &error));
    REQUIRE(succeeded(gvc_exr_frame_read(file.data, file.size, &back, &error), &error));
    uint32_t side = frame.shape.chart[0].sides.size;
    REQUIRE(back.number == frame.number && back.group == frame.group);
    REQUIRE(gvc_shape_equal(&frame.shape, &back.shape));
    REQUIRE(memcmp(frame.codes, back.codes, 3 * (size_t)side * side * sizeof *frame.codes) == 0);
    gvc_buffer_free(&file);
    gvc_exr_frame_free(&frame);
    gvc_exr_frame_free(&back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) return 0;
    uint32_t image_size = LEAST_SIZE + data[0] % SIZES;
    size_t bytes = 3 * (size_t)image_size * image_size * sizeof(uint16_t);
    gvc_exr_facts facts = {.step = 1};
    gvc_error error;
    gvc_error_init(&error);
    uint16_t *codes = calloc(1, bytes);
    REQUIRE(codes);
    if (data[0] & OPTION_CODES) {
        memcpy(codes, data + 1, size - 1 < bytes ? size - 1 : bytes);
        write_and_read(image_size, codes, &facts);
    } else {
        gvc_result result = gvc_exr_decode(data + 1, size - 1, image_size, codes, &facts, &error);
        if (succeeded(result, &error)) {
            write_and_read(image_size, codes, &facts);
        } else {
            REQUIRE(blames_input(result));
        }
        read_frame(data + 1, size - 1);
    }
    free(codes);
    return 0;
}
