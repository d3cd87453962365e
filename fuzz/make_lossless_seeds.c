/* SPDX-License-Identifier: MIT */
/** @file make_lossless_seeds.c  Writes valid seed inputs for fuzz_exr and fuzz_residual into the
 * folders given, and, for the replay test, each of them with single bytes changed. */
#include "codec/exr.h"
#include "codec/residual.h"
#include "exr_frame.h"
#include "seed.h"
#include "seed_torus.h"

#include <string.h>

#define SIZE 20u
#define OPTION (SIZE - 16u) /* both harnesses: image size minus 16 */
#define OPTION_ALONE 32u    /* fuzz_residual: no previous image */

/** A bent surface with some noise. */
static void make_image(uint16_t *codes) {
    uint32_t random = 1;
    for (uint32_t k = 0; k < 3; k++) {
        for (uint32_t y = 0; y < SIZE; y++) {
            for (uint32_t x = 0; x < SIZE; x++) {
                random = random * 1664525u + 1013904223u;
                *codes++ = (uint16_t)(20000 + 700 * (k + 1) * x + 40 * y * (x + k) + random % 16);
            }
        }
    }
}

static int save_exr(const char *folder, const uint16_t *codes, bool changed) {
    const gvc_exr_facts facts = {.origin = {-1, 0, 2.5}, .step = 0.001, .time = 0.5, .unit = "m"};
    gvc_buffer file = {0};
    int failed = gvc_exr_encode(SIZE, codes, &facts, &file, NULL) != GVC_OK ||
                 seed_save(folder, "image", OPTION, &file);
    if (!failed && changed) failed = seed_save_changed(folder, "changed", OPTION, &file, 1);
    gvc_buffer_free(&file);
    return failed;
}

/** A whole frame, which a file can be made of. */
static int save_frame(const char *folder, uint16_t *codes, bool changed) {
    torus_parts parts;
    gvc_exr_frame frame = {.config = {.picture_width = SIZE,
                                      .plane_height = SIZE,
                                      .image_size = SIZE,
                                      .code_bits = 10,
                                      .code_shift = 6,
                                      .frame_rate_num = 25,
                                      .frame_rate_den = 1},
                           .number = 7,
                           .group = 5,
                           .shape = make_torus(&parts, SIZE),
                           .codes = codes};
    gvc_buffer file = {0};
    int failed = gvc_exr_frame_write(&frame, &file, NULL) != GVC_OK ||
                 seed_save(folder, "frame", OPTION, &file);
    if (!failed && changed) failed = seed_save_changed(folder, "changed_frame", OPTION, &file, 3);
    gvc_buffer_free(&file);
    return failed;
}

static int save_residual(const char *folder, const char *name, const uint16_t *codes,
                         gvc_predictor_kind predictor, bool changed) {
    gvc_buffer sample = {0};
    int failed = gvc_residual_encode(SIZE, codes, NULL, predictor, &sample, NULL) != GVC_OK ||
                 seed_save(folder, name, OPTION | OPTION_ALONE, &sample);
    if (!failed) sample.data[1] = 1; /* the reference: then bits that fit by chance only */
    failed = failed || seed_save(folder, predictor ? "refers_1" : "refers_0", OPTION, &sample);
    if (!failed && changed) {
        sample.data[1] = 0;
        failed = seed_save_changed(folder, name, OPTION | OPTION_ALONE, &sample, 5);
    }
    gvc_buffer_free(&sample);
    return failed;
}

int main(int argc, char **argv) {
    bool changed = argc == 4 && strcmp(argv[3], "--changed") == 0;
    if (argc != 3 && !changed) {
        fprintf(stderr, "usage: make_lossless_seeds EXR_FOLDER RESIDUAL_FOLDER [--changed]\n");
        return 2;
    }
    uint16_t codes[3 * SIZE * SIZE];
    make_image(codes);
    int failed = save_exr(argv[1], codes, changed);
    failed |= save_frame(argv[1], codes, changed);
    failed |= save_residual(argv[2], "gradient", codes, GVC_PREDICTOR_GRADIENT, changed);
    failed |= save_residual(argv[2], "squares", codes, GVC_PREDICTOR_SQUARES, changed);
    if (failed) fprintf(stderr, "make_lossless_seeds: cannot write to %s, %s\n", argv[1], argv[2]);
    return failed;
}
