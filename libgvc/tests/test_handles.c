/* SPDX-License-Identifier: MIT */
/** @file test_handles.c  Loops that cut handles, and cut graphs while handles come and go. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "cut_maker.h"
#include "descriptor/graph_edit.h"
#include "descriptor/handles.h"
#include "descriptor/tracking.h"
#include "graph_check.h"
#include "synth.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------- loops */

/* The two loops as a graph of one node. */
static gvc_cut_graph graph_of(const gvc_handle *handle) {
    gvc_cut_graph graph = {0};
    uint32_t node, edge;
    gvc_cut_node base = {GVC_NODE_JUNCTION, 0, handle->loop[0][0]};
    assert_int_equal(gvc_cut_graph_add_node(&graph, base, &node, NULL), GVC_OK);
    for (int k = 0; k < 2; k++) {
        uint32_t *chain = malloc(handle->count[k] * sizeof *chain);
        memcpy(chain, handle->loop[k], handle->count[k] * sizeof *chain);
        assert_int_equal(
            gvc_cut_graph_add_edge(&graph, node, node, chain, handle->count[k], &edge, NULL),
            GVC_OK);
    }
    return graph;
}

/* Round the base: first out, second out, first in, second in, counter-clockwise. */
static void check_order(const gvc_halfedges *mesh, const gvc_cut_graph *graph) {
    static const gvc_edge_end order[] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    size_t met = 0;
    uint32_t first = gvc_edge_end_halfedge(mesh, graph, order[0]), h = first;
    do {
        for (size_t i = 0; i < 4; i++)
            if (gvc_edge_end_halfedge(mesh, graph, order[i]) == h) assert_int_equal(i, met++);
        h = gvc_turn(mesh, h);
    } while (h != first);
    assert_int_equal(met, 4);
}

static void a_torus_has_one_handle(void **state) {
    (void)state;
    gvc_halfedges ring = made_bar(1, 2, 0.1);
    gvc_pathfinder *finder;
    gvc_handle handle, other;
    const gvc_cut_graph empty = {0};
    gvc_obstacles obstacles = {&empty, NULL, 0};
    assert_int_equal(gvc_pathfinder_create(&finder, NULL), GVC_OK);
    assert_int_equal(gvc_handle_find(finder, &ring, &obstacles, 0, false, &handle, NULL), GVC_OK);
    for (int turn = 0; turn < 4; turn++) {
        gvc_cut_graph graph = graph_of(&handle);
        check_opens_to_disk(&ring, &graph);
        check_order(&ring, &graph);
        gvc_cut_graph_free(&graph);
        gvc_handle_turn(&handle);
    }
    gvc_cut_graph graph = graph_of(&handle);
    obstacles.graph = &graph;
    assert_int_equal(gvc_handle_find(finder, &ring, &obstacles, 0, false, &other, NULL), GVC_OK);
    assert_int_equal(other.count[0], 0);
    gvc_cut_graph_free(&graph);
    gvc_handle_free(&handle);
    gvc_pathfinder_destroy(&finder);
    gvc_halfedges_free(&ring);
}

static void a_sphere_has_none(void **state) {
    (void)state;
    gvc_halfedges ball = made_octahedron();
    gvc_pathfinder *finder;
    gvc_handle handle;
    const gvc_cut_graph empty = {0};
    const gvc_obstacles obstacles = {&empty, NULL, 0};
    assert_int_equal(gvc_pathfinder_create(&finder, NULL), GVC_OK);
    assert_int_equal(gvc_handle_find(finder, &ball, &obstacles, 0, false, &handle, NULL), GVC_OK);
    assert_int_equal(handle.count[0], 0);
    gvc_pathfinder_destroy(&finder);
    gvc_halfedges_free(&ball);
}

/* -------------------------------------------------------------------------------------- figures */

enum { TIPS = 5 };

/* A frame of the dancing figure, with its features and cut. */
typedef struct figure {
    gvc_halfedges mesh;
    gvc_features features;
    gvc_cut_graph graph;
    gvc_halfedges whole; /* not split */
    gvc_warp *warp;      /* from the frame before; NULL: there is none */
} figure;

static figure figure_at(unsigned genus, uint64_t frame) {
    static const gvc_features_options few_samples = {20, 0.01};
    synth_options options;
    synth_options_init(&options);
    options.genus = genus;
    options.vertex_count = 3000;
    gvc_mesh *mesh;
    figure made = {0};
    assert_int_equal(synth_frame(&options, frame, &mesh, NULL), GVC_OK);
    assert_int_equal(gvc_halfedges_build(mesh, 0, &made.mesh, NULL), GVC_OK);
    assert_int_equal(gvc_features_find(&made.mesh, &few_samples, &made.features, NULL), GVC_OK);
    assert_int_equal(gvc_halfedges_copy(&made.mesh, &made.whole, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    return made;
}

static figure figure_after(const figure *before, unsigned genus, uint64_t frame) {
    figure made = figure_at(genus, frame);
    assert_int_equal(gvc_warp_create(&before->whole, &made.mesh, &made.warp, NULL), GVC_OK);
    return made;
}

static void figure_free(figure *made) {
    gvc_halfedges_free(&made->mesh);
    gvc_features_free(&made->features);
    gvc_cut_graph_free(&made->graph);
    gvc_halfedges_free(&made->whole);
    gvc_warp_destroy(&made->warp);
}

static gvc_tracker *tracker_at(figure *made) {
    gvc_tracker_options options;
    gvc_tracker *tracker;
    gvc_tracker_options_init(&options);
    assert_int_equal(gvc_tracker_create(&options, &tracker, NULL), GVC_OK);
    assert_int_equal(gvc_tracker_start(tracker, &made->features, TIPS, GVC_HANDLES_SHORT,
                                       &made->mesh, &made->graph, NULL),
                     GVC_OK);
    return tracker;
}

static void check_cut(const figure *made, unsigned genus) {
    check_opens_to_disk(&made->mesh, &made->graph);
    check_structure(&made->graph, genus, TIPS);
}

/* While the genus is the same, so is the graph. */
static void figures_with_handles_are_one_segment(void **state) {
    (void)state;
    for (unsigned genus = 1; genus <= 3; genus++) {
        figure first = figure_at(genus, 0), before = figure_at(genus, 0);
        gvc_tracker *tracker = tracker_at(&first);
        check_cut(&first, genus);
        for (uint64_t frame = 1; frame < 3; frame++) {
            figure next = figure_after(&before, genus, frame);
            bool kept;
            assert_int_equal(gvc_tracker_next(tracker, &next.features, next.warp, &next.mesh,
                                              &next.graph, &kept, NULL),
                             GVC_OK);
            assert_true(kept);
            check_cut(&next, genus);
            assert_int_equal(next.graph.edge_count, first.graph.edge_count);
            for (size_t e = 0; e < first.graph.edge_count; e++)
                assert_memory_equal(next.graph.edge[e].node, first.graph.edge[e].node,
                                    sizeof first.graph.edge[e].node);
            figure_free(&before);
            before = next;
        }
        gvc_tracker_destroy(&tracker);
        figure_free(&first);
        figure_free(&before);
    }
}

static const double *place_of(const figure *made, gvc_node_kind kind, uint32_t feature) {
    for (size_t n = 0; n < made->graph.node_count; n++)
        if (made->graph.node[n].kind == kind && made->graph.node[n].feature == feature)
            return made->mesh.position + 3 * (size_t)made->graph.node[n].vertex;
    fail_msg("no node of kind %d, feature %u", (int)kind, feature);
    return NULL;
}

static void check_near(const figure *before, const figure *now, gvc_node_kind kind,
                       uint32_t feature, double reach) {
    const double *p = place_of(before, kind, feature), *q = place_of(now, kind, feature);
    assert_true(hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) < reach);
}

/* A change of genus ends a segment, but root and tips stay, with their numbers. The figure is about
 * 1.8 tall. */
static void handles_come_and_go(void **state) {
    (void)state;
    static const unsigned genus[] = {1, 2, 1, 0, 3};
    figure before = figure_at(genus[0], 0);
    gvc_tracker *tracker = tracker_at(&before);
    for (uint64_t frame = 1; frame < sizeof genus / sizeof *genus; frame++) {
        figure now = figure_after(&before, genus[frame], frame);
        bool kept;
        assert_int_equal(
            gvc_tracker_next(tracker, &now.features, now.warp, &now.mesh, &now.graph, &kept, NULL),
            GVC_OK);
        assert_false(kept);
        assert_int_equal(gvc_tracker_resume(tracker, &now.features, now.warp, TIPS, &now.mesh,
                                            &now.graph, &kept, NULL),
                         GVC_OK);
        assert_true(kept);
        check_cut(&now, genus[frame]);
        check_near(&before, &now, GVC_NODE_ROOT, 0, 0.1);
        for (uint32_t i = 0; i < TIPS; i++) check_near(&before, &now, GVC_NODE_EXTREMUM, i, 0.3);
        figure_free(&before);
        before = now;
    }
    gvc_tracker_destroy(&tracker);
    figure_free(&before);
}

/* Nothing is resumed that is not there, and no other number of tips. */
static void what_cannot_be_resumed(void **state) {
    (void)state;
    figure first = figure_at(1, 0), other = figure_at(2, 1), same = figure_at(1, 1);
    gvc_tracker *tracker = tracker_at(&first);
    bool kept = true;
    assert_int_equal(gvc_tracker_resume(tracker, &other.features, NULL, TIPS - 1, &other.mesh,
                                        &other.graph, &kept, NULL),
                     GVC_OK);
    assert_false(kept);
    kept = true;
    assert_int_equal(gvc_tracker_resume(tracker, &same.features, NULL, TIPS, &same.mesh,
                                        &same.graph, &kept, NULL),
                     GVC_OK);
    assert_false(kept);
    gvc_tracker_destroy(&tracker);
    gvc_tracker_options options;
    gvc_tracker_options_init(&options);
    assert_int_equal(gvc_tracker_create(&options, &tracker, NULL), GVC_OK);
    kept = true;
    assert_int_equal(gvc_tracker_resume(tracker, &other.features, NULL, TIPS, &other.mesh,
                                        &other.graph, &kept, NULL),
                     GVC_OK);
    assert_false(kept);
    assert_int_equal(other.graph.edge_count, 0);
    gvc_tracker_destroy(&tracker);
    figure_free(&first);
    figure_free(&other);
    figure_free(&same);
}

/* A cut for one frame only is a cut, but nothing goes on from it. */
static void a_single_cut_is_not_followed(void **state) {
    (void)state;
    for (unsigned genus = 1; genus <= 3; genus++) {
        figure first = figure_at(genus, 0), next = figure_at(genus, 1);
        gvc_tracker *tracker = tracker_at(&first);
        bool kept = true;
        assert_int_equal(gvc_tracker_start(tracker, &next.features, TIPS, GVC_HANDLES_GRAPH,
                                           &next.mesh, &next.graph, NULL),
                         GVC_OK);
        check_cut(&next, genus);
        gvc_cut_graph_free(&first.graph);
        assert_int_equal(gvc_tracker_next(tracker, &first.features, NULL, &first.mesh, &first.graph,
                                          &kept, NULL),
                         GVC_OK);
        assert_false(kept);
        gvc_tracker_destroy(&tracker);
        figure_free(&first);
        figure_free(&next);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_torus_has_one_handle),
        cmocka_unit_test(a_sphere_has_none),
        cmocka_unit_test(figures_with_handles_are_one_segment),
        cmocka_unit_test(handles_come_and_go),
        cmocka_unit_test(what_cannot_be_resumed),
        cmocka_unit_test(a_single_cut_is_not_followed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
