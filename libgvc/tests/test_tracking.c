/* SPDX-License-Identifier: MIT */
/** @file test_tracking.c  Matching of extrema, and the cut graph over a segment. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "descriptor/match.h"
#include "descriptor/prior.h"
#include "descriptor/tracking.h"
#include "graph_check.h"
#include "made_surfaces.h"

#include <string.h>

/* ------------------------------------------------------------------------------------- matching */

/* Least cost over all assignments of rows to columns not yet used. */
static double cheapest(const double *cost, size_t row, size_t rows, size_t columns, unsigned used) {
    double least = row == rows ? 0 : INFINITY;
    for (size_t j = 0; row < rows && j < columns; j++)
        if (!(used >> j & 1))
            least = fmin(least, cost[row * columns + j] +
                                    cheapest(cost, row + 1, rows, columns, used | 1u << j));
    return least;
}

static void assignment_is_the_cheapest(void **state) {
    (void)state;
    uint64_t random = 7;
    for (int round = 0; round < 300; round++) {
        size_t rows = 1 + (size_t)(made_random(&random) * 5);
        size_t columns = rows + (size_t)(made_random(&random) * 3);
        double cost[64], total = 0;
        uint32_t column[8];
        unsigned used = 0;
        for (size_t i = 0; i < rows * columns; i++) cost[i] = made_random(&random) - 0.3;
        assert_int_equal(gvc_assign(cost, rows, columns, column, NULL), GVC_OK);
        for (size_t i = 0; i < rows; i++) {
            assert_true(column[i] < columns && !(used >> column[i] & 1));
            used |= 1u << column[i];
            total += cost[i * columns + column[i]];
        }
        assert_float_equal(total, cheapest(cost, 0, rows, columns, 0), 1e-12);
    }
}

static void matches_are_gated(void **state) {
    (void)state;
    gvc_extremum before[2] = {{.position = {0, 0, 0}, .persistence = 1},
                              {.position = {1, 0, 0}, .persistence = 0.5}};
    gvc_extremum now[3] = {{.position = {1.05, 0, 0}, .persistence = 1},
                           {.position = {0.5, 0.5, 0}, .persistence = 0.9},
                           {.position = {0.1, 0, 0}, .persistence = 0.2}};
    gvc_features features = {.diagonal = 1, .extremum = now, .extremum_count = 3};
    uint32_t match[2];
    bool found;
    assert_int_equal(gvc_match_extrema(before, 2, &features, 0.2, match, &found, NULL), GVC_OK);
    assert_true(found);
    assert_int_equal(match[0], 2);
    assert_int_equal(match[1], 0);
    assert_int_equal(gvc_match_extrema(before, 2, &features, 0.07, match, &found, NULL), GVC_OK);
    assert_false(found);
    features.extremum_count = 1;
    assert_int_equal(gvc_match_extrema(before, 2, &features, 0.2, match, &found, NULL), GVC_OK);
    assert_false(found);
}

/* --------------------------------------------------------------------------- distance to a path */

static void prior_is_the_distance_to_the_polyline(void **state) {
    (void)state;
    double point[20 * 4], length[20], query[4];
    uint64_t random = 3;
    gvc_prior prior = {0};
    for (int i = 0; i < 20; i++) {
        length[i] = i;
        for (int k = 0; k < 4; k++) point[4 * i + k] = made_random(&random);
    }
    assert_int_equal(gvc_prior_set(&prior, 4, point, length, 20, NULL), GVC_OK);
    for (int round = 0; round < 200; round++) {
        double least = INFINITY;
        for (int k = 0; k < 4; k++) query[k] = 2 * made_random(&random) - 0.5;
        for (int s = 0; s < GVC_PRIOR_SEGMENTS; s++) {
            const double *a = prior.sample + 4 * s, *b = a + 4;
            for (int step = 0; step <= 100; step++) {
                double sum = 0;
                for (int k = 0; k < 4; k++) {
                    double d = a[k] + 0.01 * step * (b[k] - a[k]) - query[k];
                    sum += d * d;
                }
                least = fmin(least, sum);
            }
        }
        assert_float_equal(gvc_prior_distance(&prior, query, 100), least, 1e-4);
        assert_float_equal(gvc_prior_distance(&prior, query, least / 2), least / 2, 1e-15);
    }
    gvc_prior_free(&prior);
}

/* ------------------------------------------------------------------------------------- segments */

static const gvc_tracker_options usual = {1, 0.3, 0.5};
static const gvc_features_options few_samples = {40, 0.01};

/* The body with five limbs, of another connectivity in every frame, turned and stretched. */
static gvc_halfedges body_at(int frame) {
    static const uint32_t rings[] = {28, 31, 25, 34};
    gvc_halfedges body = made_globe(rings[frame % 4], 2 * rings[frame % 4] - 5);
    double angle = 0.02 * frame, stretch = 1 + 0.01 * frame;
    for (size_t v = 0; v < body.vertex_count; v++) { /* the poles are nowhere special */
        double *p = body.position + 3 * v, x = p[0], z = p[2];
        p[0] = cos(0.7) * x - sin(0.7) * z, p[2] = sin(0.7) * x + cos(0.7) * z;
    }
    made_limbs(&body);
    for (size_t v = 0; v < body.vertex_count; v++) {
        double *p = body.position + 3 * v, x = p[0], y = p[1];
        p[0] = cos(angle) * x - sin(angle) * y, p[1] = sin(angle) * x + cos(angle) * y;
        p[2] *= stretch;
    }
    return body;
}

static double nearest_on(const gvc_halfedges *mesh, const gvc_cut_edge *edge, const double *p) {
    double least = INFINITY;
    for (size_t i = 0; i < edge->vertex_count; i++) {
        const double *q = mesh->position + 3 * edge->vertex[i];
        least = fmin(least, hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]));
    }
    return least;
}

/* The same nodes and edges, each close to where it was. */
static void check_same_graph(const gvc_halfedges *before, const gvc_cut_graph *old,
                             const gvc_halfedges *mesh, const gvc_cut_graph *graph, double reach) {
    assert_int_equal(old->node_count, graph->node_count);
    assert_int_equal(old->edge_count, graph->edge_count);
    for (size_t n = 0; n < graph->node_count; n++) {
        const double *p = before->position + 3 * old->node[n].vertex;
        const double *q = mesh->position + 3 * graph->node[n].vertex;
        assert_int_equal(old->node[n].kind, graph->node[n].kind);
        assert_int_equal(old->node[n].feature, graph->node[n].feature);
        assert_true(hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]) < reach);
    }
    for (size_t e = 0; e < graph->edge_count; e++) {
        assert_memory_equal(old->edge[e].node, graph->edge[e].node, sizeof graph->edge[e].node);
        for (size_t i = 0; i < graph->edge[e].vertex_count; i++)
            assert_true(nearest_on(before, &old->edge[e],
                                   mesh->position + 3 * graph->edge[e].vertex[i]) < reach);
    }
}

typedef gvc_halfedges (*surface_maker)(int frame);

static void track_segment(surface_maker make, size_t tips, size_t genus, int frames, double reach) {
    gvc_tracker *tracker;
    gvc_halfedges before = {0};
    gvc_cut_graph old = {0};
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    for (int frame = 0; frame < frames; frame++) {
        gvc_halfedges mesh = make(frame);
        gvc_features features;
        gvc_cut_graph graph;
        bool kept = true;
        gvc_result result;
        assert_int_equal(gvc_features_find(&mesh, &few_samples, &features, NULL), GVC_OK);
        if (frame == 0)
            result =
                gvc_tracker_start(tracker, &features, tips, GVC_HANDLES_SHORT, &mesh, &graph, NULL);
        else
            result = gvc_tracker_next(tracker, &features, NULL, &mesh, &graph, &kept, NULL);
        assert_int_equal(result, GVC_OK);
        assert_true(kept);
        check_opens_to_disk(&mesh, &graph);
        check_structure(&graph, genus, genus == 0 && tips < 2 ? 2 : tips);
        assert_int_equal(mesh.attribute_count, 0);
        assert_null(mesh.attribute);
        if (frame > 0) check_same_graph(&before, &old, &mesh, &graph, reach);
        gvc_features_free(&features);
        gvc_cut_graph_free(&old);
        gvc_halfedges_free(&before);
        before = mesh;
        old = graph;
    }
    gvc_cut_graph_free(&old);
    gvc_halfedges_free(&before);
    gvc_tracker_destroy(&tracker);
}

/* The body is about 7 across. */
static void limbs_are_tracked(void **state) {
    (void)state;
    track_segment(body_at, LIMB_COUNT, 0, 6, 0.45);
}

static void made_up_tip_is_tracked(void **state) {
    (void)state;
    track_segment(body_at, 1, 0, 4, 0.45);
}

static gvc_halfedges torus_at(int frame) {
    gvc_halfedges ring = made_torus(40 + 3 * (uint32_t)frame, 20 - (uint32_t)frame, 0.4);
    for (size_t v = 0; v < ring.vertex_count; v++) {
        double *p = ring.position + 3 * v;
        p[0] *= 1.3 + 0.01 * frame;
        p[2] *= 1 + 0.2 * p[0];
    }
    return ring;
}

static void handles_are_tracked(void **state) {
    (void)state;
    track_segment(torus_at, 1, 1, 4, 0.25);
}

/* Starts a segment with the first frame of the body. */
static gvc_tracker *begun(void) {
    gvc_tracker *tracker;
    gvc_features features;
    gvc_cut_graph graph;
    gvc_halfedges body = body_at(0);
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    assert_int_equal(gvc_features_find(&body, &few_samples, &features, NULL), GVC_OK);
    assert_int_equal(
        gvc_tracker_start(tracker, &features, LIMB_COUNT, GVC_HANDLES_SHORT, &body, &graph, NULL),
        GVC_OK);
    gvc_cut_graph_free(&graph);
    gvc_features_free(&features);
    gvc_halfedges_free(&body);
    return tracker;
}

/* Expects that the frame is refused, and the tracker then has nothing to go on from. */
static void refused(gvc_tracker *tracker, gvc_halfedges *mesh, const gvc_features *features) {
    gvc_cut_graph graph;
    bool kept;
    assert_int_equal(gvc_tracker_next(tracker, features, NULL, mesh, &graph, &kept, NULL), GVC_OK);
    assert_false(kept);
    assert_int_equal(graph.edge_count, 0);
    assert_int_equal(mesh->attribute_count, 0);
    assert_int_equal(gvc_tracker_next(tracker, features, NULL, mesh, &graph, &kept, NULL),
                     GVC_ERROR_ARGUMENT);
    gvc_tracker_destroy(&tracker);
}

static void a_lost_limb_ends_the_segment(void **state) {
    (void)state;
    gvc_halfedges body = body_at(1);
    gvc_features features;
    assert_int_equal(gvc_features_find(&body, &few_samples, &features, NULL), GVC_OK);
    features.extremum_count = LIMB_COUNT - 1;
    refused(begun(), &body, &features);
    gvc_features_free(&features);
    gvc_halfedges_free(&body);
}

static void another_genus_ends_the_segment(void **state) {
    (void)state;
    gvc_halfedges ring = made_torus(30, 12, 0.4);
    gvc_features features;
    assert_int_equal(gvc_features_find(&ring, &few_samples, &features, NULL), GVC_OK);
    refused(begun(), &ring, &features);
    gvc_features_free(&features);
    gvc_halfedges_free(&ring);
}

/* Seen in a mirror the limbs follow each other the other way round. */
static void the_mirror_image_ends_the_segment(void **state) {
    (void)state;
    gvc_halfedges body = body_at(0), mirror;
    gvc_mesh *mesh;
    gvc_features features;
    assert_int_equal(gvc_mesh_allocate(body.vertex_count, body.face_count, &mesh, NULL), GVC_OK);
    memcpy(mesh->position, body.position, 3 * body.vertex_count * sizeof *mesh->position);
    for (size_t f = 0; f < body.face_count; f++)
        for (size_t k = 0; k < 3; k++) mesh->face[3 * f + k] = body.vertex[3 * f + 2 - k];
    assert_int_equal(gvc_halfedges_build(mesh, 0, &mirror, NULL), GVC_OK);
    assert_int_equal(gvc_features_find(&mirror, &few_samples, &features, NULL), GVC_OK);
    refused(begun(), &mirror, &features);
    gvc_features_free(&features);
    gvc_halfedges_free(&mirror);
    gvc_mesh_destroy(&mesh);
    gvc_halfedges_free(&body);
}

/* What the caller carries on the vertices is still there, and interpolated at the new ones. */
static void attributes_survive(void **state) {
    (void)state;
    gvc_halfedges plain = body_at(0), body;
    gvc_mesh *mesh;
    gvc_features features;
    gvc_cut_graph graph;
    gvc_tracker *tracker;
    assert_int_equal(gvc_mesh_allocate(plain.vertex_count, plain.face_count, &mesh, NULL), GVC_OK);
    memcpy(mesh->position, plain.position, 3 * plain.vertex_count * sizeof *mesh->position);
    memcpy(mesh->face, plain.vertex, 3 * plain.face_count * sizeof *mesh->face);
    assert_int_equal(gvc_halfedges_build(mesh, 3, &body, NULL), GVC_OK);
    memcpy(body.attribute, body.position, 3 * body.vertex_count * sizeof *body.attribute);
    assert_int_equal(gvc_features_find(&body, &few_samples, &features, NULL), GVC_OK);
    assert_int_equal(gvc_tracker_create(&usual, &tracker, NULL), GVC_OK);
    assert_int_equal(
        gvc_tracker_start(tracker, &features, 3, GVC_HANDLES_SHORT, &body, &graph, NULL), GVC_OK);
    assert_int_equal(body.attribute_count, 3);
    assert_true(body.vertex_count > plain.vertex_count);
    for (size_t i = 0; i < 3 * body.vertex_count; i++)
        assert_float_equal(body.attribute[i], body.position[i], 1e-12);
    gvc_cut_graph_free(&graph);
    gvc_tracker_destroy(&tracker);
    gvc_features_free(&features);
    gvc_halfedges_free(&body);
    gvc_halfedges_free(&plain);
    gvc_mesh_destroy(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assignment_is_the_cheapest),
        cmocka_unit_test(matches_are_gated),
        cmocka_unit_test(prior_is_the_distance_to_the_polyline),
        cmocka_unit_test(limbs_are_tracked),
        cmocka_unit_test(made_up_tip_is_tracked),
        cmocka_unit_test(handles_are_tracked),
        cmocka_unit_test(a_lost_limb_ends_the_segment),
        cmocka_unit_test(another_genus_ends_the_segment),
        cmocka_unit_test(the_mirror_image_ends_the_segment),
        cmocka_unit_test(attributes_survive),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
