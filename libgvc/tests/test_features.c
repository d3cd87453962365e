/* SPDX-License-Identifier: MIT */
/** @file test_features.c  The geodesic integral, the extrema and their attributes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/features.h"
#include "descriptor/integral.h"
#include "made_surfaces.h"

static const gvc_features_options OPTIONS = {.integral_samples = 100,
                                             .candidate_persistence = 0.01};

static gvc_features find(const gvc_halfedges *mesh) {
    gvc_features features;
    assert_int_equal(gvc_features_find(mesh, &OPTIONS, &features, NULL), GVC_OK);
    return features;
}

/* ---------------------------------------------------------------------------------- integral */

/* The mean distance to the points of a unit sphere is pi / 2, from everywhere. */
static void integral_of_a_sphere(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(4);
    double *mu = calloc(ball.vertex_count, sizeof *mu), greatest;
    size_t samples[] = {40, 100, 5000};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(gvc_geodesic_integral(&ball, samples[i], mu, &greatest, NULL), GVC_OK);
        double tolerance = i == 0 ? 0.05 : 0.03;
        for (size_t v = 0; v < ball.vertex_count; v++) assert_float_equal(mu[v], PI / 2, tolerance);
        assert_float_equal(greatest, PI, 0.07);
    }
    free(mu);
    gvc_halfedges_free(&ball);
}

/* Few samples give nearly what all vertices give. */
static void samples_suffice(void **state) {
    (void)state;
    gvc_halfedges body = made_sphere(4);
    made_limbs(&body);
    size_t count = body.vertex_count;
    double *few = calloc(count, sizeof *few), *all = calloc(count, sizeof *all), scale;
    assert_int_equal(gvc_geodesic_integral(&body, count, all, &scale, NULL), GVC_OK);
    double low = INFINITY, high = 0;
    for (size_t v = 0; v < count; v++) low = fmin(low, all[v]), high = fmax(high, all[v]);
    assert_int_equal(gvc_geodesic_integral(&body, 100, few, &scale, NULL), GVC_OK);
    for (size_t v = 0; v < count; v++) assert_float_equal(few[v], all[v], 0.02 * (high - low));
    free(few);
    free(all);
    gvc_halfedges_free(&body);
}

/* ---------------------------------------------------------------------------------- extrema */

/* A strip of two rows whose mu depends on the column only: a path, with every value doubled. */
static void persistences_and_areas_by_hand(void **state) {
    (void)state;
    enum { COLUMNS = 10 };
    static const double value[COLUMNS + 1] = {0.1, 0.8, 0.3, 1.0,  0.5, 0.6,
                                              0.0, 0.2, 0.4, 0.35, 0.36};
    gvc_halfedges strip = made_grid(COLUMNS, 1, 0, 0);
    double mu[2 * (COLUMNS + 1)];
    for (int i = 0; i < 2 * (COLUMNS + 1); i++) mu[i] = value[i % (COLUMNS + 1)];
    gvc_extremum *list;
    size_t count;
    assert_int_equal(gvc_extrema_find(&strip, mu, 0.001, &list, &count, NULL), GVC_OK);
    static const struct {
        uint32_t vertex;
        double persistence, area;
    } expected[] = {
        {3, 1.0, 3.5},         /* down to 0.3, where it meets column 1; halfway between 5 and 6 */
        {1, 0.5, 1 + 5.0 / 7}, /* down to 0.3, on both sides */
        {8, 0.4, 4},           /* down to 0 */
        {5, 0.1, 1 + 1.0 / 6}, /* down to 0.5 */
        {10, 0.01, 1},         /* down to 0.35 */
    };
    assert_int_equal(count, 5);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(list[i].vertex, expected[i].vertex);
        assert_float_equal(list[i].persistence, expected[i].persistence, 1e-12);
        assert_float_equal(list[i].mu, value[expected[i].vertex], 0);
        assert_float_equal(list[i].area, expected[i].area / COLUMNS, 1e-12);
        for (int k = 0; k < 3; k++)
            assert_true(list[i].position[k] == strip.position[3 * list[i].vertex + (uint32_t)k]);
    }
    free(list);
    assert_int_equal(gvc_extrema_find(&strip, mu, 0.2, &list, &count, NULL), GVC_OK);
    assert_int_equal(count, 3);
    free(list);
    gvc_halfedges_free(&strip);
}

static void a_plateau_has_one_extremum(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(2);
    double *mu = calloc(ball.vertex_count, sizeof *mu);
    gvc_extremum *list;
    size_t count;
    assert_int_equal(gvc_extrema_find(&ball, mu, 0, &list, &count, NULL), GVC_OK);
    assert_int_equal(count, 1);
    assert_int_equal(list[0].vertex, 0);
    assert_true(list[0].persistence == 1 && list[0].area == 1);
    free(list);
    mu[0] = NAN;
    assert_int_equal(gvc_extrema_find(&ball, mu, 0, &list, &count, NULL), GVC_ERROR_ARGUMENT);
    assert_null(list);
    free(mu);
    gvc_halfedges_free(&ball);
}

/* ---------------------------------------------------------------------------------- features */

static void check_limbs(const gvc_features *features) {
    size_t tips = 0;
    while (tips < features->extremum_count && features->extremum[tips].persistence >= 0.2) tips++;
    assert_int_equal(tips, LIMB_COUNT);
    double area = 0;
    for (int i = 0; i < LIMB_COUNT; i++) {
        double tip[3] = {LIMB[i][0], LIMB[i][1], LIMB[i][2]};
        made_unit(tip);
        int found = 0;
        for (size_t e = 0; e < tips; e++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = features->extremum[e].position[k];
            made_unit(p);
            if (p[0] * tip[0] + p[1] * tip[1] + p[2] * tip[2] < 0.98) continue;
            found++;
            assert_true(features->extremum[e].valence >= 3);
            area += features->extremum[e].area;
        }
        assert_int_equal(found, 1);
    }
    assert_true(area > 0.3 && area < 1);
    assert_true(features->extremum[0].persistence == 1);
}

static void limbs_are_found(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(5), globe = made_globe(48, 96);
    made_limbs(&ball);
    made_limbs(&globe);
    gvc_features on_ball = find(&ball), on_globe = find(&globe);
    check_limbs(&on_ball);
    check_limbs(&on_globe);
    for (int i = 0; i < LIMB_COUNT; i++) {
        const gvc_extremum *a = &on_ball.extremum[i], *b = &on_globe.extremum[i];
        assert_float_equal(a->persistence, b->persistence, 0.02);
        assert_float_equal(a->area, b->area, 0.03);
    }
    assert_float_equal(on_ball.geodesic_scale, on_globe.geodesic_scale,
                       0.02 * on_ball.geodesic_scale);
    gvc_features_free(&on_ball);
    gvc_features_free(&on_globe);
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&globe);
}

static void normalised_and_measured(void **state) {
    (void)state;
    gvc_halfedges body = made_sphere(4);
    made_limbs(&body);
    gvc_features features = find(&body);
    double low = 1, high = 0;
    for (size_t v = 0; v < body.vertex_count; v++) {
        low = fmin(low, features.mu[v]);
        high = fmax(high, features.mu[v]);
    }
    assert_true(low == 0 && high == 1 && features.mu[features.root] == 0);
    for (size_t i = 1; i < features.extremum_count; i++)
        assert_true(features.extremum[i - 1].persistence >= features.extremum[i].persistence);
    gvc_features_free(&features);
    gvc_halfedges_free(&body);

    gvc_halfedges grid = made_grid(3, 4, 0, 0);
    features = find(&grid);
    assert_float_equal(features.area, 12, 1e-12);
    assert_float_equal(features.diagonal, 5, 1e-12);
    assert_float_equal(features.geodesic_scale, 5, 1e-9);
    gvc_features_free(&features);
    gvc_halfedges_free(&grid);
}

/* Another unit, another place and another order of the vertices: the same features. */
static void invariance(void **state) {
    (void)state;
    gvc_halfedges body = made_sphere(4);
    made_limbs(&body);
    uint32_t count = (uint32_t)body.vertex_count, step = 401; /* coprime to 1026 */
    double *position = calloc(3 * (size_t)count, sizeof *position);
    uint32_t *face = calloc(3 * body.face_count, sizeof *face);
    for (uint32_t v = 0; v < count; v++)
        for (int k = 0; k < 3; k++)
            position[3 * (v * step % count) + (uint32_t)k] =
                1000 * body.position[3 * v + (uint32_t)k] + 100;
    for (size_t h = 0; h < 3 * body.face_count; h++) face[h] = body.vertex[h] * step % count;
    gvc_halfedges other = made_halfedges(position, count, face, body.face_count);
    gvc_features a = find(&body), b = find(&other);
    assert_int_equal(b.root, a.root * step % count);
    assert_float_equal(b.geodesic_scale, 1000 * a.geodesic_scale, 1e-6 * b.geodesic_scale);
    assert_int_equal(a.extremum_count, b.extremum_count);
    for (size_t i = 0; i < a.extremum_count; i++) {
        assert_int_equal(b.extremum[i].vertex, a.extremum[i].vertex * step % count);
        assert_float_equal(a.extremum[i].persistence, b.extremum[i].persistence, 1e-5);
        assert_float_equal(a.extremum[i].area, b.extremum[i].area, 1e-4);
        assert_int_equal(a.extremum[i].valence, b.extremum[i].valence);
    }
    gvc_features_free(&a);
    gvc_features_free(&b);
    free(position);
    free(face);
    gvc_halfedges_free(&body);
    gvc_halfedges_free(&other);
}

static void unsuitable_surfaces(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(1), two = made_twice(&ball), none = {0};
    gvc_features features;
    gvc_error error;
    assert_int_equal(gvc_features_find(&two, &OPTIONS, &features, &error), GVC_ERROR_MESH);
    assert_null(features.mu);
    assert_null(features.extremum);
    assert_int_equal(gvc_features_find(&none, &OPTIONS, &features, &error), GVC_ERROR_MESH);
    gvc_features_options no_samples = {0, 0.01};
    assert_int_equal(gvc_features_find(&ball, &no_samples, &features, &error), GVC_ERROR_ARGUMENT);
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&two);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integral_of_a_sphere),
        cmocka_unit_test(samples_suffice),
        cmocka_unit_test(persistences_and_areas_by_hand),
        cmocka_unit_test(a_plateau_has_one_extremum),
        cmocka_unit_test(limbs_are_found),
        cmocka_unit_test(normalised_and_measured),
        cmocka_unit_test(invariance),
        cmocka_unit_test(unsuitable_surfaces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
