/* SPDX-License-Identifier: MIT */
/** @file test_lossless.c  Lossless files through the whole chain: the codes that come out are those
 *  of the images that went in, twins are equal, surfaces are closed, and a preview is one. */
#include "capture_maker.h"

#include "chart/rebuild.h"
#include "container/shape_record.h"
#include "encode/tap.h"
#include "file.h"

/** The images that the encoder coded. */
typedef struct images {
    double *image[MAX_CAPTURE];
    uint32_t size;
} images;

static gvc_result keep_image(void *user, uint64_t frame, const double *image, uint32_t size,
                             gvc_error *error) {
    images *kept = user;
    (void)error;
    size_t bytes_needed = 3 * sizeof *image * size * size;
    free(kept->image[frame]);
    kept->image[frame] = malloc(bytes_needed);
    if (!kept->image[frame]) abort();
    memcpy(kept->image[frame], image, bytes_needed);
    kept->size = size;
    return GVC_OK;
}

static gvc_encode_options lossless_options(uint32_t size, uint32_t gop) {
    gvc_encode_options options = quick_options(size, NAN, gop);
    options.lossless = true;
    options.best_effort = true;
    return options;
}

static bytes encode_kept(capture *frames, const gvc_encode_options *options, images *kept) {
    bytes file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_source source = capture_source(frames);
    gvc_sink sink = bytes_sink(&file);
    gvc_image_tap tap = {.user = kept, .image = keep_image};
    if (gvc_encode_tapped(&source, &sink, options, &tap, NULL, &error) != GVC_OK) {
        fail_msg("frame %lld: %s", (long long)error.frame, error.message);
    }
    return file;
}

static void images_free(images *kept) {
    for (size_t i = 0; i < MAX_CAPTURE; i++) free(kept->image[i]);
    *kept = (images){0};
}

/** Codes of a frame are the image's coordinates in steps, to the nearest, and twins are equal. */
static void check_codes(const player *made, const images *kept, uint64_t frame) {
    const uint16_t *plane;
    uint32_t size;
    size_t fragment;
    gvc_shape shape;
    gvc_weld weld;
    assert_int_equal(gvc_reader_find(made->reader, frame, &fragment, NULL), GVC_OK);
    assert_int_equal(gvc_reader_shape(made->reader, fragment, &shape, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_codes(made->decoder, frame, 0, &plane, &size, NULL), GVC_OK);
    assert_int_equal(size, kept->size);
    const gvc_chart_shape *chart = &shape.chart[0];
    size_t samples = (size_t)size * size;
    for (size_t i = 0; i < 3 * samples; i++) {
        double code = (kept->image[frame][i] - chart->origin[i / samples]) / chart->step;
        assert_true(fabs(code - plane[i]) <= 0.5);
    }
    assert_int_equal(gvc_weld_build(&chart->sides, &weld, NULL), GVC_OK);
    uint16_t *code = malloc(3 * sizeof *code * weld.vertex_count);
    assert_non_null(code);
    gvc_weld_codes(&weld, plane, code);
    for (size_t i = 0; i < samples; i++) {
        for (size_t k = 0; k < 3; k++) {
            assert_int_equal(plane[k * samples + i], code[3 * weld.vertex[i] + k]);
        }
    }
    free(code);
    gvc_weld_free(&weld);
    gvc_shape_free(&shape);
}

static void check_lossless(capture *frames, uint32_t size, double bound) {
    images kept = {0};
    gvc_encode_options options = lossless_options(size, 2);
    bytes file = encode_kept(frames, &options, &kept);
    player made = player_open(&file, NULL);
    gvc_info info;
    gvc_reader_info(made.reader, &info);
    assert_true(info.lossless && !info.preview);
    assert_int_equal(info.geometry_bytes, 0);
    assert_true(info.exact_bytes > 0 && info.shape_bytes > 0);
    for (size_t i = frames->count; i-- > 0;) check_codes(&made, &kept, i);
    for (size_t i = 0; i < frames->count; i++) check_codes(&made, &kept, i);
    player_close(&made);
    check_frames(&file, frames, bound);
    bytes_free(&file);
    images_free(&kept);
    capture_free(frames);
}

static void codes_come_back_exactly(void **state) {
    (void)state;
    capture frames = {.mesh = {mesh_ellipsoid(0.5, 0.6, 2, 10, 8, 0),
                               mesh_ellipsoid(0.5, 0.65, 2, 10, 8, 0.1), mesh_box(0.5, 0.6, 2, 2)},
                      .count = 3};
    check_lossless(&frames, 33, 0.03);
    frames = (capture){.mesh = {mesh_torus(0.3, 14, 7, 0)}, .count = 1};
    check_lossless(&frames, 32, 0.03);
}

/* ------------------------------------------------------------------------------------- preview */

static void a_preview_is_the_lossy_file_of_the_same_images(void **state) {
    (void)state;
    capture frames = {
        .mesh = {mesh_ellipsoid(0.5, 0.6, 2, 10, 8, 0), mesh_ellipsoid(0.5, 0.7, 2, 10, 8, 0.2)},
        .count = 2};
    gvc_encode_options options = quick_options(33, 20, 2);
    bytes lossy = encode(&frames, &options, NULL);
    options.lossless = true;
    options.best_effort = true;
    bytes plain = encode(&frames, &options, NULL);
    options.with_preview = true;
    gvc_encode_report report;
    bytes both = encode(&frames, &options, &report);
    options.threads = 1; /* makes no difference */
    bytes again = encode(&frames, &options, NULL);
    assert_same_bytes(&again, &both);
    bytes_free(&again);
    assert_true(report.preview_rms > report.worst_rms && report.worst_rms > 0);

    gvc_read_options reading;
    gvc_read_options_init(&reading);
    player exact = player_open(&both, NULL), alone = player_open(&plain, NULL);
    reading.preview = true;
    player preview = player_open(&both, &reading), h264 = player_open(&lossy, &reading);
    gvc_info info;
    gvc_reader_info(exact.reader, &info);
    assert_true(info.lossless && info.preview && info.geometry_bytes > 0);
    for (uint64_t i = 0; i < frames.count; i++) {
        gvc_frame_info facts, coarse;
        gvc_mesh *a = player_frame(&exact, i), *b = player_frame(&alone, i);
        assert_same_mesh(a, b);
        gvc_mesh *c = player_frame(&preview, i), *d = player_frame(&h264, i);
        assert_same_mesh(c, d);
        assert_int_equal(gvc_reader_frame_info(exact.reader, i, &facts, NULL), GVC_OK);
        assert_int_equal(gvc_reader_frame_info(preview.reader, i, &coarse, NULL), GVC_OK);
        assert_memory_not_equal(facts.digest, coarse.digest, sizeof facts.digest);
        gvc_mesh_destroy(&a), gvc_mesh_destroy(&b), gvc_mesh_destroy(&c), gvc_mesh_destroy(&d);
    }
    player_close(&exact), player_close(&alone), player_close(&preview), player_close(&h264);
    bytes_free(&lossy), bytes_free(&plain), bytes_free(&both);
    capture_free(&frames);
}

static void there_may_be_no_preview(void **state) {
    (void)state;
    capture frames = {.mesh = {mesh_ellipsoid(0.5, 0.6, 2, 10, 8, 0)}, .count = 1};
    gvc_encode_options options = lossless_options(17, 1);
    bytes file = encode(&frames, &options, NULL);
    gvc_read_options reading;
    gvc_read_options_init(&reading);
    reading.preview = true;
    gvc_reader *reader;
    gvc_decoder *decoder;
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, &reading, &reader, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_create(reader, &decoder, NULL), GVC_ERROR_ARGUMENT);
    assert_null(decoder);
    gvc_reader_close(&reader);

    gvc_source source = capture_source(&frames);
    gvc_sink sink = bytes_sink(&file);
    options.lossless = false;
    options.with_preview = true;
    assert_int_equal(gvc_encode(&source, &sink, &options, NULL, NULL), GVC_ERROR_ARGUMENT);
    bytes_free(&file);
    capture_free(&frames);
}

static void the_error_asked_for_chooses_the_size(void **state) {
    (void)state;
    capture frames = {.mesh = {mesh_ellipsoid(0.5, 0.6, 2, 10, 8, 0)}, .count = 1};
    gvc_source source = capture_source(&frames);
    gvc_encode_options options = lossless_options(0, 1);
    options.best_effort = false;
    gvc_encode_report loose, tight;
    options.max_rms = 4e-2;
    bytes a = encode(&frames, &options, &loose);
    options.max_rms = loose.worst_rms * 0.6;
    bytes b = encode(&frames, &options, &tight);
    assert_true(loose.worst_rms <= 4e-2 && tight.worst_rms <= options.max_rms);
    assert_true(loose.image_size < tight.image_size);
    assert_true(a.size < b.size);
    assert_true(tight.mean_crf == 0);
    options.image_size = 17;
    gvc_sink sink = bytes_sink(&a);
    assert_int_equal(gvc_encode(&source, &sink, &options, NULL, NULL), GVC_ERROR_QUALITY);
    bytes_free(&a), bytes_free(&b);
    capture_free(&frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(codes_come_back_exactly),
        cmocka_unit_test(a_preview_is_the_lossy_file_of_the_same_images),
        cmocka_unit_test(there_may_be_no_preview),
        cmocka_unit_test(the_error_asked_for_chooses_the_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
