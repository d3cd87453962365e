/* SPDX-License-Identifier: MIT */
/** @file test_rigid.c  The motion of a patch, found from two triangulations of one body. */
#include "descriptor/rigid.h"
#include "descriptor/tracking.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "made_surfaces.h"

/* An ellipsoid with different half axes: no turn leaves it as it is. */
static void flatten(gvc_halfedges *m) {
    for (size_t v = 0; v < m->vertex_count; v++) {
        m->position[3 * v] *= 0.5;
        m->position[3 * v + 1] *= 0.8;
    }
}

/* Turn about z by `angle`, then a shift. */
static void move(gvc_halfedges *m, double angle, const double shift[3]) {
    for (size_t v = 0; v < m->vertex_count; v++) {
        double *p = m->position + 3 * v, x = p[0], y = p[1];
        p[0] = cos(angle) * x - sin(angle) * y + shift[0];
        p[1] = sin(angle) * x + cos(angle) * y + shift[1];
        p[2] += shift[2];
    }
}

static gvc_patch whole_patch(const gvc_halfedges *m) {
    gvc_patch patch;
    double *distance = calloc(m->vertex_count, sizeof *distance);
    assert_non_null(distance);
    assert_int_equal(gvc_patch_take(m, distance, 1, 0.5, &patch, NULL), GVC_OK);
    free(distance);
    return patch;
}

static void test_finds_the_motion_between_other_triangulations(void **state) {
    (void)state;
    static const double shift[3] = {0.04, -0.03, 0.02};
    const double angle = 0.15;
    gvc_halfedges before = made_sphere(4), now = made_globe(24, 48);
    gvc_rigid motion;
    flatten(&before);
    flatten(&now);
    move(&now, angle, shift);
    gvc_patch patch = whole_patch(&before);
    assert_int_equal(gvc_patch_follow(&patch, &now, 0.5, &motion, NULL), GVC_OK);
    for (size_t v = 0; v < before.vertex_count; v += 7) {
        double moved[3];
        gvc_rigid_apply(&motion, before.position + 3 * v, moved);
        move(&(gvc_halfedges){.vertex_count = 1, .position = before.position + 3 * v}, angle,
             shift);
        for (int k = 0; k < 3; k++) assert_true(fabs(moved[k] - before.position[3 * v + k]) < 0.01);
    }
    gvc_patch_free(&patch);
    gvc_halfedges_free(&before);
    gvc_halfedges_free(&now);
}

static void test_stays_where_nothing_is_near(void **state) {
    (void)state;
    static const double far_away[3] = {10, 0, 0};
    gvc_halfedges before = made_sphere(2), now = made_sphere(2);
    gvc_rigid motion;
    move(&now, 0, far_away);
    gvc_patch patch = whole_patch(&before);
    assert_int_equal(gvc_patch_follow(&patch, &now, 0.2, &motion, NULL), GVC_OK);
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    assert_memory_equal(motion.rotation, identity, sizeof identity);
    for (int k = 0; k < 3; k++) assert_true(motion.shift[k] == 0);
    gvc_patch_free(&patch);
    gvc_halfedges_free(&before);
    gvc_halfedges_free(&now);
}

static void test_takes_what_is_within_the_radius(void **state) {
    (void)state;
    gvc_halfedges m = made_sphere(2);
    gvc_patch patch;
    double *distance = calloc(2 * m.vertex_count, sizeof *distance);
    assert_non_null(distance);
    size_t near = 0;
    for (size_t v = 0; v < m.vertex_count; v++) {
        distance[2 * v] = 1 - m.position[3 * v + 2]; /* height below the pole +z */
        distance[2 * v + 1] = 99;
        near += distance[2 * v] <= 0.3;
    }
    assert_int_equal(gvc_patch_take(&m, distance, 2, 0.3, &patch, NULL), GVC_OK);
    assert_int_equal(patch.count, near);
    double area = 0;
    for (size_t i = 0; i < patch.count; i++) {
        area += patch.area[i];
        for (int k = 0; k < 3; k++) /* the normal of a sphere is its position */
            assert_true(fabs(patch.normal[3 * i + k] - patch.point[3 * i + k]) < 0.1);
    }
    assert_true(fabs(area - 2 * PI * 0.3) < 0.6); /* area of a cap of that height */
    free(distance);
    gvc_patch_free(&patch);
    gvc_halfedges_free(&m);
}

/* Long along z, and nearly as deep as wide: what its two tips tell of a point is hardly more than
 * its height. */
static void lengthen(gvc_halfedges *m) {
    for (size_t v = 0; v < m->vertex_count; v++) {
        m->position[3 * v] *= 0.8;
        m->position[3 * v + 2] *= 2;
    }
}

/* A body that turns about its length a little in every frame: its root turns with it instead of
 * staying behind. */
static void test_root_turns_with_the_body(void **state) {
    (void)state;
    gvc_tracker *tracker;
    gvc_tracker_options options = {.prior_weight = 1, .shortest_weight = 0.1, .lambda = 0.5};
    const gvc_features_options feature_options = {60, 0.01};
    static const double rest[3] = {0, 0, 0};
    const double step = 0.08;
    double first[3] = {0, 0, 0};
    assert_int_equal(gvc_tracker_create(&options, &tracker, NULL), GVC_OK);
    for (int frame = 0; frame < 12; frame++) {
        gvc_halfedges m = made_sphere(3);
        gvc_features features;
        gvc_cut_graph graph;
        bool kept = true;
        lengthen(&m);
        move(&m, step * frame, rest);
        assert_int_equal(gvc_features_find(&m, &feature_options, &features, NULL), GVC_OK);
        if (frame == 0) {
            assert_int_equal(
                gvc_tracker_start(tracker, &features, 2, GVC_HANDLES_SHORT, &m, &graph, NULL),
                GVC_OK);
        } else {
            assert_int_equal(gvc_tracker_next(tracker, &features, &m, &graph, &kept, NULL), GVC_OK);
        }
        assert_true(kept);
        for (size_t n = 0; n < graph.node_count; n++) {
            if (graph.node[n].kind != GVC_NODE_ROOT) continue;
            double *root = m.position + 3 * (size_t)graph.node[n].vertex;
            move(&(gvc_halfedges){.vertex_count = 1, .position = root}, -step * frame, rest);
            if (frame == 0) memcpy(first, root, sizeof first);
            double apart = hypot(hypot(root[0] - first[0], root[1] - first[1]), root[2] - first[2]);
            assert_true(apart < 0.05 * features.diagonal);
        }
        gvc_cut_graph_free(&graph);
        gvc_features_free(&features);
        gvc_halfedges_free(&m);
    }
    gvc_tracker_destroy(&tracker);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_the_motion_between_other_triangulations),
        cmocka_unit_test(test_stays_where_nothing_is_near),
        cmocka_unit_test(test_takes_what_is_within_the_radius),
        cmocka_unit_test(test_root_turns_with_the_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
