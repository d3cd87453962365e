/* SPDX-License-Identifier: MIT */
/** @file test_synth.c  The sample capture: always codable, always the same, always in motion. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "synth.h"

#include <math.h>
#include <string.h>

static gvc_mesh *make(const synth_options *options, uint64_t frame) {
    gvc_error error;
    gvc_error_init(&error);
    gvc_mesh *mesh;
    gvc_result result = synth_frame(options, frame, &mesh, &error);
    if (result != GVC_OK) fail_msg("%s", error.message);
    return mesh;
}

static void test_topology(void **state) {
    (void)state;
    for (unsigned genus = 0; genus <= SYNTH_MAX_GENUS; genus++) {
        synth_options options;
        synth_options_init(&options);
        options.genus = genus;
        options.vertex_count = 4000;
        for (uint64_t frame = 0; frame < 60; frame += 20) {
            gvc_mesh *mesh = make(&options, frame);
            gvc_topology topology;
            assert_int_equal(gvc_mesh_topology(mesh, &topology, NULL), GVC_OK);
            assert_true(topology.closed_manifold);
            assert_int_equal(topology.component_count, 1);
            assert_int_equal(topology.genus, genus);
            assert_int_equal(topology.degenerate_face_count, 0);
            assert_int_equal(topology.unreferenced_vertex_count, 0);
            double count = (double)gvc_mesh_vertex_count(mesh);
            assert_true(count > 0.8 * 4000 && count < 1.25 * 4000);
            gvc_mesh_destroy(&mesh);
        }
    }
}

/* Six times the volume enclosed: positive if the faces run counter-clockwise seen from outside. */
static void test_faces_look_outward(void **state) {
    (void)state;
    synth_options options;
    synth_options_init(&options);
    gvc_mesh *mesh = make(&options, 0);
    const double *p = gvc_mesh_positions(mesh);
    const uint32_t *f = gvc_mesh_faces(mesh);
    double volume = 0;
    for (size_t i = 0; i < gvc_mesh_face_count(mesh); i++) {
        const double *a = &p[3 * f[3 * i]], *b = &p[3 * f[3 * i + 1]], *c = &p[3 * f[3 * i + 2]];
        volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                  a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    assert_true(volume / 6 > 0.03 && volume / 6 < 0.15); /* cubic metres of a person */
    gvc_mesh_destroy(&mesh);
}

static void test_repeatable(void **state) {
    (void)state;
    synth_options options;
    synth_options_init(&options);
    gvc_mesh *a = make(&options, 7), *b = make(&options, 7);
    size_t vertices = gvc_mesh_vertex_count(a), faces = gvc_mesh_face_count(a);
    assert_int_equal(vertices, gvc_mesh_vertex_count(b));
    assert_int_equal(faces, gvc_mesh_face_count(b));
    assert_memory_equal(gvc_mesh_positions(a), gvc_mesh_positions(b),
                        3 * vertices * sizeof(double));
    assert_memory_equal(gvc_mesh_faces(a), gvc_mesh_faces(b), 3 * faces * sizeof(uint32_t));
    gvc_mesh_destroy(&a);
    gvc_mesh_destroy(&b);
}

static void test_moves_smoothly_with_new_connectivity(void **state) {
    (void)state;
    synth_options options;
    synth_options_init(&options);
    gvc_mesh *last = make(&options, 20);
    for (uint64_t frame = 21; frame < 24; frame++) {
        gvc_mesh *mesh = make(&options, frame);
        gvc_distance distance;
        assert_int_equal(gvc_mesh_distance(last, mesh, 2000, &distance, NULL), GVC_OK);
        assert_true(distance.rms[0] > 1e-3 * distance.diagonal);
        assert_true(distance.maximum[0] < 0.06 * distance.diagonal);
        assert_true(distance.maximum[1] < 0.06 * distance.diagonal);
        bool same = gvc_mesh_face_count(last) == gvc_mesh_face_count(mesh) &&
                    memcmp(gvc_mesh_faces(last), gvc_mesh_faces(mesh),
                           3 * gvc_mesh_face_count(mesh) * sizeof(uint32_t)) == 0;
        assert_false(same);
        gvc_mesh_destroy(&last);
        last = mesh;
    }
    gvc_mesh_destroy(&last);
}

/* Two meshes of one moment show one surface, however it is divided into triangles. */
static void test_resolutions_agree(void **state) {
    (void)state;
    synth_options options;
    synth_options_init(&options);
    gvc_mesh *coarse = make(&options, 3);
    options.vertex_count = 16000;
    gvc_mesh *fine = make(&options, 3);
    gvc_distance distance;
    assert_int_equal(gvc_mesh_distance(coarse, fine, 5000, &distance, NULL), GVC_OK);
    assert_true(distance.rms[0] < 1e-3 * distance.diagonal);
    assert_true(distance.rms[1] < 1e-3 * distance.diagonal);
    gvc_mesh_destroy(&coarse);
    gvc_mesh_destroy(&fine);
}

static void test_arguments(void **state) {
    (void)state;
    synth_options options;
    gvc_mesh *mesh;
    synth_options_init(&options);
    assert_int_equal(synth_frame(&options, options.frame_count, &mesh, NULL), GVC_ERROR_ARGUMENT);
    assert_null(mesh);
    options.genus = SYNTH_MAX_GENUS + 1;
    assert_int_equal(synth_frame(&options, 0, &mesh, NULL), GVC_ERROR_ARGUMENT);
    synth_options_init(&options);
    options.vertex_count = 100;
    assert_int_equal(synth_frame(&options, 0, &mesh, NULL), GVC_ERROR_ARGUMENT);
    synth_options_init(&options);
    options.frame_rate = NAN;
    assert_int_equal(synth_frame(&options, 0, &mesh, NULL), GVC_ERROR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_topology),
        cmocka_unit_test(test_faces_look_outward),
        cmocka_unit_test(test_repeatable),
        cmocka_unit_test(test_moves_smoothly_with_new_connectivity),
        cmocka_unit_test(test_resolutions_agree),
        cmocka_unit_test(test_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
