/* SPDX-License-Identifier: MIT */
/** @file seed.h  Writing seed inputs for the fuzz harnesses. */
#ifndef GVC_FUZZ_SEED_H
#define GVC_FUZZ_SEED_H

#include "base/bytes.h"

#include <stdio.h>

#define SEED_PLAIN (-1)

/** A seed: the byte of options that some harnesses read first (else SEED_PLAIN), then `bytes`.
 * Returns whether it failed. */
static inline int seed_save(const char *folder, const char *name, int option,
                            const gvc_buffer *bytes) {
    char path[4096];
    int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    if (length < 0 || (size_t)length >= sizeof path) return 1;
    FILE *file = fopen(path, "wb");
    if (!file) return 1;
    int failed = option != SEED_PLAIN && fputc(option, file) == EOF;
    failed |= fwrite(bytes->data, 1, bytes->size, file) != bytes->size;
    failed |= fclose(file) != 0;
    return failed;
}

/** Every `stride`-th byte changed, one per file. */
static inline int seed_save_changed(const char *folder, const char *stem, int option,
                                    gvc_buffer *bytes, size_t stride) {
    int failed = 0;
    for (size_t i = 0; i < bytes->size; i += stride) {
        char name[64];
        snprintf(name, sizeof name, "%s_%04zu", stem, i);
        bytes->data[i] ^= (uint8_t)(1u << i % 8);
        failed |= seed_save(folder, name, option, bytes);
        bytes->data[i] ^= (uint8_t)(1u << i % 8);
    }
    return failed;
}

#endif
