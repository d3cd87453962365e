/* SPDX-License-Identifier: MIT */
/** @file test_cut_graph.c  Paths over a surface, and the cut graph of one frame. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/path.h"
#include "descriptor/tracking.h"
#include "graph_check.h"
#include "made_surfaces.h"

static double apart(const gvc_halfedges *mesh, uint32_t a, uint32_t b) {
    const double *p = mesh->position + 3 * a, *q = mesh->position + 3 * b;
    return hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
}

/* Finds the path between two vertices and inserts it; the caller frees the chain. */
static uint32_t *linked(gvc_halfedges *mesh, const gvc_cut_graph *graph, uint32_t from, uint32_t to,
                        size_t *count, double *length) {
    gvc_pathfinder *finder;
    gvc_surface_path path = {0};
    uint32_t *chain;
    assert_int_equal(gvc_pathfinder_create(&finder, NULL), GVC_OK);
    assert_int_equal(gvc_pathfinder_begin(finder, mesh, graph, NULL), GVC_OK);
    gvc_pathfinder_mark_vertex(finder, from, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_vertex(finder, to, GVC_CORNER_TARGET);
    assert_int_equal(gvc_pathfinder_find(finder, NULL, NULL, &path, NULL), GVC_OK);
    assert_true(path.count >= 2);
    assert_int_equal(gvc_surface_path_insert(mesh, &path, &chain, count, NULL), GVC_OK);
    assert_int_equal(chain[0], from);
    assert_int_equal(chain[*count - 1], to);
    *length = 0;
    for (size_t i = 0; i + 1 < *count; i++) {
        assert_int_not_equal(gvc_halfedge_between(mesh, chain[i], chain[i + 1]), GVC_NONE);
        *length += apart(mesh, chain[i], chain[i + 1]);
    }
    assert_true(*length <= path.cost * (1 + 1e-12));
    gvc_surface_path_free(&path);
    gvc_pathfinder_destroy(&finder);
    return chain;
}

/* Along mesh edges the same paths are up to 40 % too long. */
static void path_is_nearly_straight(void **state) {
    (void)state;
    gvc_cut_graph none = {0};
    uint32_t ends[][2] = {{0, 20 * 41 + 40}, {40, 20 * 41}, {3, 40 * 41 + 11}, {0, 40}};
    for (int i = 0; i < 4; i++) {
        gvc_halfedges grid = made_grid(40, 40, 0, 0.25);
        size_t count;
        double length, straight = apart(&grid, ends[i][0], ends[i][1]);
        free(linked(&grid, &none, ends[i][0], ends[i][1], &count, &length));
        assert_true(length < 1.015 * straight);
        gvc_halfedges_free(&grid);
    }
}

/* A graph edge across the grid but for one column: the path has to go through the gap. */
static void path_goes_round_the_graph(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(20, 20, 0, 0);
    uint32_t wall[20], nodes[2] = {10 * 21, 10 * 21 + 19};
    for (uint32_t i = 0; i < 20; i++) wall[i] = 10 * 21 + i;
    gvc_cut_node node[] = {{GVC_NODE_ROOT, 0, nodes[0]}, {GVC_NODE_EXTREMUM, 0, nodes[1]}};
    gvc_cut_edge edge = {{0, 1}, wall, 20};
    gvc_cut_graph graph = {2, 1, node, &edge};
    size_t count;
    double length;
    uint32_t *chain = linked(&grid, &graph, 5 * 21 + 5, 15 * 21 + 5, &count, &length);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 20; k++) assert_int_not_equal(chain[i], wall[k]);
    for (int k = 0; k + 1 < 20; k++) /* not split either */
        assert_int_not_equal(gvc_halfedge_between(&grid, wall[k], wall[k + 1]), GVC_NONE);
    assert_true(length > 2 * hypot(14, 5) && length < 2 * hypot(15, 5) + 0.5);
    free(chain);
    gvc_halfedges_free(&grid);
}

/* Weight 0 in a corridor and high beside it: the path stays in the corridor. */
static double off_the_arc(const void *context, const double position[3], const double *attribute) {
    (void)context, (void)attribute;
    double off = hypot(position[0] - 20, position[1]) - 15;
    return 100 * fmin(off * off, 10);
}

static void path_follows_weights(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(40, 20, 0, 0.2);
    gvc_cut_graph none = {0};
    gvc_pathfinder *finder;
    gvc_surface_path path = {0};
    uint32_t *chain;
    size_t count;
    assert_int_equal(gvc_pathfinder_create(&finder, NULL), GVC_OK);
    assert_int_equal(gvc_pathfinder_begin(finder, &grid, &none, NULL), GVC_OK);
    gvc_pathfinder_mark_vertex(finder, 5, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_vertex(finder, 35, GVC_CORNER_TARGET);
    assert_int_equal(gvc_pathfinder_find(finder, off_the_arc, NULL, &path, NULL), GVC_OK);
    assert_int_equal(gvc_surface_path_insert(&grid, &path, &chain, &count, NULL), GVC_OK);
    for (size_t i = 0; i < count; i++) {
        const double *p = grid.position + 3 * chain[i];
        assert_true(fabs(hypot(p[0] - 20, p[1]) - 15) < 0.6);
    }
    free(chain);
    gvc_surface_path_free(&path);
    gvc_pathfinder_destroy(&finder);
    gvc_halfedges_free(&grid);
}

static void no_path_out_of_a_circle(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(10, 10, 0, 0);
    uint32_t ring[] = {48, 49, 50, 61, 72, 71, 70, 59, 48};
    gvc_cut_node node = {GVC_NODE_ROOT, 0, 48};
    gvc_cut_edge edge = {{0, 0}, ring, 9};
    gvc_cut_graph graph = {1, 1, &node, &edge};
    gvc_pathfinder *finder;
    gvc_surface_path path = {0};
    assert_int_equal(gvc_pathfinder_create(&finder, NULL), GVC_OK);
    assert_int_equal(gvc_pathfinder_begin(finder, &grid, &graph, NULL), GVC_OK);
    gvc_pathfinder_mark_vertex(finder, 60, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_vertex(finder, 0, GVC_CORNER_TARGET);
    assert_int_equal(gvc_pathfinder_find(finder, NULL, NULL, &path, NULL), GVC_OK);
    assert_int_equal(path.count, 0);
    gvc_surface_path_free(&path);
    gvc_pathfinder_destroy(&finder);
    gvc_halfedges_free(&grid);
}

static const gvc_tracker_options usual = {1, 0.3, 0.5};
static const gvc_features_options few_samples = {20, 0.01};

static gvc_cut_graph started(gvc_halfedges *mesh, size_t tips) {
    gvc_features features;
    gvc_cut_graph graph;
    gvc_tracker *tracker;
    assert_int_equal(gvc_features_find(mesh, &few_samples, &features, NULL), GVC_OK);
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    assert_int_equal(
        gvc_tracker_start(tracker, &features, tips, GVC_HANDLES_SHORT, mesh, &graph, NULL), GVC_OK);
    gvc_tracker_destroy(&tracker);
    gvc_features_free(&features);
    return graph;
}

/* Fewer than two tips are made up to two. */
static void trees(void **state) {
    (void)state;
    for (size_t tips = 0; tips <= LIMB_COUNT; tips++) {
        gvc_halfedges body = made_sphere(3);
        made_limbs(&body);
        gvc_cut_graph graph = started(&body, tips);
        check_opens_to_disk(&body, &graph);
        check_structure(&graph, 0, tips < 2 ? 2 : tips);
        gvc_cut_graph_free(&graph);
        gvc_halfedges_free(&body);
    }
}

/* Where mu is nearly constant, and where nothing is left free between the nodes. */
static void spheres_of_any_size(void **state) {
    (void)state;
    for (int subdivisions = 0; subdivisions < 4; subdivisions++)
        for (size_t tips = 0; tips < 5; tips++) {
            gvc_halfedges ball = made_sphere(subdivisions);
            gvc_cut_graph graph = started(&ball, tips);
            check_opens_to_disk(&ball, &graph);
            gvc_cut_graph_free(&graph);
            gvc_halfedges_free(&ball);
        }
}

/* Every vertex of an octahedron a tip: each path has to find its way between the others. */
static void crowded_tips(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(0);
    gvc_extremum tip[5] = {
        {.vertex = 1}, {.vertex = 2}, {.vertex = 3}, {.vertex = 4}, {.vertex = 5}};
    gvc_features features = {2, 4, 2, 0, NULL, tip, 5};
    gvc_cut_graph graph;
    gvc_tracker *tracker;
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    assert_int_equal(
        gvc_tracker_start(tracker, &features, 5, GVC_HANDLES_SHORT, &ball, &graph, NULL), GVC_OK);
    check_opens_to_disk(&ball, &graph);
    check_structure(&graph, 0, 5);
    gvc_cut_graph_free(&graph);
    gvc_tracker_destroy(&tracker);
    gvc_halfedges_free(&ball);
}

/* The shortest possible loops of a torus, once round the tube and once along its inside, and the
 * way to them from the root. */
static void torus(void **state) {
    (void)state;
    for (size_t tips = 0; tips < 3; tips++) {
        gvc_halfedges ring = made_torus(40, 20, 0.4);
        gvc_cut_graph graph = started(&ring, tips);
        check_opens_to_disk(&ring, &graph);
        assert_int_equal(graph.node_count + 2, graph.edge_count + 1);
        double length = 0;
        for (size_t e = 0; e < graph.edge_count && tips == 0; e++)
            if (graph.edge[e].node[0] != 0) length += gvc_cut_edge_length(&ring, &graph.edge[e]);
        assert_true(length < 1.02 * 2 * PI * (0.4 + 0.6));
        gvc_cut_graph_free(&graph);
        gvc_halfedges_free(&ring);
    }
}

static void handles(void **state) {
    (void)state;
    static const struct {
        const char *plate;
        int columns, rows;
        size_t genus;
    } holes[] = {{"####.####", 3, 3, 1}, {"######.#.######", 5, 3, 2}};
    for (int i = 0; i < 2; i++)
        for (size_t tips = 0; tips < 4; tips++) {
            gvc_halfedges coarse = made_plate(holes[i].plate, holes[i].columns, holes[i].rows);
            gvc_halfedges plate = made_finer(&coarse);
            gvc_cut_graph graph = started(&plate, tips);
            check_opens_to_disk(&plate, &graph);
            assert_int_equal(graph.node_count + 2 * holes[i].genus, graph.edge_count + 1);
            gvc_cut_graph_free(&graph);
            gvc_halfedges_free(&coarse);
            gvc_halfedges_free(&plate);
        }
}

static void two_components(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(1), two = made_twice(&ball);
    gvc_extremum tip[2] = {{.vertex = 1}, {.vertex = 20}};
    gvc_features features = {2, 4, 2, 0, NULL, tip, 2};
    gvc_cut_graph graph;
    gvc_tracker *tracker;
    gvc_error error;
    gvc_error_init(&error);
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    assert_int_equal(
        gvc_tracker_start(tracker, &features, 2, GVC_HANDLES_SHORT, &two, &graph, &error),
        GVC_ERROR_MESH);
    assert_int_equal(graph.edge_count, 0);
    gvc_tracker_destroy(&tracker);
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&two);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(path_is_nearly_straight),
        cmocka_unit_test(path_goes_round_the_graph),
        cmocka_unit_test(path_follows_weights),
        cmocka_unit_test(no_path_out_of_a_circle),
        cmocka_unit_test(trees),
        cmocka_unit_test(spheres_of_any_size),
        cmocka_unit_test(crowded_tips),
        cmocka_unit_test(torus),
        cmocka_unit_test(handles),
        cmocka_unit_test(two_components),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
