/* SPDX-License-Identifier: MIT */
/** @file random.h  Numbers that look random and are the same for the same seed. */
#ifndef GVC_FUZZ_RANDOM_H
#define GVC_FUZZ_RANDOM_H

#include <stddef.h>
#include <stdint.h>

/** 0 .. count - 1; 0 if count is 0. */
static inline size_t random_below(uint64_t *state, size_t count) {
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return count ? (size_t)(*state >> 33) % count : 0;
}

#endif
