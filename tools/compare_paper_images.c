/* SPDX-License-Identifier: MIT */
/** @file compare_paper_images.c  8-bit geometry images, and how much they change in time. */
#include "compare_paper.h"

#include "base/memory.h"
#include "base/result.h"
#include "encode/scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STEPS 255

const char *paper_method_name(paper_method method) {
    static const char *const name[PAPER_METHODS] = {"gis", "fixed", "mixed"};
    return name[method];
}

/* ---------------------------------------------------------------------------------------- cube */

static bool scan_progress(void *user, gvc_stage stage, uint64_t done, uint64_t total) {
    const paper_options *options = user;
    (void)stage;
    return !options->progress || options->progress(options->user, "reading", done, total);
}

gvc_result paper_find_cube(const gvc_source *source, const paper_options *options, paper_cube *cube,
                           gvc_error *error) {
    paper_options reading = *options;
    gvc_encode_options scan;
    gvc_encode_options_init(&scan);
    scan.threads = options->threads;
    scan.progress = scan_progress;
    scan.user = &reading;
    gvc_scan_frame *facts = gvc_alloc((size_t)source->frame_count, sizeof *facts);
    if (!facts) return gvc_fail_memory(error);
    gvc_result result = gvc_scan(source, &scan, facts, error);
    if (result == GVC_OK) {
        double low[3], high[3];
        memcpy(low, facts[0].minimum, sizeof low);
        memcpy(high, facts[0].maximum, sizeof high);
        for (uint64_t f = 1; f < source->frame_count; f++) {
            for (int k = 0; k < 3; k++) {
                low[k] = fmin(low[k], facts[f].minimum[k]);
                high[k] = fmax(high[k], facts[f].maximum[k]);
            }
        }
        cube->side = 0;
        for (int k = 0; k < 3; k++) cube->side = fmax(cube->side, high[k] - low[k]);
        for (int k = 0; k < 3; k++) cube->origin[k] = (low[k] + high[k] - cube->side) / 2;
    }
    free(facts);
    return result;
}

/* -------------------------------------------------------------------------------------- images */

static size_t image_bytes(const paper_images *images) {
    return (size_t)PAPER_COMPONENTS * images->size * images->size;
}

gvc_result paper_images_create(uint64_t frame_count, uint32_t size, const paper_cube *cube,
                               paper_images *images, gvc_error *error) {
    *images = (paper_images){.frame_count = frame_count, .size = size, .cube = *cube};
    images->code = gvc_alloc((size_t)frame_count, image_bytes(images));
    return images->code ? GVC_OK : gvc_fail_memory(error);
}

void paper_images_free(paper_images *images) {
    free(images->code);
    *images = (paper_images){0};
}

void paper_images_set(paper_images *images, uint64_t frame, const double *coordinates) {
    size_t samples = (size_t)images->size * images->size;
    uint8_t *code = images->code + frame * image_bytes(images);
    for (size_t i = 0; i < PAPER_COMPONENTS * samples; i++) {
        double place = (coordinates[i] - images->cube.origin[i / samples]) / images->cube.side;
        code[i] = (uint8_t)lrint(fmin(fmax(place * STEPS, 0), STEPS));
    }
}

double paper_images_mse(const paper_images *images, uint64_t frame) {
    const uint8_t *a = images->code + frame * image_bytes(images), *b = a + image_bytes(images);
    uint64_t sum = 0;
    for (size_t i = 0; i < image_bytes(images); i++) {
        int difference = a[i] - b[i];
        sum += (uint64_t)(difference * difference);
    }
    return (double)sum / ((double)images->size * images->size);
}

/* -------------------------------------------------------------------------------------- result */

void paper_result_free(paper_result *result) {
    free(result->mse);
    *result = (paper_result){0};
}

gvc_result paper_result_set_mse(paper_result *result, const paper_images *images,
                                gvc_error *error) {
    uint64_t pairs = images->frame_count - 1;
    double sum = 0;
    result->frame_count = images->frame_count;
    result->mse = gvc_alloc((size_t)pairs, sizeof *result->mse);
    if (!result->mse) return gvc_fail_memory(error);
    for (uint64_t f = 0; f < pairs; f++) sum += result->mse[f] = paper_images_mse(images, f);
    result->mse_mean = pairs ? sum / (double)pairs : NAN;
    return GVC_OK;
}
