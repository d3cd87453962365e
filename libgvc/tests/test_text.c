/* SPDX-License-Identifier: MIT */
/** @file test_text.c  Numbers as text: exact in both directions, whatever the locale; UTF-8. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/text.h"
#include "base/utf8.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t random_bits(uint64_t *state) {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return *state;
}

static double double_of(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/** The parser must agree with the C library in every bit and on where the number ends. */
static void check_parse(const char *text) {
    double value;
    char *expected_end;
    double expected = strtod(text, &expected_end);
    const char *end = gvc_parse_double(text, text + strlen(text), &value);
    if (end != expected_end || bits_of(value) != bits_of(expected))
        fail_msg("%s: %.17g, expected %.17g", text, value, expected);
}

static void parses_what_is_written_in_files(void **state) {
    (void)state;
    const char *texts[] = {"0",
                           "-0",
                           "+1",
                           "1.",
                           ".5",
                           "-.5e1",
                           "1e5",
                           "1E+05",
                           "1e",
                           "1e+",
                           "1.5e-3x",
                           "12.5 7",
                           "0.1",
                           "0.30000001",
                           "123456.789e-2",
                           "1e22",
                           "1e23",
                           "9007199254740993",
                           "1e-400",
                           "1e400",
                           "4.9e-324",
                           "2.4703282292062327e-324",
                           "1.7976931348623158e308",
                           "0.000000000000000000000000000000000000000000000000000000000012345678",
                           "123456789012345678901234567890123456789012345678901234567890",
                           "8.98846567431157953864652595394512366808988489471153286367150405e307",
                           "0e999999999999999999999",
                           "1e999999999999999999999",
                           "1e-99999999999999999999999"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) check_parse(texts[i]);
}

/** Half-way between 1 and the next double, then with one more digit far behind. */
static void decides_half_way_cases_by_the_last_digit(void **state) {
    (void)state;
    char text[1200];
    const char *half_way = "1.00000000000000011102230246251565404236316680908203125";
    check_parse(half_way);
    size_t length = (size_t)snprintf(text, sizeof text, "%s", half_way);
    memset(text + length, '0', 1000);
    text[length + 1000] = 0;
    check_parse(text);
    text[length + 999] = '1';
    check_parse(text);
    double value;
    assert_non_null(gvc_parse_double(text, text + length + 1000, &value));
    assert_true(value == 1 + DBL_EPSILON);
}

static void parses_random_decimals(void **state) {
    (void)state;
    uint64_t seed = 88172645463325252u;
    char text[128];
    for (int i = 0; i < 200000; i++) {
        uint64_t a = random_bits(&seed), b = random_bits(&seed);
        int decimals = (int)(b % 20);
        a >>= b >> 58;
        snprintf(text, sizeof text, "%s%llu.%0*llue%d", b & 32 ? "-" : "",
                 (unsigned long long)(a % 100000), decimals + 1,
                 (unsigned long long)(a / 100000 % 1000000000), (int)(b >> 8 & 63) - 32);
        check_parse(text);
        double any = double_of(random_bits(&seed));
        if (isnan(any)) continue;
        snprintf(text, sizeof text, "%.*g", (int)(b % 20) + 1, any);
        check_parse(text);
    }
}

static void parses_special_words(void **state) {
    (void)state;
    double value;
    const char *text = "NaN";
    assert_ptr_equal(gvc_parse_double(text, text + 3, &value), text + 3);
    assert_true(isnan(value));
    text = "-inf,";
    assert_ptr_equal(gvc_parse_double(text, text + 5, &value), text + 4);
    assert_true(isinf(value) && value < 0);
    text = "Infinity";
    assert_ptr_equal(gvc_parse_double(text, text + 8, &value), text + 8);
    assert_true(isinf(value));
    const char *bad[] = {"", "-", ".", "-.", "e5", " 1", "in", "na", "x"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_null(gvc_parse_double(bad[i], bad[i] + strlen(bad[i]), &value));
    text = "0x10"; /* hexadecimal is not for files: the number is the zero */
    assert_ptr_equal(gvc_parse_double(text, text + 4, &value), text + 1);
}

static void stays_before_the_end(void **state) {
    (void)state;
    double value;
    const char *text = "12.5e77";
    const double expected[] = {0, 1, 12, 12, 12.5, 12.5, 12.5e7, 12.5e77};
    for (size_t n = 1; n <= 7; n++) {
        const char *end = gvc_parse_double(text, text + n, &value);
        assert_non_null(end);
        assert_true(end <= text + n);
        assert_true(value == expected[n]);
    }
    assert_null(gvc_parse_double(text, text, &value));
}

static void parses_integers_within_range(void **state) {
    (void)state;
    int64_t value;
    const char *text = "-9223372036854775808";
    assert_non_null(gvc_parse_int(text, text + strlen(text), &value));
    assert_true(value == INT64_MIN);
    text = "9223372036854775807/";
    assert_ptr_equal(gvc_parse_int(text, text + strlen(text), &value), text + 19);
    assert_true(value == INT64_MAX);
    const char *bad[] = {
        "", "-", "+", "a", "9223372036854775808", "-9223372036854775809", "99999999999999999999"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_null(gvc_parse_int(bad[i], bad[i] + strlen(bad[i]), &value));
}

/** The text that the header promises, found by trying every precision with the C library. */
static void expected_text(char text[64], double value) {
    bool single = fabs(value) <= (double)FLT_MAX && (double)(float)value == value;
    for (int precision = 6; precision <= 17; precision++) {
        snprintf(text, 64, "%.*g", precision, value);
        if (single ? strtof(text, NULL) == (float)value : strtod(text, NULL) == value) return;
    }
}

static void check_format(double value) {
    char expected[64], text[32];
    expected_text(expected, value);
    size_t length = gvc_format_double(text, value);
    assert_string_equal(text, expected);
    assert_int_equal(length, strlen(text));
}

static void formats_the_shortest_text(void **state) {
    (void)state;
    const double values[] = {
        0,       -0.0,    1,        -1,         0.1,       (double)0.1f,
        1e5,     1e6,     1e7,      123456,     1234567,   9999995,
        1e-4,    1e-5,    1e-6,     9.99999e-7, 1e9,       1e22,
        1e-300,  DBL_MAX, DBL_MIN,  4.9e-324,   FLT_MAX,   FLT_MIN,
        1.0 / 3, 2e6,     16777216, 33554432,   999999999, 0.00099999999999999999};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        check_format(values[i]);
        check_format(-values[i]);
    }
    for (int n = -320; n <= 308; n++) check_format(pow(10, n));
    for (int n = -149; n <= 127; n++) check_format(ldexp(1, n));
    char text[32];
    gvc_format_double(text, NAN);
    assert_string_equal(text, "nan");
    gvc_format_double(text, -INFINITY);
    assert_string_equal(text, "-inf");
}

static void formats_random_numbers(void **state) {
    (void)state;
    uint64_t seed = 1234567890123456789u;
    for (int i = 0; i < 60000; i++) {
        uint64_t bits = random_bits(&seed);
        uint32_t low = (uint32_t)bits;
        float any_float;
        memcpy(&any_float, &low, sizeof any_float);
        if (isfinite(any_float)) check_format((double)any_float);
        double any_double = double_of(bits);
        if (isfinite(any_double)) check_format(any_double);
        double usual = ldexp((double)(int64_t)bits, -63) * pow(10, (int)(bits & 15) - 6);
        check_format(usual);
        check_format((double)(float)usual);
        check_format(round(usual * 1000) / 1000);
    }
}

static void formats_whole_numbers(void **state) {
    (void)state;
    char text[32];
    assert_int_equal(gvc_format_uint(text, 0), 1);
    assert_string_equal(text, "0");
    assert_int_equal(gvc_format_uint(text, UINT64_MAX), 20);
    assert_string_equal(text, "18446744073709551615");
}

/** With a decimal comma, where the system has such a locale. */
static void ignores_the_locale(void **state) {
    (void)state;
    const char *names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"};
    bool found = false;
    for (size_t i = 0; i < 4 && !found; i++) found = setlocale(LC_ALL, names[i]) != NULL;
    char text[32];
    double value = 0;
    gvc_format_double(text, 1.25e-20);
    assert_string_equal(text, "1.25e-20");
    gvc_format_double(text, 0.5);
    assert_string_equal(text, "0.5");
    const char *number = "1.7976931348623157e308";
    assert_non_null(gvc_parse_double(number, number + strlen(number), &value));
    assert_true(value == DBL_MAX);
    setlocale(LC_ALL, "C");
    if (!found) skip();
}

/** Every sequence of up to four bytes out of those at the borders of the table of RFC 3629 is a
 * character exactly if its number, decoded, takes that form. */
static void knows_well_formed_utf8(void **state) {
    (void)state;
    static const uint8_t edge[] = {0x00, 0x41, 0x7f, 0x80, 0x8f, 0x90, 0x9f, 0xa0, 0xbf,
                                   0xc0, 0xc1, 0xc2, 0xdf, 0xe0, 0xe1, 0xec, 0xed, 0xee,
                                   0xef, 0xf0, 0xf1, 0xf3, 0xf4, 0xf5, 0xf8, 0xff};
    enum { COUNT = sizeof edge };
    size_t met[5] = {0};
    for (unsigned n = 0; n < COUNT * COUNT * COUNT * COUNT; n++) {
        uint8_t text[4] = {edge[n % COUNT], edge[n / COUNT % COUNT],
                           edge[n / COUNT / COUNT % COUNT], edge[n / COUNT / COUNT / COUNT]};
        size_t ones = 0, expected;
        while (ones < 8 && text[0] >> (7 - ones) & 1) ones++;
        size_t size = ones ? ones : 1;
        bool good = ones != 1 && ones <= 4;
        uint32_t number = ones ? text[0] & (0x7fu >> ones) : text[0];
        for (size_t i = 1; good && i < size; i++) {
            good = (text[i] & 0xc0) == 0x80;
            number = number << 6 | (text[i] & 0x3fu);
        }
        static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
        if (good) good = number >= least[size] && number <= 0x10ffff && number >> 11 != 0x1b;
        expected = good ? size : 0;
        assert_int_equal(gvc_utf8_size(text, 4), expected);
        met[expected]++;
        for (size_t left = 1; left < 4; left++) {
            assert_int_equal(gvc_utf8_size(text, left), expected <= left ? expected : 0);
        }
    }
    for (size_t i = 0; i < 5; i++) assert_true(met[i] > 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parses_what_is_written_in_files),
        cmocka_unit_test(decides_half_way_cases_by_the_last_digit),
        cmocka_unit_test(parses_random_decimals),
        cmocka_unit_test(parses_special_words),
        cmocka_unit_test(stays_before_the_end),
        cmocka_unit_test(parses_integers_within_range),
        cmocka_unit_test(formats_the_shortest_text),
        cmocka_unit_test(formats_random_numbers),
        cmocka_unit_test(formats_whole_numbers),
        cmocka_unit_test(ignores_the_locale),
        cmocka_unit_test(knows_well_formed_utf8),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
