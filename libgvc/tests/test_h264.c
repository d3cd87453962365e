/* SPDX-License-Identifier: MIT */
/** @file test_h264.c  Round trips through the H.264 codec, and what it does with damaged data. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "codec/h264.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 48
#define HEIGHT 150
#define MAX_COUNT 40
#define SAMPLES ((size_t)WIDTH * HEIGHT)

/* A group of pictures that look like the planes of a moving surface: smooth, sliding, with an edge
 * every third of the height. */
typedef struct pictures {
    size_t count;
    uint16_t *luma[MAX_COUNT];
} pictures;

static void pictures_make(pictures *p, size_t count) {
    p->count = count;
    for (size_t i = 0; i < count; i++) {
        p->luma[i] = malloc(SAMPLES * sizeof(uint16_t));
        assert_non_null(p->luma[i]);
        for (size_t y = 0; y < HEIGHT; y++) {
            for (size_t x = 0; x < WIDTH; x++) {
                double t = (double)i * 0.15, plane = (double)(y / 50);
                double wave = sin(0.11 * (double)x + t + plane) * cos(0.13 * (double)(y % 50) - t);
                p->luma[i][y * WIDTH + x] = (uint16_t)lround(511 + 400 * wave);
            }
        }
    }
}

static void pictures_free(pictures *p) {
    for (size_t i = 0; i < p->count; i++) free(p->luma[i]);
    p->count = 0;
}

static gvc_h264_options default_options(double crf) {
    return (gvc_h264_options){.width = WIDTH,
                              .height = HEIGHT,
                              .frame_rate_num = 30,
                              .frame_rate_den = 1,
                              .crf = crf,
                              .effort = 1};
}

static void encode(const gvc_h264_options *options, const pictures *p, gvc_coded_group *group) {
    gvc_error error;
    gvc_error_init(&error);
    const uint16_t *luma[MAX_COUNT];
    for (size_t i = 0; i < p->count; i++) luma[i] = p->luma[i];
    gvc_result result = gvc_h264_encode(options, luma, p->count, group, &error);
    if (result != GVC_OK) fail_msg("%s", error.message);
    assert_int_equal(group->packet_count, p->count);
}

/* The pictures coded, for tests that do not compare with them. */
static gvc_coded_group encoded_group(double crf, size_t count) {
    pictures original;
    gvc_coded_group group;
    gvc_h264_options options = default_options(crf);
    pictures_make(&original, count);
    encode(&options, &original, &group);
    pictures_free(&original);
    return group;
}

static gvc_h264_decoder *open_decoder(const gvc_coded_group *group) {
    gvc_error error;
    gvc_error_init(&error);
    gvc_h264_decoder *decoder;
    gvc_result result = gvc_h264_decoder_create(group->config, group->config_size, WIDTH, HEIGHT,
                                                UINT64_MAX, &decoder, &error);
    if (result != GVC_OK) fail_msg("%s", error.message);
    return decoder;
}

/* Decodes the group; stops at the first error. Pictures must come in presentation order.
 * `decoded` may have fewer pictures allocated only if an error is expected. */
static gvc_result decode(gvc_h264_decoder *decoder, const gvc_coded_group *group, pictures *decoded,
                         gvc_error *error) {
    decoded->count = 0;
    gvc_result result = GVC_OK;
    for (size_t i = 0; i <= group->packet_count && result == GVC_OK; i++) {
        const gvc_packet *packet = &group->packet[i];
        result = i < group->packet_count
                     ? gvc_h264_decoder_send(decoder, packet->data, packet->size,
                                             packet->presentation, error)
                     : gvc_h264_decoder_flush(decoder, error);
        bool available = result == GVC_OK;
        while (available) {
            uint16_t *luma = malloc(SAMPLES * sizeof *luma);
            assert_non_null(luma);
            int64_t presentation = -1;
            result = gvc_h264_decoder_receive(decoder, luma, &presentation, &available, error);
            if (available) {
                assert_true(decoded->count < MAX_COUNT);
                decoded->luma[decoded->count++] = luma;
                if (group->packet_count < MAX_COUNT)
                    assert_int_equal(presentation, (int64_t)decoded->count - 1);
            } else {
                free(luma);
            }
        }
    }
    return result;
}

/* How many pictures the decoder has left. */
static size_t receive_all(gvc_h264_decoder *decoder) {
    uint16_t luma[SAMPLES];
    size_t count = 0;
    int64_t presentation;
    bool available = true;
    for (; available; count += available) {
        assert_int_equal(gvc_h264_decoder_receive(decoder, luma, &presentation, &available, NULL),
                         GVC_OK);
    }
    return count;
}

/* Greatest and mean squared difference. */
static void compare(const pictures *a, const pictures *b, int *greatest, double *mean_square) {
    assert_int_equal(a->count, b->count);
    *greatest = 0;
    *mean_square = 0;
    for (size_t i = 0; i < a->count; i++) {
        for (size_t k = 0; k < SAMPLES; k++) {
            int d = abs((int)a->luma[i][k] - (int)b->luma[i][k]);
            if (d > *greatest) *greatest = d;
            *mean_square += (double)(d * d);
        }
    }
    *mean_square /= (double)(a->count * SAMPLES);
}

static size_t group_size(const gvc_coded_group *group) {
    size_t size = 0;
    for (size_t i = 0; i < group->packet_count; i++) size += group->packet[i].size;
    return size;
}

static void round_trip(double crf, size_t count, unsigned effort, int *greatest, double *square,
                       size_t *size) {
    pictures original, decoded;
    gvc_coded_group group;
    gvc_h264_options options = default_options(crf);
    options.effort = effort;
    pictures_make(&original, count);
    encode(&options, &original, &group);
    gvc_h264_decoder *decoder = open_decoder(&group);
    assert_int_equal(decode(decoder, &group, &decoded, NULL), GVC_OK);
    compare(&original, &decoded, greatest, square);
    *size = group_size(&group);
    gvc_h264_decoder_destroy(&decoder);
    assert_null(decoder);
    gvc_coded_group_free(&group);
    pictures_free(&original);
    pictures_free(&decoded);
}

static void test_quality_falls_with_crf(void **state) {
    (void)state;
    double last_square = -1;
    size_t last_size = SIZE_MAX;
    for (int crf = -11; crf <= 34; crf += 9) {
        int greatest;
        double square;
        size_t size;
        round_trip(crf, 24, 1, &greatest, &square, &size);
        assert_true(square > last_square);
        assert_true(size < last_size);
        last_square = square;
        last_size = size;
    }
    assert_true(last_square < 400);
}

static void test_finest_quantiser(void **state) {
    (void)state;
    for (unsigned effort = 0; effort <= 1; effort++) {
        int greatest;
        double square;
        size_t size;
        round_trip(-12, 8, effort, &greatest, &square, &size);
        /* High 10 has no lossless mode: rounding of the transform may leave one step. */
        assert_true(greatest <= 1);
        assert_true(square < 0.05);
    }
}

static void test_short_groups(void **state) {
    (void)state;
    for (size_t count = 1; count <= 4; count++) {
        int greatest;
        double square;
        size_t size;
        round_trip(4, count, 1, &greatest, &square, &size);
        assert_true(greatest <= 16);
        assert_true(square < 3);
    }
}

static void test_reordering(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(10, MAX_COUNT);
    bool seen[MAX_COUNT] = {false}, reordered = false;
    for (size_t i = 0; i < group.packet_count; i++) {
        uint32_t presentation = group.packet[i].presentation;
        assert_true(presentation < MAX_COUNT && !seen[presentation]);
        seen[presentation] = true;
        reordered = reordered || presentation != i;
        assert_int_equal(group.packet[i].keyframe, i == 0);
    }
    assert_int_equal(group.packet[0].presentation, 0);
    assert_true(reordered); /* B pictures are in use */
    gvc_coded_group_free(&group);
}

/* Samples hold slices only, each with its length before it. */
static void test_samples_hold_only_slices(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(20, 12);
    for (size_t i = 0; i < group.packet_count; i++) {
        gvc_cursor in = gvc_cursor_make(group.packet[i].data, group.packet[i].size);
        while (gvc_cursor_left(&in) > 0) {
            size_t size = gvc_read_u32(&in);
            const uint8_t *nal = gvc_read_bytes(&in, size);
            assert_non_null(nal);
            assert_int_equal(nal[0] & 31, i == 0 ? 5 : 1);
        }
        assert_false(in.failed);
    }
    gvc_coded_group_free(&group);
}

static void test_config_is_constant(void **state) {
    (void)state;
    static const struct {
        double crf;
        size_t count;
        unsigned effort;
    } variants[] = {{4, 24, 1}, {-12, 24, 1}, {-11.5, 3, 1}, {51, 24, 1}, {4, 1, 1},
                    {4, 40, 1}, {-12, 1, 0},  {30, 2, 0},    {4, 24, 0}};
    gvc_coded_group first = {0};
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        pictures original;
        gvc_coded_group group;
        gvc_h264_options options = default_options(variants[i].crf);
        options.effort = variants[i].effort;
        pictures_make(&original, variants[i].count);
        encode(&options, &original, &group);
        pictures_free(&original);
        if (i == 0) {
            first = group;
            static const uint8_t head[] = {1, 110};
            assert_memory_equal(group.config, head, sizeof head);
            static const uint8_t tail[] = {0xfd, 0xfa, 0xfa, 0};
            assert_memory_equal(group.config + group.config_size - 4, tail, sizeof tail);
        } else {
            assert_int_equal(group.config_size, first.config_size);
            assert_memory_equal(group.config, first.config, first.config_size);
            gvc_coded_group_free(&group);
        }
    }
    gvc_coded_group_free(&first);
}

static void test_deterministic(void **state) {
    (void)state;
    pictures original;
    gvc_coded_group group[2];
    gvc_h264_options options = default_options(3.5);
    pictures_make(&original, 20);
    encode(&options, &original, &group[0]);
    encode(&options, &original, &group[1]);
    for (size_t i = 0; i < original.count; i++) {
        assert_int_equal(group[0].packet[i].size, group[1].packet[i].size);
        assert_int_equal(group[0].packet[i].presentation, group[1].packet[i].presentation);
        assert_memory_equal(group[0].packet[i].data, group[1].packet[i].data,
                            group[0].packet[i].size);
    }
    gvc_coded_group_free(&group[0]);
    gvc_coded_group_free(&group[1]);
    pictures_free(&original);
}

static void test_reset_between_groups(void **state) {
    (void)state;
    pictures original, decoded;
    gvc_coded_group group;
    gvc_h264_options options = default_options(8);
    pictures_make(&original, 12);
    encode(&options, &original, &group);
    gvc_h264_decoder *decoder = open_decoder(&group);
    for (int round = 0; round < 3; round++) {
        int greatest;
        double square;
        /* Leave the decoder in the middle of a group before the round that counts. */
        for (size_t i = 0; i < 2; i++) {
            uint16_t luma[SAMPLES];
            bool available;
            int64_t presentation;
            const gvc_packet *packet = &group.packet[i];
            assert_int_equal(gvc_h264_decoder_send(decoder, packet->data, packet->size, 0, NULL),
                             GVC_OK);
            assert_int_equal(
                gvc_h264_decoder_receive(decoder, luma, &presentation, &available, NULL), GVC_OK);
        }
        gvc_h264_decoder_reset(decoder);
        assert_int_equal(decode(decoder, &group, &decoded, NULL), GVC_OK);
        compare(&original, &decoded, &greatest, &square);
        assert_true(greatest < 20);
        pictures_free(&decoded);
        gvc_h264_decoder_reset(decoder);
    }
    gvc_h264_decoder_destroy(&decoder);
    gvc_coded_group_free(&group);
    pictures_free(&original);
}

/* ------------------------------------------------------------------------------- damaged data */

static void write_u32(uint8_t *at, size_t value) {
    for (int i = 0; i < 4; i++) at[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Decodes with packet `index` replaced by the first `size` bytes of `data`. */
static gvc_result decode_replaced(const gvc_coded_group *group, size_t index, uint8_t *data,
                                  size_t size) {
    gvc_packet packets[MAX_COUNT];
    memcpy(packets, group->packet, group->packet_count * sizeof *packets);
    packets[index].data = data;
    packets[index].size = size;
    gvc_coded_group damaged = *group;
    damaged.packet = packets;
    gvc_h264_decoder *decoder = open_decoder(group);
    pictures decoded;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = decode(decoder, &damaged, &decoded, &error);
    pictures_free(&decoded);
    gvc_h264_decoder_destroy(&decoder);
    return result;
}

static void test_cut_off_slices(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(0, 10);
    for (size_t i = 0; i < group.packet_count; i++) {
        size_t whole = group.packet[i].size;
        /* The arithmetic decoder reads some bytes ahead: less missing is left to the digests. */
        for (size_t size = 0; size + 16 < whole; size += whole / 8) {
            uint8_t *copy = malloc(size + 1); /* exact, so that reads beyond are seen */
            assert_non_null(copy);
            memcpy(copy, group.packet[i].data, size);
            /* The sample ends too early ... */
            assert_int_equal(decode_replaced(&group, i, copy, size), GVC_ERROR_CORRUPT);
            /* ... and so does the slice in it. */
            if (size >= 8) {
                write_u32(copy, size - 4);
                assert_int_equal(decode_replaced(&group, i, copy, size), GVC_ERROR_CORRUPT);
            }
            free(copy);
        }
    }
    gvc_coded_group_free(&group);
}

/* Not every flipped bit can be noticed here (digests do that), but most break the syntax, and none
 * may do worse than give another picture. */
static void test_flipped_bits(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 6);
    uint32_t random = 1;
    int noticed = 0, total = 0;
    for (size_t i = 0; i < group.packet_count; i++) {
        for (int round = 0; round < 25; round++) {
            random = random * 1664525u + 1013904223u;
            size_t bit = random / 7 % (8 * group.packet[i].size);
            uint8_t *copy = malloc(group.packet[i].size);
            assert_non_null(copy);
            memcpy(copy, group.packet[i].data, group.packet[i].size);
            copy[bit / 8] ^= (uint8_t)(1u << bit % 8);
            gvc_result result = decode_replaced(&group, i, copy, group.packet[i].size);
            assert_true(result == GVC_OK || result == GVC_ERROR_CORRUPT);
            noticed += result != GVC_OK;
            total++;
            free(copy);
        }
    }
    assert_true(noticed > total / 2);
    gvc_coded_group_free(&group);
}

static void test_missing_pictures(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 12);
    gvc_packet packets[MAX_COUNT];
    gvc_coded_group shorter = group;
    shorter.packet = packets;
    /* Packet 1 is a reference of the others; packet 0 is where decoding can begin. */
    for (size_t missing = 0; missing < 2; missing++) {
        shorter.packet_count = 0;
        for (size_t i = 0; i < group.packet_count; i++) {
            if (i != missing) packets[shorter.packet_count++] = group.packet[i];
        }
        gvc_h264_decoder *decoder = open_decoder(&group);
        gvc_result result = GVC_OK;
        uint16_t luma[SAMPLES];
        for (size_t i = 0; i < shorter.packet_count && result == GVC_OK; i++) {
            bool available;
            int64_t presentation;
            result = gvc_h264_decoder_send(decoder, packets[i].data, packets[i].size, 0, NULL);
            if (result == GVC_OK)
                result = gvc_h264_decoder_receive(decoder, luma, &presentation, &available, NULL);
        }
        assert_int_equal(result, GVC_ERROR_CORRUPT);
        /* Nothing more is taken until reset, but what was taken comes out. */
        assert_int_equal(gvc_h264_decoder_send(decoder, packets[0].data, packets[0].size, 0, NULL),
                         GVC_ERROR_ARGUMENT);
        assert_int_equal(gvc_h264_decoder_flush(decoder, NULL), GVC_OK);
        assert_int_equal(receive_all(decoder), missing);
        gvc_h264_decoder_reset(decoder);
        pictures decoded;
        assert_int_equal(decode(decoder, &group, &decoded, NULL), GVC_OK);
        pictures_free(&decoded);
        gvc_h264_decoder_destroy(&decoder);
    }
    gvc_coded_group_free(&group);
}

/* Parameter sets in a sample could change the pictures' size behind our back. */
static void test_parameter_sets_in_samples(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 2);
    size_t sps_size = (size_t)group.config[6] << 8 | group.config[7];
    size_t size = 4 + sps_size + group.packet[0].size;
    uint8_t *sample = malloc(size);
    assert_non_null(sample);
    write_u32(sample, sps_size);
    memcpy(sample + 4, group.config + 8, sps_size);
    memcpy(sample + 4 + sps_size, group.packet[0].data, group.packet[0].size);
    assert_int_equal(decode_replaced(&group, 0, sample, size), GVC_ERROR_CORRUPT);
    free(sample);
    gvc_coded_group_free(&group);
}

/* A length that no whole NAL unit follows, even where the sample ends with it. */
static void test_units_without_bytes(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 1);
    size_t size = group.packet[0].size;
    uint8_t *sample = malloc(size + 5);
    assert_non_null(sample);
    memcpy(sample, group.packet[0].data, size);
    memset(sample + size, 0, 5);
    assert_int_equal(decode_replaced(&group, 0, sample, size), GVC_OK);
    assert_int_equal(decode_replaced(&group, 0, sample, size + 4), GVC_ERROR_CORRUPT);
    sample[size + 3] = 1; /* one byte: no slice fits there */
    assert_int_equal(decode_replaced(&group, 0, sample, size + 5), GVC_ERROR_CORRUPT);
    free(sample);
    gvc_coded_group_free(&group);
}

/* One sample is one picture: what follows another slice must go on with its picture. */
static void test_two_pictures_in_a_sample(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 8);
    for (size_t i = 0; i < group.packet_count; i++) {
        for (size_t k = i; k < group.packet_count && k < i + 2; k++) {
            const gvc_packet *one = &group.packet[i], *two = &group.packet[k];
            uint8_t *sample = malloc(one->size + two->size);
            assert_non_null(sample);
            memcpy(sample, one->data, one->size);
            memcpy(sample + one->size, two->data, two->size);
            assert_int_equal(decode_replaced(&group, i, sample, one->size), GVC_OK);
            assert_int_equal(decode_replaced(&group, i, sample, one->size + two->size),
                             GVC_ERROR_CORRUPT);
            free(sample);
        }
    }
    gvc_coded_group_free(&group);
}

static void test_damaged_config(void **state) {
    (void)state;
    gvc_coded_group group = encoded_group(12, 1);
    gvc_h264_decoder *decoder;
    gvc_error error;
    gvc_error_init(&error);
    static const uint32_t wrong[][2] = {{WIDTH + 2, HEIGHT}, {WIDTH, HEIGHT - 2}, {16, 16}};
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(gvc_h264_decoder_create(group.config, group.config_size, wrong[i][0],
                                                 wrong[i][1], UINT64_MAX, &decoder, &error),
                         GVC_ERROR_CORRUPT);
        assert_null(decoder);
    }
    size_t needed = group.config_size - 4; /* the last four bytes repeat what the SPS says */
    for (size_t size = 0; size < needed; size++) {
        uint8_t *copy = malloc(size + 1);
        assert_non_null(copy);
        memcpy(copy, group.config, size);
        assert_int_equal(
            gvc_h264_decoder_create(copy, size, WIDTH, HEIGHT, UINT64_MAX, &decoder, &error),
            GVC_ERROR_CORRUPT);
        free(copy);
    }
    /* Four pictures and contexts take more than a megabyte. */
    assert_int_equal(gvc_h264_decoder_create(group.config, group.config_size, WIDTH, HEIGHT,
                                             UINT64_C(1) << 20, &decoder, &error),
                     GVC_ERROR_LIMIT);
    assert_null(decoder);
    group.config[1] = 244;
    assert_int_equal(gvc_h264_decoder_create(group.config, group.config_size, WIDTH, HEIGHT,
                                             UINT64_MAX, &decoder, &error),
                     GVC_ERROR_UNSUPPORTED);
    group.config[1] = 110;
    for (size_t bit = 0; bit < 8 * group.config_size; bit++) { /* no crash, no leak */
        group.config[bit / 8] ^= (uint8_t)(1u << bit % 8);
        gvc_result result = gvc_h264_decoder_create(group.config, group.config_size, WIDTH, HEIGHT,
                                                    UINT64_MAX, &decoder, &error);
        assert_int_equal(result == GVC_OK, decoder != NULL);
        gvc_h264_decoder_destroy(&decoder);
        group.config[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    gvc_coded_group_free(&group);
}

static void test_arguments(void **state) {
    (void)state;
    pictures original;
    pictures_make(&original, 1);
    const uint16_t *luma[1] = {original.luma[0]};
    gvc_coded_group group;
    gvc_h264_options options = default_options(NAN);
    assert_int_equal(gvc_h264_encode(&options, luma, 1, &group, NULL), GVC_ERROR_ARGUMENT);
    options = default_options(-12.5);
    assert_int_equal(gvc_h264_encode(&options, luma, 1, &group, NULL), GVC_ERROR_ARGUMENT);
    options = default_options(0);
    options.width = 47;
    assert_int_equal(gvc_h264_encode(&options, luma, 1, &group, NULL), GVC_ERROR_ARGUMENT);
    options = default_options(0);
    assert_int_equal(gvc_h264_encode(&options, luma, 0, &group, NULL), GVC_ERROR_ARGUMENT);
    original.luma[0][17] = 1024;
    assert_int_equal(gvc_h264_encode(&options, luma, 1, &group, NULL), GVC_ERROR_ARGUMENT);
    assert_null(group.packet);
    pictures_free(&original);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_quality_falls_with_crf),
        cmocka_unit_test(test_finest_quantiser),
        cmocka_unit_test(test_short_groups),
        cmocka_unit_test(test_reordering),
        cmocka_unit_test(test_samples_hold_only_slices),
        cmocka_unit_test(test_config_is_constant),
        cmocka_unit_test(test_deterministic),
        cmocka_unit_test(test_reset_between_groups),
        cmocka_unit_test(test_cut_off_slices),
        cmocka_unit_test(test_flipped_bits),
        cmocka_unit_test(test_missing_pictures),
        cmocka_unit_test(test_parameter_sets_in_samples),
        cmocka_unit_test(test_units_without_bytes),
        cmocka_unit_test(test_two_pictures_in_a_sample),
        cmocka_unit_test(test_damaged_config),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
