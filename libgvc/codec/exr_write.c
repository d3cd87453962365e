/* SPDX-License-Identifier: MIT */
/** @file exr_write.c  Geometry images as OpenEXR files: writing. */
#include "base/memory.h"
#include "base/utf8.h"
#include "chart/side_table.h"
#include "codec/exr.h"
#include "codec/exr_half.h"

#include <math.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

#define ZIP_LEVEL 9

typedef struct exr_target {
    gvc_buffer *bytes;
    size_t begin; /* where the file begins in `bytes` */
} exr_target;

/* The library would print to stderr; results say enough. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

/* Writes come in any order: the table of chunks is filled in at the end. */
static int64_t write_at(exr_const_context_t context, void *user, const void *data, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    static const uint8_t zeros[256];
    exr_target *target = user;
    gvc_buffer *bytes = target->bytes;
    size_t position;
    if (!gvc_add(target->begin, (size_t)offset, &position)) return -1;
    while (!bytes->failed && bytes->size < position) {
        size_t gap = position - bytes->size;
        gvc_write_bytes(bytes, zeros, gap < sizeof zeros ? gap : sizeof zeros);
    }
    size_t over = bytes->size - position;
    if (over > size) over = (size_t)size;
    if (over && !bytes->failed) memcpy(bytes->data + position, data, over);
    gvc_write_bytes(bytes, (const uint8_t *)data + over, (size_t)size - over);
    return bytes->failed ? -1 : (int64_t)size;
}

static exr_result_t describe(exr_context_t file, uint32_t size, const gvc_exr_facts *facts,
                             const gvc_exr_options *options) {
    int part;
    exr_attr_v3d_t origin = {{{facts->origin[0], facts->origin[1], facts->origin[2]}}};
    exr_result_t status = exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part);
    if (!status) {
        status = exr_initialize_required_attr_simple(file, part, (int32_t)size, (int32_t)size,
                                                     options->piz ? EXR_COMPRESSION_PIZ
                                                                  : EXR_COMPRESSION_ZIP);
    }
    for (unsigned c = 0; !status && c < GVC_EXR_CHANNELS; c++) {
        status = exr_add_channel(file, part, gvc_exr_channel_name[c], EXR_PIXEL_HALF,
                                 EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    if (!status) status = exr_attr_set_int(file, part, GVC_EXR_VERSION_NAME, GVC_EXR_VERSION);
    if (!status) status = exr_attr_set_v3d(file, part, GVC_EXR_ORIGIN_NAME, &origin);
    if (!status) status = exr_attr_set_double(file, part, GVC_EXR_STEP_NAME, facts->step);
    if (!status) status = exr_attr_set_double(file, part, GVC_EXR_TIME_NAME, facts->time);
    if (!status && facts->unit[0]) {
        status = exr_attr_set_string(file, part, GVC_EXR_UNIT_NAME, facts->unit);
    }
    for (size_t i = 0; !status && i < options->text_count; i++) {
        status = exr_attr_set_string(file, part, options->text[i].name, options->text[i].value);
    }
    return status ? status : exr_write_header(file);
}

/* Rows y ... y + rows - 1 of all channels, one channel after the other. */
static void fill_rows(uint32_t size, const uint16_t *codes, uint32_t y, uint32_t rows,
                      uint16_t *half) {
    for (unsigned c = 0; c < GVC_EXR_CHANNELS; c++) {
        const uint16_t *code = codes + (size_t)(c / 2) * size * size + (size_t)y * size;
        for (size_t i = 0; i < (size_t)rows * size; i++) {
            *half++ = c % 2 ? gvc_exr_low(code[i]) : gvc_exr_high(code[i]);
        }
    }
}

static exr_result_t write_chunk(exr_context_t file, uint32_t size, const uint16_t *codes,
                                uint32_t y, exr_encode_pipeline_t *pipeline, uint16_t *half) {
    exr_chunk_info_t chunk;
    exr_result_t status = exr_write_scanline_chunk_info(file, 0, (int)y, &chunk);
    if (status) return status;
    status = y == 0 ? exr_encoding_initialize(file, 0, &chunk, pipeline)
                    : exr_encoding_update(file, 0, &chunk, pipeline);
    if (status) return status;
    fill_rows(size, codes, y, (uint32_t)chunk.height, half);
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->user_pixel_stride = sizeof *half;
        channel->user_line_stride = (int32_t)(size * sizeof *half);
        channel->encode_from_ptr = (const uint8_t *)(half + (size_t)c * chunk.height * size);
    }
    if (y == 0) status = exr_encoding_choose_default_routines(file, 0, pipeline);
    return status ? status : exr_encoding_run(file, 0, pipeline);
}

static exr_result_t write_chunks(exr_context_t file, uint32_t size, const uint16_t *codes) {
    int32_t lines;
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t status = exr_get_scanlines_per_chunk(file, 0, &lines);
    if (status) return status;
    uint16_t *half = gvc_alloc((size_t)lines * size, GVC_EXR_CHANNELS * sizeof *half);
    if (!half) return EXR_ERR_OUT_OF_MEMORY;
    for (uint32_t y = 0; !status && y < size; y += (uint32_t)lines) {
        status = write_chunk(file, size, codes, y, &pipeline, half);
    }
    exr_encoding_destroy(file, &pipeline);
    free(half);
    return status;
}

static gvc_result check_facts(uint32_t size, const gvc_exr_facts *facts, gvc_error *error) {
    const double *origin = facts->origin;
    bool finite = isfinite(origin[0]) && isfinite(origin[1]) && isfinite(origin[2]) &&
                  isfinite(facts->step) && isfinite(facts->time);
    if (size < GVC_MIN_IMAGE_SIZE || size > GVC_MAX_IMAGE_SIZE || !finite || facts->step <= 0 ||
        !memchr(facts->unit, 0, sizeof facts->unit) ||
        !gvc_utf8_is_plain((const uint8_t *)facts->unit, strlen(facts->unit))) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "an OpenEXR image of %u samples a side, step %g",
                        size, facts->step);
    }
    return GVC_OK;
}

gvc_result gvc_exr_encode(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts,
                          gvc_buffer *bytes, gvc_error *error) {
    const gvc_exr_options plain = {0};
    return gvc_exr_encode_with(size, codes, facts, &plain, bytes, error);
}

gvc_result gvc_exr_encode_with(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts,
                               const gvc_exr_options *options, gvc_buffer *bytes,
                               gvc_error *error) {
    GVC_TRY(check_facts(size, facts, error));
    exr_target target = {bytes, bytes->size};
    exr_context_t file = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_quiet;
    init.user_data = &target;
    init.write_fn = write_at;
    init.zip_level = ZIP_LEVEL;
    exr_result_t status = exr_start_write(&file, "image.exr", EXR_WRITE_FILE_DIRECTLY, &init);
    if (!status) status = describe(file, size, facts, options);
    if (!status) status = write_chunks(file, size, codes);
    exr_result_t finished = file ? exr_finish(&file) : EXR_ERR_SUCCESS;
    if (!status) status = finished;
    if (status == EXR_ERR_OUT_OF_MEMORY || bytes->failed) return gvc_fail_memory(error);
    if (status) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "OpenEXR: %s",
                        exr_get_default_error_message(status));
    }
    return GVC_OK;
}
