/* SPDX-License-Identifier: MIT */
/** @file test_reeb.c  Reeb graphs of functions whose graph and areas are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/reeb.h"
#include "made_surfaces.h"

/* A coordinate of every vertex, scaled to [0,1]. The caller frees it. */
static double *coordinate(const gvc_halfedges *mesh, int axis) {
    double *mu = calloc(mesh->vertex_count, sizeof *mu), low = INFINITY, high = -INFINITY;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        mu[v] = mesh->position[3 * v + (size_t)axis];
        low = fmin(low, mu[v]);
        high = fmax(high, mu[v]);
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) mu[v] = (mu[v] - low) / (high - low);
    return mu;
}

/* What holds for every graph. */
static void check_graph(const gvc_halfedges *mesh, const double *mu, const gvc_reeb_graph *graph) {
    double area = 0;
    size_t ends = 0;
    for (size_t i = 0; i < graph->node_count; i++) {
        const gvc_reeb_node *node = &graph->node[i];
        assert_true(node->level < graph->levels);
        assert_true(i == 0 || graph->node[i - 1].level <= node->level);
        assert_true(node->area >= -1e-12);
        assert_true(node->mu_low <= node->mu_high);
        assert_true(node->mu_low >= (double)node->level / graph->levels - 1e-12);
        assert_true(node->mu_high <= (double)(node->level + 1) / graph->levels + 1e-12);
        area += node->area;
        ends += node->valence;
    }
    assert_float_equal(area, 1, 1e-9);
    assert_int_equal(ends, 2 * graph->arc_count);
    for (size_t i = 0; i < graph->arc_count; i++) {
        const uint32_t *arc = graph->arc[i];
        assert_int_equal(graph->node[arc[0]].level + 1, graph->node[arc[1]].level);
        if (i > 0) assert_true(arc[-2] < arc[0] || (arc[-2] == arc[0] && arc[-1] < arc[1]));
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        const gvc_reeb_node *node = &graph->node[graph->top_node[v]];
        assert_true(mu[v] >= node->mu_low - 1e-12 && mu[v] <= node->mu_high + 1e-12);
    }
}

static gvc_reeb_graph build(const gvc_halfedges *mesh, const double *mu, unsigned levels) {
    gvc_reeb_graph graph;
    assert_int_equal(gvc_reeb_graph_build(mesh, mu, levels, &graph, NULL), GVC_OK);
    check_graph(mesh, mu, &graph);
    return graph;
}

/* Independent cycles of a connected graph. */
static long cycles(const gvc_reeb_graph *graph) {
    return (long)graph->arc_count - (long)graph->node_count + 1;
}

/* Archimedes: the zones of a sphere between equidistant parallel planes have equal areas. */
static void sphere_is_a_chain_of_equal_zones(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(4);
    for (int axis = 0; axis < 3; axis++) {
        double *mu = coordinate(&ball, axis);
        gvc_reeb_graph graph = build(&ball, mu, 10);
        assert_int_equal(graph.node_count, 10);
        assert_int_equal(graph.arc_count, 9);
        for (unsigned i = 0; i < 10; i++) {
            assert_int_equal(graph.node[i].valence, i == 0 || i == 9 ? 1 : 2);
            assert_float_equal(graph.node[i].area, 0.1, 0.002);
            assert_float_equal(graph.node[i].mu_low, i / 10.0, 1e-12);
            assert_float_equal(graph.node[i].mu_high, (i + 1) / 10.0, 1e-12);
        }
        gvc_reeb_graph_free(&graph);
        free(mu);
    }
    gvc_halfedges_free(&ball);
}

/* However the plane is triangulated, and however few triangles there are. */
static void clipping_is_exact(void **state) {
    (void)state;
    uint32_t sizes[] = {1, 3, 16};
    for (int i = 0; i < 3; i++) {
        gvc_halfedges grid = made_grid(sizes[i], sizes[i], 0, i == 1 ? 0.2 : 0);
        double *mu = coordinate(&grid, 0);
        gvc_reeb_graph graph = build(&grid, mu, 7);
        assert_int_equal(graph.node_count, 7);
        for (int n = 0; n < 7; n++) assert_float_equal(graph.node[n].area, 1.0 / 7, 1e-12);
        gvc_reeb_graph_free(&graph);
        free(mu);
        gvc_halfedges_free(&grid);
    }
}

/* A cone over a square: the part above a level is a smaller square, so areas are quadratic. */
static void quadratic_areas(void **state) {
    (void)state;
    static const double position[] = {1, 1, 0, -1, 1, 0, -1, -1, 0, 1, -1, 0, 0, 0, 0};
    static const uint32_t face[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    static const double mu[] = {0, 0, 0, 0, 1};
    gvc_halfedges cone = made_halfedges(position, 5, face, 4);
    gvc_reeb_graph graph = build(&cone, mu, 4);
    assert_int_equal(graph.node_count, 4);
    assert_float_equal(graph.node[0].area, 7 / 16.0, 1e-12);
    assert_float_equal(graph.node[1].area, 5 / 16.0, 1e-12);
    assert_float_equal(graph.node[2].area, 3 / 16.0, 1e-12);
    assert_float_equal(graph.node[3].area, 1 / 16.0, 1e-12);
    gvc_reeb_graph_free(&graph);
    gvc_halfedges_free(&cone);
}

static void handles_are_cycles(void **state) {
    (void)state;
    gvc_halfedges torus = made_torus(48, 24, 0.4);
    double *mu = coordinate(&torus, 0);
    unsigned levels[] = {8, 24, 100};
    for (int i = 0; i < 3; i++) {
        gvc_reeb_graph graph = build(&torus, mu, levels[i]);
        assert_int_equal(cycles(&graph), 1);
        gvc_reeb_graph_free(&graph);
    }
    free(mu);
    gvc_halfedges_free(&torus);
    /* Two holes one after the other, and one above the other; flat ends and all values tied. */
    gvc_halfedges long_plate = made_plate("#######"
                                          "#.###.#"
                                          "#######",
                                          7, 3);
    gvc_halfedges high_plate = made_plate("#####"
                                          "#...#"
                                          "#####"
                                          "#...#"
                                          "#####",
                                          5, 5);
    gvc_halfedges *plate[] = {&long_plate, &high_plate};
    for (int i = 0; i < 2; i++) {
        mu = coordinate(plate[i], 0);
        gvc_reeb_graph graph = build(plate[i], mu, 30);
        assert_int_equal(cycles(&graph), 2);
        gvc_reeb_graph_free(&graph);
        free(mu);
        gvc_halfedges_free(plate[i]);
    }
}

/* On a sphere any function has a tree, on a torus at most one cycle, whatever the noise, the number
 * of levels, and the ties with the bounds. */
static void noise_makes_no_cycles(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(3), torus = made_torus(20, 12, 0.4);
    gvc_halfedges *surface[] = {&ball, &torus};
    uint64_t random = 7;
    for (int round = 0; round < 40; round++) {
        gvc_halfedges *mesh = surface[round & 1];
        double *mu = calloc(mesh->vertex_count, sizeof *mu);
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            mu[v] = made_random(&random);
            if (round & 2) mu[v] = floor(mu[v] * 9) / 8; /* all values on bounds of 8 levels */
        }
        gvc_reeb_graph graph = build(mesh, mu, round & 4 ? 8 : 3 + (unsigned)round);
        assert_true(cycles(&graph) >= 0 && cycles(&graph) <= (round & 1));
        gvc_reeb_graph_free(&graph);
        free(mu);
    }
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&torus);
}

static void limbs_are_leaves(void **state) {
    (void)state;
    gvc_halfedges body = made_sphere(5);
    made_limbs(&body);
    double *mu = calloc(body.vertex_count, sizeof *mu), high = 0;
    for (size_t v = 0; v < body.vertex_count; v++) {
        const double *p = body.position + 3 * v;
        mu[v] = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        high = fmax(high, mu[v]);
    }
    for (size_t v = 0; v < body.vertex_count; v++) mu[v] = fmax(0, mu[v] / high - 0.3) / 0.7;
    gvc_reeb_graph graph = build(&body, mu, 12);
    int tips = 0;
    for (size_t i = 0; i < graph.node_count; i++)
        tips += graph.node[i].valence == 1 && graph.node[i].level > 3;
    assert_int_equal(tips, LIMB_COUNT);
    assert_int_equal(cycles(&graph), 0);
    gvc_reeb_graph_free(&graph);
    free(mu);
    gvc_halfedges_free(&body);
}

static void components_stay_apart(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(2), two = made_twice(&ball);
    double *mu = coordinate(&ball, 2), *both = calloc(two.vertex_count, sizeof *both);
    for (size_t v = 0; v < two.vertex_count; v++) both[v] = mu[v % ball.vertex_count];
    for (unsigned levels = 1; levels < 6; levels++) {
        gvc_reeb_graph graph = build(&two, both, levels);
        assert_int_equal(graph.node_count, 2 * levels);
        assert_int_equal(graph.arc_count, 2 * (levels - 1));
        gvc_reeb_graph_free(&graph);
    }
    free(mu);
    free(both);
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&two);
}

static void wrong_arguments(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(0);
    gvc_reeb_graph graph;
    gvc_error error;
    double mu[6] = {0, 0.5, 1, 0, 0, 0};
    assert_int_equal(gvc_reeb_graph_build(&ball, mu, 0, &graph, &error), GVC_ERROR_ARGUMENT);
    assert_null(graph.node);
    double wrong[] = {-0.1, 1.1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        mu[3] = wrong[i];
        assert_int_equal(gvc_reeb_graph_build(&ball, mu, 8, &graph, &error), GVC_ERROR_ARGUMENT);
        assert_null(graph.node);
        assert_null(graph.arc);
    }
    gvc_halfedges_free(&ball);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_is_a_chain_of_equal_zones),
        cmocka_unit_test(clipping_is_exact),
        cmocka_unit_test(quadratic_areas),
        cmocka_unit_test(handles_are_cycles),
        cmocka_unit_test(noise_makes_no_cycles),
        cmocka_unit_test(limbs_are_leaves),
        cmocka_unit_test(components_stay_apart),
        cmocka_unit_test(wrong_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
