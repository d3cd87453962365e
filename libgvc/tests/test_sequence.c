/* SPDX-License-Identifier: MIT */
/** @file test_sequence.c  Captures of several frames: the same bytes on any number of threads, the
 *  same frames in any order, groups and segments. */
#include "capture_maker.h"

/* --------------------------------------------------------------------------------- determinism */

static void threads_and_repetition_do_not_matter(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 3, 0, 4);
    bytes file[3];
    static const uint32_t threads[3] = {1, 2, 3};
    for (int i = 0; i < 3; i++) {
        gvc_encode_options options = quick_options(33, 20, 3);
        options.threads = threads[i];
        file[i] = encode(&frames, &options, NULL);
        assert_same_bytes(&file[0], &file[i]);
    }
    for (int i = 0; i < 3; i++) bytes_free(&file[i]);
    capture_free(&frames);
}

static void order_of_decoding_does_not_matter(void **state) {
    (void)state;
    static const size_t order[] = {3, 3, 0, 4, 2, 1, 4, 0};
    static const uint32_t gops[] = {2, 5};
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 20, 5);
    for (int g = 0; g < 2; g++) {
        gvc_encode_options options = quick_options(33, 20, gops[g]);
        gvc_encode_report report;
        bytes file = encode(&frames, &options, &report);
        assert_true(report.gop_count >= (5 + gops[g] - 1) / gops[g]);
        check_frames(&file, &frames, 0.02);
        player in_order = player_open(&file, NULL), random = player_open(&file, NULL);
        gvc_mesh *expected[5];
        for (size_t i = 0; i < 5; i++) expected[i] = player_frame(&in_order, i);
        for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
            gvc_mesh *mesh = player_frame(&random, order[i]);
            assert_same_mesh(mesh, expected[order[i]]);
            gvc_mesh_destroy(&mesh);
        }
        for (size_t i = 0; i < 5; i++) gvc_mesh_destroy(&expected[i]);
        player_close(&random);
        player_close(&in_order);
        bytes_free(&file);
    }
    capture_free(&frames);
}

/* ------------------------------------------------------------------------------------ segments */

static void a_change_of_genus_starts_a_segment(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    capture_add_figure(&frames, 1, 1, 2, 2);
    capture_add_figure(&frames, 0, 1, 4, 1);
    gvc_encode_options options = quick_options(48, 20, 60);
    gvc_encode_report report;
    bytes file = encode(&frames, &options, &report);
    assert_true(report.segment_count >= 3);
    check_frames(&file, &frames, 0.02);
    player made = player_open(&file, NULL);
    static const uint32_t genus[] = {0, 0, 1, 1, 0};
    uint64_t segment = 0;
    for (uint64_t i = 0; i < 5; i++) {
        gvc_frame_info info;
        assert_int_equal(gvc_reader_frame_info(made.reader, i, &info, NULL), GVC_OK);
        assert_int_equal(info.genus, genus[i]);
        if (i > 0 && genus[i] != genus[i - 1]) {
            assert_true(info.segment > segment);
            assert_true(info.keyframe);
        }
        assert_true(info.segment >= segment);
        segment = info.segment;
    }
    player_close(&made);
    bytes_free(&file);
    capture_free(&frames);
}

/* Nothing in common from frame to frame: shapes of the same genus, but with other extrema. */
static void a_capture_of_unlike_frames(void **state) {
    (void)state;
    capture frames = {.mesh = {mesh_ellipsoid(1, 1, 1, 16, 12, 0), mesh_box(1, 1, 3, 6)},
                      .count = 2};
    capture_add_figure(&frames, 0, 1, 0, 1);
    frames.mesh[frames.count++] = mesh_ellipsoid(0.2, 0.2, 2, 16, 24, 0.1);
    capture_add_figure(&frames, 0, 2, 9, 1);
    gvc_encode_options options = quick_options(48, 8, 2);
    bytes file = encode(&frames, &options, NULL);
    check_frames(&file, &frames, 0.02);
    bytes_free(&file);
    capture_free(&frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_repetition_do_not_matter),
        cmocka_unit_test(order_of_decoding_does_not_matter),
        cmocka_unit_test(a_change_of_genus_starts_a_segment),
        cmocka_unit_test(a_capture_of_unlike_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
