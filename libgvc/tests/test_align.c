/* SPDX-License-Identifier: MIT */
/** @file test_align.c  A chart slides to where the samples of another frame are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "chart/align.h"
#include "flat_disk.h"

#define SIZE 40
#define VERTICES 30

static void flat(double u, double v, double p[3]) {
    p[0] = u;
    p[1] = v;
    p[2] = 0;
}

/* Pixel (x, y) is to show the material at this place, in the unit square: the border stays. */
static void wanted(double strength, size_t x, size_t y, double place[2]) {
    const double pi = 3.14159265358979323846;
    double u = (double)x / (SIZE - 1), v = (double)y / (SIZE - 1);
    double bump = strength * sin(pi * u) * sin(pi * v);
    place[0] = u + bump * bump * 0.7;
    place[1] = v - bump * bump * 0.4;
}

static void set_target(double strength, double *target) {
    for (size_t i = 0; i < SIZE * SIZE; i++) {
        double place[2];
        wanted(strength, i % SIZE, i / SIZE, place);
        target[i] = place[0];
        target[SIZE * SIZE + i] = place[1];
        target[2 * SIZE * SIZE + i] = 0;
    }
}

/* Mean distance, in pixels, between where material is in the chart and where it is to be. The
 * chart is flat, so material is its own place: vertex v shows at uv, wanted where pixel uv asks. */
static double misfit(const gvc_disk *disk, const double *uv, double strength) {
    double sum = 0;
    size_t count = 0;
    for (size_t v = 0; v < disk->mesh.vertex_count; v++) {
        const double *p = disk->mesh.position + 3 * v;
        if (p[0] < 0.2 || p[1] < 0.2 || p[0] > 0.8 || p[1] > 0.8) continue;
        double x = uv[2 * v], y = uv[2 * v + 1], place[2];
        wanted(strength, (size_t)lrint(x), (size_t)lrint(y), place);
        /* the wanted place at a pixel nearby, taken to (x, y) by its unit slope */
        place[0] += (x - (double)lrint(x)) / (SIZE - 1);
        place[1] += (y - (double)lrint(y)) / (SIZE - 1);
        sum += hypot(place[0] - p[0], place[1] - p[1]) * (SIZE - 1);
        count++;
    }
    return sum / (double)count;
}

static size_t flips(const gvc_disk *disk, const double *uv) {
    size_t count = 0;
    for (size_t f = 0; f < disk->mesh.face_count; f++) {
        const uint32_t *v = disk->mesh.vertex + 3 * f;
        const double *a = uv + 2 * v[0], *b = uv + 2 * v[1], *c = uv + 2 * v[2];
        count += !((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    return count;
}

static void test_slides_to_the_target(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv, *target = malloc(3 * SIZE * SIZE * sizeof *target), border[8];
    const gvc_align_options all = {1, 1}, half = {0.5, 1};
    const double strength = 0.25;
    assert_non_null(target);
    assert_int_equal(flat_disk_make(VERTICES, 0.2, SIZE, flat, &disk, &uv, NULL), GVC_OK);
    set_target(strength, target);
    double before = misfit(&disk, uv, strength);
    assert_true(before > 0.8);
    for (int i = 0; i < 4; i++) memcpy(border + 2 * i, uv + 2 * disk.border[9 * i], 2 * sizeof *uv);
    assert_int_equal(gvc_align(&disk, SIZE, target, &half, uv, NULL), GVC_OK);
    double middle = misfit(&disk, uv, strength);
    assert_true(middle < 0.65 * before && middle > 0.35 * before);
    assert_int_equal(gvc_align(&disk, SIZE, target, &all, uv, NULL), GVC_OK);
    assert_true(misfit(&disk, uv, strength) < 0.15 * before);
    assert_int_equal(flips(&disk, uv), 0);
    for (int i = 0; i < 4; i++)
        assert_memory_equal(border + 2 * i, uv + 2 * disk.border[9 * i], 2 * sizeof *uv);
    flat_disk_free(&disk, uv);
    free(target);
}

/* Targets off the surface, and a target that would fold the chart over, leave a chart that is one.
 */
static void test_never_folds(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv, *target = malloc(3 * SIZE * SIZE * sizeof *target);
    const gvc_align_options all = {1, 1};
    assert_non_null(target);
    assert_int_equal(flat_disk_make(VERTICES, 0.3, SIZE, flat, &disk, &uv, NULL), GVC_OK);
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        target[i] = (i % SIZE) / (SIZE - 1.0) + 0.12 * (flat_noise(i, 5) - 0.5);
        target[SIZE * SIZE + i] = (i / SIZE) / (SIZE - 1.0) + 0.12 * (flat_noise(i, 6) - 0.5);
        target[2 * SIZE * SIZE + i] = 0;
    }
    assert_int_equal(gvc_align(&disk, SIZE, target, &all, uv, NULL), GVC_OK);
    assert_int_equal(flips(&disk, uv), 0);
    double *kept = malloc(2 * VERTICES * VERTICES * sizeof *kept);
    assert_non_null(kept);
    memcpy(kept, uv, 2 * VERTICES * VERTICES * sizeof *kept);
    for (size_t i = 0; i < SIZE * SIZE; i++) target[2 * SIZE * SIZE + i] = 5;
    assert_int_equal(gvc_align(&disk, SIZE, target, &all, uv, NULL), GVC_OK);
    assert_memory_equal(kept, uv, 2 * VERTICES * VERTICES * sizeof *kept);
    free(kept);
    flat_disk_free(&disk, uv);
    free(target);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slides_to_the_target),
        cmocka_unit_test(test_never_folds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
