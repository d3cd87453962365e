/* SPDX-License-Identifier: MIT */
/** @file decoder_exact.c  Decodes the exact track. */
#include "decoder_exact.h"

#include "base/memory.h"
#include "codec/exact_sample.h"

#include <stdio.h>
#include <stdlib.h>

static size_t chart_codes(const gvc_chart_shape *chart) {
    return (size_t)3 * chart->sides.size * chart->sides.size;
}

uint64_t gvc_exact_decoder_memory(const gvc_config *config) {
    /* charts do not overlap, so all of them have no more samples than a plane */
    uint64_t samples = (uint64_t)config->picture_width * config->plane_height;
    return samples * 2 * 3 * sizeof(uint16_t) + gvc_exact_image_memory(config->image_size);
}

void gvc_exact_decoder_free(gvc_exact_decoder *decoder) {
    gvc_buffer_free(&decoder->sample);
    free(decoder->codes);
    free(decoder->before);
    *decoder = (gvc_exact_decoder){0};
}

gvc_result gvc_exact_decoder_begin(gvc_exact_decoder *decoder, const gvc_shape *shape,
                                   uint64_t most_bytes, gvc_error *error) {
    size_t count = 0;
    for (size_t c = 0; c < shape->chart_count; c++) count += chart_codes(&shape->chart[c]);
    if (decoder->code_count != count) gvc_exact_decoder_free(decoder);
    decoder->most_bytes = most_bytes;
    decoder->next = 0;
    decoder->end = SIZE_MAX;
    if (decoder->code_count == count) return GVC_OK;
    decoder->codes = gvc_alloc(count, sizeof *decoder->codes);
    decoder->before = gvc_alloc(count, sizeof *decoder->before);
    if (!decoder->codes || !decoder->before) {
        gvc_exact_decoder_free(decoder);
        return gvc_fail_memory(error);
    }
    decoder->code_count = count;
    return GVC_OK;
}

/* The bytes of the next chart of a sample: all that is left if the frame has one chart, else as
 * many as the number before them says. */
static gvc_result next_image(gvc_cursor *cursor, size_t chart_count, const uint8_t **data,
                             size_t *size, gvc_error *error) {
    *size = chart_count > 1 ? gvc_read_u32(cursor) : gvc_cursor_left(cursor);
    *data = gvc_read_bytes(cursor, *size);
    if (!cursor->failed) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CORRUPT, "an exact image ends early");
}

/* Decodes decoder->sample to decoder->codes; decoder->before is the frame before, if `follows`. */
static gvc_result decode_sample(gvc_exact_decoder *decoder, const gvc_shape *shape, bool follows,
                                gvc_error *error) {
    gvc_cursor cursor = gvc_cursor_make(decoder->sample.data, decoder->sample.size);
    size_t at = 0;
    for (size_t c = 0; c < shape->chart_count; c++) {
        const uint8_t *data;
        size_t size;
        GVC_TRY(next_image(&cursor, shape->chart_count, &data, &size, error));
        if (!follows && !gvc_exact_image_is_key(data, size)) {
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "the first exact image of a fragment is no OpenEXR file");
        }
        GVC_TRY(gvc_exact_image_decode(data, size, shape->chart[c].sides.size,
                                       follows ? decoder->before + at : NULL, decoder->codes + at,
                                       error));
        at += chart_codes(&shape->chart[c]);
    }
    if (gvc_cursor_left(&cursor) == 0) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are left after the last exact image",
                    gvc_cursor_left(&cursor));
}

static gvc_result decode_next(gvc_exact_decoder *decoder, const gvc_reader *reader,
                              const gvc_fragment_entry *fragment, const gvc_shape *shape,
                              gvc_error *error) {
    const gvc_demux *demux = &reader->demux;
    size_t index = fragment->first_sample[GVC_TRACK_EXACT] + decoder->next;
    const gvc_sample_entry *entry = &demux->sample[GVC_TRACK_EXACT][index];
    GVC_TRY(gvc_demux_read(demux, &reader->io, GVC_TRACK_EXACT, index, decoder->most_bytes,
                           &decoder->sample, error));
    uint16_t *codes = decoder->before;
    decoder->before = decoder->codes;
    decoder->codes = codes;
    gvc_result result = decode_sample(decoder, shape, decoder->next > 0, error);
    decoder->next++;
    if (result != GVC_OK && error && error->offset == GVC_NO_OFFSET) {
        error->offset = entry->offset;
        snprintf(error->where, sizeof error->where, "mdat/exact image");
    }
    return gvc_at_frame(error, result, (int64_t)entry->presentation);
}

gvc_result gvc_exact_decoder_seek(gvc_exact_decoder *decoder, const gvc_reader *reader,
                                  size_t fragment, uint64_t frame, const gvc_shape *shape,
                                  gvc_error *error) {
    const gvc_fragment_entry *entry = &reader->demux.fragment[fragment];
    size_t place = (size_t)(frame - entry->first_frame);
    gvc_error defect = decoder->defect;
    gvc_result result = place < decoder->end ? GVC_OK : defect.code;
    if (result == GVC_OK) gvc_error_init(&defect);
    if (decoder->next > place + 1) decoder->next = 0;
    while (result == GVC_OK && decoder->next <= place) {
        size_t at = decoder->next;
        result = decode_next(decoder, reader, entry, shape, &defect);
        if (result == GVC_OK) continue;
        decoder->next = 0; /* the codes of the frame before have been given up */
        if (result != GVC_ERROR_CORRUPT) continue;
        decoder->end = at;
        decoder->defect = defect;
    }
    if (result != GVC_OK && error) *error = defect;
    return result;
}

const uint16_t *gvc_exact_decoder_chart(const gvc_exact_decoder *decoder, const gvc_shape *shape,
                                        size_t chart) {
    const uint16_t *codes = decoder->codes;
    for (size_t c = 0; c < chart; c++) codes += chart_codes(&shape->chart[c]);
    return codes;
}
