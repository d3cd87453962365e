/* SPDX-License-Identifier: MIT */
/** @file test_parameterize.c  The inner parameterization: exact cases, limbs, fallbacks, failure.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "chart/curvature.h"
#include "chart/parameterize.h"
#include "flat_disk.h"

#define SIZE 65

static void plane(double u, double v, double p[3]) {
    p[0] = 3 * u + 1;
    p[1] = 2 * v - u;
    p[2] = 5;
}

/** A finger of a tenth of the plate's width and many times as long, closed by a cap. */
static void limb(double u, double v, double p[3]) {
    double x = 2 * u - 1, y = 2 * v - 1, around = sqrt(x * x + y * y);
    double r = fmax(fabs(x), fabs(y)), cap = fmin(r / 0.1, 1), foot = fmax(r - 0.7, 0);
    double radius = 0.1 * sqrt(cap * (2 - cap)) + 3 * foot;
    p[0] = around > 0 ? radius * x / around : 0;
    p[1] = around > 0 ? radius * y / around : 0;
    p[2] = r < 0.7 ? 2 * (0.7 - r) : 0;
}

static void small_limb(double u, double v, double p[3]) {
    limb(u, v, p);
    for (int c = 0; c < 3; c++) p[c] *= 1e-3;
}

static const gvc_parameterize_options usual = {1.1, 0.5};

/** Clears inner places, so that a result cannot be left over from the input. */
static void forget_inner(const gvc_disk *disk, double *uv) {
    for (size_t v = 0; v < disk->mesh.vertex_count; v++) {
        double x = uv[2 * v], y = uv[2 * v + 1];
        if (x > 0 && y > 0 && x < SIZE - 1 && y < SIZE - 1) uv[2 * v] = uv[2 * v + 1] = -1e3;
    }
}

static double *copy_uv(const gvc_disk *disk, const double *uv) {
    double *copy = malloc(2 * disk->mesh.vertex_count * sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, uv, 2 * disk->mesh.vertex_count * sizeof *copy);
    return copy;
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

/** Harmonic weights reproduce affine maps; stretch and curvature are constant on a plane
 * whose border is placed isometrically, so the further weights must not change that. */
static void flat_surface_keeps_its_shape(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    gvc_parameterize_report report;
    assert_int_equal(flat_disk_make(20, 0.3, SIZE, plane, &disk, &uv, NULL), GVC_OK);
    double *expected = copy_uv(&disk, uv);
    forget_inner(&disk, uv);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &usual, uv, &report, NULL), GVC_OK);
    for (size_t i = 0; i < 2 * disk.mesh.vertex_count; i++)
        assert_true(fabs(uv[i] - expected[i]) < 1e-9);
    assert_int_equal(report.fallback, 0);
    assert_int_equal(report.flipped, 0);
    /* The plane is sheared: stretch of the affine map from the unit square, normalised. */
    assert_true(fabs(report.stretch - sqrt((3 * 3 + 1 + 2 * 2) / 2.0 / 6)) < 1e-9);
    free(expected);
    flat_disk_free(&disk, uv);
}

/** Splits every inner edge in the middle; the surface stays what it is. */
static void split_inner_edges(gvc_disk *disk) {
    gvc_halfedges *m = &disk->mesh;
    uint32_t vertex, old = (uint32_t)m->vertex_count, end = 3 * (uint32_t)m->face_count;
    for (uint32_t h = 0; h < end; h++) {
        uint32_t from = m->vertex[h], to = m->vertex[gvc_next(h)];
        if (m->twin[h] != GVC_NONE && from < to && to < old)
            assert_int_equal(gvc_halfedges_split(m, h, 0.5, &vertex, NULL), GVC_OK);
    }
    free(disk->original);
    disk->original = malloc(m->vertex_count * sizeof *disk->original);
    assert_non_null(disk->original);
    for (size_t v = 0; v < m->vertex_count; v++) disk->original[v] = (uint32_t)v;
}

/** One surface in two triangulations, the finer one full of slivers. Mean value coordinates, for
 * one, put the vertices 0.9 pixels apart. */
static void does_not_depend_on_the_mesh(void **state) {
    (void)state;
    const gvc_parameterize_options none = {0, 0};
    enum { N = 41 };
    gvc_disk coarse, fine;
    double *uv, *fine_uv, sum = 0;
    assert_int_equal(flat_disk_make(N, 0, SIZE, limb, &coarse, &uv, NULL), GVC_OK);
    assert_int_equal(flat_disk_make(N, 0, SIZE, limb, &fine, &fine_uv, NULL), GVC_OK);
    split_inner_edges(&fine);
    fine_uv = realloc(fine_uv, 2 * fine.mesh.vertex_count * sizeof *fine_uv);
    assert_non_null(fine_uv);
    assert_int_equal(gvc_parameterize(&coarse, SIZE, &none, uv, NULL, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&fine, SIZE, &none, fine_uv, NULL, NULL), GVC_OK);
    for (size_t i = 0; i < 2 * N * N; i++) sum += (uv[i] - fine_uv[i]) * (uv[i] - fine_uv[i]);
    assert_true(sqrt(sum / (N * N)) < 0.1);
    flat_disk_free(&coarse, uv);
    flat_disk_free(&fine, fine_uv);
}

static void stretch_step_unfolds_a_limb(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    gvc_parameterize_report harmonic, full;
    const gvc_parameterize_options none = {0, 0};
    assert_int_equal(flat_disk_make(41, 0.2, SIZE, limb, &disk, &uv, NULL), GVC_OK);
    double *other = copy_uv(&disk, uv);
    forget_inner(&disk, uv);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &none, uv, &harmonic, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &usual, other, &full, NULL), GVC_OK);
    assert_int_equal(harmonic.fallback + full.fallback, 0);
    assert_int_equal(flips(&disk, uv) + flips(&disk, other), 0);
    assert_true(harmonic.stretch > 4);
    assert_true(full.stretch < 0.75 * harmonic.stretch);
    free(other);
    flat_disk_free(&disk, uv);
}

static void does_not_depend_on_the_unit(void **state) {
    (void)state;
    gvc_disk disk, small;
    double *uv, *small_uv;
    assert_int_equal(flat_disk_make(31, 0.2, SIZE, limb, &disk, &uv, NULL), GVC_OK);
    assert_int_equal(flat_disk_make(31, 0.2, SIZE, small_limb, &small, &small_uv, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &usual, uv, NULL, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&small, SIZE, &usual, small_uv, NULL, NULL), GVC_OK);
    for (size_t i = 0; i < 2 * disk.mesh.vertex_count; i++)
        assert_true(fabs(uv[i] - small_uv[i]) < 1e-6);
    flat_disk_free(&disk, uv);
    flat_disk_free(&small, small_uv);
}

/** Exponents that overflow every weight leave the harmonic map; curvature alone is dropped
 * first. */
static void falls_back_in_order(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    gvc_parameterize_report report;
    const gvc_parameterize_options curvature = {1.1, 1e6}, stretch = {1e6, 0.5}, none = {0, 0};
    assert_int_equal(flat_disk_make(21, 0.2, SIZE, limb, &disk, &uv, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &curvature, uv, &report, NULL), GVC_OK);
    assert_int_equal(report.fallback, 1);
    assert_int_equal(flips(&disk, uv), 0);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &stretch, uv, &report, NULL), GVC_OK);
    assert_int_equal(report.fallback, 2);
    double *plain = copy_uv(&disk, uv);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &none, plain, &report, NULL), GVC_OK);
    assert_int_equal(report.fallback, 0);
    assert_memory_equal(uv, plain, 2 * disk.mesh.vertex_count * sizeof *uv);
    free(plain);
    flat_disk_free(&disk, uv);
}

/** A border vertex moved so that a triangle of border vertices is flat cannot be repaired. */
static void reports_a_flat_triangle(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    gvc_error error;
    gvc_error_init(&error);
    assert_int_equal(flat_disk_make(6, 0, SIZE, plane, &disk, &uv, NULL), GVC_OK);
    uv[0] = 1e-3; /* the square's corner, now on the wrong side of its neighbours' edge */
    uv[1] = SIZE - 1;
    double *before = copy_uv(&disk, uv);
    gvc_parameterize_report report = {.stretch = -1};
    assert_int_equal(gvc_parameterize(&disk, SIZE, &usual, uv, &report, &error), GVC_ERROR_MESH);
    assert_int_equal(error.code, GVC_ERROR_MESH);
    assert_memory_equal(uv, before, 2 * disk.mesh.vertex_count * sizeof *uv);
    free(before);
    flat_disk_free(&disk, uv);
}

static void a_disk_without_inner_vertices(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    gvc_parameterize_report report;
    assert_int_equal(flat_disk_make(2, 0, SIZE, plane, &disk, &uv, NULL), GVC_OK);
    assert_int_equal(gvc_parameterize(&disk, SIZE, &usual, uv, &report, NULL), GVC_OK);
    assert_int_equal(report.flipped, 0);
    flat_disk_free(&disk, uv);
}

/** A roof: bent along its ridge only, flat elsewhere. */
static void roof(double u, double v, double p[3]) {
    p[0] = u;
    p[1] = v;
    p[2] = -fabs(u - 0.5);
}

static void curvature_sits_at_the_crease(void **state) {
    (void)state;
    double ridge[2], slope[2];
    for (int fine = 0; fine < 2; fine++) {
        gvc_disk disk;
        double *uv, curvature[61 * 61];
        uint32_t n = fine ? 61 : 31;
        assert_int_equal(flat_disk_make(n, 0, SIZE, roof, &disk, &uv, NULL), GVC_OK);
        assert_int_equal(gvc_curvature(&disk, curvature, NULL), GVC_OK);
        ridge[fine] = curvature[n / 2 * n + n / 2];
        slope[fine] = curvature[n / 2 * n + n / 6];
        flat_disk_free(&disk, uv);
    }
    for (int fine = 0; fine < 2; fine++) {
        assert_true(ridge[fine] > 3 && ridge[fine] <= 4);
        assert_true(slope[fine] >= 0.25 && slope[fine] < 0.5);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_surface_keeps_its_shape),
        cmocka_unit_test(does_not_depend_on_the_mesh),
        cmocka_unit_test(stretch_step_unfolds_a_limb),
        cmocka_unit_test(does_not_depend_on_the_unit),
        cmocka_unit_test(falls_back_in_order),
        cmocka_unit_test(reports_a_flat_triangle),
        cmocka_unit_test(a_disk_without_inner_vertices),
        cmocka_unit_test(curvature_sits_at_the_crease),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
