/* SPDX-License-Identifier: MIT */
/** @file test_roundtrip.c  The format's promise, as properties of the whole chain: what is decoded
 *  is closed, manifold, oriented, of the same genus and near the original, at every image size and
 *  bit rate; and coding is deterministic. */
#include "capture_maker.h"

typedef struct setting {
    uint32_t image_size;
    double crf, bound;
} setting;

static const setting coarse_to_fine[] = {{16, 51, NO_BOUND}, {16, -12, 0.05},    {17, 30, NO_BOUND},
                                         {33, 8, 0.012},     {48, -12, 0.008},   {65, 8, 0.006},
                                         {100, 30, 0.03},    {129, 51, NO_BOUND}};

static void check_settings(capture *frames, const setting *settings, size_t count) {
    for (size_t i = 0; i < count; i++) {
        gvc_encode_options options = quick_options(settings[i].image_size, settings[i].crf, 60);
        gvc_encode_report report;
        bytes file = encode(frames, &options, &report);
        assert_int_equal(report.frame_count, frames->count);
        assert_int_equal(report.byte_count, file.size);
        assert_int_equal(report.image_size, settings[i].image_size);
        check_frames(&file, frames, settings[i].bound);
        bytes_free(&file);
    }
}

static void every_size_and_rate_keeps_the_surface(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 1);
    check_settings(&frames, coarse_to_fine, sizeof coarse_to_fine / sizeof *coarse_to_fine);
    capture_free(&frames);
}

static void handles_survive(void **state) {
    (void)state;
    static const setting settings[] = {{65, -12, 0.01}, {33, 51, NO_BOUND}, {48, 8, 0.02}};
    for (unsigned genus = 1; genus <= SYNTH_MAX_GENUS; genus++) {
        capture frames = {0};
        capture_add_figure(&frames, genus, genus, 3 * genus, 1);
        check_settings(&frames, settings + genus % 3, 1);
        capture_free(&frames);
    }
}

static void other_dances(void **state) {
    (void)state;
    static const setting settings[] = {{33, 30, 0.05}, {64, 8, 0.006}};
    for (uint64_t seed = 2; seed < 6; seed++) {
        capture frames = {0};
        capture_add_figure(&frames, 0, seed, 7 * seed, 2);
        check_settings(&frames, settings + seed % 2, 1);
        capture_free(&frames);
    }
}

/* Surfaces of which nothing sticks out, with sharp edges, long and thin, flat, and with large
 * handles. */
static void plain_shapes(void **state) {
    (void)state;
    static const setting settings[] = {{17, 51, NO_BOUND}, {33, -12, 0.02}};
    gvc_mesh *shape[] = {mesh_ellipsoid(1, 1, 1, 24, 16, 0),
                         mesh_ellipsoid(1, 1, 9, 20, 40, 0),
                         mesh_ellipsoid(5, 4, 0.3, 32, 20, 0),
                         mesh_box(1, 1, 1, 8),
                         mesh_box(1, 0.4, 4, 8),
                         mesh_torus(0.4, 32, 16, 0),
                         mesh_torus(0.15, 48, 10, 0)};
    for (size_t i = 0; i < sizeof shape / sizeof *shape; i++) {
        capture frames = {.mesh = {shape[i]}, .count = 1};
        check_settings(&frames, settings + i % 2, 1);
        capture_free(&frames);
    }
}

/* A handful of faces: the mesh is far coarser than the image. */
static void smallest_meshes(void **state) {
    (void)state;
    static const setting settings[] = {{16, 8, 0.1}, {33, 8, 0.1}};
    static const double corner[12] = {1, 1, 1, -1, -1, 1, -1, 1, -1, 1, -1, -1};
    static const uint32_t face[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    capture frames = {.count = 1};
    assert_int_equal(gvc_mesh_create(corner, 4, face, 4, &frames.mesh[0], NULL), GVC_OK);
    check_settings(&frames, settings, 2);
    capture_free(&frames);
    frames = (capture){.mesh = {mesh_box(1, 1, 1, 1)}, .count = 1};
    check_settings(&frames, settings, 2);
    capture_free(&frames);
}

/* Far from the origin and in other units, nothing changes but the numbers. */
static void place_and_unit_do_not_matter(void **state) {
    (void)state;
    static const setting settings[] = {{48, 8, 0.006}};
    static const double scale[] = {1e-6, 1000}, offset[] = {-3e-4, 50000};
    for (size_t s = 0; s < 2; s++) {
        capture figure = {0}, frames = {.count = 1};
        capture_add_figure(&figure, 0, 1, 4, 1);
        frames.mesh[0] = mesh_moved(figure.mesh[0], scale[s], offset[s]);
        check_settings(&frames, settings, 1);
        capture_free(&figure);
        capture_free(&frames);
    }
}

static void the_error_asked_for_is_held(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    gvc_encode_options options;
    gvc_encode_report report;
    gvc_encode_options_init(&options);
    options.max_rms = 2e-3;
    bytes file = encode(&frames, &options, &report);
    assert_true(report.worst_rms <= 2e-3);
    assert_true(report.worst_rms > 1e-3); /* and not at any price */
    check_frames(&file, &frames, 2.2e-3);
    bytes_free(&file);
    capture_free(&frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_size_and_rate_keeps_the_surface),
        cmocka_unit_test(handles_survive),
        cmocka_unit_test(other_dances),
        cmocka_unit_test(plain_shapes),
        cmocka_unit_test(smallest_meshes),
        cmocka_unit_test(place_and_unit_do_not_matter),
        cmocka_unit_test(the_error_asked_for_is_held),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
