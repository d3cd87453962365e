/* SPDX-License-Identifier: MIT */
/** @file fuzz_residual.c  Fuzzes the decoder of residual images.
 *
 * The first byte holds options. The rest is either a residual sample, decoded against a smooth
 * image or none, or the codes of an image, which is coded and must come back. A sample that is
 * accepted must be the one that its image gives: there is one way to write an image down. */
#include "codec/residual.h"

#include <stdlib.h>
#include <string.h>

#define LEAST_SIZE 16u
#define SIZES 16u
#define OPTION_SIZE 15u      /**< image size minus 16 */
#define OPTION_CODES 16u     /**< the rest is an image, not a sample */
#define OPTION_ALONE 32u     /**< no previous image */
#define OPTION_PREDICTOR 64u /**< with OPTION_CODES: by gradient */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void *allocate(size_t bytes) {
    void *data = calloc(1, bytes ? bytes : 1);
    if (!data) abort();
    return data;
}

static uint16_t *make_previous(uint32_t size) {
    size_t plane = (size_t)size * size;
    uint16_t *image = allocate(3 * plane * sizeof *image);
    for (size_t i = 0; i < plane; i++) {
        uint32_t x = (uint32_t)(i % size), y = (uint32_t)(i / size);
        image[i] = (uint16_t)(30000 + 900 * x - 7 * y * y);
        image[plane + i] = (uint16_t)(20000 + 31 * x * y);
        image[2 * plane + i] = (uint16_t)(x % 3 * 65000);
    }
    return image;
}

/** An accepted sample with `reference` kept must be written the same again. */
static void check_sample(const uint8_t *sample, size_t sample_size, uint32_t size,
                         const uint16_t *previous, uint16_t *codes) {
    gvc_buffer again = {0};
    if (gvc_residual_decode(sample, sample_size, size, previous, codes, NULL) != GVC_OK) return;
    if (gvc_residual_encode(size, codes, sample[1] ? previous : NULL, (gvc_predictor_kind)sample[0],
                            &again, NULL) != GVC_OK) {
        abort();
    }
    if (again.size != sample_size || memcmp(again.data, sample, sample_size) != 0) abort();
    gvc_buffer_free(&again);
}

static void check_image(const uint16_t *codes, uint32_t size, const uint16_t *previous,
                        gvc_predictor_kind predictor) {
    size_t bytes = 3 * (size_t)size * size * sizeof *codes;
    uint16_t *back = allocate(bytes);
    gvc_buffer sample = {0};
    if (gvc_residual_encode(size, codes, previous, predictor, &sample, NULL) != GVC_OK ||
        gvc_residual_decode(sample.data, sample.size, size, previous, back, NULL) != GVC_OK ||
        memcmp(codes, back, bytes) != 0) {
        abort();
    }
    gvc_buffer_free(&sample);
    free(back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) return 0;
    unsigned option = data[0];
    uint32_t image_size = LEAST_SIZE + (option & OPTION_SIZE);
    size_t bytes = 3 * (size_t)image_size * image_size * sizeof(uint16_t);
    uint16_t *codes = allocate(bytes), *smooth = make_previous(image_size);
    const uint16_t *previous = option & OPTION_ALONE ? NULL : smooth;
    if (option & OPTION_CODES) {
        memcpy(codes, data + 1, size - 1 < bytes ? size - 1 : bytes);
        check_image(codes, image_size, previous,
                    option & OPTION_PREDICTOR ? GVC_PREDICTOR_GRADIENT : GVC_PREDICTOR_SQUARES);
    } else {
        check_sample(data + 1, size - 1, image_size, previous, codes);
    }
    free(codes);
    free(smooth);
    return 0;
}
