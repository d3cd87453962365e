/* SPDX-License-Identifier: MIT */
/** @file test_refine.c  Refinement keeps the surface and meets its bound. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "made_surfaces.h"
#include "mesh/refine.h"

#include <string.h>

static double longest_edge(const gvc_halfedges *mesh) {
    double longest = 0;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++)
        longest = fmax(longest, gvc_halfedge_length(mesh, h));
    return longest;
}

static double area(const gvc_halfedges *mesh, double *least_angle) {
    double sum = 0;
    *least_angle = PI;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        double a = gvc_halfedge_length(mesh, gvc_next(h)), b = gvc_halfedge_length(mesh, h);
        double c = gvc_halfedge_length(mesh, gvc_prev(h));
        double angle = acos(fmax(-1, fmin(1, (b * b + c * c - a * a) / (2 * b * c))));
        *least_angle = fmin(*least_angle, angle);
        if (h % 3 == 0) sum += b * c * sin(angle) / 2;
    }
    return sum;
}

static void check_twins(const gvc_halfedges *m) {
    for (uint32_t h = 0; h < 3 * m->face_count; h++) {
        if (m->twin[h] == GVC_NONE) continue;
        assert_int_equal(m->twin[m->twin[h]], h);
        assert_int_equal(m->vertex[m->twin[h]], m->vertex[gvc_next(h)]);
    }
    for (uint32_t v = 0; v < m->vertex_count; v++) assert_int_equal(m->vertex[m->outgoing[v]], v);
}

static void check_refined(gvc_halfedges *mesh, double longest) {
    double before, after, whole = area(mesh, &before);
    size_t count = mesh->vertex_count;
    double *position = malloc(3 * count * sizeof *position);
    memcpy(position, mesh->position, 3 * count * sizeof *position);
    assert_int_equal(gvc_refine(mesh, longest, SIZE_MAX, NULL), GVC_OK);
    assert_true(mesh->vertex_count > count);
    assert_true(longest_edge(mesh) <= longest);
    assert_float_equal(area(mesh, &after), whole, 1e-9 * whole);
    assert_true(after >= before / 2 - 1e-9);
    assert_memory_equal(position, mesh->position, 3 * count * sizeof *position);
    check_twins(mesh);
    free(position);
}

static void splits_to_the_bound(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(1), sheet = made_grid(5, 4, 1.5, 0.2);
    check_refined(&ball, 0.1);
    check_refined(&sheet, 0.13); /* with a border */
    gvc_halfedges_free(&ball);
    gvc_halfedges_free(&sheet);
}

static void stops_at_a_count(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(1);
    assert_int_equal(gvc_refine(&ball, 1e-6, 100, NULL), GVC_OK);
    assert_int_equal(ball.vertex_count, 100);
    double longest = longest_edge(&ball);
    assert_true(longest < 0.8); /* the longest went first */
    assert_int_equal(gvc_refine(&ball, longest, SIZE_MAX, NULL), GVC_OK);
    assert_int_equal(ball.vertex_count, 100); /* none is longer */
    gvc_halfedges_free(&ball);
}

/* Every point of an attribute that is linear on each face keeps its value. */
static void interpolates_attributes(void **state) {
    (void)state;
    gvc_halfedges plain = made_sphere(0), ball;
    gvc_mesh view = {plain.vertex_count, plain.face_count, plain.position, plain.vertex};
    assert_int_equal(gvc_halfedges_build(&view, 1, &ball, NULL), GVC_OK);
    for (size_t v = 0; v < ball.vertex_count; v++)
        ball.attribute[v] = 3 * ball.position[3 * v] - ball.position[3 * v + 2];
    assert_int_equal(gvc_refine(&ball, 0.2, SIZE_MAX, NULL), GVC_OK);
    for (size_t v = 0; v < ball.vertex_count; v++)
        assert_float_equal(ball.attribute[v], 3 * ball.position[3 * v] - ball.position[3 * v + 2],
                           1e-12);
    gvc_halfedges_free(&plain);
    gvc_halfedges_free(&ball);
}

static void refuses_a_bound_of_nothing(void **state) {
    (void)state;
    gvc_halfedges ball = made_sphere(0);
    assert_int_equal(gvc_refine(&ball, 0, 100, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_refine(&ball, NAN, 100, NULL), GVC_ERROR_ARGUMENT);
    gvc_halfedges_free(&ball);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splits_to_the_bound),
        cmocka_unit_test(stops_at_a_count),
        cmocka_unit_test(interpolates_attributes),
        cmocka_unit_test(refuses_a_bound_of_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
