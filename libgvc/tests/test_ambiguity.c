/* SPDX-License-Identifier: MIT */
/** @file test_ambiguity.c  Ambiguity on a sphere, where it is the area of a zone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/ambiguity.h"
#include "made_surfaces.h"

static const double pi = 3.14159265358979323846;

static double *ambiguity(const gvc_halfedges *mesh, const uint32_t *feature, size_t count,
                         double epsilon) {
    double *share = calloc(mesh->vertex_count, sizeof *share);
    assert_int_equal(gvc_ambiguity(mesh, feature, count, epsilon, share, NULL), GVC_OK);
    return share;
}

static double angle(const gvc_halfedges *mesh, size_t v) {
    const double *p = mesh->position, *q = p + 3 * v;
    return acos(fmax(-1, fmin(1, p[0] * q[0] + p[1] * q[1] + p[2] * q[2])));
}

/* Consistent to a point with respect to one feature is the zone at its distance from it. */
static void one_feature_leaves_a_zone(void **state) {
    (void)state;
    const uint32_t feature = 0;
    const double epsilon = 0.1;
    gvc_halfedges sphere = made_sphere(5);
    double *share = ambiguity(&sphere, &feature, 1, epsilon);
    for (size_t v = 0; v < sphere.vertex_count; v++) {
        double low = fmax(0, angle(&sphere, v) - epsilon * pi);
        double high = fmin(pi, angle(&sphere, v) + epsilon * pi);
        assert_float_equal(share[v], (cos(low) - cos(high)) / 2, 0.03);
    }
    free(share);
    gvc_halfedges_free(&sphere);
}

/* Three features in general position leave little, and the less the smaller the tolerance. */
static void more_features_leave_less(void **state) {
    (void)state;
    gvc_halfedges sphere = made_sphere(4);
    const uint32_t feature[3] = {0, 5, (uint32_t)sphere.vertex_count - 1};
    double *one = ambiguity(&sphere, feature, 1, 0.1), *three = ambiguity(&sphere, feature, 3, 0.1);
    double *strict = ambiguity(&sphere, feature, 3, 0.02), sum = 0, strict_sum = 0;
    for (size_t v = 0; v < sphere.vertex_count; v++) {
        assert_true(three[v] <= one[v] + 1e-12 && strict[v] <= three[v] + 1e-12);
        assert_true(strict[v] > 0); /* a point is consistent to itself */
        sum += three[v] / one[v];
        strict_sum += strict[v] / one[v];
    }
    assert_true(sum / (double)sphere.vertex_count < 0.3);
    assert_true(strict_sum < 0.2 * sum);
    free(one);
    free(three);
    free(strict);
    gvc_halfedges_free(&sphere);
}

static void no_feature_tells_nothing_apart(void **state) {
    (void)state;
    gvc_halfedges sphere = made_sphere(1);
    double *share = ambiguity(&sphere, NULL, 0, 0.1);
    for (size_t v = 0; v < sphere.vertex_count; v++) assert_float_equal(share[v], 1, 1e-12);
    free(share);
    gvc_halfedges_free(&sphere);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_feature_leaves_a_zone),
        cmocka_unit_test(more_features_leave_less),
        cmocka_unit_test(no_feature_tells_nothing_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
