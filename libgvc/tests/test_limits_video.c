/* SPDX-License-Identifier: MIT */
/** @file test_limits_video.c  Memory that decoding of pictures takes, libavcodec's included: never
 * more than max_memory; where that is too little, the error says so. */
#include "capture_maker.h"
#include "live_memory.h"

#define FRAMES 6

/* Codecs keep pictures until it is their turn: with many frames and B-pictures as many as they may.
 */
static bytes make_video(uint32_t image_size) {
    capture frames = {0};
    for (size_t f = 0; f < FRAMES; f++) {
        frames.mesh[frames.count++] = mesh_ellipsoid(1, 1 + 0.02 * (double)f, 1.5, 8, 5, 0);
    }
    gvc_encode_options options = quick_options(image_size, 20, 60);
    options.longest_edge = 0.15;
    options.registration = false;
    bytes file = encode(&frames, &options, NULL);
    capture_free(&frames);
    return file;
}

/** Decodes all frames; the peak must keep to the limit. */
static gvc_result decode_within(const bytes *file, uint64_t max_memory) {
    gvc_read_options options;
    gvc_reader *reader;
    gvc_decoder *decoder = NULL;
    gvc_read_options_init(&options);
    options.max_memory = max_memory;
    memory_begin();
    gvc_result result = gvc_reader_open_memory(file->data, file->size, &options, &reader, NULL);
    if (result == GVC_OK) result = gvc_decoder_create(reader, &decoder, NULL);
    for (unsigned turn = 0; turn < 2; turn++) { /* pools grow, if at all, the second time */
        for (uint64_t f = 0; f < FRAMES && result == GVC_OK; f++) {
            gvc_mesh *mesh;
            result = gvc_decoder_frame(decoder, f, &mesh, NULL);
            gvc_mesh_destroy(&mesh);
        }
    }
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    uint64_t peak = memory_peak();
    if (getenv("GVC_SHOW_PEAKS")) {
        print_message("%zu bytes: limit %llu KiB, peak %llu KiB: %s\n", file->size,
                      (unsigned long long)(max_memory >> 10), (unsigned long long)(peak >> 10),
                      gvc_result_string(result));
    }
    if (peak > max_memory + MEMORY_ALLOWANCE) {
        fail_msg("%llu bytes held; the limit is %llu", (unsigned long long)peak,
                 (unsigned long long)max_memory);
    }
    return result;
}

static void test_sizes(void **state) {
    (void)state;
    static const uint32_t size[] = {16, 49, 97};
    for (unsigned i = 0; i < 3; i++) {
        bytes file = make_video(size[i]);
        bool decoded = false;
        for (uint64_t limit = 1 << 18; limit <= 1 << 28; limit *= 2) {
            gvc_result result = decode_within(&file, limit);
            if (decoded) assert_int_equal(result, GVC_OK); /* more is never worse */
            if (result == GVC_OK) decoded = true;
            if (result != GVC_OK) assert_int_equal(result, GVC_ERROR_LIMIT);
        }
        assert_true(decoded);
        bytes_free(&file);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sizes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
