/* SPDX-License-Identifier: MIT */
/** @file fuzz_exr.c  Fuzzes the reader of OpenEXR keyframes.
 *
 * The first byte picks the image size and whether the rest is a file or the codes of an image. An
 * image that is read, or made of the input, must come out of its own file unchanged. */
#include "codec/exr.h"

#include <stdlib.h>
#include <string.h>

#define LEAST_SIZE 16u
#define SIZES 64u /* 16 .. 79: more than one chunk of 16 lines */
#define OPTION_CODES 64u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void write_and_read(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts) {
    size_t count = 3 * (size_t)size * size;
    uint16_t *back = calloc(count, sizeof *back);
    gvc_exr_facts facts_back;
    gvc_buffer file = {0};
    if (!back || gvc_exr_encode(size, codes, facts, &file, NULL) != GVC_OK) abort();
    if (gvc_exr_decode(file.data, file.size, size, back, &facts_back, NULL) != GVC_OK) abort();
    if (memcmp(codes, back, count * sizeof *back) != 0) abort();
    if (facts_back.step != facts->step || strcmp(facts_back.unit, facts->unit) != 0) abort();
    gvc_buffer_free(&file);
    free(back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size == 0) return 0;
    uint32_t image_size = LEAST_SIZE + data[0] % SIZES;
    size_t bytes = 3 * (size_t)image_size * image_size * sizeof(uint16_t);
    gvc_exr_facts facts = {.step = 1};
    uint16_t *codes = calloc(1, bytes);
    if (!codes) abort();
    if (data[0] & OPTION_CODES) {
        memcpy(codes, data + 1, size - 1 < bytes ? size - 1 : bytes);
        write_and_read(image_size, codes, &facts);
    } else if (gvc_exr_decode(data + 1, size - 1, image_size, codes, &facts, NULL) == GVC_OK) {
        write_and_read(image_size, codes, &facts);
    }
    free(codes);
    return 0;
}
