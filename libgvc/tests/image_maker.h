/* SPDX-License-Identifier: MIT */
/** @file image_maker.h  Geometry images of 16-bit codes for tests, of integers only. */
#ifndef GVC_TESTS_IMAGE_MAKER_H
#define GVC_TESTS_IMAGE_MAKER_H

#include <stdint.h>
#include <stdlib.h>

typedef enum image_kind {
    IMAGE_SMOOTH, /**< a bent surface, a little rough */
    IMAGE_SLID,   /**< the same, moved, stretched, and sampled at other places */
    IMAGE_NOISE,
    IMAGE_ENDS, /**< 0 and 65535 in turn */
    IMAGE_FLAT, /**< 65535 */
} image_kind;
#define IMAGE_KINDS 5

static inline size_t image_samples(uint32_t size) { return 3 * (size_t)size * size; }

/** Next 16 bits of a linear congruential generator. */
static inline uint32_t image_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return *state >> 16;
}

/** A wave of period 2048 and height 4096, of parabolas. */
static inline int64_t image_wave(int64_t t) {
    int64_t p = t & 1023, arc = p * (1024 - p) / 64;
    return t & 1024 ? -arc : arc;
}

/** Component k of a bent surface at (u, v), in 1/16384 of the square's side. */
static inline int64_t image_surface(unsigned k, int64_t u, int64_t v) {
    int64_t bend = image_wave(u / 8 + v / 16) + image_wave(v / 4 - u / 16 + 300) / 2;
    switch (k) {
    case 0:
        return 9000 + 2 * u + bend;
    case 1:
        return 52000 - 2 * v - bend / 2;
    default:
        return 20000 + u / 2 + v + 2 * bend;
    }
}

static inline uint16_t image_code(image_kind kind, uint32_t size, unsigned k, uint32_t x,
                                  uint32_t y, uint32_t *random) {
    int64_t u = (int64_t)x * 16384 / size, v = (int64_t)y * 16384 / size;
    switch (kind) {
    case IMAGE_SMOOTH:
        return (uint16_t)(image_surface(k, u, v) + image_random(random) % 2);
    case IMAGE_SLID:
        u += 70 + v / 128;
        v += 50 - u / 256;
        return (uint16_t)(image_surface(k, u, v) * 33 / 32 + 40 + image_random(random) % 2);
    case IMAGE_NOISE:
        return (uint16_t)image_random(random);
    case IMAGE_ENDS:
        return (x + y + k) % 2 ? UINT16_MAX : 0;
    default:
        return UINT16_MAX;
    }
}

/** 3 planes of size * size codes; free() them. */
static inline uint16_t *image_make(uint32_t size, image_kind kind) {
    uint32_t random = 1 + (uint32_t)kind;
    uint16_t *codes = malloc(image_samples(size) * sizeof *codes), *next = codes;
    if (!codes) abort();
    for (unsigned k = 0; k < 3; k++) {
        for (uint32_t y = 0; y < size; y++) {
            for (uint32_t x = 0; x < size; x++) *next++ = image_code(kind, size, k, x, y, &random);
        }
    }
    return codes;
}

#endif
