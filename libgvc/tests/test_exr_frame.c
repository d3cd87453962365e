/* SPDX-License-Identifier: MIT */
/** @file test_exr_frame.c  Frames that leave a file as OpenEXR files and come back: the same bytes,
 *  changed images told, damaged files refused. */
#include "capture_maker.h"

#include "codec/exr.h"
#include "encoder_exr.h"
#include "exr_frame.h"

#define FRAMES 3

typedef struct fixture {
    bytes file;
    gvc_buffer exr[FRAMES];
    size_t warnings;
} fixture;

static int make_fixture(void **state) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    capture frames = {.mesh = {mesh_ellipsoid(0.5, 0.6, 2, 10, 8, 0),
                               mesh_ellipsoid(0.5, 0.65, 2, 10, 8, 0.1),
                               mesh_ellipsoid(0.5, 0.7, 2, 10, 8, 0.2)},
                      .count = FRAMES};
    gvc_encode_options options = quick_options(20, NAN, 2);
    options.lossless = options.best_effort = true;
    options.frame_rate_num = 30000;
    options.frame_rate_den = 1001;
    strcpy(options.unit, "m");
    f->file = encode(&frames, &options, NULL);
    capture_free(&frames);
    player made = player_open(&f->file, NULL);
    for (size_t i = 0; i < FRAMES; i++) {
        gvc_exr_frame frame;
        assert_int_equal(gvc_exr_frame_take(made.reader, made.decoder, i, &frame, NULL), GVC_OK);
        assert_int_equal(gvc_exr_frame_write(&frame, &f->exr[i], NULL), GVC_OK);
        assert_int_equal(frame.group, i / 2 * 2);
        gvc_exr_frame_free(&frame);
    }
    player_close(&made);
    *state = f;
    return 0;
}

static int free_fixture(void **state) {
    fixture *f = *state;
    for (size_t i = 0; i < FRAMES; i++) gvc_buffer_free(&f->exr[i]);
    bytes_free(&f->file);
    free(f);
    return 0;
}

static gvc_result read_exr(void *user, uint64_t frame, gvc_buffer *out, gvc_error *error) {
    const gvc_buffer *exr = &((const fixture *)user)->exr[frame];
    (void)error;
    gvc_write_bytes(out, exr->data, exr->size);
    return GVC_OK;
}

static void count_warning(void *user, int64_t frame, const char *message) {
    fixture *f = user;
    assert_int_equal(frame, 1);
    assert_non_null(strstr(message, "changed"));
    f->warnings++;
}

static gvc_result encode_exr(fixture *f, bytes *file, gvc_error *error) {
    gvc_exr_source source = {.user = f, .frame_count = FRAMES, .read = read_exr};
    gvc_sink sink = bytes_sink(file);
    gvc_encode_options options;
    gvc_encode_options_init(&options);
    options.threads = 2;
    options.warn = count_warning;
    options.user = f;
    gvc_error_init(error);
    return gvc_encode_exr(&source, &sink, &options, NULL, error);
}

static void the_same_bytes_come_back(void **state) {
    fixture *f = *state;
    bytes back = {0};
    gvc_error error;
    if (encode_exr(f, &back, &error) != GVC_OK) fail_msg("%s", error.message);
    assert_same_bytes(&back, &f->file);
    assert_int_equal(f->warnings, 0);
    bytes_free(&back);
}

static void a_changed_image_is_coded_and_told(void **state) {
    fixture *f = *state;
    gvc_exr_frame frame;
    gvc_buffer kept = f->exr[1];
    bytes file = {0};
    gvc_error error;
    assert_int_equal(gvc_exr_frame_read(kept.data, kept.size, &frame, NULL), GVC_OK);
    frame.codes[21] = frame.codes[21] == UINT16_MAX ? 0 : UINT16_MAX; /* inside of the border */
    f->exr[1] = (gvc_buffer){0};
    assert_int_equal(gvc_exr_frame_write(&frame, &f->exr[1], NULL), GVC_OK);
    assert_int_equal(encode_exr(f, &file, &error), GVC_OK);
    assert_int_equal(f->warnings, 1);
    f->warnings = 0;
    player made = player_open(&file, NULL);
    gvc_mesh *mesh = player_frame(&made, 1); /* the digest is that of the image as it is now */
    gvc_mesh_destroy(&mesh);
    gvc_exr_frame again;
    assert_int_equal(gvc_exr_frame_take(made.reader, made.decoder, 1, &again, NULL), GVC_OK);
    assert_memory_equal(again.codes, frame.codes, 3 * 20 * 20 * sizeof *frame.codes);
    gvc_exr_frame_free(&again);
    gvc_exr_frame_free(&frame);
    player_close(&made);
    gvc_buffer_free(&f->exr[1]);
    f->exr[1] = kept;
    bytes_free(&file);
}

/* Frames of two captures are not put into one file. */
static void configurations_must_agree(void **state) {
    fixture *f = *state;
    gvc_exr_frame frame;
    gvc_buffer kept = f->exr[2];
    bytes file = {0};
    gvc_error error;
    assert_int_equal(gvc_exr_frame_read(kept.data, kept.size, &frame, NULL), GVC_OK);
    frame.config.frame_rate_num = 25;
    f->exr[2] = (gvc_buffer){0};
    assert_int_equal(gvc_exr_frame_write(&frame, &f->exr[2], NULL), GVC_OK);
    assert_int_equal(encode_exr(f, &file, &error), GVC_ERROR_MESH);
    assert_int_equal(error.frame, 2);
    gvc_exr_frame_free(&frame);
    gvc_buffer_free(&f->exr[2]);
    f->exr[2] = kept;
    bytes_free(&file);
}

/* Without its attributes, or with others, a file is refused by name. */
static void attributes_must_be_there(void **state) {
    const fixture *f = *state;
    static const char *const name[] = {"gvcConfig", "gvcRecord", "gvcFrame", "gvcGroup",
                                       "gvcOrigin"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        gvc_buffer copy = {0};
        gvc_exr_frame frame;
        gvc_error error;
        gvc_error_init(&error);
        gvc_write_bytes(&copy, f->exr[0].data, f->exr[0].size);
        size_t at = 0, size = strlen(name[i]);
        while (memcmp(copy.data + at, name[i], size) != 0) at++;
        /* past the name: the type and its NUL, the length, the value's first byte */
        size_t value = at + size + 1 + strlen((const char *)copy.data + at + size + 1) + 1 + 4;
        copy.data[value] = 'x';
        assert_int_equal(gvc_exr_frame_read(copy.data, copy.size, &frame, &error),
                         GVC_ERROR_CORRUPT);
        assert_null(frame.codes);
        assert_non_null(strstr(error.message, name[i]));
        copy.data[value] = f->exr[0].data[value];
        copy.data[at] = 'y';
        assert_int_equal(gvc_exr_frame_read(copy.data, copy.size, &frame, &error),
                         GVC_ERROR_CORRUPT);
        gvc_buffer_free(&copy);
    }
}

/* Whatever is read is whole: what it says can be written and read again. */
static void damage_does_no_harm(void **state) {
    const fixture *f = *state;
    uint64_t random = 7;
    for (int i = 0; i < 1500; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        gvc_buffer copy = {0}, again = {0};
        gvc_exr_frame frame, back;
        gvc_write_bytes(&copy, f->exr[0].data, f->exr[0].size);
        copy.data[(random >> 16) % copy.size] ^= (uint8_t)(random >> 56 | 1);
        if (i % 4 == 0) copy.size = (size_t)(random >> 20) % copy.size;
        if (gvc_exr_frame_read(copy.data, copy.size, &frame, NULL) == GVC_OK) {
            uint8_t digest[8];
            assert_int_equal(gvc_exr_frame_digest(&frame, digest, NULL), GVC_OK);
            assert_int_equal(gvc_exr_frame_write(&frame, &again, NULL), GVC_OK);
            assert_int_equal(gvc_exr_frame_read(again.data, again.size, &back, NULL), GVC_OK);
            assert_true(gvc_shape_equal(&frame.shape, &back.shape));
            gvc_exr_frame_free(&back);
            gvc_exr_frame_free(&frame);
        }
        gvc_buffer_free(&again);
        gvc_buffer_free(&copy);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_bytes_come_back),
        cmocka_unit_test(a_changed_image_is_coded_and_told),
        cmocka_unit_test(configurations_must_agree),
        cmocka_unit_test(attributes_must_be_there),
        cmocka_unit_test(damage_does_no_harm),
    };
    return cmocka_run_group_tests(tests, make_fixture, free_fixture);
}
