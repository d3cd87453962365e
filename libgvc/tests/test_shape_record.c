/* SPDX-License-Identifier: MIT */
/** @file test_shape_record.c  Shape records: round trip, rules, every prefix, every flipped byte.
 */
#include <math.h>
#include <string.h>
#include <zstd.h>

#include "shape_maker.h"

#define WIDTH 64u
#define HEIGHT 48u
#define MEMORY ((size_t)1 << 20)

static gvc_shape_frame frame_make(bool same, const char *source) {
    gvc_shape_frame frame = {.same = same, .digest = {1, 2, 3, 4, 250, 251, 252, 253}};
    strcpy(frame.source, source);
    return frame;
}

/** What a file with charts of up to `image_size` says of itself, as far as records depend on it. */
static gvc_config config_of(uint32_t width, uint32_t height, uint32_t image_size) {
    return (gvc_config){.picture_width = width, .plane_height = height, .image_size = image_size};
}

static gvc_result read_bytes(const uint8_t *data, size_t size, gvc_shape *shape,
                             gvc_shape_frame *frame, gvc_error *error) {
    gvc_config config = config_of(WIDTH, HEIGHT, HEIGHT);
    return gvc_shape_record_read(data, size, &config, MEMORY, shape, frame, error);
}

static gvc_result read_at(const gvc_buffer *record, uint32_t width, uint32_t height,
                          gvc_shape *shape, gvc_shape_frame *frame) {
    gvc_config config = config_of(width, height, GVC_MAX_IMAGE_SIZE);
    return gvc_shape_record_read(record->data, record->size, &config, MEMORY, shape, frame, NULL);
}

static gvc_buffer record_of(const gvc_shape *shape, const gvc_shape_frame *frame) {
    gvc_buffer record = {0};
    assert_int_equal(gvc_shape_record_write(shape, frame, &record, NULL), GVC_OK);
    return record;
}

static void test_round_trip(void **state) {
    (void)state;
    gvc_shape shape = shape_of_two(), back;
    gvc_shape_frame frame = frame_make(false, "frame_0001.obj"), frame_back;
    gvc_buffer record = record_of(&shape, &frame);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_OK);
    assert_true(gvc_shape_equal(&shape, &back));
    assert_int_equal(back.chart[1].genus, 1);
    assert_false(frame_back.same);
    assert_memory_equal(frame_back.digest, frame.digest, 8);
    assert_string_equal(frame_back.source, "frame_0001.obj");
    back.chart[0].node[3].feature++;
    assert_false(gvc_shape_equal(&shape, &back));
    gvc_shape_free(&back);
    gvc_shape_free(&shape);
    gvc_buffer_free(&record);
}

static void test_same_takes_nine_bytes(void **state) {
    (void)state;
    gvc_shape back;
    gvc_shape_frame frame = frame_make(true, ""), frame_back;
    gvc_buffer record = record_of(NULL, &frame);
    assert_int_equal(record.size, 9);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_OK);
    assert_true(frame_back.same);
    assert_memory_equal(frame_back.digest, frame.digest, 8);
    assert_int_equal(back.chart_count, 0);
    assert_null(back.chart);
    gvc_write_u8(&record, 0);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_ERROR_CORRUPT);
    gvc_buffer_free(&record);
    frame = frame_make(true, "name");
    record = record_of(NULL, &frame);
    assert_int_equal(record.size, 14);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_OK);
    assert_string_equal(frame_back.source, "name");
    gvc_buffer_free(&record);
}

/** Random trees and gluings of any genus. */
static void test_random_tables(void **state) {
    (void)state;
    uint64_t random = 7;
    unsigned met = 0, handles = 0;
    for (unsigned i = 0; i < 3000; i++) {
        gvc_side_table table =
            table_allocate(16 + random_below(&random, 60), 1 + random_below(&random, 7));
        table_random_steps(&table, 2, &random);
        if (i % 2) {
            table_random_tree(&table, &random);
        } else {
            table_random_gluing(&table, &random);
        }
        table.start = random_below(&random, 4 * (table.size - 1));
        gvc_weld weld;
        if (gvc_weld_build(&table, &weld, NULL) != GVC_OK) {
            gvc_side_table_free(&table);
            continue;
        }
        gvc_weld_free(&weld);
        met++;
        gvc_shape shape = {.segment = i, .chart_count = 1}, back;
        shape.chart = calloc(1, sizeof *shape.chart);
        shape.chart[0] = chart_make(table, 0, 0);
        handles += shape.chart[0].genus;
        gvc_shape_frame frame = frame_make(false, ""), frame_back;
        gvc_buffer record = record_of(&shape, &frame);
        assert_int_equal(read_at(&record, 80, 80, &back, &frame_back), GVC_OK);
        assert_true(gvc_shape_equal(&shape, &back));
        gvc_shape_free(&back);
        gvc_shape_free(&shape);
        gvc_buffer_free(&record);
    }
    assert_true(met > 100 && handles > 20);
}

static void test_many_charts(void **state) {
    (void)state;
    gvc_shape shape = {.chart_count = 400}, back;
    shape.chart = calloc(400, sizeof *shape.chart);
    for (uint32_t i = 0; i < 400; i++) {
        gvc_side_table table = table_star(17, 3);
        table.start = 3;
        shape.chart[i] = chart_make(table, i % 20 * 17, i / 20 * 17);
    }
    gvc_shape_frame frame = frame_make(false, ""), frame_back;
    gvc_buffer record = record_of(&shape, &frame);
    assert_true(record.data[0] == 4); /* zstd */
    assert_true(record.size < 400 * 20);
    assert_int_equal(read_at(&record, 340, 340, &back, &frame_back), GVC_OK);
    assert_true(gvc_shape_equal(&shape, &back));
    gvc_shape_free(&back);
    assert_int_equal(read_at(&record, 338, 340, &back, &frame_back), GVC_ERROR_CORRUPT);
    gvc_config config = config_of(340, 340, 17);
    assert_int_equal(
        gvc_shape_record_read(record.data, record.size, &config, 1000, &back, &frame_back, NULL),
        GVC_ERROR_LIMIT);
    gvc_shape_free(&shape);
    gvc_buffer_free(&record);
}

/** Each rule is broken alone. */
static void test_rules(void **state) {
    (void)state;
    gvc_shape back;
    gvc_shape_frame frame = frame_make(false, ""), frame_back;
    gvc_error error;
#define BROKEN(change)                                                                             \
    do {                                                                                           \
        gvc_shape shape = shape_of_two();                                                          \
        gvc_chart_shape *star = &shape.chart[0], *torus = &shape.chart[1];                         \
        (void)star, (void)torus;                                                                   \
        change;                                                                                    \
        gvc_buffer record = record_of(&shape, &frame);                                             \
        gvc_error_init(&error);                                                                    \
        assert_int_equal(read_bytes(record.data, record.size, &back, &frame_back, &error),         \
                         GVC_ERROR_CORRUPT);                                                       \
        assert_int_equal(error.code, GVC_ERROR_CORRUPT);                                           \
        assert_null(back.chart);                                                                   \
        gvc_buffer_free(&record);                                                                  \
        gvc_shape_free(&shape);                                                                    \
    } while (0)
    BROKEN(torus->x = 32);
    BROKEN(torus->x = 0);
    BROKEN(torus->x = 45);
    BROKEN(torus->x = UINT32_MAX);
    BROKEN(torus->y = 29);
    BROKEN(torus->y = UINT32_MAX - 10);
    BROKEN(torus->genus = 0);
    BROKEN(star->genus = 1);
    BROKEN(star->step = 0);
    BROKEN(star->step = -1);
    BROKEN(star->step = (double)NAN);
    BROKEN(star->step = (double)INFINITY);
    BROKEN(star->step = 1e36);
    BROKEN(star->origin[2] = (double)NAN);
    BROKEN(star->origin[1] = -(double)INFINITY);
    BROKEN(star->origin[0] = 1e39);
    BROKEN(star->sides.size = 15);
    BROKEN(star->sides.size = 2050);
    BROKEN(star->sides.size = 32);
    BROKEN(star->sides.start = 128);
    BROKEN(star->sides.steps[0]++);
    BROKEN(star->sides.side[0].reversed = true);
    BROKEN(star->sides.side[0].edge = 4);
    BROKEN(star->edge[0].node[0] = 5);
    BROKEN(star->edge[0].node[1] = 0);
    BROKEN(star->edge[0].node[1] = star->edge[1].node[1]);
    BROKEN(star->node[0].kind = 3);
    /* Swapping the ends of an edge keeps it an edge, but the walk no longer follows it. */
    BROKEN(uint32_t from = star->edge[2].node[0]; star->edge[2].node[0] = star->edge[2].node[1];
           star->edge[2].node[1] = from);
    BROKEN(star->sides.side[7] = star->sides.side[6]);
#undef BROKEN
    gvc_shape empty = {0};
    gvc_buffer record = {0};
    assert_int_equal(gvc_shape_record_write(&empty, &frame, &record, NULL), GVC_ERROR_ARGUMENT);
    gvc_buffer_free(&record);
}

/** Neither a cut nor a changed byte makes the reader read past the end or leak. */
static void test_prefixes_and_flips(void **state) {
    (void)state;
    gvc_shape shape = shape_of_two(), back;
    for (unsigned named = 0; named < 2; named++) {
        gvc_shape_frame frame = frame_make(false, named ? "x" : ""), frame_back;
        gvc_buffer record = record_of(&shape, &frame);
        for (size_t size = 0; size < record.size; size++) {
            uint8_t *exact = malloc(size ? size : 1);
            memcpy(exact, record.data, size);
            assert_int_equal(read_bytes(exact, size, &back, &frame_back, NULL), GVC_ERROR_CORRUPT);
            free(exact);
        }
        for (size_t i = 0; i < 8 * record.size; i++) {
            record.data[i / 8] ^= (uint8_t)(1u << i % 8);
            if (read_at(&record, WIDTH, HEIGHT, &back, &frame_back) == GVC_OK) {
                gvc_shape_free(&back);
            }
            record.data[i / 8] ^= (uint8_t)(1u << i % 8);
        }
        gvc_buffer_free(&record);
    }
    gvc_shape_free(&shape);
}

/** Counts far beyond the bytes must fail before memory is asked for. */
static void test_hostile_counts(void **state) {
    (void)state;
    gvc_shape back;
    gvc_shape_frame frame_back;
    gvc_buffer record = {0};
    for (unsigned i = 0; i < 9; i++) gvc_write_u8(&record, 0);
    gvc_write_varint(&record, 0);
    gvc_write_varint(&record, UINT64_MAX);
    for (unsigned i = 0; i < 100; i++) gvc_write_u8(&record, 1);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_ERROR_CORRUPT);
    record.data[0] = 0x10;
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_ERROR_UNSUPPORTED);
    gvc_buffer_free(&record);
}

/** A record of which nothing but a zstd frame's head is there: magic, single segment, content size.
 */
static gvc_result read_stated(uint64_t content, size_t max_memory) {
    gvc_config config = config_of(WIDTH, HEIGHT, HEIGHT);
    gvc_shape back;
    gvc_shape_frame frame_back;
    uint8_t bomb[] = {4,    0, 0, 0, 0, 0, 0, 0, 0, 0x28, 0xb5, 0x2f, 0xfd,
                      0xe0, 0, 0, 0, 0, 0, 0, 0, 0, 1,    0,    0};
    for (unsigned i = 0; i < 8; i++) bomb[14 + i] = (uint8_t)(content >> 8 * i);
    return gvc_shape_record_read(bomb, sizeof bomb, &config, max_memory, &back, &frame_back, NULL);
}

/** A content size that no body can have is a defect; one that the caller does not want, a limit. */
static void test_stated_sizes(void **state) {
    (void)state;
    uint64_t greatest = 20 + 3 * WIDTH * HEIGHT;
    assert_int_equal(read_stated(UINT64_C(1) << 60, SIZE_MAX), GVC_ERROR_CORRUPT);
    assert_int_equal(read_stated(greatest + 1, 0), GVC_ERROR_CORRUPT);
    assert_int_equal(read_stated(greatest, 1000), GVC_ERROR_LIMIT);
}

/** No chart is greater than the configuration says. */
static void test_image_size(void **state) {
    (void)state;
    gvc_shape shape = shape_of_two(), back;
    gvc_shape_frame frame = frame_make(false, ""), frame_back;
    gvc_buffer record = record_of(&shape, &frame);
    for (uint32_t most = 20; most <= 34; most++) {
        gvc_config config = config_of(WIDTH, HEIGHT, most);
        gvc_result result = gvc_shape_record_read(record.data, record.size, &config, MEMORY, &back,
                                                  &frame_back, NULL);
        assert_int_equal(result, most < 33 ? GVC_ERROR_CORRUPT : GVC_OK);
        gvc_shape_free(&back);
    }
    gvc_buffer_free(&record);
    gvc_shape_free(&shape);
}

/** The component of a chart is its number. */
static void test_component(void **state) {
    (void)state;
    gvc_shape shape = shape_of_two(), back;
    gvc_shape_frame frame_back;
    uint8_t *chart = NULL;
    gvc_buffer record = {0};
    /* Written plain: flags, digest, segment 0, one chart, its component. */
    shape.segment = 0;
    shape.chart_count = 1;
    gvc_shape_frame frame = frame_make(false, "");
    record = record_of(&shape, &frame);
    if (record.data[0] == 4) { /* packed: the same again, unpacked */
        uint8_t body[4096];
        size_t size = ZSTD_decompress(body, sizeof body, record.data + 9, record.size - 9);
        assert_false(ZSTD_isError(size));
        record.size = 9;
        record.data[0] = 0;
        gvc_write_bytes(&record, body, size);
    }
    chart = record.data + 11;
    assert_int_equal(chart[0], 0);
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_OK);
    gvc_shape_free(&back);
    chart[0] = 1;
    assert_int_equal(read_at(&record, WIDTH, HEIGHT, &back, &frame_back), GVC_ERROR_CORRUPT);
    gvc_buffer_free(&record);
    shape.chart_count = 2;
    gvc_shape_free(&shape);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),     cmocka_unit_test(test_same_takes_nine_bytes),
        cmocka_unit_test(test_random_tables),  cmocka_unit_test(test_many_charts),
        cmocka_unit_test(test_rules),          cmocka_unit_test(test_prefixes_and_flips),
        cmocka_unit_test(test_hostile_counts), cmocka_unit_test(test_stated_sizes),
        cmocka_unit_test(test_image_size),     cmocka_unit_test(test_component),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
