/* SPDX-License-Identifier: MIT */
/** @file test_exr.c  Keyframes as OpenEXR files: all codes, an own reader, refusals, damage. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "codec/exr.h"
#include "codec/exr_half.h"
#include "exr_maker.h"
#include "image_maker.h"

static const gvc_exr_facts facts = {
    .origin = {-1.5, 0.25, 1e6}, .step = 1.0 / 3, .time = 1001.0 / 30000, .unit = "mm"};

static gvc_buffer encoded(uint32_t size, const uint16_t *codes) {
    gvc_buffer file = {0};
    assert_int_equal(gvc_exr_encode(size, codes, &facts, &file, NULL), GVC_OK);
    return file;
}

static gvc_result decoded(const gvc_buffer *file, uint32_t size, uint16_t *codes,
                          gvc_exr_facts *found, gvc_error *error) {
    /* Exactly as large as the file, so that a sanitizer sees a read past the end. */
    uint8_t *copy = malloc(file->size ? file->size : 1);
    assert_non_null(copy);
    if (file->size) memcpy(copy, file->data, file->size);
    gvc_result result = gvc_exr_decode(copy, file->size, size, codes, found, error);
    free(copy);
    return result;
}

/* ------------------------------------------------------------------------------------- round trip
 */

/** The value of a HALF that is neither infinite nor NaN. */
static double value_of(uint16_t half) {
    int exponent = half >> 10 & 31, mantissa = half & 1023;
    assert_true(exponent < 31);
    double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return half >> 15 ? -value : value;
}

static void test_all_codes(void **state) {
    (void)state;
    double before = -1;
    for (uint32_t code = 0; code <= UINT16_MAX; code++) {
        uint16_t high = gvc_exr_high((uint16_t)code), low = gvc_exr_low((uint16_t)code), back;
        assert_true(high == 0 || (high >> 10 & 31) > 0); /* no subnormal */
        assert_true((low >> 10 & 31) > 0);
        assert_true(65536 * value_of(high) + 2048 * (value_of(low) - 0.5) == code);
        assert_true(value_of(high) >= before && value_of(high) < 1);
        before = value_of(high);
        assert_true(gvc_exr_code(high, low, &back));
        assert_int_equal(back, code);
    }
    assert_true(before == 2047.0 / 2048);
}

/** Of all pairs of HALFs in which one is right, exactly those made of codes are taken. */
static void test_no_other_halves(void **state) {
    (void)state;
    unsigned high_count = 0, low_count = 0;
    for (uint32_t half = 0; half <= UINT16_MAX; half++) {
        uint16_t code;
        bool taken = gvc_exr_code((uint16_t)half, gvc_exr_low(7), &code);
        high_count += taken;
        if (taken) assert_int_equal(gvc_exr_high(code), half);
        taken = gvc_exr_code(gvc_exr_high(999), (uint16_t)half, &code);
        low_count += taken;
        if (taken) assert_int_equal(gvc_exr_low(code), half);
    }
    assert_int_equal(high_count, 2048);
    assert_int_equal(low_count, 32);
}

static void round_trip(uint32_t size, const uint16_t *codes) {
    size_t bytes = image_samples(size) * sizeof *codes;
    uint16_t *back = malloc(bytes);
    gvc_exr_facts found;
    gvc_error error;
    gvc_buffer file = encoded(size, codes), again = encoded(size, codes);
    if (decoded(&file, size, back, &found, &error) != GVC_OK) fail_msg("%s", error.message);
    assert_memory_equal(back, codes, bytes);
    assert_memory_equal(found.origin, facts.origin, sizeof facts.origin);
    assert_true(found.step == facts.step && found.time == facts.time);
    assert_string_equal(found.unit, facts.unit);
    assert_int_equal(again.size, file.size);
    assert_memory_equal(again.data, file.data, file.size);
    gvc_buffer_free(&file);
    gvc_buffer_free(&again);
    free(back);
}

static void test_round_trip(void **state) {
    (void)state;
    static const uint32_t size[] = {16, 17, 31, 129};
    for (unsigned s = 0; s < sizeof size / sizeof *size; s++) {
        for (unsigned kind = 0; kind < IMAGE_KINDS; kind++) {
            uint16_t *codes = image_make(size[s], (image_kind)kind);
            round_trip(size[s], codes);
            free(codes);
        }
    }
}

static void test_every_code_in_a_file(void **state) {
    (void)state;
    uint16_t *codes = malloc(image_samples(256) * sizeof *codes);
    assert_non_null(codes);
    for (uint32_t i = 0; i < 65536; i++) {
        codes[i] = (uint16_t)i;
        codes[65536 + i] = (uint16_t)(UINT16_MAX - i);
        codes[2 * 65536 + i] = (uint16_t)(i * 40503u);
    }
    round_trip(256, codes);
    free(codes);
}

static void test_greatest_image(void **state) {
    (void)state;
    uint16_t *codes = image_make(2049, IMAGE_FLAT);
    codes[image_samples(2049) - 1] = 12345;
    gvc_buffer file = encoded(2049, codes);
    memset(codes, 0, image_samples(2049) * sizeof *codes);
    assert_int_equal(decoded(&file, 2049, codes, NULL, NULL), GVC_OK);
    assert_int_equal(codes[0], UINT16_MAX);
    assert_int_equal(codes[image_samples(2049) - 2], UINT16_MAX);
    assert_int_equal(codes[image_samples(2049) - 1], 12345);
    gvc_buffer_free(&file);
    free(codes);
}

/** Appended to what is there, as a sample in a fragment is; and without a unit. */
static void test_appended(void **state) {
    (void)state;
    uint16_t *codes = image_make(16, IMAGE_SMOOTH);
    gvc_exr_facts bare = facts, found;
    bare.unit[0] = '\0';
    gvc_buffer file = {0};
    gvc_write_u32(&file, 0x01020304);
    assert_int_equal(gvc_exr_encode(16, codes, &bare, &file, NULL), GVC_OK);
    assert_int_equal(exr_get(file.data, 4), 0x04030201);
    assert_int_equal(gvc_exr_decode(file.data + 4, file.size - 4, 16, codes, &found, NULL), GVC_OK);
    assert_string_equal(found.unit, "");
    gvc_buffer_free(&file);
    free(codes);
}

/** What another program sees: read with nothing of this library. */
static void test_read_by_others(void **state) {
    (void)state;
    static const char *const attribute[] = {
        "channels",          "compression", "dataWindow",       "displayWindow",
        "gvcOrigin",         "gvcStep",     "gvcTime",          "gvcUnit",
        "gvcVersion",        "lineOrder",   "pixelAspectRatio", "screenWindowCenter",
        "screenWindowWidth", "type"};
    enum { SIZE = 37 };
    uint16_t *codes = image_make(SIZE, IMAGE_SLID);
    gvc_buffer file = encoded(SIZE, codes);
    const uint8_t *end, *at = file.data + 8;
    assert_int_equal(exr_get(file.data, 4), 20000630);
    assert_int_equal(exr_get(file.data + 4, 4), 2);
    unsigned count = 0;
    for (; *at; count++) {
        bool known = false;
        for (unsigned i = 0; i < sizeof attribute / sizeof *attribute; i++) {
            known = known || strcmp((const char *)at, attribute[i]) == 0;
        }
        assert_true(known); /* no date, no name of a machine */
        at += strlen((const char *)at) + 1;
        at += strlen((const char *)at) + 1;
        at += 4 + exr_get(at, 4);
    }
    assert_int_equal(count, sizeof attribute / sizeof *attribute);
    assert_int_equal(exr_find(file.data, "compression", &end)[0], 3);
    assert_int_equal(exr_get(exr_find(file.data, "dataWindow", &end) + 12, 4), SIZE - 1);
    assert_string_equal((const char *)exr_find(file.data, "channels", &end), "X");
    assert_memory_equal(exr_find(file.data, "gvcUnit", &end), "mm", 2);
    uint16_t *half = exr_halves(file.data, SIZE);
    size_t plane = SIZE * SIZE;
    for (size_t i = 0; i < 3 * plane; i++) {
        double high = value_of(half[i / plane * 2 * plane + i % plane]);
        double low = value_of(half[(i / plane * 2 + 1) * plane + i % plane]);
        assert_true(65536 * high + 2048 * (low - 0.5) == codes[i]);
    }
    free(half);
    free(codes);
    gvc_buffer_free(&file);
}

/* -------------------------------------------------------------------------------------- refusals
 */

static gvc_result read_plan(const exr_plan *plan) {
    uint16_t codes[3 * 16 * 16];
    gvc_exr_facts found;
    gvc_buffer file = exr_make(plan);
    gvc_result result = decoded(&file, 16, codes, &found, NULL);
    if (result == GVC_OK) {
        assert_int_equal(codes[0], 32768 + 3);
        assert_int_equal(codes[3 * 16 * 16 - 1], 32768 + 3);
        assert_true(found.origin[2] == 2.5 && found.step == 0.25 && found.time == 2);
    }
    gvc_buffer_free(&file);
    return result;
}

static void test_files_of_others(void **state) {
    (void)state;
    exr_plan plan = exr_plain();
    assert_int_equal(read_plan(&plan), GVC_OK);
    plan.extra = true;
    plan.unit = "furlongs, say.."; /* 15 bytes */
    assert_int_equal(read_plan(&plan), GVC_OK);
    plan.flags |= 0x400; /* long names allowed */
    assert_int_equal(read_plan(&plan), GVC_OK);
}

#define REFUSED(expected, change)                                                                  \
    do {                                                                                           \
        exr_plan plan = exr_plain();                                                               \
        change;                                                                                    \
        assert_int_equal(read_plan(&plan), expected);                                              \
    } while (0)

static void test_other_kinds_are_refused(void **state) {
    (void)state;
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.flags |= 0x200);  /* tiled */
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.flags |= 0x800);  /* deep */
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.flags |= 0x1000); /* several parts */
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.flags = 3);
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.order = 1);
    for (uint32_t compression = 4; compression < 10; compression++) { /* PIZ, PXR24, B44 ... DWAB */
        REFUSED(GVC_ERROR_UNSUPPORTED, plan.compression = compression);
    }
    REFUSED(GVC_ERROR_CORRUPT, plan.compression = 10);
    REFUSED(GVC_ERROR_UNSUPPORTED, plan.version = 1);
}

static void test_other_images_are_refused(void **state) {
    (void)state;
    REFUSED(GVC_ERROR_CORRUPT, plan.size = 17);
    REFUSED(GVC_ERROR_CORRUPT, plan.first = 1);
    REFUSED(GVC_ERROR_CORRUPT, plan.pixel_type = 0);
    REFUSED(GVC_ERROR_CORRUPT, plan.pixel_type = 2);
    REFUSED(GVC_ERROR_CORRUPT, plan.sampling = 2);
    REFUSED(GVC_ERROR_CORRUPT, plan.channels = 5);
    REFUSED(GVC_ERROR_CORRUPT, plan.name[5] = "Z.hi");
    REFUSED(GVC_ERROR_CORRUPT, plan.chunk_y = 1);
    REFUSED(GVC_ERROR_CORRUPT, plan.chunk_gap = 100000);
    static const char *const needed[] = {"gvcVersion", "gvcOrigin", "gvcStep", "gvcTime"};
    for (unsigned i = 0; i < 4; i++) REFUSED(GVC_ERROR_CORRUPT, plan.without = needed[i]);
    REFUSED(GVC_ERROR_CORRUPT, plan.step = 0);
    REFUSED(GVC_ERROR_CORRUPT, plan.step = -1);
    REFUSED(GVC_ERROR_CORRUPT, plan.step = NAN);
    REFUSED(GVC_ERROR_CORRUPT, plan.origin = INFINITY);
    REFUSED(GVC_ERROR_CORRUPT, plan.time = NAN);
    REFUSED(GVC_ERROR_CORRUPT, plan.unit = "sixteen bytes!!!");
    REFUSED(GVC_ERROR_CORRUPT, plan.unit = "m\n");
    REFUSED(GVC_ERROR_CORRUPT, plan.unit = "\xff");
    static const uint16_t high[] = {0x8000, 0x7c00, 0x7e00, 0x0001, 0x03ff, 0x0c00, 0x1001, 0x3c00};
    for (unsigned i = 0; i < 8; i++) REFUSED(GVC_ERROR_CORRUPT, plan.high = high[i]);
    static const uint16_t low[] = {0, 0x37ff, 0x3820, 0xb800};
    for (unsigned i = 0; i < 4; i++) REFUSED(GVC_ERROR_CORRUPT, plan.low = low[i]);
}

static void test_arguments(void **state) {
    (void)state;
    uint16_t codes[3 * 16 * 16] = {0};
    gvc_buffer file = {0};
    gvc_exr_facts wrong = facts;
    assert_int_equal(gvc_exr_encode(15, codes, &facts, &file, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_exr_encode(2050, codes, &facts, &file, NULL), GVC_ERROR_ARGUMENT);
    wrong.step = 0;
    assert_int_equal(gvc_exr_encode(16, codes, &wrong, &file, NULL), GVC_ERROR_ARGUMENT);
    wrong = facts;
    wrong.time = INFINITY;
    assert_int_equal(gvc_exr_encode(16, codes, &wrong, &file, NULL), GVC_ERROR_ARGUMENT);
    wrong = facts;
    strcpy(wrong.unit, "a\tb");
    assert_int_equal(gvc_exr_encode(16, codes, &wrong, &file, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(file.size, 0);
    assert_int_equal(decoded(&file, 16, codes, NULL, NULL), GVC_ERROR_CORRUPT);
    assert_int_equal(decoded(&file, 15, codes, NULL, NULL), GVC_ERROR_ARGUMENT);
}

/** Every cut and every changed byte ends in a result, without a word on stderr. */
static void test_damage(void **state) {
    (void)state;
    uint16_t *codes = image_make(20, IMAGE_SLID), *back = image_make(20, IMAGE_FLAT);
    gvc_buffer file = encoded(20, codes), cut = file;
    FILE *said = tmpfile();
    int kept = dup(STDERR_FILENO);
    assert_true(said && kept >= 0);
    fflush(stderr);
    dup2(fileno(said), STDERR_FILENO);
    unsigned cut_read = 0, changed_read = 0;
    for (cut.size = 0; cut.size < file.size; cut.size++) {
        cut_read += decoded(&cut, 20, back, NULL, NULL) == GVC_OK;
    }
    for (size_t i = 0; i < file.size; i++) {
        file.data[i] ^= (uint8_t)(1u << i % 8);
        changed_read += decoded(&file, 20, back, NULL, NULL) == GVC_OK;
        file.data[i] ^= (uint8_t)(1u << i % 8);
    }
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    assert_int_equal(lseek(fileno(said), 0, SEEK_END), 0);
    fclose(said);
    assert_int_equal(cut_read, 0);
    assert_true(changed_read <
                120); /* attributes of no meaning here: time, origin, display window */
    assert_int_equal(decoded(&file, 20, back, NULL, NULL), GVC_OK);
    assert_memory_equal(codes, back, image_samples(20) * sizeof *codes);
    gvc_buffer_free(&file);
    free(codes);
    free(back);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_codes),
        cmocka_unit_test(test_no_other_halves),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_every_code_in_a_file),
        cmocka_unit_test(test_greatest_image),
        cmocka_unit_test(test_appended),
        cmocka_unit_test(test_read_by_others),
        cmocka_unit_test(test_files_of_others),
        cmocka_unit_test(test_other_kinds_are_refused),
        cmocka_unit_test(test_other_images_are_refused),
        cmocka_unit_test(test_arguments),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
