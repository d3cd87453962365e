/* SPDX-License-Identifier: MIT */
/** @file test_halfedge.c  Halfedges: building, refusing, turning, splitting. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh/halfedge.h"

#include <math.h>
#include <string.h>

static const double octahedron_positions[] = {1, 0,  0, -1, 0, 0, 0, 1, 0,
                                              0, -1, 0, 0,  0, 1, 0, 0, -1};
static const uint32_t octahedron_faces[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                            2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};

static gvc_mesh *make(size_t vertex_count, const uint32_t *faces, size_t face_count) {
    double positions[3 * 16];
    for (size_t i = 0; i < 3 * vertex_count; i++) positions[i] = (double)(i * i % 17);
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_create(positions, vertex_count, faces, face_count, &mesh, NULL),
                     GVC_OK);
    return mesh;
}

static gvc_halfedges build_octahedron(size_t attributes) {
    gvc_mesh *mesh;
    gvc_halfedges m;
    assert_int_equal(gvc_mesh_create(octahedron_positions, 6, octahedron_faces, 8, &mesh, NULL),
                     GVC_OK);
    assert_int_equal(gvc_halfedges_build(mesh, attributes, &m, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    return m;
}

static double area(const gvc_halfedges *m) {
    gvc_mesh mesh = {.vertex_count = m->vertex_count,
                     .face_count = m->face_count,
                     .position = m->position,
                     .face = m->vertex};
    return gvc_mesh_area(&mesh);
}

/** Every rule that the header states, from scratch. Returns the number of border halfedges. */
static size_t check_all(const gvc_halfedges *m) {
    size_t border = 0, met = 0;
    for (uint32_t h = 0; h < 3 * m->face_count; h++) {
        uint32_t twin = m->twin[h];
        assert_true(m->vertex[h] < m->vertex_count);
        if (twin == GVC_NONE) {
            border++;
            assert_int_equal(m->outgoing[m->vertex[h]], h);
            continue;
        }
        assert_true(twin < 3 * m->face_count);
        assert_int_equal(m->twin[twin], h);
        assert_int_equal(m->vertex[h], m->vertex[gvc_next(twin)]);
        assert_int_equal(m->vertex[gvc_next(h)], m->vertex[twin]);
    }
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        uint32_t h = m->outgoing[v];
        do {
            assert_int_equal(m->vertex[h], v);
            assert_int_equal(gvc_halfedge_between(m, v, m->vertex[gvc_next(h)]), h);
            met++;
            h = gvc_turn(m, h);
        } while (h != GVC_NONE && h != m->outgoing[v]);
    }
    assert_int_equal(met, 3 * m->face_count);
    return border;
}

static void builds_a_closed_mesh(void **state) {
    (void)state;
    gvc_halfedges m = build_octahedron(2);
    assert_int_equal(check_all(&m), 0);
    assert_int_equal(gvc_halfedge_between(&m, 0, 1), GVC_NONE);
    assert_true(fabs(gvc_halfedge_length(&m, gvc_halfedge_between(&m, 0, 2)) - sqrt(2)) < 1e-15);
    for (size_t i = 0; i < 12; i++) assert_true(m.attribute[i] == 0);
    gvc_halfedges_free(&m);
    assert_null(m.position);
}

static void builds_a_mesh_with_a_border(void **state) {
    (void)state;
    gvc_mesh *mesh = make(6, octahedron_faces, 4); /* the upper half: a disk of four faces */
    mesh->vertex_count = 5;
    gvc_halfedges m;
    assert_int_equal(gvc_halfedges_build(mesh, 0, &m, NULL), GVC_OK);
    assert_null(m.attribute);
    assert_int_equal(check_all(&m), 4);
    gvc_halfedges_free(&m);
    gvc_mesh_destroy(&mesh);
}

static void check_refused(size_t vertex_count, const uint32_t *faces, size_t face_count,
                          const char *reason) {
    gvc_mesh *mesh = make(vertex_count, faces, face_count);
    gvc_halfedges m;
    gvc_error error;
    assert_int_equal(gvc_halfedges_build(mesh, 0, &m, &error), GVC_ERROR_MESH);
    if (!strstr(error.message, reason)) fail_msg("%s: %s", reason, error.message);
    assert_null(m.vertex);
    assert_int_equal(m.face_count, 0);
    gvc_mesh_destroy(&mesh);
}

static void refuses_what_is_not_a_manifold(void **state) {
    (void)state;
    check_refused(5, (uint32_t[]){0, 1, 2, 1, 0, 3, 0, 1, 4}, 3, "has 3 faces");
    check_refused(4, (uint32_t[]){0, 1, 2, 0, 1, 3}, 2, "the same way");
    check_refused(5, (uint32_t[]){0, 1, 2, 0, 3, 4}, 2, "more than one fan");
    check_refused(3, (uint32_t[]){0, 1, 1}, 1, "repeats a vertex");
    check_refused(4, (uint32_t[]){0, 1, 2}, 1, "has no face");
    /* Two closed fans at vertex 0. */
    check_refused(
        7, (uint32_t[]){0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5}, 8,
        "more than one fan");
}

static void splits_keep_the_surface(void **state) {
    (void)state;
    gvc_halfedges m = build_octahedron(1);
    for (size_t v = 0; v < 6; v++) m.attribute[v] = 10 * m.position[3 * v] + m.position[3 * v + 1];
    double before = area(&m);
    for (uint32_t i = 0; i < 300; i++) {
        uint32_t h = (uint32_t)(i * 2654435761u % (3 * m.face_count)), vertex;
        uint32_t face = h / 3, a = m.vertex[h], b = m.vertex[gvc_next(h)];
        double t = 0.25 + 0.5 * (i % 3) / 2, expected[3];
        for (size_t k = 0; k < 3; k++)
            expected[k] =
                m.position[3 * a + k] + t * (m.position[3 * b + k] - m.position[3 * a + k]);
        assert_int_equal(gvc_halfedges_split(&m, h, t, &vertex, NULL), GVC_OK);
        assert_int_equal(vertex, m.vertex_count - 1);
        assert_int_equal(h / 3, face);
        assert_int_equal(m.vertex[h], a);
        assert_int_equal(m.vertex[gvc_next(h)], vertex);
        assert_int_not_equal(gvc_halfedge_between(&m, vertex, b), GVC_NONE);
        assert_int_equal(gvc_halfedge_between(&m, a, b), GVC_NONE);
        for (size_t k = 0; k < 3; k++)
            assert_true(fabs(m.position[3 * vertex + k] - expected[k]) < 1e-15);
        assert_true(fabs(m.attribute[vertex] - 10 * expected[0] - expected[1]) < 1e-12);
    }
    assert_int_equal(m.vertex_count, 306);
    assert_int_equal(m.face_count, 608);
    assert_int_equal(check_all(&m), 0);
    assert_true(fabs(area(&m) - before) < 1e-12);
    gvc_halfedges_free(&m);
}

static void splits_border_edges(void **state) {
    (void)state;
    gvc_mesh *mesh = make(3, (uint32_t[]){0, 1, 2}, 1);
    gvc_halfedges m;
    assert_int_equal(gvc_halfedges_build(mesh, 0, &m, NULL), GVC_OK);
    double before = area(&m);
    for (uint32_t i = 0; i < 60; i++) {
        uint32_t h = (uint32_t)(i * 40503u % (3 * m.face_count)), vertex;
        size_t faces = m.face_count, added = m.twin[h] == GVC_NONE ? 1 : 2;
        assert_int_equal(gvc_halfedges_split(&m, h, 0.5, &vertex, NULL), GVC_OK);
        assert_int_equal(m.face_count, faces + added);
        assert_true(check_all(&m) >= 3);
    }
    assert_true(fabs(area(&m) - before) < 1e-9 * before);
    gvc_halfedges_free(&m);
    gvc_mesh_destroy(&mesh);
}

static void refuses_splits_outside_the_edge(void **state) {
    (void)state;
    gvc_halfedges m = build_octahedron(0);
    uint32_t vertex;
    const double bad[] = {0, 1, -1, NAN};
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(gvc_halfedges_split(&m, 0, bad[i], &vertex, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_halfedges_split(&m, 24, 0.5, &vertex, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(m.face_count, 8);
    gvc_halfedges_free(&m);
}

static void copies_are_independent(void **state) {
    (void)state;
    gvc_halfedges m = build_octahedron(3), copy;
    uint32_t vertex;
    m.attribute[17] = 4;
    assert_int_equal(gvc_halfedges_split(&m, 5, 0.5, &vertex, NULL), GVC_OK);
    assert_int_equal(gvc_halfedges_copy(&m, &copy, NULL), GVC_OK);
    assert_int_equal(gvc_halfedges_split(&m, 7, 0.5, &vertex, NULL), GVC_OK);
    assert_int_equal(copy.vertex_count, 7);
    assert_int_equal(copy.face_count, 10);
    assert_true(copy.attribute[17] == 4);
    assert_int_equal(check_all(&copy), 0);
    assert_int_equal(gvc_halfedges_split(&copy, 7, 0.5, &vertex, NULL), GVC_OK);
    assert_memory_equal(copy.vertex, m.vertex, 3 * m.face_count * sizeof *m.vertex);
    gvc_halfedges_free(&m);
    gvc_halfedges_free(&copy);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(builds_a_closed_mesh),
        cmocka_unit_test(builds_a_mesh_with_a_border),
        cmocka_unit_test(refuses_what_is_not_a_manifold),
        cmocka_unit_test(splits_keep_the_surface),
        cmocka_unit_test(splits_border_edges),
        cmocka_unit_test(refuses_splits_outside_the_edge),
        cmocka_unit_test(copies_are_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
