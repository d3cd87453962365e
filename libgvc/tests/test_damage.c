/* SPDX-License-Identifier: MIT */
/** @file test_damage.c  Damaged and cut-off files: every defect is told, nothing wrong is handed
 * out, and what is whole can be had. */
#include "capture_maker.h"

#define FRAMES 6
#define GOP 2

typedef struct fixture {
    capture frames;
    bytes file;
    gvc_mesh *decoded[FRAMES];
    size_t group_end[FRAMES / GOP]; /* offset just after each group's fragment */
} fixture;

static uint32_t read_u32(const uint8_t *at) {
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

static bool is_box(const uint8_t *at, const char *type) { return memcmp(at + 4, type, 4) == 0; }

/* Walks over the top-level boxes; mdat ends a group. */
static void find_groups(fixture *f) {
    size_t at = 0, groups = 0;
    while (at + 8 <= f->file.size) {
        const uint8_t *box = f->file.data + at;
        at += read_u32(box);
        if (is_box(box, "mdat") && groups < FRAMES / GOP) f->group_end[groups++] = at;
    }
    assert_int_equal(at, f->file.size);
    assert_int_equal(groups, FRAMES / GOP);
}

static int make_fixture(void **state) {
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    capture_add_figure(&f->frames, 0, 1, 0, FRAMES);
    gvc_encode_options options = quick_options(17, 30, GOP);
    f->file = encode(&f->frames, &options, NULL);
    player made = player_open(&f->file, NULL);
    for (size_t i = 0; i < FRAMES; i++) f->decoded[i] = player_frame(&made, i);
    player_close(&made);
    find_groups(f);
    *state = f;
    return 0;
}

static int free_fixture(void **state) {
    fixture *f = *state;
    for (size_t i = 0; i < FRAMES; i++) gvc_mesh_destroy(&f->decoded[i]);
    bytes_free(&f->file);
    capture_free(&f->frames);
    free(f);
    return 0;
}

/* A copy of exactly the bytes given, so that reading past them is seen by AddressSanitizer. */
static bytes exact_copy(const uint8_t *data, size_t size) {
    bytes copy = {.data = malloc(size ? size : 1), .size = size};
    assert_non_null(copy.data);
    memcpy(copy.data, data, size);
    return copy;
}

/* What became of every frame of a damaged file. */
typedef struct outcome {
    gvc_result opened;
    gvc_error error;          /* of opening */
    gvc_result frame[FRAMES]; /* if opened */
    gvc_info info;
} outcome;

/* Whatever is handed out must be what was encoded. */
static outcome play(const fixture *f, const bytes *file, bool keep_going) {
    outcome result = {.opened = GVC_OK};
    gvc_read_options options;
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_read_options_init(&options);
    options.keep_going = keep_going;
    gvc_error_init(&result.error);
    result.opened =
        gvc_reader_open_memory(file->data, file->size, &options, &reader, &result.error);
    if (result.opened == GVC_OK) {
        gvc_reader_info(reader, &result.info);
        result.opened = gvc_decoder_create(reader, &decoder, &result.error);
        if (result.opened != GVC_OK) gvc_reader_close(&reader);
    }
    if (result.opened != GVC_OK) {
        assert_null(reader);
        assert_int_equal(result.error.code, result.opened);
        assert_true(result.error.message[0] != '\0');
        return result;
    }
    for (uint64_t i = 0; i < FRAMES; i++) {
        gvc_mesh *mesh;
        gvc_error error;
        gvc_error_init(&error);
        result.frame[i] = gvc_decoder_frame(decoder, i, &mesh, &error);
        if (result.frame[i] == GVC_OK) {
            assert_same_mesh(mesh, f->decoded[i]);
            gvc_mesh_destroy(&mesh);
        } else {
            assert_null(mesh);
            assert_int_equal(error.code, result.frame[i]);
            assert_int_equal(error.frame, (int64_t)i);
            assert_true(error.message[0] != '\0');
        }
    }
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    return result;
}

static bool all_good(const outcome *result) {
    if (result->opened != GVC_OK) return false;
    for (size_t i = 0; i < FRAMES; i++)
        if (result->frame[i] != GVC_OK) return false;
    return true;
}

static bool is_damage(gvc_result result) {
    return result == GVC_ERROR_CORRUPT || result == GVC_ERROR_TRUNCATED;
}

/* ----------------------------------------------------------------------------------- truncation */

static void every_prefix_is_told(void **state) {
    const fixture *f = *state;
    for (size_t size = 0; size < f->file.size; size++) {
        bytes prefix = exact_copy(f->file.data, size);
        outcome result = play(f, &prefix, false);
        if (!is_damage(result.opened)) {
            fail_msg("%zu of %zu bytes: result %d", size, f->file.size, result.opened);
        }
        bytes_free(&prefix);
    }
}

/* Of a file cut off anywhere, the groups before the cut come out, and some frames of the last. */
static void every_prefix_gives_its_whole_groups(void **state) {
    const fixture *f = *state;
    size_t step = 1 + f->file.size / 400;
    for (size_t size = 0; size < f->file.size; size += step) {
        bytes prefix = exact_copy(f->file.data, size);
        outcome result = play(f, &prefix, true);
        size_t whole = 0;
        while (whole < FRAMES / GOP && f->group_end[whole] <= size) whole++;
        if (result.opened == GVC_OK) {
            assert_true(result.info.frame_count >= GOP * whole);
            assert_true(result.info.frame_count < GOP * (whole + 1));
            assert_int_equal(result.info.declared_count, FRAMES);
            assert_true(result.info.damage_count > 0);
            for (size_t i = 0; i < FRAMES; i++) {
                if (i < GOP * whole) assert_int_equal(result.frame[i], GVC_OK);
                if (i > GOP * whole) assert_true(is_damage(result.frame[i]));
            }
        } else {
            assert_true(is_damage(result.opened));
            assert_int_equal(whole, 0); /* not even the head is there */
        }
        bytes_free(&prefix);
    }
}

/* -------------------------------------------------------------------------------------- damage */

#define FLIPS 400
#define FLIP_SEED 2024u

static void every_flipped_byte_is_told(void **state) {
    const fixture *f = *state;
    bytes copy = exact_copy(f->file.data, f->file.size);
    uint64_t random = FLIP_SEED;
    print_message("seed %u\n", FLIP_SEED);
    for (int i = 0; i < FLIPS; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        size_t place = (size_t)((random >> 16) % f->file.size);
        uint8_t change = (uint8_t)(random >> 56 ? random >> 56 : 1);
        copy.data[place] ^= change;
        outcome strict = play(f, &copy, false);
        if (all_good(&strict)) fail_msg("byte %zu changed by %02x: nobody saw it", place, change);
        outcome lenient = play(f, &copy, true); /* hands out nothing wrong */
        if (strict.opened == GVC_OK) assert_int_equal(lenient.opened, GVC_OK);
        copy.data[place] ^= change;
    }
    bytes_free(&copy);
}

/* The last byte of a group's mdat is the end of its last picture. */
static void a_damaged_picture_costs_its_group_only(void **state) {
    const fixture *f = *state;
    for (size_t group = 0; group < FRAMES / GOP; group++) {
        bytes copy = exact_copy(f->file.data, f->file.size);
        copy.data[f->group_end[group] - 1] ^= 0x40;
        outcome result = play(f, &copy, false);
        assert_int_equal(result.opened, GVC_OK);
        bool lost = false;
        for (size_t i = 0; i < FRAMES; i++) {
            if (i / GOP != group) assert_int_equal(result.frame[i], GVC_OK);
            lost |= result.frame[i] == GVC_ERROR_CORRUPT;
        }
        assert_true(lost);
        bytes_free(&copy);
    }
}

/* The decoder is not confused by what it could not decode: the same frames come out after. */
static void frames_decode_after_a_failure(void **state) {
    const fixture *f = *state;
    static const size_t order[] = {3, 0, 3, 2, 5, 3, 1, 4, 0};
    bytes copy = exact_copy(f->file.data, f->file.size);
    copy.data[f->group_end[1] - 1] ^= 1; /* frames 2 and 3 */
    player made = player_open(&copy, NULL);
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        gvc_mesh *mesh;
        gvc_result result = gvc_decoder_frame(made.decoder, order[i], &mesh, NULL);
        if (order[i] / GOP != 1) assert_int_equal(result, GVC_OK);
        if (result == GVC_OK) assert_same_mesh(mesh, f->decoded[order[i]]);
        gvc_mesh_destroy(&mesh);
    }
    player_close(&made);
    bytes_free(&copy);
}

/* A destroyed moof in the middle: refused as a rule, passed over with keep_going. */
static void a_damaged_fragment_is_passed_over(void **state) {
    const fixture *f = *state;
    bytes copy = exact_copy(f->file.data, f->file.size);
    memset(copy.data + f->group_end[0] + 8, 0xaa, 24);
    outcome strict = play(f, &copy, false), lenient = play(f, &copy, true);
    assert_int_equal(strict.opened, GVC_ERROR_CORRUPT);
    assert_true(strict.error.offset >= f->group_end[0]);
    assert_true(strict.error.offset <= f->group_end[0] + 32);
    assert_int_equal(lenient.opened, GVC_OK);
    assert_int_equal(lenient.info.damage_count, 1);
    assert_int_equal(lenient.info.frame_count, FRAMES - GOP);
    for (size_t i = 0; i < FRAMES; i++) {
        assert_int_equal(lenient.frame[i], i / GOP == 1 ? GVC_ERROR_CORRUPT : GVC_OK);
    }
    bytes_free(&copy);
}

static void other_files_are_not_gvc(void **state) {
    (void)state;
    static const char *const text[] = {"", "OFF\n4 4 0\n", "not a video at all, but text",
                                       "\0\0\0\030ftypisom\0\0\0\0isomavc1"};
    static const size_t size[] = {0, 10, 28, 24};
    for (size_t i = 0; i < 4; i++) {
        for (int keep_going = 0; keep_going < 2; keep_going++) {
            gvc_read_options options;
            gvc_reader *reader = (gvc_reader *)(uintptr_t)1;
            gvc_read_options_init(&options);
            options.keep_going = keep_going;
            gvc_result result = gvc_reader_open_memory(text[i], size[i], &options, &reader, NULL);
            assert_true(is_damage(result) || result == GVC_ERROR_UNSUPPORTED);
            assert_null(reader);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_prefix_is_told),
        cmocka_unit_test(every_prefix_gives_its_whole_groups),
        cmocka_unit_test(every_flipped_byte_is_told),
        cmocka_unit_test(a_damaged_picture_costs_its_group_only),
        cmocka_unit_test(frames_decode_after_a_failure),
        cmocka_unit_test(a_damaged_fragment_is_passed_over),
        cmocka_unit_test(other_files_are_not_gvc),
    };
    return cmocka_run_group_tests(tests, make_fixture, free_fixture);
}
