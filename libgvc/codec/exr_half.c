/* SPDX-License-Identifier: MIT */
/** @file exr_half.c  Codes as two HALFs and back. */
#include "codec/exr_half.h"

#define HIGH_BITS 11u
#define LOW_BITS 5u
#define MANTISSA_BITS 10u
#define BIAS 15u
#define ONE_HALF ((BIAS - 1) << MANTISSA_BITS)

const char *const gvc_exr_channel_name[GVC_EXR_CHANNELS] = {"X", "X.lo", "Y", "Y.lo", "Z", "Z.lo"};

uint16_t gvc_exr_high(uint16_t code) {
    uint32_t n = (uint32_t)code >> LOW_BITS;
    if (n == 0) return 0;
    unsigned length = 0;
    while (n >> length) length++;
    /* n / 2^11 = 1.m * 2^(length - 12) */
    uint32_t mantissa = n << (MANTISSA_BITS + 1 - length) & ((1u << MANTISSA_BITS) - 1);
    return (uint16_t)((BIAS + length - 1 - HIGH_BITS) << MANTISSA_BITS | mantissa);
}

/* All in one binade, so that the bits of the code are those of the mantissa: half the bytes of a
 * fraction of its own magnitude. */
uint16_t gvc_exr_low(uint16_t code) {
    return (uint16_t)(ONE_HALF + (code & ((1u << LOW_BITS) - 1)));
}

bool gvc_exr_code(uint16_t high, uint16_t low, uint16_t *code) {
    uint32_t n = 0;
    if (high) {
        unsigned length = (high >> MANTISSA_BITS) + 1 + HIGH_BITS - BIAS; /* with the sign */
        if (length < 1 || length > HIGH_BITS) return false; /* wraps round for tiny ones */
        uint32_t significand = (high & ((1u << MANTISSA_BITS) - 1)) | 1u << MANTISSA_BITS;
        n = significand >> (MANTISSA_BITS + 1 - length);
        if (n << (MANTISSA_BITS + 1 - length) != significand) return false;
    }
    if (low < ONE_HALF || low >= ONE_HALF + (1u << LOW_BITS)) return false;
    *code = (uint16_t)(n << LOW_BITS | (low - ONE_HALF));
    return true;
}
