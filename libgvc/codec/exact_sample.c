/* SPDX-License-Identifier: MIT */
/** @file exact_sample.c  One chart's image in the exact track. */
#include "codec/exact_sample.h"

#include "codec/exr.h"
#include "codec/residual.h"

#include <string.h>

/* The first byte of a residual is the number of a predictor, far below this. */
static const uint8_t exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};

bool gvc_exact_image_is_key(const uint8_t *data, size_t data_size) {
    return data_size >= sizeof exr_magic && memcmp(data, exr_magic, sizeof exr_magic) == 0;
}

gvc_result gvc_exact_image_decode(const uint8_t *data, size_t data_size, uint32_t size,
                                  const uint16_t *previous, uint16_t *codes, gvc_error *error) {
    if (gvc_exact_image_is_key(data, data_size)) {
        return gvc_exr_decode(data, data_size, size, codes, NULL, error);
    }
    return gvc_residual_decode(data, data_size, size, previous, codes, error);
}

uint64_t gvc_exact_image_memory(uint32_t size) {
    /* the header of an OpenEXR file as the library keeps it, 3.1 kB a column of the predictor's
     * sums, an image of zeros in place of one to refer to, and a chunk of lines of an OpenEXR file,
     * packed and unpacked */
    return (uint64_t)size * (3100 + 6 * (uint64_t)size + 4 * 16 * 12) + GVC_EXR_HEADER_MEMORY;
}
