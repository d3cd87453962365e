/* SPDX-License-Identifier: MIT */
/** @file test_geodesic.c  Fast marching against surfaces whose geodesics are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/geodesic.h"
#include "made_surfaces.h"

/* Distances from one vertex; the caller frees them. */
static double *march_from(const gvc_halfedges *mesh, uint32_t source) {
    gvc_marcher *marcher;
    double *distance = calloc(mesh->vertex_count, sizeof *distance);
    assert_int_equal(gvc_marcher_create(mesh, &marcher, NULL), GVC_OK);
    assert_int_equal(gvc_march(marcher, &source, 1, distance, NULL), GVC_OK);
    gvc_marcher_destroy(&marcher);
    assert_null(marcher);
    return distance;
}

static double straight(const gvc_halfedges *mesh, size_t a, size_t b) {
    const double *p = mesh->position + 3 * a, *q = mesh->position + 3 * b;
    return sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                (p[2] - q[2]) * (p[2] - q[2]));
}

static double arc(const gvc_halfedges *mesh, size_t a, size_t b) {
    return 2 * asin(fmin(1, straight(mesh, a, b) / 2));
}

/* Mean relative error over all targets. */
static double mean_error(const gvc_halfedges *mesh, uint32_t source,
                         double (*truth)(const gvc_halfedges *, size_t, size_t)) {
    double *distance = march_from(mesh, source), sum = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (v != source) sum += fabs(distance[v] / truth(mesh, source, v) - 1);
    free(distance);
    return sum / (double)(mesh->vertex_count - 1);
}

/* On a plane the planar-source update is exact, as long as obtuse corners are split: sheared, a
 * third of all corners are obtuse, and the distances without splitting are 13 % too long. */
static void plane_is_exact(void **state) {
    (void)state;
    double shears[] = {0, 0.5, 1.5};
    for (int i = 0; i < 3; i++) {
        gvc_halfedges grid = made_grid(40, 40, shears[i], 0);
        uint32_t sources[] = {0, 20 * 41 + 20, 40 * 41 + 7};
        for (int s = 0; s < 3; s++) {
            double *distance = march_from(&grid, sources[s]);
            for (size_t v = 0; v < grid.vertex_count; v++)
                assert_float_equal(distance[v], straight(&grid, sources[s], v), 1e-9);
            free(distance);
        }
        gvc_halfedges_free(&grid);
    }
}

static void irregular_plane(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(50, 50, 0, 0.28);
    assert_true(mean_error(&grid, 0, straight) < 1e-3);
    assert_true(mean_error(&grid, 25 * 51 + 25, straight) < 1e-3);
    gvc_halfedges_free(&grid);
}

static void sphere(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(4), globe = made_globe(36, 72);
    assert_int_equal(ball.vertex_count, 1026);
    assert_int_equal(globe.vertex_count, 35 * 72 + 2);
    for (uint32_t source = 0; source < 1026; source += 101)
        assert_true(mean_error(&ball, source, arc) < 0.01);
    for (uint32_t source = 0; source < globe.vertex_count; source += 313)
        assert_true(mean_error(&globe, source, arc) < 0.01);
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&globe);
}

/* A body with limbs from two triangulations that share the six vertices on the axes. */
static void triangulations_agree(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(5), globe = made_globe(48, 96);
    uint32_t on_globe[6];
    uint32_t equator = 23 * 96;
    on_globe[0] = equator, on_globe[1] = equator + 48, on_globe[2] = equator + 24;
    on_globe[3] = equator + 72, on_globe[4] = 47 * 96, on_globe[5] = 47 * 96 + 1;
    made_limbs(&ball);
    made_limbs(&globe);
    for (uint32_t a = 0; a < 6; a++) {
        double *first = march_from(&ball, a), *second = march_from(&globe, on_globe[a]);
        for (uint32_t b = 0; b < 6; b++)
            assert_float_equal(first[b], second[on_globe[b]], 0.01 * first[b] + 1e-12);
        free(first);
        free(second);
    }
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&globe);
}

static void neighbours_are_exact(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(3);
    for (uint32_t source = 0; source < ball.vertex_count; source += 17) {
        double *distance = march_from(&ball, source);
        assert_true(distance[source] == 0);
        uint32_t h = ball.outgoing[source];
        do {
            uint32_t neighbour = ball.vertex[gvc_next(h)];
            assert_float_equal(distance[neighbour], straight(&ball, source, neighbour), 1e-14);
            h = gvc_turn(&ball, h);
        } while (h != ball.outgoing[source]);
        free(distance);
    }
    gvc_halfedges_free(&ball);
}

static void nearest_of_several_sources(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(4);
    gvc_marcher *marcher;
    double *distance = calloc(ball.vertex_count, sizeof *distance);
    uint32_t sources[] = {0, 3, 4, 0};
    assert_int_equal(gvc_marcher_create(&ball, &marcher, NULL), GVC_OK);
    assert_int_equal(gvc_march(marcher, sources, 4, distance, NULL), GVC_OK);
    for (size_t v = 0; v < ball.vertex_count; v++) {
        double truth = fmin(arc(&ball, 0, v), fmin(arc(&ball, 3, v), arc(&ball, 4, v)));
        assert_float_equal(distance[v], truth, 0.03 * truth + 1e-15);
    }
    gvc_marcher_destroy(&marcher);
    free(distance);
    gvc_halfedges_free(&ball);
}

/* A marcher carries nothing over from one march to the next. */
static void marcher_is_reusable(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(4);
    gvc_marcher *marcher;
    double *again = calloc(ball.vertex_count, sizeof *again), *once = march_from(&ball, 77);
    uint32_t sources[] = {500, 77};
    assert_int_equal(gvc_marcher_create(&ball, &marcher, NULL), GVC_OK);
    assert_int_equal(gvc_march(marcher, &sources[0], 1, again, NULL), GVC_OK);
    assert_int_equal(gvc_march(marcher, &sources[1], 1, again, NULL), GVC_OK);
    assert_memory_equal(again, once, ball.vertex_count * sizeof *again);
    gvc_marcher_destroy(&marcher);
    free(again);
    free(once);
    gvc_halfedges_free(&ball);
}

static void unreachable_is_infinite(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(1), two = made_twice(&ball);
    double *distance = march_from(&two, 0);
    for (size_t v = 0; v < two.vertex_count; v++)
        assert_true(isinf(distance[v]) == (v >= ball.vertex_count));
    free(distance);
    gvc_halfedges_free(&two);
    gvc_halfedges_free(&ball);
}

static void no_source_and_wrong_source(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(0);
    gvc_marcher *marcher;
    double distance[6];
    gvc_error error;
    uint32_t wrong = 6;
    assert_int_equal(gvc_marcher_create(&ball, &marcher, NULL), GVC_OK);
    assert_int_equal(gvc_march(marcher, NULL, 0, distance, NULL), GVC_OK);
    for (int v = 0; v < 6; v++) assert_true(isinf(distance[v]));
    assert_int_equal(gvc_march(marcher, &wrong, 1, distance, &error), GVC_ERROR_ARGUMENT);
    assert_int_equal(error.code, GVC_ERROR_ARGUMENT);
    gvc_marcher_destroy(&marcher);
    gvc_marcher_destroy(&marcher);
    gvc_halfedges_free(&ball);
}

/* Slivers and faces without area must not bring in NaN or wrong shortcuts. */
static void degenerate_faces(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(20, 20, 0, 0);
    for (size_t v = 0; v < grid.vertex_count; v++)
        if (v / 21 == 10) grid.position[3 * v + 1] = 11; /* row 10 falls onto row 11 */
    double *distance = march_from(&grid, 0);
    for (size_t v = 0; v < grid.vertex_count; v++)
        assert_float_equal(distance[v], straight(&grid, 0, v), 0.02 * straight(&grid, 0, v) + 1e-9);
    free(distance);
    gvc_halfedges_free(&grid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane_is_exact),
        cmocka_unit_test(irregular_plane),
        cmocka_unit_test(sphere),
        cmocka_unit_test(triangulations_agree),
        cmocka_unit_test(neighbours_are_exact),
        cmocka_unit_test(nearest_of_several_sources),
        cmocka_unit_test(marcher_is_reusable),
        cmocka_unit_test(unreachable_is_infinite),
        cmocka_unit_test(no_source_and_wrong_source),
        cmocka_unit_test(degenerate_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
