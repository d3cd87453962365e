/* SPDX-License-Identifier: MIT */
/** @file test_sample.c  Point samples and their least-squares fit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "chart/sample.h"
#include "flat_disk.h"

static void plane(double u, double v, double p[3]) {
    p[0] = 3 * u + 1;
    p[1] = 2 * v - u;
    p[2] = u + v;
}

static void waves(double u, double v, double p[3]) {
    p[0] = u;
    p[1] = v;
    p[2] = 0.05 * sin(25 * u) * cos(31 * v);
}

/** Border position of the radial projection of (u, v), of a loop of length 4, and the distance from
 * the centre in the maximum norm. */
static double loop_position(double u, double v, double *r) {
    double x = 2 * u - 1, y = 2 * v - 1;
    *r = fmax(fabs(x), fabs(y));
    if (*r == 0) return 0;
    x /= *r;
    y /= *r;
    if (y == -1) return (x + 1) / 2;
    if (x == 1) return 1 + (y + 1) / 2;
    if (y == 1) return 2 + (1 - x) / 2;
    return 3 + (1 - y) / 2;
}

#define POUCH_START 0.5 /* of a side of the square */

/** A pouch: the border of the square is folded onto the segment from (1,0,0) to (-1,0,0). */
static void pouch(double u, double v, double p[3]) {
    const double pi = 3.14159265358979323846;
    double r, at = loop_position(u, v, &r) - POUCH_START, angle = at * pi / 2;
    p[0] = r * (1 - fabs(fmod(at + 4, 4) - 2)); /* linear in the position along the border */
    p[1] = 2 * r * (1 - r * r) * sin(angle);
    p[2] = 1 - r * r;
}

/** A weld that joins nothing. */
static gvc_weld loose_weld(uint32_t size) {
    gvc_weld weld = {.size = size, .vertex_count = size * size, .border_count = 4 * (size - 1)};
    weld.vertex = malloc((size_t)size * size * sizeof *weld.vertex);
    assert_non_null(weld.vertex);
    for (uint32_t i = 0; i < size * size; i++) weld.vertex[i] = i;
    return weld;
}

/** One cut edge, folded at its two ends. */
static gvc_weld pouch_weld(uint32_t size) {
    uint32_t steps[1] = {2 * (size - 1)};
    gvc_side sides[2] = {{0, false}, {0, true}};
    gvc_side_table table = {.size = size,
                            .start = (uint32_t)(POUCH_START * (size - 1)),
                            .edge_count = 1,
                            .steps = steps,
                            .side_count = 2,
                            .side = sides};
    gvc_weld weld;
    assert_int_equal(gvc_weld_build(&table, &weld, NULL), GVC_OK);
    return weld;
}

/** Sampling an affine surface gives the affine function, whichever triangles cover a pixel: here
 * pixels fall on vertices and edges (n - 1 divides or is divided by size - 1) and into needles. */
static void affine_surface_is_sampled_exactly(void **state) {
    (void)state;
    const struct {
        uint32_t n, size;
        double jitter;
    } cases[] = {{17, 33, 0},   {33, 33, 0},    {65, 33, 0},
                 {20, 33, 0.3}, {50, 17, 0.49}, {3, 65, 0.4}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        uint32_t size = cases[k].size;
        gvc_disk disk;
        double *uv;
        assert_int_equal(flat_disk_make(cases[k].n, cases[k].jitter, size, plane, &disk, &uv, NULL),
                         GVC_OK);
        gvc_weld weld = loose_weld(size);
        double *image = malloc(3 * (size_t)size * size * sizeof *image);
        for (size_t i = 0; i < 3 * (size_t)size * size; i++) image[i] = NAN;
        for (int fitted = 0; fitted < 2; fitted++) {
            gvc_result result = fitted ? gvc_sample_fit(&disk, uv, &weld, 1e-3, image, NULL)
                                       : gvc_sample_points(&disk, uv, &weld, image, NULL);
            assert_int_equal(result, GVC_OK);
            for (uint32_t i = 0; i < size * size; i++) {
                double expected[3];
                plane(i % size / (size - 1.0), i / size / (size - 1.0), expected);
                for (uint32_t c = 0; c < 3; c++)
                    assert_true(fabs(image[c * size * size + i] - expected[c]) < 1e-10);
            }
        }
        free(image);
        gvc_weld_free(&weld);
        flat_disk_free(&disk, uv);
    }
}

static void check_twins(const gvc_weld *weld, const double *image) {
    size_t plane_size = (size_t)weld->size * weld->size;
    size_t *first = calloc(weld->vertex_count, sizeof *first), welded = 0;
    for (size_t i = 0; i < plane_size; i++) {
        size_t *seen = &first[weld->vertex[i]];
        if (*seen == 0) {
            *seen = i + 1;
            continue;
        }
        welded++;
        for (size_t c = 0; c < 3; c++)
            assert_memory_equal(&image[c * plane_size + i], &image[c * plane_size + *seen - 1],
                                sizeof *image);
    }
    assert_int_equal(welded, weld->border_count / 2 - 1);
    free(first);
}

static void twins_are_equal_and_on_the_cut(void **state) {
    (void)state;
    const uint32_t size = 33, plane_size = size * size;
    gvc_disk disk;
    double *uv;
    assert_int_equal(flat_disk_make(41, 0.2, size, pouch, &disk, &uv, NULL), GVC_OK);
    gvc_weld weld = pouch_weld(size);
    double *image = malloc(3 * plane_size * sizeof *image);
    assert_int_equal(gvc_sample_points(&disk, uv, &weld, image, NULL), GVC_OK);
    check_twins(&weld, image);
    for (uint32_t p = 0; p < weld.border_count; p++) {
        uint32_t x, y;
        gvc_border_pixel(size, p, &x, &y);
        double expected[3];
        pouch(x / (size - 1.0), y / (size - 1.0), expected);
        for (uint32_t c = 0; c < 3; c++)
            assert_true(fabs(image[c * plane_size + y * size + x] - expected[c]) < 1e-12);
    }
    assert_int_equal(gvc_sample_fit(&disk, uv, &weld, 1e-3, image, NULL), GVC_OK);
    check_twins(&weld, image);
    free(image);
    gvc_weld_free(&weld);
    flat_disk_free(&disk, uv);
}

/** Mean squared distance at corresponding parameters, by its own dense quadrature. */
static double squared_error(const gvc_disk *disk, const double *uv, uint32_t size,
                            const double *image) {
    double sum = 0, total = 0;
    const uint32_t parts = 12;
    for (size_t f = 0; f < disk->mesh.face_count; f++) {
        const uint32_t *v = disk->mesh.vertex + 3 * f;
        const double *q[3];
        double a[3], b[3];
        for (int k = 0; k < 3; k++) q[k] = disk->mesh.position + 3 * v[k];
        for (int c = 0; c < 3; c++) {
            a[c] = q[1][c] - q[0][c];
            b[c] = q[2][c] - q[0][c];
        }
        double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
        double area = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (uint32_t i = 0; i < parts; i++)
            for (uint32_t j = 0; i + j < parts; j++) {
                double s = (i + 0.25) / parts, t = (j + 0.25) / parts, r = 1 - s - t;
                double x = r * uv[2 * v[0]] + s * uv[2 * v[1]] + t * uv[2 * v[2]];
                double y = r * uv[2 * v[0] + 1] + s * uv[2 * v[1] + 1] + t * uv[2 * v[2] + 1];
                uint32_t xi = (uint32_t)fmin(floor(x), size - 2.0);
                uint32_t yi = (uint32_t)fmin(floor(y), size - 2.0);
                double fx = x - xi, fy = y - yi;
                for (uint32_t c = 0; c < 3; c++) {
                    const double *at = image + c * size * size + yi * size + xi;
                    double e = (1 - fx) * (1 - fy) * at[0] + fx * (1 - fy) * at[1] +
                               (1 - fx) * fy * at[size] + fx * fy * at[size + 1] -
                               (r * q[0][c] + s * q[1][c] + t * q[2][c]);
                    sum += area * e * e;
                }
                total += area;
            }
    }
    return sum / total;
}

/** The fit must clearly beat point samples, and be a minimum: no single sample can be moved to
 * gain more than the weak pull explains. */
static void fit_lowers_the_error(void **state) {
    (void)state;
    const uint32_t size = 17, plane_size = size * size;
    gvc_disk disk;
    double *uv;
    assert_int_equal(flat_disk_make(50, 0.3, size, waves, &disk, &uv, NULL), GVC_OK);
    gvc_weld weld = loose_weld(size);
    double *image = malloc(3 * plane_size * sizeof *image);
    assert_int_equal(gvc_sample_points(&disk, uv, &weld, image, NULL), GVC_OK);
    double before = squared_error(&disk, uv, size, image);
    assert_int_equal(gvc_sample_fit(&disk, uv, &weld, 1e-3, image, NULL), GVC_OK);
    double after = squared_error(&disk, uv, size, image);
    assert_true(after < 0.6 * before);
    for (uint32_t i = 0; i < 12; i++) {
        double *sample = image + 2 * plane_size + i * 24 % plane_size, kept = *sample;
        *sample = kept + (i % 2 ? 4e-3 : -4e-3);
        assert_true(squared_error(&disk, uv, size, image) > after);
        *sample = kept;
    }
    free(image);
    gvc_weld_free(&weld);
    flat_disk_free(&disk, uv);
}

/** Few large triangles over many pixels, and many small ones in a pixel, determine all samples. */
static void fit_is_finite_and_repeatable(void **state) {
    (void)state;
    const struct { uint32_t n, size; } cases[] = {{4, 65}, {90, 17}};
    for (size_t k = 0; k < 2; k++) {
        uint32_t size = cases[k].size, plane_size = size * size;
        gvc_disk disk;
        double *uv;
        assert_int_equal(flat_disk_make(cases[k].n, 0.3, size, pouch, &disk, &uv, NULL), GVC_OK);
        gvc_weld weld = pouch_weld(size);
        double *image = malloc(3 * plane_size * sizeof *image);
        double *again = malloc(3 * plane_size * sizeof *again);
        assert_int_equal(gvc_sample_points(&disk, uv, &weld, image, NULL), GVC_OK);
        memcpy(again, image, 3 * plane_size * sizeof *image);
        double before = squared_error(&disk, uv, size, image);
        assert_int_equal(gvc_sample_fit(&disk, uv, &weld, 1e-3, image, NULL), GVC_OK);
        assert_int_equal(gvc_sample_fit(&disk, uv, &weld, 1e-3, again, NULL), GVC_OK);
        assert_memory_equal(image, again, 3 * plane_size * sizeof *image);
        assert_true(squared_error(&disk, uv, size, image) < before);
        free(image);
        free(again);
        gvc_weld_free(&weld);
        flat_disk_free(&disk, uv);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(affine_surface_is_sampled_exactly),
        cmocka_unit_test(twins_are_equal_and_on_the_cut),
        cmocka_unit_test(fit_lowers_the_error),
        cmocka_unit_test(fit_is_finite_and_repeatable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
