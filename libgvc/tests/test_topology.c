/* SPDX-License-Identifier: MIT */
/** @file test_topology.c  The topology report and the cleaning of captures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

static gvc_mesh *make(const double *positions, size_t vertex_count, const uint32_t *faces,
                      size_t face_count) {
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_create(positions, vertex_count, faces, face_count, &mesh, NULL),
                     GVC_OK);
    return mesh;
}

/** Positions do not matter to topology: distinct ones. */
static gvc_topology survey(size_t vertex_count, const uint32_t *faces, size_t face_count) {
    double positions[3 * 64] = {0};
    for (size_t v = 0; v < vertex_count; v++) positions[3 * v] = (double)v;
    gvc_mesh *mesh = make(positions, vertex_count, faces, face_count);
    gvc_topology t;
    assert_int_equal(gvc_mesh_topology(mesh, &t, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    return t;
}

static gvc_topology survey_mesh(const gvc_mesh *mesh) {
    gvc_topology t;
    assert_int_equal(gvc_mesh_topology(mesh, &t, NULL), GVC_OK);
    return t;
}

/** A grid of n * n quads over the unit square, closed to a torus if `wrap`. */
static gvc_mesh *make_grid(size_t n, bool wrap) {
    size_t side = wrap ? n : n + 1;
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_allocate(side * side, 2 * n * n, &mesh, NULL), GVC_OK);
    for (size_t v = 0; v < side * side; v++) {
        double a = 6.283185307179586 * (double)(v % side) / (double)n;
        double b = 6.283185307179586 * (double)(v / side) / (double)n;
        const double torus[3] = {(3 + cos(a)) * cos(b), (3 + cos(a)) * sin(b), sin(a)};
        const double flat[3] = {a, b, 0};
        memcpy(mesh->position + 3 * v, wrap ? torus : flat, sizeof flat);
    }
    uint32_t *corner = mesh->face;
    for (size_t y = 0; y < n; y++) {
        for (size_t x = 0; x < n; x++) {
            uint32_t a = (uint32_t)(y * side + x), b = (uint32_t)(y * side + (x + 1) % side);
            uint32_t c = (uint32_t)((y + 1) % side * side + x);
            uint32_t d = (uint32_t)((y + 1) % side * side + (x + 1) % side);
            const uint32_t quad[6] = {a, b, d, a, d, c};
            memcpy(corner, quad, sizeof quad);
            corner += 6;
        }
    }
    return mesh;
}

static const uint32_t tetrahedron[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

static void knows_closed_surfaces(void **state) {
    (void)state;
    gvc_topology t = survey(4, tetrahedron, 4);
    assert_true(t.closed_manifold);
    assert_int_equal(t.genus, 0);
    assert_int_equal(t.edge_count, 6);
    assert_int_equal(t.component_count, 1);

    gvc_mesh *torus = make_grid(8, true);
    t = survey_mesh(torus);
    assert_true(t.closed_manifold);
    assert_int_equal(t.genus, 1);
    assert_int_equal(t.edge_count, 192);
    gvc_mesh_destroy(&torus);

    uint32_t two[24];
    for (size_t i = 0; i < 24; i++) two[i] = tetrahedron[i % 12] + (i < 12 ? 0 : 5);
    t = survey(9, two, 8); /* vertex 4 is not used */
    assert_true(t.closed_manifold);
    assert_int_equal(t.component_count, 2);
    assert_int_equal(t.unreferenced_vertex_count, 1);
    assert_int_equal(t.genus, 0);
}

static void counts_borders(void **state) {
    (void)state;
    gvc_mesh *grid = make_grid(6, false);
    gvc_topology t = survey_mesh(grid);
    assert_false(t.closed_manifold);
    assert_int_equal(t.genus, -1);
    assert_int_equal(t.boundary_edge_count, 24);
    assert_int_equal(t.boundary_loop_count, 1);
    uint32_t *face = grid->face;
    memset(face + 6 * 7, 0, 6 * sizeof *face); /* quads (1, 1) and (2, 2), as degenerate faces */
    memset(face + 6 * 14, 0, 6 * sizeof *face);
    t = survey_mesh(grid);
    assert_int_equal(t.degenerate_face_count, 4);
    assert_int_equal(t.boundary_edge_count, 32);
    assert_int_equal(t.nonmanifold_vertex_count, 1);
    /* A border goes on through the fan, so the two holes that touch in a vertex have one loop. */
    assert_int_equal(t.boundary_loop_count, 2);
    assert_int_equal(t.component_count, 1);
    gvc_mesh_destroy(&grid);
}

static void counts_what_is_not_manifold(void **state) {
    (void)state;
    gvc_topology t = survey(5, (uint32_t[]){0, 1, 2, 1, 0, 3, 0, 1, 4}, 3);
    assert_int_equal(t.nonmanifold_edge_count, 1);
    assert_int_equal(t.nonmanifold_vertex_count, 2);
    assert_int_equal(t.component_count, 3);
    assert_int_equal(t.edge_count, 7);
    assert_int_equal(t.boundary_edge_count, 6);

    t = survey(5, (uint32_t[]){0, 1, 2, 0, 3, 4}, 2); /* a bow tie */
    assert_int_equal(t.nonmanifold_vertex_count, 1);
    assert_int_equal(t.nonmanifold_edge_count, 0);
    assert_int_equal(t.boundary_loop_count, 2);

    /* An hourglass: closed, but pinched at vertex 0. */
    uint32_t hourglass[24];
    for (size_t i = 0; i < 24; i++)
        hourglass[i] =
            i < 12 || tetrahedron[i % 12] == 0 ? tetrahedron[i % 12] : tetrahedron[i % 12] + 3;
    t = survey(7, hourglass, 8);
    assert_int_equal(t.boundary_edge_count, 0);
    assert_int_equal(t.nonmanifold_vertex_count, 1);
    assert_int_equal(t.component_count, 2);
    assert_false(t.closed_manifold);
    assert_int_equal(t.genus, -1);
}

static void counts_wrong_orientation_and_odd_faces(void **state) {
    (void)state;
    uint32_t flipped[12];
    memcpy(flipped, tetrahedron, sizeof flipped);
    flipped[0] = 1;
    flipped[2] = 0;
    flipped[1] = 2;
    gvc_topology t = survey(4, flipped, 4);
    assert_int_equal(t.misoriented_edge_count, 3);
    assert_int_equal(t.nonmanifold_vertex_count, 0);
    assert_int_equal(t.boundary_edge_count, 0);
    assert_false(t.closed_manifold);

    t = survey(4, (uint32_t[]){0, 1, 2, 2, 1, 0, 1, 2, 0, 3, 3, 0, 3, 0, 3}, 5);
    assert_int_equal(t.duplicate_face_count, 2);
    assert_int_equal(t.degenerate_face_count, 2);
    assert_int_equal(t.edge_count, 3);
    assert_int_equal(t.unreferenced_vertex_count, 0);

    t = survey(3, NULL, 0);
    assert_false(t.closed_manifold);
    assert_int_equal(t.unreferenced_vertex_count, 3);
}

/** Any triangles at all, against a quadratic count. */
static void survives_any_soup(void **state) {
    (void)state;
    uint64_t seed = 99;
    for (int round = 0; round < 300; round++) {
        uint32_t faces[3 * 20];
        size_t vertex_count = 3 + (size_t)round % 9, face_count = (size_t)round % 21;
        for (size_t i = 0; i < 3 * face_count; i++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            faces[i] = (uint32_t)((seed >> 33) % vertex_count);
        }
        gvc_topology t = survey(vertex_count, faces, face_count);
        uint64_t met[4] = {0};
        for (uint32_t a = 0; a < vertex_count; a++) {
            for (uint32_t b = a + 1; b < vertex_count; b++) {
                unsigned count = 0;
                for (size_t f = 0; f < face_count; f++) {
                    const uint32_t *v = faces + 3 * f;
                    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
                    bool has_a = v[0] == a || v[1] == a || v[2] == a;
                    count += has_a && (v[0] == b || v[1] == b || v[2] == b);
                }
                met[count < 3 ? count : 3]++;
            }
        }
        assert_int_equal(t.edge_count, met[1] + met[2] + met[3]);
        assert_int_equal(t.boundary_edge_count, met[1]);
        assert_int_equal(t.nonmanifold_edge_count, met[3]);
        assert_true(t.boundary_loop_count <= t.boundary_edge_count);
    }
}

/* ------------------------------------------------------------------------------------- cleaning */

static gvc_mesh *clean(const gvc_mesh *mesh, bool weld, size_t *welded) {
    gvc_mesh *made;
    assert_int_equal(gvc_mesh_clean(mesh, weld, &made, welded, NULL), GVC_OK);
    return made;
}

/** The torus with every face on its own, as if each were cut out by texture seams. */
static gvc_mesh *make_shattered_torus(void) {
    gvc_mesh *torus = make_grid(8, true), *shattered;
    size_t corners = 3 * torus->face_count;
    assert_int_equal(gvc_mesh_allocate(corners + 1, torus->face_count, &shattered, NULL), GVC_OK);
    for (size_t i = 0; i < corners; i++) {
        memcpy(shattered->position + 3 * i, torus->position + 3 * (size_t)torus->face[i],
               3 * sizeof(double));
        /* zero has two signs */
        for (size_t k = 0; k < 3; k++) {
            double *value = &shattered->position[3 * i + k];
            if (*value == 0) *value = i % 2 ? 0.0 : -0.0;
        }
        shattered->face[i] = (uint32_t)i;
    }
    gvc_mesh_destroy(&torus);
    return shattered;
}

static void welds_seams(void **state) {
    (void)state;
    gvc_mesh *shattered = make_shattered_torus();
    size_t welded = 77;
    gvc_mesh *made = clean(shattered, true, &welded);
    gvc_topology t = survey_mesh(made);
    assert_true(t.closed_manifold);
    assert_int_equal(t.genus, 1);
    assert_int_equal(made->vertex_count, 64);
    assert_int_equal(welded, shattered->vertex_count - 1 - 64); /* one was never used */
    gvc_mesh_destroy(&made);

    made = clean(shattered, false, &welded);
    assert_int_equal(welded, 0);
    assert_int_equal(made->vertex_count, shattered->vertex_count - 1);
    assert_int_equal(survey_mesh(made).component_count, 128);
    gvc_mesh_destroy(&made);
    gvc_mesh_destroy(&shattered);
}

/** Two closed tetrahedra that touch in an edge must stay apart. */
static void leaves_closed_meshes_alone(void **state) {
    (void)state;
    double positions[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    uint32_t faces[24];
    for (size_t i = 0; i < 24; i++) faces[i] = tetrahedron[i % 12] + (i < 12 ? 0 : 4);
    const double second[12] = {0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0, -1};
    memcpy(positions + 12, second, sizeof second);
    gvc_mesh *mesh = make(positions, 8, faces, 8);
    size_t welded;
    gvc_mesh *made = clean(mesh, true, &welded);
    assert_int_equal(welded, 0);
    assert_int_equal(made->vertex_count, 8);
    assert_memory_equal(made->face, mesh->face, 24 * sizeof(uint32_t));
    gvc_mesh_destroy(&made);

    /* The same with a hole: welding would make a non-manifold edge, so it is undone. */
    mesh->face_count = 7;
    made = clean(mesh, true, &welded);
    assert_int_equal(welded, 0);
    assert_int_equal(made->vertex_count, 8);
    gvc_mesh_destroy(&made);
    gvc_mesh_destroy(&mesh);
}

static void drops_useless_parts(void **state) {
    (void)state;
    double positions[24];
    for (size_t i = 0; i < 24; i++) positions[i] = (double)(i * i % 23);
    const uint32_t faces[] = {6, 6, 0, 1, 3, 2, 1, 2, 4, 3, 2, 1, 2, 3, 4, 3, 1, 4, 0, 7, 0};
    gvc_mesh *mesh = make(positions, 8, faces, 7);
    size_t welded;
    gvc_mesh *made = clean(mesh, true, &welded);
    const uint32_t expected[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    assert_int_equal(made->vertex_count, 4);
    assert_int_equal(made->face_count, 4);
    assert_memory_equal(made->face, expected, sizeof expected);
    assert_memory_equal(made->position, positions + 3, 12 * sizeof(double));
    assert_true(survey_mesh(made).closed_manifold);
    gvc_mesh_destroy(&made);
    gvc_mesh_destroy(&mesh);
}

static void measures_size(void **state) {
    (void)state;
    const double positions[] = {0, 0, 0, 3, 0, 0, 0, 4, 0, 100, 100, 100};
    gvc_mesh *mesh = make(positions, 4, (uint32_t[]){0, 1, 2}, 1);
    assert_true(gvc_mesh_diagonal(mesh) == 5);
    assert_true(gvc_mesh_area(mesh) == 6);
    gvc_mesh_destroy(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(knows_closed_surfaces),
        cmocka_unit_test(counts_borders),
        cmocka_unit_test(counts_what_is_not_manifold),
        cmocka_unit_test(counts_wrong_orientation_and_odd_faces),
        cmocka_unit_test(survives_any_soup),
        cmocka_unit_test(welds_seams),
        cmocka_unit_test(leaves_closed_meshes_alone),
        cmocka_unit_test(drops_useless_parts),
        cmocka_unit_test(measures_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
