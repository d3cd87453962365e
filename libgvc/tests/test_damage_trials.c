/* SPDX-License-Identifier: MIT */
/**
 * @file test_damage_trials.c
 * Bytes changed and files cut off at random places: every one is told, with the right fragment and
 * frame; what does not depend on it comes out as before; and the repaired file is good.
 *
 *   test_damage_trials                          small files of its own, few trials
 *   test_damage_trials FILE CHANGES CUTS SEED   any .gvc file
 */
#include "capture_maker.h"

#include "base/bytes.h"
#include "file.h"
#include "memory_file.h"

#include <time.h>

enum { FRAMES = 6, GOP = 3, CHANGES = 12, CUTS = 4 };

/* The good file, and what its parts are. */
typedef struct original {
    gvc_buffer file;
    gvc_reader *reader;
    size_t frames;
    gvc_mesh **mesh;
} original;

static original open_original(gvc_buffer file) {
    original o = {.file = file};
    gvc_info info;
    gvc_decoder *decoder;
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, NULL, &o.reader, NULL), GVC_OK);
    gvc_reader_info(o.reader, &info);
    o.frames = (size_t)info.frame_count;
    o.mesh = calloc(o.frames, sizeof *o.mesh);
    assert_non_null(o.mesh);
    assert_int_equal(gvc_decoder_create(o.reader, &decoder, NULL), GVC_OK);
    for (size_t i = 0; i < o.frames; i++) {
        assert_int_equal(gvc_decoder_frame(decoder, i, &o.mesh[i], NULL), GVC_OK);
    }
    gvc_decoder_destroy(&decoder);
    return o;
}

static void close_original(original *o) {
    for (size_t i = 0; i < o->frames; i++) gvc_mesh_destroy(&o->mesh[i]);
    free(o->mesh);
    gvc_reader_close(&o->reader);
    gvc_buffer_free(&o->file);
}

/* What the damage is, as far as the good file tells. */
typedef struct expectation {
    gvc_part part;
    uint64_t fragment, first_frame,
        frame_count;     /* of a defect that must be told; fragment 0: none */
    uint64_t begin, end; /* bytes that are damaged */
    bool cut;            /* nothing is left behind the damage */
    bool restored;       /* the repaired file must be the original */
} expectation;

/* What must come out of a damaged file. */
typedef struct found {
    const expectation *expected;
    size_t defects;
    bool told;
} found;

static bool on_defect(void *user, const gvc_defect *defect) {
    found *f = user;
    const expectation *e = f->expected;
    f->defects++;
    assert_true(defect->error.code != GVC_OK && defect->error.message[0]);
    bool here = defect->offset <= e->begin && defect->offset + defect->size >= e->end;
    bool fragment = defect->first_fragment == e->fragment;
    bool frames = e->frame_count == 0 ||
                  (defect->first_frame == e->first_frame && defect->frame_count == e->frame_count);
    f->told = f->told || (defect->part == e->part && here && fragment && frames);
    return true;
}

/* Decodes every frame; those of `must` have to come out, and none may come out wrong. */
static size_t decode_all(const original *o, const gvc_reader *reader, const bool *must,
                         gvc_result lost) {
    gvc_decoder *decoder;
    size_t good = 0;
    assert_int_equal(gvc_decoder_create(reader, &decoder, NULL), GVC_OK);
    for (size_t i = 0; i < o->frames; i++) {
        gvc_mesh *mesh;
        gvc_error error;
        gvc_error_init(&error);
        gvc_result result = gvc_decoder_frame(decoder, i, &mesh, &error);
        if (result == GVC_OK) {
            assert_same_mesh(mesh, o->mesh[i]);
            gvc_mesh_destroy(&mesh);
            good++;
        } else {
            if (must && must[i]) fail_msg("frame %zu is lost: %s", i, error.message);
            if (lost != GVC_OK) assert_int_equal(result, lost);
            assert_int_equal(error.frame, (int64_t)i);
        }
    }
    gvc_decoder_destroy(&decoder);
    return good;
}

static bool ignore(void *user, const gvc_defect *defect) {
    (void)defect;
    ++*(size_t *)user;
    return true;
}

static void try_repair(const original *o, const gvc_reader *damaged, const bool *must,
                       const expectation *expected) {
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_repair_report report;
    gvc_reader *reader;
    size_t defects = 0, good;
    gvc_result result = gvc_repair(damaged, &sink, NULL, NULL, &report, NULL);
    if (result != GVC_OK) { /* nothing to save */
        for (size_t i = 0; i < o->frames; i++) assert_false(must[i]);
        gvc_buffer_free(&file);
        return;
    }
    assert_int_equal(report.byte_count, file.size);
    assert_int_equal(report.frame_count + report.lost_count, o->frames);
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, NULL, &reader, NULL), GVC_OK);
    assert_int_equal(gvc_reader_check(reader, ignore, &defects, NULL), GVC_OK);
    assert_int_equal(defects, 0);
    good = decode_all(o, reader, NULL, GVC_ERROR_LOST);
    assert_int_equal(good, report.frame_count);
    /* Whole fragments are there, bit for bit. */
    for (size_t i = 0; i < o->reader->demux.fragment_count; i++) {
        const gvc_fragment_entry *f = &o->reader->demux.fragment[i];
        bool whole = (f->offset >= expected->end && !expected->cut) ||
                     f->offset + f->size <= expected->begin;
        bool copied = false;
        for (size_t k = 0; k < reader->demux.fragment_count; k++) {
            const gvc_fragment_entry *g = &reader->demux.fragment[k];
            copied = copied || (g->first_frame == f->first_frame && g->size == f->size &&
                                memcmp(file.data + g->offset, o->file.data + f->offset,
                                       (size_t)f->size) == 0);
        }
        if (whole && !copied) fail_msg("fragment %u was not copied", f->sequence);
    }
    if (expected->restored) {
        assert_int_equal(file.size, o->file.size);
        assert_memory_equal(file.data, o->file.data, file.size);
    }
    gvc_reader_close(&reader);
    gvc_buffer_free(&file);
}

static void try_damaged(const original *o, const uint8_t *data, size_t size, const bool *must,
                        const expectation *expected) {
    gvc_read_options options;
    gvc_reader *reader;
    found f = {.expected = expected};
    gvc_read_options_init(&options);
    options.keep_going = true;
    uint8_t *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, data, size);
    gvc_result result = gvc_reader_open_memory(exact, size, &options, &reader, NULL);
    if (result != GVC_OK) {
        for (size_t i = 0; i < o->frames; i++) assert_false(must[i]);
        assert_true(size < o->reader->demux.head_size);
    } else {
        assert_int_equal(gvc_reader_check(reader, on_defect, &f, NULL), GVC_OK);
        if (f.defects == 0) fail_msg("nobody saw it");
        if (!f.told) fail_msg("none of %zu defects is the right one", f.defects);
        decode_all(o, reader, must, GVC_OK);
        try_repair(o, reader, must, expected);
        gvc_reader_close(&reader);
    }
    free(exact);
}

/* -------------------------------------------------------------------------------------- changes */

static void lose(bool *must, uint64_t first, uint64_t count) {
    for (uint64_t i = first; i < first + count; i++) must[i] = false;
}

/* A picture costs those that follow it in decoding order, unless none refers to it; an exact image
 * all that follow. Where there are exact images, pictures are not what frames are decoded from. */
static void expect_sample(const original *o, const gvc_fragment_entry *f, unsigned kind, size_t nth,
                          size_t place, bool *must, expectation *e) {
    const gvc_demux *demux = &o->reader->demux;
    const gvc_sample_entry *s = &demux->sample[kind][f->first_sample[kind] + nth];
    e->part = kind == GVC_TRACK_SHAPE   ? GVC_PART_SHAPE
              : kind == GVC_TRACK_EXACT ? GVC_PART_EXACT
                                        : GVC_PART_GEOMETRY;
    e->first_frame = s->presentation;
    e->frame_count = 1;
    e->begin = s->offset;
    e->end = s->offset + s->size;
    if (kind == GVC_TRACK_GEOMETRY && demux->has_track[GVC_TRACK_EXACT]) return;
    bool needed_by_all = kind == GVC_TRACK_SHAPE ? s->presentation == f->first_frame : nth == 0;
    if (needed_by_all) {
        lose(must, f->first_frame, f->frame_count);
    } else if (kind == GVC_TRACK_SHAPE ||
               (kind == GVC_TRACK_GEOMETRY && !(o->file.data[s->offset + 4] & 0x60) &&
                place != s->offset + 4)) {
        lose(must, s->presentation, 1);
    } else {
        for (size_t i = nth; i < f->frame_count; i++) {
            lose(must, demux->sample[kind][f->first_sample[kind] + i].presentation, 1);
        }
    }
}

static expectation expect_change(const original *o, size_t place, bool *must) {
    const gvc_demux *demux = &o->reader->demux;
    expectation e = {.part = GVC_PART_HEAD, .begin = place, .end = place + 1, .restored = true};
    for (size_t i = 0; i < o->frames; i++) must[i] = true;
    if (place < demux->head_size) return e;
    e.part = GVC_PART_INDEX;
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *f = &demux->fragment[i];
        if (place < f->offset || place - f->offset >= f->size) continue;
        e.fragment = f->sequence;
        e.part = GVC_PART_FRAGMENT;
        if (place < f->offset + f->moof_size) {
            e.first_frame = f->first_frame;
            e.frame_count = f->frame_count;
            e.restored = false;
            lose(must, f->first_frame, f->frame_count);
            return e;
        }
        for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
            for (size_t k = 0; demux->has_track[kind] && k < f->frame_count; k++) {
                const gvc_sample_entry *s = &demux->sample[kind][f->first_sample[kind] + k];
                if (place < s->offset || place - s->offset >= s->size) continue;
                e.restored = false;
                expect_sample(o, f, kind, k, place, must, &e);
                return e;
            }
        }
        return e; /* the header of mdat */
    }
    return e;
}

static uint64_t next_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return *state >> 16;
}

static void try_changes(const original *o, size_t count, uint64_t seed) {
    bool *must = calloc(o->frames, sizeof *must);
    assert_non_null(must);
    size_t lost = 0, of[GVC_PART_FILE] = {0};
    for (size_t i = 0; i < count; i++) {
        size_t place = (size_t)(next_random(&seed) % o->file.size);
        uint8_t change = (uint8_t)(1 + next_random(&seed) % 255);
        expectation expected = expect_change(o, place, must);
        for (size_t f = 0; f < o->frames; f++) lost += !must[f];
        of[expected.part]++;
        print_message("%zu: byte %zu ^ %02x, fragment %llu\n", i, place, change,
                      (unsigned long long)expected.fragment);
        o->file.data[place] ^= change;
        uint8_t *copy = malloc(o->file.size);
        assert_non_null(copy);
        memcpy(copy, o->file.data, o->file.size);
        o->file.data[place] ^= change; /* the reader of the original borrows it */
        try_damaged(o, copy, o->file.size, must, &expected);
        free(copy);
    }
    print_message(
        "%zu changes: %zu in the head, %zu in moof, %zu in pictures, %zu in shape records, "
        "%zu in exact images, %zu in the index; %.1f frames lost by each\n",
        count, of[GVC_PART_HEAD], of[GVC_PART_FRAGMENT], of[GVC_PART_GEOMETRY], of[GVC_PART_SHAPE],
        of[GVC_PART_EXACT], of[GVC_PART_INDEX], (double)lost / (double)count);
    free(must);
}

/* ----------------------------------------------------------------------------------------- cuts */

/* Frames whose fragment is whole, or whose records and pictures before them are all there. */
static expectation expect_cut(const original *o, size_t size, bool *must) {
    const gvc_demux *demux = &o->reader->demux;
    expectation e = {.part = GVC_PART_INDEX, .begin = size, .end = size, .cut = true};
    for (size_t i = 0; i < o->frames; i++) must[i] = false;
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *f = &demux->fragment[i];
        gvc_track_kind kind =
            demux->has_track[GVC_TRACK_EXACT] ? GVC_TRACK_EXACT : GVC_TRACK_GEOMETRY;
        const gvc_sample_entry *picture = &demux->sample[kind][f->first_sample[kind]];
        for (size_t k = 0; k < f->frame_count && size >= demux->head_size; k++) {
            if (picture[k].offset + picture[k].size > size) break;
            must[picture[k].presentation] = true;
        }
        if (f->offset + f->size <= size || e.fragment) continue;
        e.part = GVC_PART_FRAGMENT;
        e.fragment = f->sequence;
    }
    e.restored = size >= demux->index_offset;
    return e;
}

static void try_cuts(const original *o, size_t count, uint64_t seed) {
    bool *must = calloc(o->frames, sizeof *must);
    assert_non_null(must);
    for (size_t i = 0; i < count; i++) {
        size_t size = (size_t)(next_random(&seed) % o->file.size);
        expectation expected = expect_cut(o, size, must);
        print_message("%zu: cut at byte %zu, fragment %llu\n", i, size,
                      (unsigned long long)expected.fragment);
        try_damaged(o, o->file.data, size, must, &expected);
    }
    print_message("%zu cuts\n", count);
    free(must);
}

/* ----------------------------------------------------------------------------------------- main */

static gvc_buffer given; /* the file named on the command line */
static size_t changes = CHANGES, cuts = CUTS;
static uint64_t seed = 20261122;

static gvc_buffer make_file(bool lossless, bool with_preview) {
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, FRAMES);
    gvc_encode_options options = quick_options(17, 24, GOP);
    options.lossless = lossless;
    options.with_preview = with_preview;
    options.best_effort = true;
    bytes made = encode(&frames, &options, NULL);
    gvc_buffer file = {0};
    gvc_write_bytes(&file, made.data, made.size);
    bytes_free(&made);
    capture_free(&frames);
    return file;
}

static void try_file(gvc_buffer file) {
    original o = open_original(file);
    print_message("%zu frames, %zu bytes, seed %llu\n", o.frames, o.file.size,
                  (unsigned long long)seed);
    try_changes(&o, changes, seed);
    try_cuts(&o, cuts, seed);
    close_original(&o);
}

static void damage_is_told_and_repaired(void **state) {
    (void)state;
    if (given.size) {
        try_file(given);
        return;
    }
    try_file(make_file(false, false));
    try_file(make_file(true, false));
    try_file(make_file(true, true));
}

static void read_given(const char *path) {
    static uint8_t chunk[1 << 16];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    for (size_t got; (got = fread(chunk, 1, sizeof chunk, file)) > 0;) {
        gvc_write_bytes(&given, chunk, got);
    }
    fclose(file);
}

int main(int argc, char **argv) {
    if (argc > 1) read_given(argv[1]);
    if (argc > 2) changes = strtoull(argv[2], NULL, 10);
    if (argc > 3) cuts = strtoull(argv[3], NULL, 10);
    if (argc > 1) seed = argc > 4 ? strtoull(argv[4], NULL, 10) : (uint64_t)time(NULL);
    const struct CMUnitTest tests[] = {cmocka_unit_test(damage_is_told_and_repaired)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
