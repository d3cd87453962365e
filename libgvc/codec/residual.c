/* SPDX-License-Identifier: MIT */
/** @file residual.c  Lossless coding of geometry images against a prediction. */
#include "codec/residual.h"

#include "base/memory.h"
#include "chart/side_table.h"
#include "codec/residual_bits.h"

#include <stdlib.h>
#include <string.h>

#define MAX_EXPONENT 15
#define ACTIVITIES 72 /* m has at most 19 bits: 4 * (19 - 2) + 3 is the greatest */
#define MODELLED_BITS 3

typedef struct models {
    gvc_bit_model exponent[ACTIVITIES][MAX_EXPONENT];
    gvc_bit_model mantissa[MAX_EXPONENT + 1][1 << MODELLED_BITS];
    gvc_bit_model sign[9];
} bit_models;

/** An image on its way through the coder, in either direction. */
typedef struct image_coder {
    uint32_t size;
    const uint16_t *codes;
    uint16_t *decoded; /* `codes` to be filled; NULL in an encoder */
    gvc_bit_coder bits;
    gvc_predictor *predictor;
    bit_models *models;
    int32_t *residual[3]; /* the last three rows, y mod 3, each with a margin of two samples at both
                             ends: 3 components a sample */
} image_coder;

#define MARGIN 2

/* -------------------------------------------------------------------------------------- one value
 */

static unsigned bit_length(uint32_t value) {
    unsigned bits = 0;
    while (value >> bits) bits++;
    return bits;
}

static unsigned activity_class(uint32_t m) {
    if (m < 4) return m;
    unsigned bits = bit_length(m);
    return 4 * (bits - 2) + (m >> (bits - 3) & 3);
}

/* Codes u + 1 >= 1, see residual.h, 1 and 2. */
static uint32_t code_magnitude(gvc_bit_coder *bits, bit_models *models, unsigned activity,
                               uint32_t value) {
    unsigned exponent = 0, wanted = bit_length(value) - 1;
    while (exponent < MAX_EXPONENT &&
           gvc_bit_code(bits, &models->exponent[activity][exponent], exponent < wanted)) {
        exponent++;
    }
    uint32_t coded = 1;
    for (unsigned i = 0; i < exponent; i++) {
        unsigned bit = value >> (exponent - 1 - i) & 1;
        bit = i < MODELLED_BITS ? gvc_bit_code(bits, &models->mantissa[exponent][coded], bit)
                                : gvc_bit_code_even(bits, bit);
        coded = 2 * coded + bit;
    }
    return coded;
}

static int32_t code_residual(gvc_bit_coder *bits, bit_models *models, unsigned activity,
                             unsigned signs, int32_t residual) {
    uint32_t magnitude = (uint32_t)(residual < 0 ? -residual : residual);
    magnitude = code_magnitude(bits, models, activity, magnitude + 1) - 1;
    if (magnitude == 0) return 0;
    unsigned negative = gvc_bit_code(bits, &models->sign[signs], residual < 0);
    return negative ? -(int32_t)magnitude : (int32_t)magnitude;
}

/* -------------------------------------------------------------------------------------- one image
 */

static uint32_t magnitude_at(const int32_t *row, int offset) {
    return (uint32_t)abs(row[3 * offset]);
}

/* `row`, `above` and `above2` point at component k of the sample in its row and in those above. */
static unsigned activity_of(const int32_t *row, const int32_t *above, const int32_t *above2,
                            unsigned k) {
    uint32_t sum = 2 * magnitude_at(row, -1) + 2 * magnitude_at(above, 0) +
                   magnitude_at(above, -1) + magnitude_at(above, 1) + magnitude_at(row, -2) +
                   magnitude_at(above2, 0);
    for (unsigned i = 1; i <= k; i++) sum += 2 * (uint32_t)abs(row[-(int)i]);
    return activity_class(sum * 8 / (8 + 2 * k));
}

static int32_t wrapped(int32_t difference) {
    uint32_t low = (uint32_t)difference & UINT16_MAX;
    return low > INT16_MAX ? (int32_t)low - (UINT16_MAX + 1) : (int32_t)low;
}

/* False if the residual read is none. */
static bool code_sample(image_coder *coder, uint32_t x, uint32_t y) {
    size_t plane = (size_t)coder->size * coder->size, at = (size_t)y * coder->size + x;
    size_t column = 3 * ((size_t)x + MARGIN);
    int32_t *row = coder->residual[y % 3] + column;
    const int32_t *above = coder->residual[(y + 2) % 3] + column;
    const int32_t *above2 = coder->residual[(y + 1) % 3] + column;
    int32_t expected[3];
    unsigned signs = 0;
    gvc_predict(coder->predictor, x, y, expected);
    for (unsigned k = 0; k < 3; k++, at += plane) {
        unsigned activity = activity_of(row + k, above + k, above2 + k, k);
        int32_t residual = coder->decoded ? 0 : wrapped(coder->codes[at] - expected[k]);
        residual = code_residual(&coder->bits, coder->models, activity, signs, residual);
        if (residual < INT16_MIN || residual > INT16_MAX) return false;
        if (coder->decoded) coder->decoded[at] = (uint16_t)(expected[k] + residual);
        row[k] = residual;
        signs = 3 * signs + (residual > 0 ? 1 : residual < 0 ? 2 : 0);
    }
    gvc_predict_learn(coder->predictor, x, y);
    return true;
}

static gvc_result code_rows(image_coder *coder, gvc_error *error) {
    for (uint32_t y = 0; y < coder->size; y++) {
        for (uint32_t x = 0; x < coder->size; x++) {
            if (!code_sample(coder, x, y)) {
                return gvc_fail(error, GVC_ERROR_CORRUPT,
                                "the residual at column %u, row %u does not fit 16 bits", x, y);
            }
        }
        if (coder->bits.in.failed) {
            return gvc_fail(error, GVC_ERROR_CORRUPT, "the residuals end in row %u of %u", y,
                            coder->size);
        }
    }
    return GVC_OK;
}

/* Codes the image that `coder` names, with all that this takes besides. */
static gvc_result code_image(image_coder *coder, gvc_predictor_kind kind, const uint16_t *previous,
                             gvc_error *error) {
    size_t row = 3 * ((size_t)coder->size + 2 * MARGIN);
    size_t samples = 3 * (size_t)coder->size * coder->size;
    uint16_t *nothing = previous ? NULL : gvc_alloc(samples, sizeof *nothing);
    coder->models = gvc_alloc(1, sizeof *coder->models);
    coder->residual[0] = gvc_alloc(3 * row, sizeof *coder->residual[0]);
    bool room = (previous || nothing) && coder->models && coder->residual[0];
    gvc_result result = room ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        for (unsigned i = 1; i < 3; i++) coder->residual[i] = coder->residual[0] + i * row;
        gvc_bit_models_init((gvc_bit_model *)coder->models,
                            sizeof(bit_models) / sizeof(gvc_bit_model));
        result = gvc_predictor_create(kind, coder->size, coder->codes,
                                      previous ? previous : nothing, &coder->predictor, error);
    }
    if (result == GVC_OK) result = code_rows(coder, error);
    gvc_predictor_destroy(&coder->predictor);
    free(coder->models);
    free(coder->residual[0]);
    free(nothing);
    return result;
}

/* ------------------------------------------------------------------------------------ whole sample
 */

static bool size_is_legal(uint32_t size) {
    return size >= GVC_MIN_IMAGE_SIZE && size <= GVC_MAX_IMAGE_SIZE;
}

gvc_result gvc_residual_encode(uint32_t size, const uint16_t *codes, const uint16_t *previous,
                               gvc_predictor_kind predictor, gvc_buffer *bytes, gvc_error *error) {
    if (!size_is_legal(size) || (unsigned)predictor >= GVC_PREDICTOR_KINDS) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "no image of %u samples a side, predictor %u",
                        size, (unsigned)predictor);
    }
    gvc_write_u8(bytes, (uint8_t)predictor);
    gvc_write_u8(bytes, previous != NULL);
    gvc_write_u16(bytes, (uint16_t)size);
    image_coder coder = {.size = size, .codes = codes, .bits = gvc_bit_encoder(bytes)};
    GVC_TRY(code_image(&coder, predictor, previous, error));
    gvc_bit_encoder_end(&coder.bits);
    return bytes->failed ? gvc_fail_memory(error) : GVC_OK;
}

static gvc_result read_head(gvc_cursor *cursor, uint32_t size, gvc_predictor_kind *predictor,
                            bool *refers, gvc_error *error) {
    unsigned kind = gvc_read_u8(cursor), reference = gvc_read_u8(cursor);
    unsigned coded_size = gvc_read_u16(cursor);
    if (cursor->failed) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are too few for a residual image",
                        cursor->size);
    }
    if (kind >= GVC_PREDICTOR_KINDS || reference > 1) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "a residual image of predictor %u, reference %u", kind, reference);
    }
    if (coded_size != size) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a residual image of %u samples a side, not %u",
                        coded_size, size);
    }
    *predictor = (gvc_predictor_kind)kind;
    *refers = reference;
    return GVC_OK;
}

gvc_result gvc_residual_decode(const uint8_t *data, size_t data_size, uint32_t size,
                               const uint16_t *previous, uint16_t *codes, gvc_error *error) {
    gvc_cursor cursor = gvc_cursor_make(data, data_size);
    gvc_predictor_kind predictor = GVC_PREDICTOR_GRADIENT;
    bool refers = false;
    if (!size_is_legal(size)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "no image of %u samples a side", size);
    }
    GVC_TRY(read_head(&cursor, size, &predictor, &refers, error));
    if (refers && !previous) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a residual image without the frame before it");
    }
    size_t left = gvc_cursor_left(&cursor);
    image_coder coder = {.size = size, .codes = codes, .decoded = codes};
    coder.bits = gvc_bit_decoder(gvc_read_bytes(&cursor, left), left);
    GVC_TRY(code_image(&coder, predictor, refers ? previous : NULL, error));
    if (!gvc_bit_decoder_ended(&coder.bits)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "bytes are left after the last residual, or wrong");
    }
    return GVC_OK;
}
