/* SPDX-License-Identifier: MIT */
/** @file exr_frame.c  A frame as an OpenEXR file that needs nothing else. */
#include "exr_frame.h"

#include "base/memory.h"
#include "chart/rebuild.h"
#include "codec/exr.h"
#include "file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CONFIG_NAME "gvcConfig"
#define RECORD_NAME "gvcRecord"
#define FRAME_NAME "gvcFrame"
#define GROUP_NAME "gvcGroup"
#define MAX_RECORD ((size_t)1 << 24) /* bytes of a record expanded */

void gvc_exr_frame_free(gvc_exr_frame *frame) {
    gvc_shape_free(&frame->shape);
    free(frame->codes);
    *frame = (gvc_exr_frame){0};
}

static size_t code_count(const gvc_exr_frame *frame) {
    return (size_t)3 * frame->shape.chart[0].sides.size * frame->shape.chart[0].sides.size;
}

gvc_result gvc_exr_frame_digest(const gvc_exr_frame *frame, uint8_t digest[8], gvc_error *error) {
    gvc_weld weld = {0};
    uint8_t full[32];
    GVC_TRY(gvc_weld_build(&frame->shape.chart[0].sides, &weld, error));
    uint16_t *code = gvc_alloc((size_t)3 * weld.vertex_count, sizeof *code);
    uint32_t *face = gvc_alloc(3 * gvc_rebuild_face_count(&weld), sizeof *face);
    gvc_sha256 *state = gvc_sha256_begin();
    gvc_result result = code && face && state ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        gvc_weld_codes(&weld, frame->codes, code);
        gvc_rebuild_faces(&weld, code, face);
        result = gvc_rebuild_digest_update(state, &weld, code, face, error);
    }
    gvc_sha256_end(state, full);
    memcpy(digest, full, 8);
    free(code);
    free(face);
    gvc_weld_free(&weld);
    return result;
}

/* ----------------------------------------------------------------------------------------- take */

static gvc_result check_taken(const gvc_reader *reader, const gvc_exr_frame *frame,
                              gvc_error *error) {
    uint8_t digest[8];
    GVC_TRY(gvc_exr_frame_digest(frame, digest, error));
    if (memcmp(digest, gvc_reader_digest(reader, &frame->facts), sizeof digest) == 0) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CORRUPT, "the decoded frame does not match its digest");
}

static gvc_result take(const gvc_reader *reader, gvc_decoder *decoder, size_t fragment,
                       gvc_exr_frame *frame, gvc_error *error) {
    gvc_shape own = {0};
    const uint16_t *codes;
    uint32_t size;
    GVC_TRY(gvc_reader_shape(reader, fragment, &frame->shape, error));
    gvc_result result =
        gvc_reader_record(reader, fragment, frame->number, &own, &frame->facts, error);
    gvc_shape_free(&own);
    GVC_TRY(result);
    if (frame->shape.chart_count != 1) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "a frame of %zu charts: an OpenEXR file holds one",
                        frame->shape.chart_count);
    }
    GVC_TRY(gvc_decoder_codes(decoder, frame->number, 0, &codes, &size, error));
    frame->codes = gvc_alloc(code_count(frame), sizeof *frame->codes);
    if (!frame->codes) return gvc_fail_memory(error);
    memcpy(frame->codes, codes, code_count(frame) * sizeof *codes);
    GVC_TRY(check_taken(reader, frame, error));
    memcpy(frame->facts.digest, gvc_reader_digest(reader, &frame->facts),
           sizeof frame->facts.digest);
    frame->facts.same = frame->facts.has_preview = false;
    return GVC_OK;
}

gvc_result gvc_exr_frame_take(const gvc_reader *reader, gvc_decoder *decoder, uint64_t number,
                              gvc_exr_frame *frame, gvc_error *error) {
    size_t fragment;
    *frame = (gvc_exr_frame){.config = reader->demux.config, .number = number};
    GVC_TRY(gvc_reader_find(reader, number, &fragment, error));
    frame->group = reader->demux.fragment[fragment].first_frame;
    gvc_result result = take(reader, decoder, fragment, frame, error);
    if (result != GVC_OK) gvc_exr_frame_free(frame);
    return gvc_at_frame(error, result, (int64_t)number);
}

/* ---------------------------------------------------------------------------------------- write */

/* Two digits for each byte, and a NUL. */
static void write_hex(const gvc_buffer *bytes, gvc_buffer *text) {
    static const char digit[] = "0123456789abcdef";
    for (size_t i = 0; i < bytes->size; i++) {
        gvc_write_u8(text, (uint8_t)digit[bytes->data[i] >> 4]);
        gvc_write_u8(text, (uint8_t)digit[bytes->data[i] & 15]);
    }
    gvc_write_u8(text, 0);
}

static gvc_result describe(const gvc_exr_frame *frame, gvc_buffer *config, gvc_buffer *record,
                           gvc_error *error) {
    gvc_buffer bytes = {0};
    gvc_config_write(&frame->config, &bytes);
    write_hex(&bytes, config);
    bool failed = bytes.failed;
    gvc_buffer_clear(&bytes);
    gvc_result result = gvc_shape_record_write(&frame->shape, &frame->facts, &bytes, error);
    write_hex(&bytes, record);
    failed = failed || bytes.failed || config->failed || record->failed;
    gvc_buffer_free(&bytes);
    return result == GVC_OK && failed ? gvc_fail_memory(error) : result;
}

gvc_result gvc_exr_frame_write(const gvc_exr_frame *frame, gvc_buffer *bytes, gvc_error *error) {
    const gvc_chart_shape *chart = &frame->shape.chart[0];
    const gvc_config *config = &frame->config;
    gvc_exr_facts facts = {.step = chart->step,
                           .time = (double)frame->number * config->frame_rate_den /
                                   config->frame_rate_num};
    memcpy(facts.origin, chart->origin, sizeof facts.origin);
    memcpy(facts.unit, config->unit, sizeof facts.unit);
    char number[24], group[24];
    snprintf(number, sizeof number, "%llu", (unsigned long long)frame->number);
    snprintf(group, sizeof group, "%llu", (unsigned long long)frame->group);
    gvc_buffer config_text = {0}, record_text = {0};
    gvc_result result = describe(frame, &config_text, &record_text, error);
    if (result == GVC_OK) {
        const gvc_exr_text text[] = {{CONFIG_NAME, (const char *)config_text.data},
                                     {RECORD_NAME, (const char *)record_text.data},
                                     {FRAME_NAME, number},
                                     {GROUP_NAME, group}};
        const gvc_exr_options options = {.text = text, .text_count = sizeof text / sizeof *text};
        result =
            gvc_exr_encode_with(chart->sides.size, frame->codes, &facts, &options, bytes, error);
    }
    gvc_buffer_free(&config_text);
    gvc_buffer_free(&record_text);
    return result;
}

/* ----------------------------------------------------------------------------------------- read */

typedef struct exr_bytes {
    const uint8_t *data;
    size_t size;
} exr_bytes;

static int hex_digit(uint8_t c) {
    if (c >= '0' && c <= '9') return c - '0';
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* The bytes that an attribute writes as digits. */
static gvc_result read_hex(exr_bytes file, const char *name, gvc_buffer *bytes, gvc_error *error) {
    gvc_buffer text = {0};
    gvc_result result = gvc_exr_read_text(file.data, file.size, name, &text, error);
    bool wrong = text.size % 2 != 0;
    for (size_t i = 0; result == GVC_OK && i + 1 < text.size; i += 2) {
        int high = hex_digit(text.data[i]), low = hex_digit(text.data[i + 1]);
        wrong = wrong || high < 0 || low < 0;
        gvc_write_u8(bytes, (uint8_t)(wrong ? 0 : high << 4 | low));
    }
    gvc_buffer_free(&text);
    if (result == GVC_OK && bytes->failed) return gvc_fail_memory(error);
    if (result == GVC_OK && wrong) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%s of the OpenEXR file is not hexadecimal",
                        name);
    }
    return result;
}

static gvc_result read_number(exr_bytes file, const char *name, uint64_t *number,
                              gvc_error *error) {
    gvc_buffer text = {0};
    gvc_result result = gvc_exr_read_text(file.data, file.size, name, &text, error);
    bool right = text.size > 0 && text.size < 19; /* of which the greatest fits */
    *number = 0;
    for (size_t i = 0; right && i < text.size; i++) {
        right = text.data[i] >= '0' && text.data[i] <= '9';
        *number = 10 * *number + (uint64_t)(text.data[i] - '0');
    }
    gvc_buffer_free(&text);
    if (result == GVC_OK && !right) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%s of the OpenEXR file is no number", name);
    }
    return result;
}

static gvc_result read_attributes(exr_bytes file, gvc_exr_frame *frame, gvc_error *error) {
    gvc_buffer bytes = {0};
    gvc_result result = read_hex(file, CONFIG_NAME, &bytes, error);
    if (result == GVC_OK) {
        gvc_cursor cursor = gvc_cursor_make(bytes.data, bytes.size);
        result = gvc_config_read(&cursor, &frame->config, error);
    }
    gvc_buffer_clear(&bytes);
    if (result == GVC_OK) result = read_hex(file, RECORD_NAME, &bytes, error);
    if (result == GVC_OK) {
        result = gvc_shape_record_read(bytes.data, bytes.size, &frame->config, MAX_RECORD,
                                       &frame->shape, &frame->facts, error);
    }
    gvc_buffer_free(&bytes);
    if (result == GVC_OK) result = read_number(file, FRAME_NAME, &frame->number, error);
    if (result == GVC_OK) result = read_number(file, GROUP_NAME, &frame->group, error);
    if (result == GVC_OK &&
        (frame->shape.chart_count != 1 || frame->facts.same || frame->facts.has_preview)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "%s of the OpenEXR file is not the whole record of one chart", RECORD_NAME);
    }
    return result;
}

/* The affine map is in the record, too, which holds; a program that moved one moved nothing. */
static gvc_result check_map(const gvc_chart_shape *chart, const gvc_exr_facts *facts,
                            gvc_error *error) {
    if (memcmp(chart->origin, facts->origin, sizeof chart->origin) == 0 &&
        memcmp(&chart->step, &facts->step, sizeof chart->step) == 0) {
        return GVC_OK;
    }
    return gvc_fail(error, GVC_ERROR_CORRUPT,
                    "gvcOrigin and gvcStep of the OpenEXR file are not those of its record");
}

gvc_result gvc_exr_frame_read(const uint8_t *data, size_t data_size, gvc_exr_frame *frame,
                              gvc_error *error) {
    exr_bytes file = {data, data_size};
    gvc_exr_facts facts;
    *frame = (gvc_exr_frame){0};
    gvc_result result = read_attributes(file, frame, error);
    if (result == GVC_OK) {
        frame->codes = gvc_alloc(code_count(frame), sizeof *frame->codes);
        if (!frame->codes) result = gvc_fail_memory(error);
    }
    if (result == GVC_OK) {
        result = gvc_exr_decode(data, data_size, frame->shape.chart[0].sides.size, frame->codes,
                                &facts, error);
    }
    if (result == GVC_OK) result = check_map(&frame->shape.chart[0], &facts, error);
    if (result != GVC_OK) gvc_exr_frame_free(frame);
    return result;
}
