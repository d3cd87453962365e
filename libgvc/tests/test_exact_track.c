/* SPDX-License-Identifier: MIT */
/** @file test_exact_track.c  Files with an exact track, made sample by sample: several charts,
 * codes at both ends of the range, and all that may be wrong. */
#include "file_maker.h"

#include "base/digest.h"
#include "codec/exr.h"
#include "codec/residual.h"
#include "container/iso.h"
#include "container/shape_record.h"
#include "file.h"
#include "image_maker.h"
#include "shape_maker.h"

#define CHARTS 2
#define FRAMES 4

/** The content of each sample, to be spoilt before the file is made. */
typedef struct parts {
    gvc_shape shape;
    uint16_t *codes[FRAMES][CHARTS];
    gvc_buffer exact[FRAMES], record[FRAMES];
    gvc_config config;
} parts;

static void add_image(parts *p, size_t frame, size_t chart) {
    const gvc_chart_shape *of = &p->shape.chart[chart];
    gvc_exr_facts facts = {.origin = {of->origin[0], of->origin[1], of->origin[2]},
                           .step = of->step};
    gvc_buffer image = {0};
    if (frame == 0) {
        assert_int_equal(gvc_exr_encode(of->sides.size, p->codes[0][chart], &facts, &image, NULL),
                         GVC_OK);
    } else {
        assert_int_equal(gvc_residual_encode(of->sides.size, p->codes[frame][chart],
                                             p->codes[frame - 1][chart], GVC_PREDICTOR_SQUARES,
                                             &image, NULL),
                         GVC_OK);
    }
    if (p->shape.chart_count > 1) gvc_write_u32(&p->exact[frame], (uint32_t)image.size);
    gvc_write_bytes(&p->exact[frame], image.data, image.size);
    gvc_buffer_free(&image);
}

/** Frames of noise, of both ends of the range, and of surfaces, on one or two charts. */
static parts parts_make(size_t charts) {
    parts p = {.shape = shape_of_two(), .config = config_make(FRAMES)};
    gvc_shape one = p.shape;
    one.chart_count = charts;
    p.config.features = GVC_FEATURE_EXACT;
    for (size_t f = 0; f < FRAMES; f++) {
        static const image_kind kind[FRAMES] = {IMAGE_ENDS, IMAGE_SMOOTH, IMAGE_FLAT, IMAGE_NOISE};
        gvc_shape_frame facts = {.same = f > 0};
        assert_int_equal(gvc_shape_record_write(&one, &facts, &p.record[f], NULL), GVC_OK);
        for (size_t c = 0; c < CHARTS; c++) {
            p.codes[f][c] = image_make(p.shape.chart[c].sides.size, kind[(f + c) % FRAMES]);
        }
    }
    size_t all = p.shape.chart_count;
    p.shape.chart_count = charts;
    for (size_t f = 0; f < FRAMES; f++) {
        for (size_t c = 0; c < charts; c++) add_image(&p, f, c);
    }
    p.shape.chart_count = all;
    return p;
}

static void parts_free(parts *p) {
    for (size_t f = 0; f < FRAMES; f++) {
        for (size_t c = 0; c < CHARTS; c++) free(p->codes[f][c]);
        gvc_buffer_free(&p->exact[f]);
        gvc_buffer_free(&p->record[f]);
    }
    gvc_shape_free(&p->shape);
}

/** One fragment of the parts; with video, of bytes that are none. */
static gvc_buffer parts_write(const parts *p, bool video) {
    static const uint8_t picture[1] = {0};
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_writer *writer;
    gvc_sample exact[FRAMES], record[FRAMES], geometry[FRAMES];
    for (size_t f = 0; f < FRAMES; f++) {
        exact[f] = (gvc_sample){p->exact[f].data, p->exact[f].size, 0, f == 0};
        record[f] = (gvc_sample){p->record[f].data, p->record[f].size, 0, f == 0};
        geometry[f] = (gvc_sample){picture, 1, 0, f == 0};
    }
    gvc_fragment fragment = {0, FRAMES, video ? geometry : NULL, record,
                             p->config.features ? exact : NULL};
    const uint8_t *avc = video ? (const uint8_t *)MADE_AVC_CONFIG : NULL;
    assert_int_equal(
        gvc_writer_create(&sink, &p->config, avc, sizeof MADE_AVC_CONFIG - 1, &writer, NULL),
        GVC_OK);
    assert_int_equal(gvc_writer_fragment(writer, &fragment, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    gvc_writer_destroy(&writer);
    assert_false(file.failed);
    return file;
}

/** Result of opening the file and getting codes of a frame. */
static gvc_result codes_of(const gvc_buffer *file, uint64_t frame, size_t chart, gvc_error *error) {
    gvc_reader *reader;
    gvc_decoder *decoder = NULL;
    const uint16_t *plane;
    uint32_t size;
    gvc_error_init(error);
    gvc_result result = gvc_reader_open_memory(file->data, file->size, NULL, &reader, error);
    if (result == GVC_OK) result = gvc_decoder_create(reader, &decoder, error);
    if (result == GVC_OK) result = gvc_decoder_codes(decoder, frame, chart, &plane, &size, error);
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    return result;
}

/* --------------------------------------------------------------------------------------- right */

static void check_all_codes(size_t charts) {
    static const uint64_t order[] = {0, 1, 2, 3, 1, 3, 0, 2};
    parts p = parts_make(charts);
    gvc_buffer file = parts_write(&p, false);
    gvc_reader *reader;
    gvc_decoder *decoder;
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, NULL, &reader, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_create(reader, &decoder, NULL), GVC_OK);
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        for (size_t c = 0; c < charts; c++) {
            const uint16_t *plane;
            uint32_t size;
            assert_int_equal(gvc_decoder_codes(decoder, order[i], c, &plane, &size, NULL), GVC_OK);
            assert_int_equal(size, p.shape.chart[c].sides.size);
            assert_memory_equal(plane, p.codes[order[i]][c], image_samples(size) * sizeof *plane);
        }
    }
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    gvc_buffer_free(&file);
    parts_free(&p);
}

static void any_codes_come_back(void **state) {
    (void)state;
    check_all_codes(1);
    check_all_codes(2);
}

/* The digest is compared: these records state another one. */
static void a_frame_must_match_its_digest(void **state) {
    (void)state;
    parts p = parts_make(1);
    gvc_buffer file = parts_write(&p, false);
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_mesh *mesh;
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, NULL, &reader, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_create(reader, &decoder, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_frame(decoder, 1, &mesh, NULL), GVC_ERROR_CORRUPT);
    assert_null(mesh);
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    gvc_buffer_free(&file);
    parts_free(&p);
}

static void a_decoder_keeps_to_its_memory(void **state) {
    (void)state;
    parts p = parts_make(1);
    gvc_buffer file = parts_write(&p, false);
    gvc_read_options options = options_make(false);
    gvc_reader *reader;
    gvc_decoder *decoder;
    options.max_memory = 100000;
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, &options, &reader, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_create(reader, &decoder, NULL), GVC_ERROR_LIMIT);
    gvc_reader_close(&reader);
    gvc_buffer_free(&file);
    parts_free(&p);
}

/* --------------------------------------------------------------------------------------- wrong */

/** The sample of a frame is refused, and those before it are not. */
static void expect_refusal(const parts *p, size_t frame, gvc_result expected) {
    gvc_buffer file = parts_write(p, false);
    gvc_error error;
    for (size_t f = 0; f < FRAMES; f++) {
        gvc_result result = codes_of(&file, f, 0, &error);
        assert_int_equal(result, f < frame ? GVC_OK : expected);
        if (f < frame) continue;
        assert_int_equal(error.frame, (int64_t)f);
        assert_true(error.offset != GVC_NO_OFFSET);
    }
    gvc_buffer_free(&file);
}

static void samples_must_be_exact_images(void **state) {
    (void)state;
    for (size_t charts = 1; charts <= CHARTS; charts++) {
        parts p = parts_make(charts);
        for (size_t f = 0; f < FRAMES; f++) {
            gvc_buffer whole = p.exact[f];
            p.exact[f].size = whole.size - 1; /* ends early */
            expect_refusal(&p, f, GVC_ERROR_CORRUPT);
            p.exact[f] = whole;
            gvc_write_u8(&p.exact[f], 0); /* goes on; bytes behind an OpenEXR file may be its own */
            if (f > 0 || charts > 1) expect_refusal(&p, f, GVC_ERROR_CORRUPT);
            p.exact[f].size--;
        }
        parts_free(&p);
    }
}

static void the_first_image_must_be_a_keyframe(void **state) {
    (void)state;
    parts p = parts_make(1);
    gvc_buffer key = p.exact[0], alone = {0};
    uint32_t size = p.shape.chart[0].sides.size;
    assert_int_equal(
        gvc_residual_encode(size, p.codes[0][0], NULL, GVC_PREDICTOR_GRADIENT, &alone, NULL),
        GVC_OK);
    p.exact[0] = alone;
    expect_refusal(&p, 0, GVC_ERROR_CORRUPT);
    p.exact[0] = key;
    gvc_buffer other = p.exact[2]; /* a keyframe in between is no harm, as no reference is */
    p.exact[2] = key;
    gvc_buffer file = parts_write(&p, false);
    gvc_error error;
    assert_int_equal(codes_of(&file, 2, 0, &error), GVC_OK);
    gvc_buffer_free(&file);
    p.exact[2] = other;
    gvc_buffer_free(&alone);
    parts_free(&p);
}

static void a_size_before_an_image_must_fit(void **state) {
    (void)state;
    parts p = parts_make(2);
    gvc_patch_u32(&p.exact[1], 0, UINT32_MAX);
    expect_refusal(&p, 1, GVC_ERROR_CORRUPT);
    gvc_patch_u32(&p.exact[1], 0, 0);
    expect_refusal(&p, 1, GVC_ERROR_CORRUPT);
    parts_free(&p);
}

/* A bit in gvcC and the tracks that are there, and a digest for each way to decode. */
static void records_and_features_tell_of_the_tracks(void **state) {
    (void)state;
    gvc_error error;
    parts p = parts_make(1);
    gvc_buffer file = parts_write(&p, true);
    assert_int_equal(codes_of(&file, 0, 0, &error), GVC_ERROR_CORRUPT); /* no preview's digest */
    gvc_buffer_free(&file);
    for (size_t f = 0; f < FRAMES; f++) {
        gvc_shape_frame facts = {.same = f > 0, .has_preview = true};
        gvc_shape one = p.shape;
        one.chart_count = 1;
        gvc_buffer_clear(&p.record[f]);
        assert_int_equal(gvc_shape_record_write(&one, &facts, &p.record[f], NULL), GVC_OK);
    }
    file = parts_write(&p, true);
    assert_int_equal(codes_of(&file, 3, 0, &error), GVC_OK);
    gvc_buffer_free(&file);
    file = parts_write(&p, false);
    assert_int_equal(codes_of(&file, 0, 0, &error), GVC_ERROR_CORRUPT); /* one too many */
    gvc_buffer_free(&file);
    parts_free(&p);
}

/** Place of a text's first byte. */
static size_t place_of(const gvc_buffer *file, const char *text, size_t from) {
    size_t size = strlen(text);
    for (size_t at = from; at + size <= file->size; at++) {
        if (memcmp(file->data + at, text, size) == 0) return at;
    }
    fail_msg("there is no %s", text);
    return 0;
}

/** Makes the checksum of the head right again. */
static void seal_head(gvc_buffer *file) {
    size_t moov = place_of(file, "moov", 0) - 4;
    gvc_cursor size = gvc_cursor_make(file->data + moov, 4);
    size_t end = moov + gvc_read_u32(&size) - 4;
    gvc_patch_u32(file, end, gvc_crc32(0, file->data, end));
}

static gvc_result open_changed(gvc_buffer *file, size_t at, uint8_t change, gvc_error *error) {
    file->data[at] ^= change;
    seal_head(file);
    gvc_result result = codes_of(file, 0, 0, error);
    file->data[at] ^= change;
    seal_head(file);
    return result;
}

static void what_tools_drop_is_missed(void **state) {
    (void)state;
    gvc_error error;
    parts p = parts_make(1);
    gvc_buffer file = parts_write(&p, false);
    size_t config = place_of(&file, "gvcC", 0), uri = place_of(&file, "urn:gvc:exact:0", 0);
    size_t shape = place_of(&file, "urn:gvc:shape:0", 0);
    /* the features say that there is no such track */
    assert_int_equal(open_changed(&file, config + 4 + 7, 1, &error), GVC_ERROR_CORRUPT);
    /* a bit that is not known */
    assert_int_equal(open_changed(&file, config + 4 + 7, 2, &error), GVC_ERROR_UNSUPPORTED);
    /* the exact track is another's, so nothing is left; one of a version to come */
    assert_int_equal(open_changed(&file, uri + 4, 1, &error), GVC_ERROR_CORRUPT);
    assert_int_equal(open_changed(&file, uri + 14, 1, &error), GVC_ERROR_UNSUPPORTED);
    /* the exact track is here, but no shapes */
    assert_int_equal(open_changed(&file, shape + 4, 1, &error), GVC_ERROR_CORRUPT);
    assert_non_null(strstr(error.message, "shape track is missing"));
    /* the configuration is gone */
    assert_int_equal(open_changed(&file, config, 1, &error), GVC_ERROR_CORRUPT);
    assert_int_equal(codes_of(&file, 0, 0, &error), GVC_OK);
    gvc_buffer_free(&file);

    file = parts_write(&p, true);
    uri = place_of(&file, "urn:gvc:exact:0", 0);
    assert_int_equal(open_changed(&file, uri + 4, 1, &error), GVC_ERROR_CORRUPT);
    if (!strstr(error.message, "exact track is missing")) fail_msg("%s", error.message);
    gvc_buffer_free(&file);
    parts_free(&p);
}

/* Track number 0 in a fragment is no track, least of all one that is missing. */
static void a_fragment_names_tracks_that_are_there(void **state) {
    (void)state;
    parts p = parts_make(1);
    gvc_buffer file = parts_write(&p, false);
    gvc_error error;
    size_t moof = place_of(&file, "moof", 0) - 4, traf = place_of(&file, "tfhd", moof);
    size_t end = place_of(&file, "mdat", moof) - 4 - 4;
    for (uint32_t number = 0; number <= 3; number++) {
        gvc_patch_u32(&file, traf + 8, number);
        gvc_patch_u32(&file, end, gvc_crc32(0, file.data + moof, end - moof));
        gvc_result expected = number == 2 ? GVC_OK : GVC_ERROR_CORRUPT; /* 2 is what it was */
        assert_int_equal(codes_of(&file, 0, 0, &error), expected);
    }
    gvc_buffer_free(&file);
    parts_free(&p);
}

static void the_writer_refuses_what_cannot_be(void **state) {
    (void)state;
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_writer *writer;
    parts p = parts_make(1);
    gvc_config config = config_make(FRAMES);
    assert_int_equal(gvc_writer_create(&sink, &config, NULL, 0, &writer, NULL), GVC_ERROR_ARGUMENT);
    assert_null(writer);
    config.features = GVC_FEATURE_EXACT;
    assert_int_equal(gvc_writer_create(&sink, &config, NULL, 0, &writer, NULL), GVC_OK);
    gvc_sample exact = {p.exact[0].data, p.exact[0].size, 0, true};
    gvc_sample record = {p.record[0].data, p.record[0].size, 0, true};
    gvc_fragment none = {0, 1, NULL, &record, NULL}, both = {0, 1, &exact, &record, &exact};
    gvc_fragment right = {0, 1, NULL, &record, &exact};
    assert_int_equal(gvc_writer_fragment(writer, &none, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(gvc_writer_fragment(writer, &both, NULL), GVC_ERROR_ARGUMENT);
    exact.sync = false;
    assert_int_equal(gvc_writer_fragment(writer, &right, NULL), GVC_ERROR_ARGUMENT);
    exact.sync = true;
    assert_int_equal(gvc_writer_fragment(writer, &right, NULL), GVC_OK);
    gvc_writer_destroy(&writer);
    gvc_buffer_free(&file);
    parts_free(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_codes_come_back),
        cmocka_unit_test(a_frame_must_match_its_digest),
        cmocka_unit_test(a_decoder_keeps_to_its_memory),
        cmocka_unit_test(samples_must_be_exact_images),
        cmocka_unit_test(the_first_image_must_be_a_keyframe),
        cmocka_unit_test(a_size_before_an_image_must_fit),
        cmocka_unit_test(records_and_features_tell_of_the_tracks),
        cmocka_unit_test(what_tools_drop_is_missed),
        cmocka_unit_test(a_fragment_names_tracks_that_are_there),
        cmocka_unit_test(the_writer_refuses_what_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
