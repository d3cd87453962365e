/* SPDX-License-Identifier: MIT */
/** @file text.c  Numbers as text, independent of the locale, exact in both directions. */
#include "base/text.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef __SIZEOF_INT128__
__extension__ typedef unsigned __int128 wide;
#define HAVE_WIDE 1
#endif

static const uint64_t power_of_ten[20] = {1ULL,
                                          10ULL,
                                          100ULL,
                                          1000ULL,
                                          10000ULL,
                                          100000ULL,
                                          1000000ULL,
                                          10000000ULL,
                                          100000000ULL,
                                          1000000000ULL,
                                          10000000000ULL,
                                          100000000000ULL,
                                          1000000000000ULL,
                                          10000000000000ULL,
                                          100000000000000ULL,
                                          1000000000000000ULL,
                                          10000000000000000ULL,
                                          100000000000000000ULL,
                                          1000000000000000000ULL,
                                          10000000000000000000ULL};

/** Powers of ten that a double holds exactly. */
static const double exact_power[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                       1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* ------------------------------------------------------------------------------------- parsing */

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/** A decimal number as written: mantissa * 10^exponent, where `mantissa` holds the first 19
 *  significant digits and `digits` counts all of them. */
typedef struct decimal {
    const char *first, *last; /**< text of the mantissa, with its point */
    uint64_t mantissa;
    int64_t digits;
    int64_t exponent; /**< of the whole mantissa as an integer, all digits included */
} decimal;

static const char *scan_mantissa(const char *p, const char *end, decimal *number) {
    bool point = false, any = false;
    number->first = p;
    for (; p < end; p++) {
        if (*p == '.' && !point) {
            point = true;
            continue;
        }
        if (!is_digit(*p)) break;
        any = true;
        number->exponent -= point;
        if (number->digits == 0 && *p == '0') continue; /* leading zeros are not significant */
        if (number->digits < 19) number->mantissa = number->mantissa * 10 + (uint64_t)(*p - '0');
        number->digits++;
    }
    number->last = p;
    return any ? p : NULL;
}

/** An exponent that is not followed by digits is left alone: it is not part of the number. */
static const char *scan_exponent(const char *p, const char *end, decimal *number) {
    const char *q = p;
    if (q == end || (*q != 'e' && *q != 'E')) return p;
    q++;
    bool negative = q < end && *q == '-';
    if (q < end && (*q == '-' || *q == '+')) q++;
    if (q == end || !is_digit(*q)) return p;
    int64_t value = 0;
    for (; q < end && is_digit(*q); q++) {
        if (value < INT64_C(1000000000000000)) value = value * 10 + (*q - '0');
    }
    number->exponent += negative ? -value : value;
    return q;
}

#ifdef HAVE_WIDE
/** Powers of five below 2^63. */
static uint64_t power_of_five(unsigned n) {
    uint64_t power = 1;
    while (n--) power *= 5;
    return power;
}

/** value * 2^exponent rounded to the nearest double, ties to even. `value` must have at least 54
 *  bits or `inexact` be false; `inexact` says that the true value is a little greater. */
static double round_wide(wide value, bool inexact, int exponent) {
    uint64_t high = (uint64_t)(value >> 64);
    int bits = high ? 128 - __builtin_clzll(high) : 64 - __builtin_clzll((uint64_t)value);
    int shift = bits - DBL_MANT_DIG;
    if (shift <= 0) return ldexp((double)(uint64_t)value, exponent);
    uint64_t kept = (uint64_t)(value >> shift);
    wide rest = value & (((wide)1 << shift) - 1), half = (wide)1 << (shift - 1);
    if (rest > half || (rest == half && (inexact || (kept & 1)))) kept++;
    return ldexp((double)kept, exponent + shift);
}

/** Exact for every mantissa and |exponent| <= 27, where 10^n = 5^n 2^n and 5^n < 2^63; results are
 *  far from the subnormal range. */
static double scale_wide(uint64_t mantissa, int exponent) {
    if (exponent >= 0)
        return round_wide((wide)mantissa * power_of_five((unsigned)exponent), false, exponent);
    int lead = __builtin_clzll(mantissa);
    uint64_t divisor = power_of_five((unsigned)-exponent);
    wide numerator = (wide)(mantissa << lead) << 64; /* the quotient then has more than 63 bits */
    return round_wide(numerator / divisor, numerator % divisor != 0, exponent - lead - 64);
}
#endif

/** The C library, given digits and exponent without a decimal point, which the locale could change.
 *  A decimal that is exactly half-way between doubles has at most 767 digits, so later digits only
 *  matter as being zero or not. */
static double convert_slowly(const decimal *number) {
    enum { KEPT = 768 };
    char text[KEPT + 32];
    size_t length = 0;
    bool more = false;
    for (const char *p = number->first; p < number->last; p++) {
        if (!is_digit(*p) || (length == 0 && *p == '0')) continue;
        if (length < KEPT)
            text[length++] = *p;
        else
            more |= *p != '0';
    }
    int64_t exponent = number->exponent + (number->digits - (int64_t)length);
    if (more) {
        text[length++] = '1';
        exponent--;
    }
    const int64_t limit = 10000; /* beyond it every double is 0 or infinite anyway */
    if (exponent > limit) exponent = limit;
    if (exponent < -limit) exponent = -limit;
    text[length++] = 'e';
    if (exponent < 0) text[length++] = '-';
    gvc_format_uint(text + length, (uint64_t)(exponent < 0 ? -exponent : exponent));
    return strtod(text, NULL);
}

/** mantissa * 10^exponent where that takes no text. False, leaving `value`, elsewhere. */
static bool convert_quickly(uint64_t mantissa, int64_t exponent, double *value) {
    /* Both operands exact, so the one operation rounds correctly (Clinger 1990). */
    bool exact = mantissa <= (uint64_t)1 << DBL_MANT_DIG;
    if (exact && exponent >= 0 && exponent <= 22)
        *value = (double)mantissa * exact_power[exponent];
    else if (exact && exponent < 0 && exponent >= -22)
        *value = (double)mantissa / exact_power[-exponent];
#ifdef HAVE_WIDE
    else if (mantissa && exponent >= -27 && exponent <= 27)
        *value = scale_wide(mantissa, (int)exponent);
#endif
    else
        return false;
    return true;
}

static double convert(const decimal *number) {
    if (number->mantissa == 0) return 0;
    double value;
    bool whole = number->digits <= 19; /* the mantissa has them all */
    if (whole && convert_quickly(number->mantissa, number->exponent, &value)) return value;
    return convert_slowly(number);
}

/** `word` is lower case. Returns the byte after it, or NULL. */
static const char *skip_word(const char *p, const char *end, const char *word) {
    for (; *word; word++, p++) {
        if (p == end || (*p | 0x20) != *word) return NULL;
    }
    return p;
}

static const char *parse_special(const char *p, const char *end, double *value) {
    const char *after = skip_word(p, end, "nan");
    if (after) {
        *value = NAN;
        return after;
    }
    after = skip_word(p, end, "infinity");
    if (!after) after = skip_word(p, end, "inf");
    if (after) *value = INFINITY;
    return after;
}

const char *gvc_parse_double(const char *text, const char *end, double *value) {
    const char *p = text;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;
    decimal number = {0};
    double magnitude;
    const char *after = scan_mantissa(p, end, &number);
    if (after) {
        after = scan_exponent(after, end, &number);
        magnitude = convert(&number);
    } else {
        after = parse_special(p, end, &magnitude);
        if (!after) return NULL;
    }
    *value = negative ? -magnitude : magnitude;
    return after;
}

const char *gvc_parse_int(const char *text, const char *end, int64_t *value) {
    const char *p = text;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) p++;
    if (p == end || !is_digit(*p)) return NULL;
    const uint64_t limit = (uint64_t)INT64_MAX + negative;
    uint64_t magnitude = 0;
    for (; p < end && is_digit(*p); p++) {
        uint64_t digit = (uint64_t)(*p - '0');
        if (magnitude > (limit - digit) / 10) return NULL;
        magnitude = magnitude * 10 + digit;
    }
    /* INT64_MIN has no positive counterpart to negate. */
    if (negative && magnitude > (uint64_t)INT64_MAX)
        *value = INT64_MIN;
    else
        *value = negative ? -(int64_t)magnitude : (int64_t)magnitude;
    return p;
}

/* ---------------------------------------------------------------------------------- formatting */

size_t gvc_format_uint(char *text, uint64_t value) {
    char reversed[20];
    size_t length = 0;
    do {
        reversed[length++] = (char)('0' + value % 10);
        value /= 10;
    } while (value);
    for (size_t i = 0; i < length; i++) text[i] = reversed[length - 1 - i];
    text[length] = 0;
    return length;
}

/** Writes d.ddd * 10^exponent, where the `count` figures of `digits` are the d, as printf's
 *  %.{precision}g would: without zeros at the end. */
static size_t emit(char *text, bool negative, uint64_t digits, int count, int exponent,
                   int precision) {
    char figure[24], *p = text;
    while (digits && digits % 10 == 0) {
        digits /= 10;
        count--;
    }
    gvc_format_uint(figure, digits);
    if (negative) *p++ = '-';
    bool scientific = exponent < -4 || exponent >= precision;
    int whole = scientific ? 1 : exponent + 1; /* digits before the point */
    if (whole <= 0) {
        *p++ = '0';
        *p++ = '.';
        for (int i = whole; i < 0; i++) *p++ = '0';
    }
    for (int i = 0; i < count; i++) {
        if (i == whole && i > 0) *p++ = '.';
        *p++ = figure[i];
    }
    for (int i = count; i < whole; i++) *p++ = '0';
    if (scientific) {
        int magnitude = exponent < 0 ? -exponent : exponent;
        *p++ = 'e';
        *p++ = exponent < 0 ? '-' : '+';
        if (magnitude < 10) *p++ = '0';
        p += gvc_format_uint(p, (uint64_t)magnitude);
    }
    *p = 0;
    return (size_t)(p - text);
}

/** Digits and exponent of %.{precision-1}e, whatever the locale's decimal point is. */
static uint64_t print_digits(double magnitude, int precision, int *exponent) {
    char text[64];
    snprintf(text, sizeof text, "%.*e", precision - 1, magnitude);
    uint64_t digits = 0;
    const char *p = text;
    for (; *p && *p != 'e'; p++) {
        if (is_digit(*p)) digits = digits * 10 + (uint64_t)(*p - '0');
    }
    int64_t parsed = 0;
    if (*p) gvc_parse_int(p + 1, text + strlen(text), &parsed);
    *exponent = (int)parsed;
    return digits;
}

/** The exponent of the leading digit, for the common range of coordinates; INT_MIN outside it. */
static int leading_exponent(double magnitude) {
#ifdef HAVE_WIDE
    if (!(magnitude >= 1e-6 && magnitude < 1e9)) return INT_MIN;
    int exponent = 8;
    while (exponent > 0 && magnitude < exact_power[exponent]) exponent--;
    /* 1 / 10^n is the double nearest to 10^-n, so that one belongs to n even if it is less. */
    while (exponent <= 0 && magnitude < 1 / exact_power[-exponent]) exponent--;
    return exponent;
#else
    (void)magnitude;
    return INT_MIN;
#endif
}

/** The same as print_digits in integers: magnitude * 10^(precision - 1 - leading), rounded to the
 *  nearest, ties to even. */
static uint64_t round_digits(double magnitude, int leading, int precision, int *exponent) {
#ifdef HAVE_WIDE
    int binary, scale = precision - 1 - leading; /* -3 to 22 */
    wide numerator = (wide)ldexp(frexp(magnitude, &binary), DBL_MANT_DIG);
    int shift = DBL_MANT_DIG - binary; /* magnitude = numerator / 2^shift; 23 to 72 */
    wide denominator = (wide)1 << shift, rest;
    uint64_t digits;
    if (scale >= 0) {
        int part = scale < 19 ? scale : 19;
        numerator = numerator * power_of_ten[part] * power_of_ten[scale - part];
        digits = (uint64_t)(numerator >> shift);
        rest = numerator & (denominator - 1);
    } else {
        denominator *= power_of_ten[-scale];
        digits = (uint64_t)(numerator / denominator);
        rest = numerator % denominator;
    }
    if (2 * rest > denominator || (2 * rest == denominator && (digits & 1))) digits++;
    bool carried = digits == power_of_ten[precision];
    *exponent = leading + carried;
    return carried ? digits / 10 : digits;
#else
    (void)leading;
    return print_digits(magnitude, precision, exponent);
#endif
}

/** "digits" "e" "exponent": a number without a decimal point, which the locale could change. */
static void write_plain(char *text, uint64_t digits, int exponent) {
    text += gvc_format_uint(text, digits);
    *text++ = 'e';
    if (exponent < 0) *text++ = '-';
    gvc_format_uint(text, (uint64_t)(exponent < 0 ? -exponent : exponent));
}

/** Whether digits * 10^exponent reads as the same double or, if `is_float`, as the same float. */
static bool reads_back(uint64_t digits, int exponent, double magnitude, bool is_float) {
    char plain[48];
    double again;
    bool quick = convert_quickly(digits, exponent, &again);
    if (quick && !is_float) return again == magnitude;
    if (quick && again >= (double)FLT_MIN) {
        uint64_t bits;
        memcpy(&bits, &again, sizeof bits);
        /* Unless `again` is half-way between two floats, where the decimal may be on either side.
         */
        const uint64_t dropped = (UINT64_C(1) << (DBL_MANT_DIG - FLT_MANT_DIG)) - 1;
        if ((bits & dropped) != dropped / 2 + 1) return (float)again == (float)magnitude;
    }
    write_plain(plain, digits, exponent);
    return is_float ? strtof(plain, NULL) == (float)magnitude : strtod(plain, NULL) == magnitude;
}

static size_t format_magnitude(char *text, bool negative, double magnitude, bool is_float) {
    /* Fifteen digits survive in a normal double, so one that fewer digits tell is also told by
     * these, with zeros at the end. */
    int precision = is_float || magnitude < DBL_MIN ? 6 : 15, last = is_float ? 9 : 17, exponent;
    int leading = leading_exponent(magnitude);
    for (;; precision++) {
        uint64_t digits = leading == INT_MIN
                              ? print_digits(magnitude, precision, &exponent)
                              : round_digits(magnitude, leading, precision, &exponent);
        if (precision < last &&
            !reads_back(digits, exponent - (precision - 1), magnitude, is_float))
            continue;
        int needed = precision;
        uint64_t kept = digits;
        for (; needed > 6 && kept % 10 == 0; needed--) kept /= 10;
        return emit(text, negative, kept, needed, exponent, needed);
    }
}

size_t gvc_format_double(char *text, double value) {
    if (!isfinite(value) || value == 0) {
        const char *word = isnan(value) ? "nan" : isinf(value) ? "inf" : "0";
        bool minus = !isnan(value) && signbit(value);
        if (minus) text[0] = '-';
        strcpy(text + minus, word);
        return strlen(text);
    }
    bool is_float = fabs(value) <= (double)FLT_MAX && (double)(float)value == value;
    return format_magnitude(text, value < 0, fabs(value), is_float);
}
