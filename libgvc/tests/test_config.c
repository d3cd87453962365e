/* SPDX-License-Identifier: MIT */
/** @file test_config.c  The gvcC box: round trip, refusals, every prefix. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "container/config.h"

static gvc_config example(void) {
    gvc_config config = {.version_minor = GVC_FORMAT_MINOR,
                         .picture_width = 128,
                         .plane_height = 112,
                         .image_size = 97,
                         .code_bits = 10,
                         .code_shift = 6,
                         .frame_rate_num = 30000,
                         .frame_rate_den = 1001,
                         .declared_frames = 123456789012};
    strcpy(config.unit, "mm");
    strcpy(config.encoder, "gvc 0.1.0 \xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80");
    memset(config.settings, 's', sizeof config.settings - 1);
    return config;
}

static gvc_result through(const gvc_config *config, gvc_config *back) {
    gvc_buffer buffer = {0};
    gvc_config_write(config, &buffer);
    assert_false(buffer.failed);
    gvc_cursor cursor = gvc_cursor_make(buffer.data, buffer.size);
    gvc_result result = gvc_config_read(&cursor, back, NULL);
    if (result == GVC_OK) assert_int_equal(gvc_cursor_left(&cursor), 0);
    gvc_buffer_free(&buffer);
    return result;
}

static void test_round_trip(void **state) {
    (void)state;
    gvc_config config = example(), back;
    assert_int_equal(through(&config, &back), GVC_OK);
    assert_int_equal(back.version_minor, config.version_minor);
    assert_int_equal(back.picture_width, 128);
    assert_int_equal(back.plane_height, 112);
    assert_int_equal(back.image_size, 97);
    assert_int_equal(back.frame_rate_num, 30000);
    assert_int_equal(back.frame_rate_den, 1001);
    assert_true(back.declared_frames == config.declared_frames);
    assert_string_equal(back.unit, config.unit);
    assert_string_equal(back.encoder, config.encoder);
    assert_string_equal(back.settings, config.settings);
}

/** The bytes that config.h promises. */
static void test_layout(void **state) {
    (void)state;
    static const uint8_t expected[] = {0,    0,    0,    1,    0,    0, 0,   0,    0,  0,  0,
                                       128,  0,    0,    0,    112,  0, 0,   0,    97, 10, 6,
                                       0,    0,    0x75, 0x30, 0,    0, 3,   0xe9, 0,  0,  0,
                                       0x1c, 0xbe, 0x99, 0x1a, 0x14, 2, 'm', 'm',  0,  0};
    gvc_config config = example();
    config.encoder[0] = config.settings[0] = '\0';
    gvc_buffer buffer = {0};
    gvc_config_write(&config, &buffer);
    assert_int_equal(buffer.size, sizeof expected);
    assert_memory_equal(buffer.data, expected, sizeof expected);
    gvc_buffer_free(&buffer);
}

static void test_refusals(void **state) {
    (void)state;
#define EXPECT(result, change)                                                                     \
    do {                                                                                           \
        gvc_config config = example(), back;                                                       \
        change;                                                                                    \
        assert_int_equal(through(&config, &back), result);                                         \
    } while (0)
    EXPECT(GVC_ERROR_UNSUPPORTED, config.version_major = GVC_FORMAT_MAJOR + 1);
    EXPECT(GVC_ERROR_UNSUPPORTED, config.features = 0x80000000u);
    EXPECT(GVC_ERROR_UNSUPPORTED, config.code_bits = 8);
    EXPECT(GVC_ERROR_UNSUPPORTED, config.code_shift = 5);
    EXPECT(GVC_ERROR_CORRUPT, config.picture_width = 0);
    EXPECT(GVC_ERROR_CORRUPT, config.picture_width = 17);
    EXPECT(GVC_ERROR_CORRUPT, config.picture_width = 16386);
    EXPECT(GVC_ERROR_CORRUPT, config.plane_height = 5462);
    EXPECT(GVC_ERROR_CORRUPT, config.plane_height = 33);
    EXPECT(GVC_ERROR_CORRUPT, config.image_size = 15);
    EXPECT(GVC_ERROR_CORRUPT, config.image_size = 2050);
    EXPECT(GVC_ERROR_CORRUPT, config.frame_rate_num = 0);
    EXPECT(GVC_ERROR_CORRUPT, config.frame_rate_den = 0);
    EXPECT(GVC_ERROR_CORRUPT, config.declared_frames = UINT64_MAX);
    EXPECT(GVC_OK, config.version_minor = 65535);
    EXPECT(GVC_OK, config.picture_width = 16384; config.plane_height = 5460);
    EXPECT(GVC_OK, config.frame_rate_num = config.frame_rate_den = UINT32_MAX;
           config.declared_frames = UINT32_MAX);
#undef EXPECT
}

/** Later minor versions may append fields. */
static void test_bytes_after_are_ignored(void **state) {
    (void)state;
    gvc_config config = example(), back;
    gvc_buffer buffer = {0};
    gvc_config_write(&config, &buffer);
    gvc_write_u32(&buffer, 0xdeadbeef);
    gvc_cursor cursor = gvc_cursor_make(buffer.data, buffer.size);
    assert_int_equal(gvc_config_read(&cursor, &back, NULL), GVC_OK);
    gvc_buffer_free(&buffer);
}

static void test_every_prefix_fails(void **state) {
    (void)state;
    gvc_config config = example(), back;
    gvc_buffer buffer = {0};
    gvc_config_write(&config, &buffer);
    for (size_t size = 0; size < buffer.size; size++) {
        uint8_t *exact = malloc(size ? size : 1); /* a read past the end is a sanitizer's finding */
        assert_non_null(exact);
        memcpy(exact, buffer.data, size);
        gvc_cursor cursor = gvc_cursor_make(exact, size);
        assert_int_equal(gvc_config_read(&cursor, &back, NULL), GVC_ERROR_CORRUPT);
        free(exact);
    }
    gvc_buffer_free(&buffer);
}

/** Texts that may not be in a file are cleaned by the writer and refused by the reader. */
static void test_labels(void **state) {
    (void)state;
    static const struct {
        const char *text, *clean;
    } cases[] = {{"\x1b[2J", "?[2J"},
                 {"a\xff", "a?"},
                 {"\xc0\xaf", "??"},
                 {"\xe2\x82", "??"},
                 {"\xed\xa0\x80", "???"},
                 {"\xf4\x90\x80\x80", "????"},
                 {"\xc2\x9b", "??"},
                 {"\x7f", "?"},
                 {"\xf0\x8f\xbf\xbf", "????"},
                 {"\xc2\xa0", "\xc2\xa0"},
                 {"\xe0\xa0\x80", "\xe0\xa0\x80"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        gvc_config config = example(), back;
        strcpy(config.unit, cases[i].text);
        assert_int_equal(through(&config, &back), GVC_OK);
        assert_string_equal(back.unit, cases[i].clean);
        bool clean = strcmp(cases[i].text, cases[i].clean) == 0;
        gvc_buffer buffer = {0};
        gvc_config_write(&config, &buffer);
        memcpy(buffer.data + 39, cases[i].text, strlen(cases[i].text));
        gvc_cursor cursor = gvc_cursor_make(buffer.data, buffer.size);
        assert_int_equal(gvc_config_read(&cursor, &back, NULL), clean ? GVC_OK : GVC_ERROR_CORRUPT);
        gvc_buffer_free(&buffer);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),         cmocka_unit_test(test_layout),
        cmocka_unit_test(test_refusals),           cmocka_unit_test(test_bytes_after_are_ignored),
        cmocka_unit_test(test_every_prefix_fails), cmocka_unit_test(test_labels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
