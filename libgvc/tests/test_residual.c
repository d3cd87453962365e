/* SPDX-License-Identifier: MIT */
/** @file test_residual.c  Residual images: round trip, prediction by its definition, damaged
 * samples, and the range coder below. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/digest.h"
#include "codec/residual.h"
#include "codec/residual_bits.h"
#include "image_maker.h"

static const gvc_predictor_kind kinds[] = {GVC_PREDICTOR_GRADIENT, GVC_PREDICTOR_SQUARES};

/* ------------------------------------------------------------------------------------ range coder
 */

/** Bits of all skews, long runs of the unlikely one included, so that carries go far. */
static void test_bits_come_back(void **state) {
    (void)state;
    enum { COUNT = 200000, MODELS = 16 };
    uint32_t random = 3;
    uint8_t *bit = malloc(COUNT);
    gvc_buffer bytes = {0};
    gvc_write_u8(&bytes, 77);
    gvc_bit_coder coder = gvc_bit_encoder(&bytes);
    gvc_bit_model model[MODELS];
    gvc_bit_models_init(model, MODELS);
    for (unsigned i = 0; i < COUNT; i++) {
        unsigned m = i % MODELS;
        bit[i] = i / 997 % 3 == 0 ? 1 : image_random(&random) % (m + 1) == 0;
        unsigned coded =
            m == 0 ? gvc_bit_code_even(&coder, bit[i]) : gvc_bit_code(&coder, &model[m], bit[i]);
        assert_int_equal(coded, bit[i]);
    }
    gvc_bit_encoder_end(&coder);
    assert_int_equal(bytes.data[0], 77);
    gvc_bit_models_init(model, MODELS);
    coder = gvc_bit_decoder(bytes.data + 1, bytes.size - 1);
    for (unsigned i = 0; i < COUNT; i++) {
        unsigned m = i % MODELS;
        unsigned coded = m == 0 ? gvc_bit_code_even(&coder, 0) : gvc_bit_code(&coder, &model[m], 0);
        assert_int_equal(coded, bit[i]);
        if (i < COUNT - 100) assert_false(gvc_bit_decoder_ended(&coder) && coder.in.failed);
    }
    assert_true(gvc_bit_decoder_ended(&coder));
    gvc_buffer_free(&bytes);
    free(bit);
}

static void test_probabilities_stay_inside(void **state) {
    (void)state;
    gvc_buffer bytes = {0};
    for (unsigned bit = 0; bit < 2; bit++) {
        gvc_bit_model model;
        gvc_bit_models_init(&model, 1);
        gvc_bit_coder coder = gvc_bit_encoder(&bytes);
        for (unsigned i = 0; i < 10000; i++) {
            gvc_bit_code(&coder, &model, bit);
            assert_in_range(model.zero, 1, 32767);
        }
    }
    assert_true(bytes.size < 60); /* what is certain costs next to nothing */
    gvc_buffer_free(&bytes);
}

/* ------------------------------------------------------------------------------------- round trip
 */

static gvc_buffer encoded(uint32_t size, const uint16_t *codes, const uint16_t *previous,
                          gvc_predictor_kind kind) {
    gvc_buffer bytes = {0};
    assert_int_equal(gvc_residual_encode(size, codes, previous, kind, &bytes, NULL), GVC_OK);
    return bytes;
}

static gvc_result decoded(const gvc_buffer *bytes, uint32_t size, const uint16_t *previous,
                          uint16_t *codes, gvc_error *error) {
    /* Exactly as large as the sample, so that a sanitizer sees a read past the end. */
    uint8_t *copy = malloc(bytes->size ? bytes->size : 1);
    assert_non_null(copy);
    if (bytes->size) memcpy(copy, bytes->data, bytes->size);
    gvc_result result = gvc_residual_decode(copy, bytes->size, size, previous, codes, error);
    free(copy);
    return result;
}

/** Bytes of the sample, after it has been decoded. */
static size_t round_trip(uint32_t size, const uint16_t *codes, const uint16_t *previous,
                         gvc_predictor_kind kind) {
    size_t count = image_samples(size);
    uint16_t *back = malloc(count * sizeof *back);
    gvc_buffer bytes = encoded(size, codes, previous, kind);
    gvc_error error;
    if (decoded(&bytes, size, previous, back, &error) != GVC_OK) fail_msg("%s", error.message);
    assert_memory_equal(back, codes, count * sizeof *back);
    size_t result = bytes.size;
    gvc_buffer_free(&bytes);
    free(back);
    return result;
}

static void test_round_trip(void **state) {
    (void)state;
    static const uint32_t size[] = {16, 17, 23};
    for (unsigned s = 0; s < sizeof size / sizeof *size; s++) {
        uint16_t *image[IMAGE_KINDS];
        for (unsigned i = 0; i < IMAGE_KINDS; i++) image[i] = image_make(size[s], (image_kind)i);
        for (unsigned i = 0; i < IMAGE_KINDS; i++) {
            for (unsigned k = 0; k < 2; k++) {
                round_trip(size[s], image[i], NULL, kinds[k]);
                for (unsigned j = 0; j < IMAGE_KINDS; j++) {
                    round_trip(size[s], image[i], image[j], kinds[k]);
                }
            }
        }
        for (unsigned i = 0; i < IMAGE_KINDS; i++) free(image[i]);
    }
}

/** Nearly a still, which takes one bit a code and not ten. */
static void test_greatest_image(void **state) {
    (void)state;
    size_t count = image_samples(2049);
    uint16_t *codes = image_make(2049, IMAGE_FLAT), *back = image_make(2049, IMAGE_FLAT);
    for (size_t i = 0; i < count; i += count / 100) codes[i] = (uint16_t)(i / 3);
    codes[count - 1] = 5;
    gvc_buffer bytes = encoded(2049, codes, back, GVC_PREDICTOR_GRADIENT);
    uint16_t *previous = image_make(2049, IMAGE_FLAT);
    memset(back, 0, count * sizeof *back);
    assert_int_equal(decoded(&bytes, 2049, previous, back, NULL), GVC_OK);
    assert_memory_equal(back, codes, count * sizeof *codes);
    gvc_buffer_free(&bytes);
    free(codes);
    free(back);
    free(previous);
}

static void test_a_still_costs_nothing(void **state) {
    (void)state;
    uint16_t *codes = image_make(64, IMAGE_NOISE);
    for (unsigned k = 0; k < 2; k++) {
        assert_true(round_trip(64, codes, codes, kinds[k]) < 60);
        assert_in_range(round_trip(64, codes, NULL, kinds[k]), 24400, 25000); /* raw: 24,576 */
    }
    free(codes);
}

/** What least squares are for: a surface that moves while the samples slide over it. */
static void test_sliding_is_learned(void **state) {
    (void)state;
    uint16_t *before = image_make(64, IMAGE_SMOOTH), *after = image_make(64, IMAGE_SLID);
    size_t gradient = round_trip(64, after, before, GVC_PREDICTOR_GRADIENT);
    size_t squares = round_trip(64, after, before, GVC_PREDICTOR_SQUARES);
    assert_true(squares < gradient * 3 / 4);
    free(before);
    free(after);
}

/** Bytes that any machine must write: images are made of integers, and so is what they become. */
static void test_known_bytes(void **state) {
    (void)state;
    static const uint32_t crc[2][2] = {{0x4456fc07, 0x50a7443d}, {0x93cf5df7, 0x4964f130}};
    uint16_t *before = image_make(33, IMAGE_SMOOTH), *after = image_make(33, IMAGE_SLID);
    for (unsigned k = 0; k < 2; k++) {
        for (unsigned reference = 0; reference < 2; reference++) {
            gvc_buffer bytes = encoded(33, after, reference ? before : NULL, kinds[k]);
            assert_int_equal(bytes.data[0], k);
            assert_int_equal(bytes.data[1], reference);
            assert_int_equal(bytes.data[2] << 8 | bytes.data[3], 33);
            assert_int_equal(gvc_crc32(0, bytes.data, bytes.size), crc[k][reference]);
            gvc_buffer_free(&bytes);
        }
    }
    free(before);
    free(after);
}

/* ------------------------------------------------------------------------------------- prediction
 */

#define SIZE 56u
#define TERMS 18

static long double code_at(const uint16_t *image, unsigned k, int x, int y) {
    return image[(k * SIZE + (unsigned)y) * SIZE + (unsigned)x];
}

/** Terms of a sample at least two away from the border, in any order that suits; and what is
 * sought.
 */
static void terms_at(const uint16_t *codes, const uint16_t *previous, unsigned k, int x, int y,
                     long double term[TERMS], long double *sought) {
    long double here = code_at(previous, k, x, y);
    unsigned n = 0;
    for (int dy = -2; dy <= 1; dy++) {
        for (int dx = -2; dx <= 2; dx++) {
            int far = abs(dx) > abs(dy) ? abs(dx) : abs(dy);
            bool near = far == 1 || (far == 2 && (dx == 0 || dy == 0) && dx <= 0 && dy <= 0);
            bool corner = dx == 2 && dy == -1;
            if (!near && !corner) continue;
            term[n++] = code_at(previous, k, x + dx, y + dy) - here;
            if (dy > 0 || (dy == 0 && dx > 0)) continue;
            term[n++] = code_at(codes, k, x + dx, y + dy) - here;
        }
    }
    assert_int_equal(n, TERMS);
    *sought = code_at(codes, k, x, y) - here;
}

static void eliminate(long double a[TERMS][TERMS + 1], long double *weight) {
    for (int j = 0; j < TERMS; j++) {
        for (int i = 0; i < TERMS; i++) {
            if (i == j) continue;
            long double factor = a[i][j] / a[j][j];
            for (int k = j; k <= TERMS; k++) a[i][k] -= factor * a[j][k];
        }
    }
    for (int i = 0; i < TERMS; i++) weight[i] = a[i][TERMS] / a[i][i];
}

/** The weighted least squares of predict_squares.h, straight from its definition. Samples near the
 * border are left out on both sides by weights that have died away there. */
static long double squares_by_definition(const uint16_t *codes, const uint16_t *previous, int x,
                                         int y, unsigned component) {
    long double a[TERMS][TERMS + 1] = {{0}}, weight[TERMS], term[TERMS], sought, sum = 0;
    for (int v = 2; v <= y; v++) {
        for (int u = 2; u < (int)SIZE - 2 && (v < y || u < x); u++) {
            long double share = ldexpl(1, -(y - v + abs(x - u)));
            for (unsigned k = 0; k < 3; k++) {
                terms_at(codes, previous, k, u, v, term, &sought);
                for (int i = 0; i < TERMS; i++) {
                    for (int j = 0; j < TERMS; j++) a[i][j] += share * term[i] * term[j];
                    a[i][TERMS] += share * term[i] * sought;
                }
            }
        }
    }
    for (int i = 0; i < TERMS; i++) a[i][i] += a[i][i] / 65536 + 1;
    eliminate(a, weight);
    terms_at(codes, previous, component, x, y, term, &sought);
    for (int i = 0; i < TERMS; i++) sum += weight[i] * term[i];
    return code_at(previous, component, x, y) + sum;
}

static void test_squares_by_definition(void **state) {
    (void)state;
    uint16_t *before = image_make(SIZE, IMAGE_SMOOTH), *after = image_make(SIZE, IMAGE_SLID);
    gvc_predictor *predictor;
    assert_int_equal(
        gvc_predictor_create(GVC_PREDICTOR_SQUARES, SIZE, after, before, &predictor, NULL), GVC_OK);
    unsigned compared = 0;
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            int32_t expected[3];
            gvc_predict(predictor, x, y, expected);
            gvc_predict_learn(predictor, x, y);
            if (x != SIZE / 2 || y < SIZE - 6 || y == SIZE - 1) continue;
            for (unsigned k = 0; k < 3; k++, compared++) {
                long double value = squares_by_definition(after, before, (int)x, (int)y, k);
                assert_true(fabsl(value - expected[k]) < 0.6L);
            }
        }
    }
    assert_int_equal(compared, 3 * 5);
    gvc_predictor_destroy(&predictor);
    free(before);
    free(after);
}

static void test_gradient_by_hand(void **state) {
    (void)state;
    uint16_t codes[3 * 16 * 16] = {0}, previous[3 * 16 * 16];
    for (unsigned i = 0; i < 3 * 256; i++) previous[i] = 1000;
    codes[0] = 1010, codes[1] = 1030, codes[16] = 1005; /* differences 10, 30; 5 */
    gvc_predictor *predictor;
    assert_int_equal(
        gvc_predictor_create(GVC_PREDICTOR_GRADIENT, 16, codes, previous, &predictor, NULL),
        GVC_OK);
    int32_t expected[3];
    gvc_predict(predictor, 0, 0, expected);
    assert_int_equal(expected[0], 1000);
    assert_int_equal(expected[2], 1000);
    gvc_predict(predictor, 1, 0, expected);
    assert_int_equal(expected[0], 1010);
    gvc_predict(predictor, 0, 1, expected);
    assert_int_equal(expected[0], 1010);
    gvc_predict(predictor, 1, 1, expected); /* 5 + 30 - 10 */
    assert_int_equal(expected[0], 1025);
    codes[0] = 1040; /* a corner above both: the lesser of them */
    gvc_predict(predictor, 1, 1, expected);
    assert_int_equal(expected[0], 1005);
    codes[0] = 1001; /* below both: the greater */
    gvc_predict(predictor, 1, 1, expected);
    assert_int_equal(expected[0], 1030);
    gvc_predictor_destroy(&predictor);
}

/* ---------------------------------------------------------------------------------------- damage
 */

typedef struct sample {
    uint16_t *codes, *previous, *back;
    gvc_buffer bytes;
} sample;

static sample sample_make(gvc_predictor_kind kind) {
    sample s = {.codes = image_make(16, IMAGE_SLID), .previous = image_make(16, IMAGE_SMOOTH)};
    s.back = malloc(image_samples(16) * sizeof *s.back);
    s.bytes = encoded(16, s.codes, s.previous, kind);
    return s;
}

static void sample_free(sample *s) {
    free(s->codes);
    free(s->previous);
    free(s->back);
    gvc_buffer_free(&s->bytes);
}

/** Of changed bytes: 0 if they are refused, 1 if they are the sample of another image, which one
 * bit coded with even odds is enough for. */
static unsigned is_refused_or_another(sample *s) {
    gvc_result result = decoded(&s->bytes, 16, s->previous, s->back, NULL);
    if (result == GVC_ERROR_CORRUPT) return 0;
    assert_int_equal(result, GVC_OK);
    assert_memory_not_equal(s->back, s->codes, image_samples(16) * sizeof *s->codes);
    gvc_buffer again = encoded(16, s->back, s->previous, (gvc_predictor_kind)s->bytes.data[0]);
    assert_int_equal(again.size, s->bytes.size);
    assert_memory_equal(again.data, s->bytes.data, again.size);
    gvc_buffer_free(&again);
    return 1;
}

static void test_damage(void **state) {
    (void)state;
    for (unsigned k = 0; k < 2; k++) {
        sample s = sample_make(kinds[k]);
        gvc_buffer cut = s.bytes;
        for (cut.size = 0; cut.size < s.bytes.size; cut.size++) {
            assert_int_equal(decoded(&cut, 16, s.previous, s.back, NULL), GVC_ERROR_CORRUPT);
        }
        unsigned accepted = 0;
        for (size_t i = 4; i < s.bytes.size; i++) {
            s.bytes.data[i] ^= (uint8_t)(1u << i % 8);
            accepted += is_refused_or_another(&s);
            s.bytes.data[i] ^= (uint8_t)(1u << i % 8);
        }
        assert_true(accepted < 10);
        assert_int_equal(decoded(&s.bytes, 16, s.previous, s.back, NULL), GVC_OK);
        gvc_write_u8(&s.bytes, 0);
        assert_int_equal(decoded(&s.bytes, 16, s.previous, s.back, NULL), GVC_ERROR_CORRUPT);
        sample_free(&s);
    }
}

static void test_head(void **state) {
    (void)state;
    sample s = sample_make(GVC_PREDICTOR_SQUARES);
    gvc_error error;
    assert_int_equal(decoded(&s.bytes, 16, NULL, s.back, &error), GVC_ERROR_CORRUPT);
    assert_non_null(strstr(error.message, "without the frame"));
    uint16_t *larger = malloc(image_samples(17) * sizeof *larger);
    assert_int_equal(decoded(&s.bytes, 17, s.previous, larger, &error), GVC_ERROR_CORRUPT);
    free(larger);
    assert_non_null(strstr(error.message, "16"));
    assert_int_equal(decoded(&s.bytes, 15, s.previous, s.back, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(decoded(&s.bytes, 2050, s.previous, s.back, NULL), GVC_ERROR_ARGUMENT);
    for (unsigned i = 0; i < 2; i++) {
        uint8_t kept = s.bytes.data[i];
        s.bytes.data[i] = 2;
        assert_int_equal(decoded(&s.bytes, 16, s.previous, s.back, NULL), GVC_ERROR_UNSUPPORTED);
        s.bytes.data[i] = kept;
    }
    gvc_buffer bytes = {0};
    assert_int_equal(gvc_residual_encode(15, s.codes, NULL, kinds[0], &bytes, NULL),
                     GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_residual_encode(2050, s.codes, NULL, kinds[0], &bytes, NULL),
                     GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_residual_encode(16, s.codes, NULL, (gvc_predictor_kind)2, &bytes, NULL),
                     GVC_ERROR_ARGUMENT);
    gvc_buffer_free(&bytes);
    sample_free(&s);
}

/** A first residual of -32768 is one, +32768 and all beyond are none. */
static void test_residuals_have_16_bits(void **state) {
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        static const uint32_t value[3] = {32769, 32769, 65535}; /* |e| + 1 */
        static const unsigned negative[3] = {1, 0, 1};
        gvc_bit_model model[20];
        gvc_bit_models_init(model, 20);
        gvc_buffer bytes = {0};
        gvc_write_u32(&bytes, 16); /* gradient, no reference */
        gvc_bit_coder coder = gvc_bit_encoder(&bytes);
        for (unsigned b = 0; b < 15; b++) gvc_bit_code(&coder, &model[b], 1);
        for (unsigned b = 0; b < 15; b++) {
            unsigned bit = value[i] >> (14 - b) & 1;
            b < 3 ? gvc_bit_code(&coder, &model[15 + b], bit) : gvc_bit_code_even(&coder, bit);
        }
        gvc_bit_code(&coder, &model[18], negative[i]);
        gvc_bit_encoder_end(&coder);
        uint16_t codes[3 * 16 * 16];
        gvc_error error;
        assert_int_equal(decoded(&bytes, 16, NULL, codes, &error), GVC_ERROR_CORRUPT);
        assert_true((strstr(error.message, "16 bits") != NULL) == (i > 0));
        if (i == 0) assert_int_equal(codes[0], 32768);
        gvc_buffer_free(&bytes);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bits_come_back),
        cmocka_unit_test(test_probabilities_stay_inside),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_greatest_image),
        cmocka_unit_test(test_a_still_costs_nothing),
        cmocka_unit_test(test_sliding_is_learned),
        cmocka_unit_test(test_known_bytes),
        cmocka_unit_test(test_squares_by_definition),
        cmocka_unit_test(test_gradient_by_hand),
        cmocka_unit_test(test_damage),
        cmocka_unit_test(test_head),
        cmocka_unit_test(test_residuals_have_16_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
