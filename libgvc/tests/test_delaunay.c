/* SPDX-License-Identifier: MIT */
/** @file test_delaunay.c  The intrinsic Delaunay triangulation keeps the surface and its border. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "chart/delaunay.h"
#include "made_surfaces.h"

static double area_of(const gvc_intrinsic *t) {
    double area = 0;
    for (size_t f = 0; f < t->face_count; f++) {
        double a[2], b[2];
        gvc_intrinsic_lay(t, (uint32_t)(3 * f), a, b);
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return area;
}

/* Twins mirror each other, stars close, no edge is left that should be flipped. */
static void check_triangulation(const gvc_halfedges *mesh, const gvc_intrinsic *t) {
    size_t border = 0, mesh_border = 0;
    for (uint32_t h = 0; h < 3 * t->face_count; h++) {
        uint32_t g = t->twin[h];
        border += g == GVC_NONE;
        mesh_border += mesh->twin[h] == GVC_NONE;
        if (g == GVC_NONE) continue;
        assert_int_equal(t->twin[g], h);
        assert_int_equal(t->vertex[g], t->vertex[gvc_next(h)]);
        assert_float_equal(t->length[g], t->length[h], 1e-12);
        if (g / 3 != h / 3)
            assert_true(gvc_intrinsic_cotangent(t, h) + gvc_intrinsic_cotangent(t, g) > -1e-8);
    }
    assert_int_equal(border, mesh_border);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        assert_int_equal(t->vertex[t->outgoing[v]], v);
        assert_int_equal(t->twin[t->outgoing[v]] == GVC_NONE,
                         mesh->twin[mesh->outgoing[v]] == GVC_NONE);
    }
}

static void check(const gvc_halfedges *mesh) {
    gvc_intrinsic t;
    double area = 0;
    for (size_t f = 0; f < mesh->face_count; f++) {
        const gvc_intrinsic own = {mesh->face_count, NULL, NULL, NULL,
                                   (double[]){gvc_halfedge_length(mesh, (uint32_t)(3 * f)),
                                              gvc_halfedge_length(mesh, (uint32_t)(3 * f + 1)),
                                              gvc_halfedge_length(mesh, (uint32_t)(3 * f + 2))}};
        double a[2], b[2];
        gvc_intrinsic_lay(&own, 0, a, b);
        area += a[0] * b[1] / 2;
    }
    assert_int_equal(gvc_delaunay(mesh, &t, NULL), GVC_OK);
    assert_int_equal(t.face_count, mesh->face_count);
    assert_float_equal(area_of(&t), area, 1e-9 * area);
    check_triangulation(mesh, &t);
    gvc_intrinsic_free(&t);
}

static void surfaces(void **state) {
    (void)state;
    gvc_halfedges grid = made_grid(20, 20, 1.5, 0.2), globe = made_globe(9, 60);
    check(&grid);
    check(&globe);
    gvc_halfedges_free(&grid);
    gvc_halfedges_free(&globe);
}

/* On a plane there is one Delaunay triangulation: squares sheared by whole steps become upright
 * again, so every edge has length 1 or the root of 2. */
static void shear_is_undone(void **state) {
    (void)state;
    enum { N = 12 };
    gvc_halfedges grid = made_grid(N, N, 2, 0);
    gvc_intrinsic t;
    size_t other = 0;
    assert_int_equal(gvc_delaunay(&grid, &t, NULL), GVC_OK);
    for (uint32_t h = 0; h < 3 * t.face_count; h++)
        if (fabs(t.length[h] - 1) > 1e-9 && fabs(t.length[h] - sqrt(2)) > 1e-9) other++;
    assert_true(other < 3 * t.face_count / 5); /* the slanting border has longer ones */
    assert_true(other < 6 * N * 3);
    gvc_intrinsic_free(&t);
    gvc_halfedges_free(&grid);
}

/* Two thin triangles that share their long side, glued along the others too: edges that meet
 * themselves must not spoil the numbering. */
static void a_needle(void **state) {
    (void)state;
    const double position[] = {0, 0, 0, 10, 0, 0, 5, 0.2, 0.1, 5, -0.2, 0.1, 5, 0, -0.2};
    const uint32_t face[] = {0, 1, 2, 1, 0, 3, 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4};
    gvc_halfedges needle = made_halfedges(position, 5, face, 6);
    check(&needle);
    gvc_halfedges_free(&needle);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(surfaces),
        cmocka_unit_test(shear_is_undone),
        cmocka_unit_test(a_needle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
