/* SPDX-License-Identifier: MIT */
/** @file test_reader.c  Shape records as the reader sees them: one whole record per fragment,
 * charts no larger than the file says, a bounded number of reads per frame; and the codes of a
 * chart. */
#include "capture_maker.h"

#include "base/digest.h"
#include "chart/rebuild.h"
#include "container/box.h"
#include "container/writer.h"
#include "file.h"
#include "memory_file.h"
#include "shape_maker.h"

#define GROUP 500u /**< frames, all in one fragment */

typedef struct counted {
    const gvc_buffer *file;
    size_t reads;
} counted;

static gvc_result counted_read(void *user, uint64_t offset, void *data, size_t size,
                               gvc_error *error) {
    counted *input = user;
    (void)error;
    input->reads++;
    assert_true(offset <= input->file->size && size <= input->file->size - offset);
    memcpy(data, input->file->data + offset, size);
    return GVC_OK;
}

static gvc_reader *open_counted(counted *input) {
    gvc_io io = {.user = input, .size = input->file->size, .read = counted_read};
    gvc_reader *reader;
    assert_int_equal(gvc_reader_open_io(&io, NULL, &reader, NULL), GVC_OK);
    return reader;
}

/** Changes the flag "same" of a frame's shape record, and makes all checksums right again. */
static void flip_same(gvc_buffer *file, uint64_t frame) {
    counted input = {.file = file};
    gvc_reader *reader = open_counted(&input);
    gvc_sample_entry sample = reader->demux.sample[GVC_TRACK_SHAPE][frame];
    size_t moof = (size_t)reader->demux.fragment[0].offset, place = 0;
    gvc_reader_close(&reader);
    file->data[sample.offset] ^= 1;
    gvc_cursor cursor = gvc_cursor_make(file->data + moof, 4);
    size_t end = moof + gvc_read_u32(&cursor);
    for (size_t at = moof; at + 4 <= end; at++) { /* the last gcks is that of the shapes */
        if (memcmp(file->data + at, "gcks", 4) == 0) place = at + 8 + 4 * (size_t)frame;
    }
    gvc_cursor old = gvc_cursor_make(file->data + place, 4);
    assert_int_equal(gvc_read_u32(&old), sample.crc);
    gvc_patch_u32(file, place, gvc_crc32(0, file->data + sample.offset, sample.size));
    gvc_patch_u32(file, end - 4, gvc_crc32(0, file->data + moof, end - 4 - moof));
}

/** A file of one fragment whose pictures are no H.264, coded I P B B ..., with charts of up to 33
 * samples a side. All records are as they should be but that of frame `odd`, which is "same" if it
 * should be whole, and the reverse. The writer would not write it, so it is made afterwards. */
static gvc_buffer group_make(uint32_t image_size, size_t odd) {
    static const uint8_t avc[] = {1, 110, 0, 42, 255}, picture[16] = {0};
    static const int32_t order[3] = {2, -1, -1};
    gvc_buffer file = {0}, whole = {0}, same = {0}, other = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_config config = {.version_minor = GVC_FORMAT_MINOR,
                         .picture_width = 64,
                         .plane_height = 48,
                         .image_size = image_size,
                         .code_bits = 10,
                         .code_shift = 6,
                         .frame_rate_num = 30,
                         .frame_rate_den = 1,
                         .declared_frames = GROUP};
    gvc_shape shape = shape_of_two();
    gvc_shape_frame first = {.digest = {1}, .source = "first"}, next = {.same = true};
    assert_int_equal(gvc_shape_record_write(&shape, &first, &whole, NULL), GVC_OK);
    assert_int_equal(gvc_shape_record_write(NULL, &next, &same, NULL), GVC_OK);
    gvc_shape_free(&shape);
    const gvc_buffer *unlike = odd ? &whole : &same;
    gvc_write_bytes(&other, unlike->data, unlike->size);
    other.data[0] ^= 1;
    gvc_sample geometry[GROUP], record[GROUP];
    for (size_t i = 0; i < GROUP; i++) {
        const gvc_buffer *made = i == odd ? &other : i ? &same : &whole;
        bool reordered = i > 0 && i - (i - 1) % 3 + 3 <= GROUP;
        geometry[i] = (gvc_sample){picture, 1 + i % 16, reordered ? order[(i - 1) % 3] : 0, i == 0};
        record[i] = (gvc_sample){made->data, made->size, 0, i == 0};
    }
    gvc_writer *writer;
    gvc_fragment fragment = {0, GROUP, geometry, record, NULL};
    assert_int_equal(gvc_writer_create(&sink, &config, avc, sizeof avc, &writer, NULL), GVC_OK);
    assert_int_equal(gvc_writer_fragment(writer, &fragment, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    gvc_writer_destroy(&writer);
    gvc_buffer_free(&whole);
    gvc_buffer_free(&same);
    gvc_buffer_free(&other);
    assert_false(file.failed);
    if (odd < GROUP) flip_same(&file, odd);
    return file;
}

/* -------------------------------------------------------------------------------------- records */

static void facts_of_a_frame_take_two_records(void **state) {
    (void)state;
    gvc_buffer file = group_make(33, GROUP);
    counted input = {.file = &file};
    gvc_reader *reader = open_counted(&input);
    uint64_t total = 0, keyframes = 0;
    for (uint64_t frame = 0; frame < GROUP; frame++) {
        gvc_frame_info info;
        input.reads = 0;
        assert_int_equal(gvc_reader_frame_info(reader, frame, &info, NULL), GVC_OK);
        assert_true(input.reads <= 2);
        assert_int_equal(info.segment, 300);
        assert_int_equal(info.chart_count, 2);
        assert_int_equal(info.genus, 1);
        assert_int_equal(info.keyframe, frame == 0);
        assert_string_equal(info.source, frame ? "" : "first");
        assert_int_equal(info.digest[0], frame ? 0 : 1);
        total += info.byte_count;
        keyframes += info.keyframe;
    }
    uint64_t all = 0;
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; i < reader->demux.sample_count[kind]; i++)
            all += reader->demux.sample[kind][i].size;
    }
    assert_int_equal(total, all);
    assert_int_equal(keyframes, 1);
    gvc_reader_close(&reader);
    gvc_buffer_free(&file);
}

static gvc_result info_of(const gvc_buffer *file, uint64_t frame, gvc_error *error) {
    counted input = {.file = file};
    gvc_reader *reader = open_counted(&input);
    gvc_frame_info info;
    gvc_error_init(error);
    gvc_result result = gvc_reader_frame_info(reader, frame, &info, error);
    if (result != GVC_OK) assert_true(error->offset != GVC_NO_OFFSET);
    gvc_reader_close(&reader);
    return result;
}

static void the_first_record_must_be_whole(void **state) {
    (void)state;
    gvc_error error;
    gvc_buffer file = group_make(33, 0);
    for (uint64_t frame = 0; frame < 3; frame++) {
        assert_int_equal(info_of(&file, frame, &error), GVC_ERROR_CORRUPT);
        assert_int_equal(error.frame, 0);
    }
    gvc_buffer_free(&file);
}

static void no_other_record_may_be_whole(void **state) {
    (void)state;
    gvc_error error;
    for (size_t odd = 1; odd < GROUP; odd += 166) {
        gvc_buffer file = group_make(33, odd);
        assert_int_equal(info_of(&file, odd, &error), GVC_ERROR_CORRUPT);
        assert_int_equal(error.frame, (int64_t)odd);
        assert_int_equal(info_of(&file, odd - 1, &error), GVC_OK);
        if (odd + 1 < GROUP) assert_int_equal(info_of(&file, odd + 1, &error), GVC_OK);
        gvc_buffer_free(&file);
    }
}

/** What gvcC says of image sizes is true, so that a limit on it holds. */
static void charts_are_no_larger_than_the_file_says(void **state) {
    (void)state;
    gvc_error error;
    for (uint32_t size = 32; size <= 33; size++) {
        gvc_buffer file = group_make(size, GROUP);
        gvc_result expected = size < 33 ? GVC_ERROR_CORRUPT : GVC_OK;
        assert_int_equal(info_of(&file, 0, &error), expected);
        assert_int_equal(info_of(&file, GROUP - 1, &error), expected);
        gvc_buffer_free(&file);
    }
}

/* ---------------------------------------------------------------------------------------- codes */

/** The mesh made here from codes and shape must be the one that the decoder hands out. */
static void check_codes(const player *made, uint64_t frame) {
    const uint16_t *plane;
    uint32_t size;
    size_t fragment;
    gvc_shape shape;
    gvc_weld weld;
    gvc_mesh *mesh, *decoded;
    assert_int_equal(gvc_reader_find(made->reader, frame, &fragment, NULL), GVC_OK);
    assert_int_equal(gvc_reader_shape(made->reader, fragment, &shape, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_codes(made->decoder, frame, 0, &plane, &size, NULL), GVC_OK);
    const gvc_chart_shape *chart = &shape.chart[0];
    assert_int_equal(size, chart->sides.size);
    for (size_t i = 0; i < 3 * (size_t)size * size; i++) assert_int_equal(plane[i] % 64, 0);
    assert_int_equal(gvc_weld_build(&chart->sides, &weld, NULL), GVC_OK);
    assert_int_equal(gvc_rebuild_mesh(&weld, plane, chart->origin, chart->step, &mesh, NULL),
                     GVC_OK);
    decoded = player_frame(made, frame);
    assert_same_mesh(mesh, decoded);
    gvc_mesh_destroy(&mesh);
    gvc_mesh_destroy(&decoded);
    gvc_weld_free(&weld);
    gvc_shape_free(&shape);
}

static void codes_are_what_the_mesh_is_made_of(void **state) {
    (void)state;
    static const uint64_t order[] = {0, 2, 1, 3, 3, 0};
    capture frames = {0};
    capture_add_figure(&frames, 1, 1, 0, 4);
    gvc_encode_options options = quick_options(33, 20, 2);
    bytes file = encode(&frames, &options, NULL);
    player made = player_open(&file, NULL);
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        const uint16_t *plane = (const uint16_t *)order;
        uint32_t size;
        check_codes(&made, order[i]);
        assert_int_equal(gvc_decoder_codes(made.decoder, order[i], 1, &plane, &size, NULL),
                         GVC_ERROR_ARGUMENT);
        assert_null(plane);
        plane = (const uint16_t *)order;
        assert_int_equal(gvc_decoder_codes(made.decoder, 4, 0, &plane, &size, NULL),
                         GVC_ERROR_ARGUMENT);
        assert_null(plane);
    }
    player_close(&made);
    bytes_free(&file);
    capture_free(&frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facts_of_a_frame_take_two_records),
        cmocka_unit_test(the_first_record_must_be_whole),
        cmocka_unit_test(no_other_record_may_be_whole),
        cmocka_unit_test(charts_are_no_larger_than_the_file_says),
        cmocka_unit_test(codes_are_what_the_mesh_is_made_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
