/* SPDX-License-Identifier: MIT */
/** @file test_registration.c  Motion found between two triangulations of one body, and its uses. */
#include "descriptor/registration.h"
#include "descriptor/tracking.h"
#include "mesh/pin.h"
#include "mesh/vector.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "made_surfaces.h"

static void scale(gvc_halfedges *m, double x, double y, double z) {
    for (size_t v = 0; v < m->vertex_count; v++) {
        m->position[3 * v] *= x;
        m->position[3 * v + 1] *= y;
        m->position[3 * v + 2] *= z;
    }
}

/* Turn about z by `angle`, then a shift. */
static void move(double *p, double angle, const double shift[3]) {
    double x = p[0], y = p[1];
    p[0] = cos(angle) * x - sin(angle) * y + shift[0];
    p[1] = sin(angle) * x + cos(angle) * y + shift[1];
    p[2] += shift[2];
}

static void move_all(gvc_halfedges *m, double angle, const double shift[3]) {
    for (size_t v = 0; v < m->vertex_count; v++) move(m->position + 3 * v, angle, shift);
}

/* Bends the z axis to a circle of curvature `bend` in the plane of x and z. */
static void bend(double *p, double curvature) {
    double angle = curvature * p[2], radius = 1 / curvature - p[0];
    p[0] = 1 / curvature - radius * cos(angle);
    p[2] = radius * sin(angle);
}

static gvc_mesh view_of(const gvc_halfedges *m) {
    return (gvc_mesh){m->vertex_count, m->face_count, m->position, m->vertex};
}

static double apart(const double a[3], const double b[3]) {
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* Registers and frees nothing else; the result is freed by the caller. */
static double *registered(const gvc_halfedges *from, const gvc_halfedges *to) {
    gvc_bvh *bvh;
    const gvc_mesh view = view_of(to);
    double *moved = calloc(3 * from->vertex_count, sizeof *moved);
    assert_non_null(moved);
    assert_int_equal(gvc_bvh_create(&view, &bvh, NULL), GVC_OK);
    assert_int_equal(gvc_register(from, to, bvh, moved, NULL), GVC_OK);
    gvc_bvh_destroy(&bvh);
    return moved;
}

static void test_finds_a_rigid_motion(void **state) {
    (void)state;
    static const double shift[3] = {0.04, -0.03, 0.02};
    gvc_halfedges before = made_sphere(4), now = made_globe(24, 48);
    scale(&before, 0.5, 0.8, 1); /* no turn leaves an ellipsoid as it is */
    scale(&now, 0.5, 0.8, 1);
    move_all(&now, 0.1, shift);
    double *moved = registered(&before, &now), sum = 0;
    for (size_t v = 0; v < before.vertex_count; v++) {
        move(before.position + 3 * v, 0.1, shift);
        sum += apart(moved + 3 * v, before.position + 3 * v);
    }
    assert_true(sum / (double)before.vertex_count < 0.01);
    free(moved);
    gvc_halfedges_free(&before);
    gvc_halfedges_free(&now);
}

/* A limb that bends: far from rigid as a whole, nearly so in every part. */
static void test_finds_a_bend(void **state) {
    (void)state;
    gvc_halfedges before = made_sphere(4), now = made_globe(40, 30);
    scale(&before, 0.15, 0.2, 1);
    scale(&now, 0.15, 0.2, 1);
    for (size_t v = 0; v < now.vertex_count; v++) bend(now.position + 3 * v, 0.15);
    double *moved = registered(&before, &now), sum = 0, still = 0;
    for (size_t v = 0; v < before.vertex_count; v++) {
        double truth[3];
        memcpy(truth, before.position + 3 * v, sizeof truth);
        bend(truth, 0.15);
        sum += apart(moved + 3 * v, truth);
        still += apart(before.position + 3 * v, truth);
    }
    assert_true(still / (double)before.vertex_count > 0.02);
    assert_true(sum < 0.25 * still);
    free(moved);
    gvc_halfedges_free(&before);
    gvc_halfedges_free(&now);
}

static void test_stays_where_nothing_is_near(void **state) {
    (void)state;
    static const double far_away[3] = {10, 0, 0};
    gvc_halfedges before = made_sphere(3), now = made_sphere(3);
    move_all(&now, 0, far_away);
    double *moved = registered(&before, &now);
    for (size_t v = 0; v < before.vertex_count; v++)
        assert_true(apart(moved + 3 * v, before.position + 3 * v) < 1e-6);
    free(moved);
    gvc_halfedges_free(&before);
    gvc_halfedges_free(&now);
}

/* ---------------------------------------------------------------------------------------- pins */

static double area_of(const gvc_halfedges *m) {
    double area = 0;
    for (size_t f = 0; f < m->face_count; f++) {
        const double *a = m->position + 3 * (size_t)m->vertex[3 * f];
        double e[3], g[3], n[3];
        gvc_subtract(m->position + 3 * (size_t)m->vertex[3 * f + 1], a, e);
        gvc_subtract(m->position + 3 * (size_t)m->vertex[3 * f + 2], a, g);
        gvc_cross(e, g, n);
        area += sqrt(gvc_dot(n, n)) / 2;
    }
    return area;
}

static void test_pins_vertices_into_faces(void **state) {
    (void)state;
    gvc_halfedges m = made_sphere(2);
    const gvc_mesh view = view_of(&m);
    size_t faces = m.face_count, vertices = m.vertex_count;
    double area = area_of(&m);
    uint32_t vertex, again;
    uint64_t random = 7;
    gvc_bvh *bvh;
    assert_int_equal(gvc_bvh_create(&view, &bvh, NULL), GVC_OK);
    assert_int_equal(gvc_pin(&m, bvh, faces, m.position + 3 * 5, &vertex, NULL), GVC_OK);
    assert_int_equal(vertex, 5);
    assert_int_equal(m.vertex_count, vertices);
    for (int i = 0; i < 200; i++) { /* many in one face, too: 320 faces */
        double p[3];
        for (int k = 0; k < 3; k++) p[k] = 2 * made_random(&random) - 1;
        if (i % 2) p[0] = p[1] = 0.1 * p[0], p[2] = 1; /* near the pole */
        made_unit(p);
        gvc_closest nearest;
        assert_true(gvc_bvh_closest(bvh, p, NULL, INFINITY, &nearest));
        assert_int_equal(gvc_pin(&m, bvh, faces, p, &vertex, NULL), GVC_OK);
        /* snapping moves it by a tenth of an edge at most */
        assert_true(apart(m.position + 3 * (size_t)vertex, nearest.point) < 0.06);
        assert_int_equal(gvc_pin(&m, bvh, faces, m.position + 3 * (size_t)vertex, &again, NULL),
                         GVC_OK);
        assert_int_equal(again, vertex);
    }
    assert_true(m.vertex_count > vertices + 50);
    assert_true(fabs(area_of(&m) - area) < 1e-9 * area);
    gvc_bvh_destroy(&bvh);
    gvc_halfedges_free(&m);
}

/* ------------------------------------------------------------------------------------ tracking */

/* A body long along z, and nearly as deep as wide, that turns about its length a little in every
 * frame: what its two tips tell of a point is hardly more than its height, yet the root turns with
 * the body instead of staying behind. */
static void test_root_turns_with_the_body(void **state) {
    (void)state;
    gvc_tracker *tracker;
    gvc_tracker_options options;
    const gvc_features_options feature_options = {60, 0.01};
    static const double rest[3] = {0, 0, 0};
    const double step = 0.08;
    double first[3] = {0, 0, 0};
    gvc_halfedges before = {0};
    gvc_tracker_options_init(&options);
    assert_int_equal(gvc_tracker_create(&options, &tracker, NULL), GVC_OK);
    for (int frame = 0; frame < 12; frame++) {
        gvc_halfedges m = made_sphere(3), whole;
        gvc_features features;
        gvc_cut_graph graph;
        gvc_warp *warp = NULL;
        bool kept = true;
        scale(&m, 0.7, 1, 2);
        move_all(&m, step * frame, rest);
        assert_int_equal(gvc_halfedges_copy(&m, &whole, NULL), GVC_OK);
        assert_int_equal(gvc_features_find(&m, &feature_options, &features, NULL), GVC_OK);
        if (frame == 0) {
            assert_int_equal(
                gvc_tracker_start(tracker, &features, 2, GVC_HANDLES_SHORT, &m, &graph, NULL),
                GVC_OK);
        } else {
            assert_int_equal(gvc_warp_create(&before, &m, &warp, NULL), GVC_OK);
            assert_int_equal(gvc_tracker_next(tracker, &features, warp, &m, &graph, &kept, NULL),
                             GVC_OK);
        }
        assert_true(kept);
        for (size_t n = 0; n < graph.node_count; n++) {
            if (graph.node[n].kind != GVC_NODE_ROOT) continue;
            double *root = m.position + 3 * (size_t)graph.node[n].vertex;
            move(root, -step * frame, rest);
            if (frame == 0) memcpy(first, root, sizeof first);
            assert_true(apart(root, first) < 0.05 * features.diagonal);
        }
        gvc_warp_destroy(&warp);
        gvc_cut_graph_free(&graph);
        gvc_features_free(&features);
        gvc_halfedges_free(&m);
        gvc_halfedges_free(&before);
        before = whole;
    }
    gvc_halfedges_free(&before);
    gvc_tracker_destroy(&tracker);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_a_rigid_motion),
        cmocka_unit_test(test_finds_a_bend),
        cmocka_unit_test(test_stays_where_nothing_is_near),
        cmocka_unit_test(test_pins_vertices_into_faces),
        cmocka_unit_test(test_root_turns_with_the_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
