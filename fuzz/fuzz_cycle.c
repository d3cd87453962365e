/* SPDX-License-Identifier: MIT */
/** @file fuzz_cycle.c  Decodes, encodes what came out, and decodes again.
 *
 * The input is a file. Its first meshes, if small, are encoded, exactly or not as the input's size
 * is odd or even. The new file must be good; its exact codes must come back from both of their
 * codings, and its records from theirs. */
#include "codec/exr.h"
#include "codec/residual.h"
#include "container/shape_record.h"
#include "decoding.h"
#include "encoding.h"
#include "require.h"

#define FRAMES 2u
#define MAX_VERTICES 1500u
#define IMAGE_SIZE 16u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void decode_capture(const gvc_reader *reader, small_capture *capture) {
    gvc_decoder *decoder;
    if (gvc_decoder_create(reader, &decoder, NULL) != GVC_OK) return;
    for (uint64_t f = 0; f < FRAMES; f++) {
        gvc_mesh *mesh;
        if (gvc_decoder_frame(decoder, f, &mesh, NULL) != GVC_OK) break;
        if (gvc_mesh_vertex_count(mesh) <= MAX_VERTICES) {
            capture->mesh[capture->count++] = mesh;
        } else {
            gvc_mesh_destroy(&mesh);
        }
    }
    gvc_decoder_destroy(&decoder);
}

static void check_images(uint32_t size, const uint16_t *codes, const uint16_t *before) {
    const gvc_exr_facts facts = {.step = 1};
    size_t bytes = 3 * (size_t)size * size * sizeof *codes;
    uint16_t *back = malloc(bytes);
    gvc_error error;
    gvc_error_init(&error);
    gvc_buffer image = {0};
    REQUIRE(back);
    REQUIRE(succeeded(gvc_exr_encode(size, codes, &facts, &image, &error), &error));
    REQUIRE(succeeded(gvc_exr_decode(image.data, image.size, size, back, NULL, &error), &error));
    REQUIRE(memcmp(codes, back, bytes) == 0);
    for (unsigned predictor = before ? 0 : GVC_PREDICTOR_KINDS; predictor < GVC_PREDICTOR_KINDS;
         predictor++) {
        gvc_buffer_clear(&image);
        REQUIRE(succeeded(
            gvc_residual_encode(size, codes, before, (gvc_predictor_kind)predictor, &image, &error),
            &error));
        REQUIRE(succeeded(gvc_residual_decode(image.data, image.size, size, before, back, &error),
                          &error));
        REQUIRE(memcmp(codes, back, bytes) == 0);
    }
    gvc_buffer_free(&image);
    free(back);
}

static void check_record(const gvc_reader *reader, uint64_t frame) {
    const gvc_config *config = &reader->demux.config;
    size_t fragment;
    gvc_shape shape, back;
    gvc_shape_frame facts, facts_back;
    gvc_buffer record = {0};
    gvc_error error;
    gvc_error_init(&error);
    REQUIRE(succeeded(gvc_reader_find(reader, frame, &fragment, &error), &error));
    REQUIRE(succeeded(gvc_reader_record(reader, fragment, frame, &shape, &facts, &error), &error));
    REQUIRE(succeeded(gvc_shape_record_write(&shape, &facts, &record, &error), &error));
    REQUIRE(succeeded(gvc_shape_record_read(record.data, record.size, config, SIZE_MAX, &back,
                                            &facts_back, &error),
                      &error));
    REQUIRE(gvc_shape_equal(&shape, &back) && memcmp(&facts, &facts_back, sizeof facts) == 0);
    gvc_shape_free(&shape);
    gvc_shape_free(&back);
    gvc_buffer_free(&record);
}

/** All frames of a good file made here. */
static void check_codes(const gvc_buffer *file, size_t count) {
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_error error;
    uint16_t before[3 * IMAGE_SIZE * IMAGE_SIZE];
    gvc_error_init(&error);
    REQUIRE(
        succeeded(gvc_reader_open_memory(file->data, file->size, NULL, &reader, &error), &error));
    REQUIRE(succeeded(gvc_decoder_create(reader, &decoder, &error), &error));
    for (uint64_t f = 0; f < count; f++) {
        const uint16_t *codes;
        uint32_t size;
        REQUIRE(succeeded(gvc_decoder_codes(decoder, f, 0, &codes, &size, &error), &error));
        REQUIRE(size == IMAGE_SIZE);
        check_images(size, codes, f ? before : NULL);
        memcpy(before, codes, sizeof before);
        check_record(reader, f);
    }
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gvc_read_options limits = decoding_options(true, false);
    gvc_encode_options options;
    gvc_reader *reader;
    small_capture capture = {0};
    gvc_buffer file = {0};
    if (gvc_reader_open_memory(data, size, &limits, &reader, NULL) != GVC_OK) return 0;
    decode_capture(reader, &capture);
    gvc_reader_close(&reader);
    gvc_encode_options_init(&options);
    options.image_size = IMAGE_SIZE;
    options.lossless = size % 2;
    options.crf = 20;
    options.best_effort = true;
    options.threads = 1;
    options.longest_edge = 0.15; /* 50 vertices: as fast as can be */
    if (capture.count && encode_and_check(&capture, &options, &file)) {
        check_codes(&file, capture.count);
    }
    gvc_buffer_free(&file);
    small_capture_free(&capture);
    return 0;
}
