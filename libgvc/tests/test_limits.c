/* SPDX-License-Identifier: MIT */
/** @file test_limits.c  Small hostile files: the memory held while they are opened and decoded,
 * that of libavcodec, OpenEXR and zstd included, never exceeds max_memory; or they are refused. */
#include "file_maker.h"

#include "live_memory.h"

#include "codec/exr.h"
#include "codec/residual.h"
#include "container/iso.h"
#include "container/shape_layout.h"
#include "container/shape_record.h"
#include "file.h"

#include <stdio.h>
#include <zstd.h>

#define MIB (UINT64_C(1) << 20)

static const uint64_t limits[] = {MIB / 4, 2 * MIB, 16 * MIB, 64 * MIB, 256 * MIB};
#define LIMITS (sizeof limits / sizeof *limits)

/** What a file came to under one limit. */
typedef struct outcome {
    gvc_result opened, decoded;
    uint64_t peak;
} outcome;

/** Opens, decodes two frames, asks for facts, and looks at every byte. */
static outcome try_file(const gvc_buffer *file, uint64_t max_memory, bool keep_going) {
    gvc_read_options options;
    gvc_reader *reader;
    gvc_decoder *decoder = NULL;
    gvc_frame_info facts;
    gvc_read_options_init(&options);
    options.max_memory = max_memory;
    options.keep_going = keep_going;
    memory_begin();
    outcome out = {.decoded = GVC_ERROR_LIMIT};
    out.opened = gvc_reader_open_memory(file->data, file->size, &options, &reader, NULL);
    if (out.opened == GVC_OK) {
        (void)!gvc_reader_frame_info(reader, 0, &facts, NULL);
        out.decoded = gvc_decoder_create(reader, &decoder, NULL);
    }
    for (uint64_t f = 0; decoder && f < 2; f++) {
        gvc_mesh *mesh;
        out.decoded = gvc_decoder_frame(decoder, f, &mesh, NULL);
        gvc_mesh_destroy(&mesh);
    }
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    out.peak = memory_peak();
    return out;
}

/** At every limit. The greatest one must give `expected`. */
static void try_limits(const char *name, const gvc_buffer *file, gvc_result expected) {
    assert_false(file->failed);
    for (unsigned keep_going = 0; keep_going < 2; keep_going++) {
        for (size_t i = 0; i < LIMITS; i++) {
            outcome out = try_file(file, limits[i], keep_going);
            gvc_result result = out.opened == GVC_OK ? out.decoded : out.opened;
            if (out.peak > limits[i] + MEMORY_ALLOWANCE) {
                fail_msg("%s, %zu bytes: %llu bytes held; the limit is %llu (%s)", name, file->size,
                         (unsigned long long)out.peak, (unsigned long long)limits[i],
                         gvc_result_string(result));
            }
            if (result != GVC_ERROR_LIMIT && result != expected) {
                fail_msg("%s: %s at %llu bytes", name, gvc_result_string(result),
                         (unsigned long long)limits[i]);
            }
            if (getenv("GVC_SHOW_PEAKS")) {
                print_message("%s, %zu bytes: limit %llu KiB, peak %llu KiB: %s\n", name,
                              file->size, (unsigned long long)(limits[i] >> 10),
                              (unsigned long long)(out.peak >> 10), gvc_result_string(result));
            }
            if (i == LIMITS - 1) assert_int_equal(result, expected);
        }
    }
}

/* ------------------------------------------------------------------------------------------- files
 */

/** A file without video of one fragment of two frames, whose records and images are given. */
static gvc_buffer make_exact(const gvc_config *config, const gvc_buffer *record,
                             const gvc_buffer image[2]) {
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_config described = *config;
    gvc_writer *writer;
    uint8_t same[9] = {GVC_RECORD_SAME};
    described.features = GVC_FEATURE_EXACT;
    gvc_sample shape[2] = {{record->data, record->size, 0, true}, {same, sizeof same, 0, false}};
    gvc_sample exact[2] = {{image[0].data, image[0].size, 0, true},
                           {image[1].data, image[1].size, 0, false}};
    gvc_fragment fragment = {0, 2, NULL, shape, exact};
    assert_int_equal(gvc_writer_create(&sink, &described, NULL, 0, &writer, NULL), GVC_OK);
    assert_int_equal(gvc_writer_fragment(writer, &fragment, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    gvc_writer_destroy(&writer);
    return file;
}

static gvc_config config_of(uint32_t width, uint32_t height, uint32_t image_size) {
    gvc_config config = config_make(2);
    config.picture_width = width;
    config.plane_height = height;
    config.image_size = image_size;
    return config;
}

/** One chart of `size`, a sphere cut along one edge: the least record there is. */
static gvc_buffer make_record(uint32_t size) {
    uint32_t steps[1] = {2 * (size - 1)};
    gvc_side side[2] = {{0, false}, {0, true}};
    gvc_shape_node node[2] = {{0}};
    gvc_shape_edge edge[1] = {{{0, 1}}};
    gvc_chart_shape chart = {.step = 1,
                             .node_count = 2,
                             .edge_count = 1,
                             .node = node,
                             .edge = edge,
                             .sides = {size, size / 4, 1, steps, 2, side}};
    gvc_shape shape = {.chart_count = 1, .chart = &chart};
    gvc_shape_frame facts = {.same = false};
    gvc_buffer record = {0};
    assert_int_equal(gvc_shape_record_write(&shape, &facts, &record, NULL), GVC_OK);
    return record;
}

static gvc_buffer make_key(uint32_t size) {
    uint16_t *codes = calloc((size_t)3 * size * size, sizeof *codes);
    gvc_exr_facts facts = {.step = 1};
    gvc_buffer image = {0};
    assert_non_null(codes);
    assert_int_equal(gvc_exr_encode(size, codes, &facts, &image, NULL), GVC_OK);
    free(codes);
    return image;
}

static void free_three(gvc_buffer *a, gvc_buffer *b, gvc_buffer *c) {
    gvc_buffer_free(a);
    gvc_buffer_free(b);
    gvc_buffer_free(c);
}

/* ------------------------------------------------------------------------------------------- tests
 */

/** The greatest planes, and a chart of a few samples. */
static void test_greatest_picture(void **state) {
    (void)state;
    gvc_config config = config_of(16384, 5460, 16);
    gvc_buffer record = make_record(16), image[2] = {make_key(16), make_key(16)};
    gvc_buffer file = make_exact(&config, &record, image);
    try_limits("greatest picture", &file, GVC_ERROR_LIMIT);
    gvc_buffer_free(&file);
    free_three(&record, &image[0], &image[1]);
}

/** Images of 1025 samples a side in some kilobytes: the second is a residual that ends early. */
static void test_great_images(void **state) {
    (void)state;
    enum { SIZE = 1025 };
    gvc_config config = config_of(SIZE + 1, SIZE + 1, SIZE);
    static uint8_t few[] = {1, 1, SIZE >> 8, SIZE & 255, 0, 0, 0, 0};
    gvc_buffer record = make_record(SIZE), key = make_key(SIZE);
    gvc_buffer image[2] = {key, {.data = few, .size = sizeof few}};
    gvc_buffer file = make_exact(&config, &record, image);
    assert_true(file.size < 100000);
    try_limits("great images", &file, GVC_ERROR_CORRUPT);
    gvc_buffer_free(&file);
    gvc_buffer_free(&record);
    gvc_buffer_free(&key);
}

/** A record that says to be `expanded` bytes of zeros. */
static gvc_buffer make_bomb(size_t expanded) {
    gvc_buffer record = {0};
    uint8_t *zeros = calloc(expanded, 1), head[9] = {GVC_RECORD_ZSTD};
    size_t bound = ZSTD_compressBound(expanded);
    uint8_t *packed = malloc(bound);
    assert_true(zeros && packed);
    size_t size = ZSTD_compress(packed, bound, zeros, expanded, 19);
    assert_false(ZSTD_isError(size));
    gvc_write_bytes(&record, head, sizeof head);
    gvc_write_bytes(&record, packed, size);
    free(zeros);
    free(packed);
    return record;
}

static void test_bombs(void **state) {
    (void)state;
    static const size_t expanded[] = {1 << 16, 3 << 18, 40 << 20};
    gvc_buffer image[2] = {make_key(16), make_key(16)};
    for (size_t i = 0; i < sizeof expanded / sizeof *expanded; i++) {
        gvc_config config = config_of(512, 512, 512);
        gvc_buffer record = make_bomb(expanded[i]);
        gvc_buffer file = make_exact(&config, &record, image);
        try_limits("zstd bomb", &file, GVC_ERROR_CORRUPT);
        gvc_buffer_free(&file);
        gvc_buffer_free(&record);
    }
    gvc_buffer_free(&image[0]);
    gvc_buffer_free(&image[1]);
}

/** A record of as many charts, nodes and edges as it says, of charts that lie on each other. */
static void test_many_charts(void **state) {
    (void)state;
    enum { CHARTS = 1400, EDGES = 15 };
    gvc_config config = config_of(256, 256, 16);
    gvc_buffer body = {0}, record = {0}, image[2] = {make_key(16), make_key(16)};
    static const uint8_t head[9] = {0};
    gvc_write_varint(&body, 0);
    gvc_write_varint(&body, CHARTS);
    for (uint64_t c = 0; c < CHARTS; c++) {
        const uint64_t fields[] = {c, 0, 0, 16, 0};
        for (unsigned i = 0; i < 5; i++) gvc_write_varint(&body, fields[i]);
        for (unsigned i = 0; i < 4; i++) gvc_write_f64(&body, 1);
        gvc_write_varint(&body, EDGES + 1);
        gvc_write_varint(&body, EDGES);
        for (unsigned i = 0; i < EDGES + 1; i++) gvc_write_u8(&body, 0);
        for (unsigned i = 0; i < 1 + 5 * EDGES; i++) gvc_write_varint(&body, 0);
    }
    gvc_write_bytes(&record, head, sizeof head);
    gvc_write_bytes(&record, body.data, body.size);
    gvc_buffer file = make_exact(&config, &record, image);
    try_limits("many charts", &file, GVC_ERROR_CORRUPT);
    gvc_buffer_free(&file);
    gvc_buffer_free(&body);
    free_three(&record, &image[0], &image[1]);
}

/** An OpenEXR header of small attributes, which the library keeps at many times their size. */
static gvc_buffer make_attributes(const gvc_buffer *key, size_t count) {
    gvc_buffer image = {0};
    gvc_write_bytes(&image, key->data, 8);
    for (size_t i = 0; i < count; i++) {
        char name[16];
        int length = snprintf(name, sizeof name, "a%zx", i);
        static const uint8_t rest[] = {'i', 'n', 't', 0, 4, 0, 0, 0, 1, 0, 0, 0};
        gvc_write_bytes(&image, name, (size_t)length + 1);
        gvc_write_bytes(&image, rest, sizeof rest);
    }
    gvc_write_bytes(&image, key->data + 8, key->size - 8);
    return image;
}

static void test_attributes(void **state) {
    (void)state;
    static const size_t count[] = {100, 4000, 15000, 40000};
    gvc_config config = config_of(32, 32, 16);
    gvc_buffer record = make_record(16), key = make_key(16);
    for (size_t i = 0; i < 4; i++) {
        gvc_buffer image[2] = {make_attributes(&key, count[i]), key};
        gvc_buffer file = make_exact(&config, &record, image);
        /* Chunk offsets have moved: what is read is damaged at best. */
        bool refused = image[0].size > GVC_EXR_MAX_HEADER;
        try_limits("attributes", &file, refused ? GVC_ERROR_LIMIT : GVC_ERROR_CORRUPT);
        gvc_buffer_free(&file);
        gvc_buffer_free(&image[0]);
    }
    gvc_buffer_free(&record);
    gvc_buffer_free(&key);
}

/** A sample longer than it need be is refused where it does not fit. */
static void test_long_sample(void **state) {
    (void)state;
    gvc_config config = config_of(32, 32, 16);
    gvc_buffer record = make_record(16), key = make_key(16), longer = {0};
    static const uint8_t zeros[1 << 16];
    gvc_write_bytes(&longer, key.data, key.size);
    for (unsigned i = 0; i < 320; i++) gvc_write_bytes(&longer, zeros, sizeof zeros);
    gvc_buffer image[2] = {longer, key};
    gvc_buffer file = make_exact(&config, &record, image);
    outcome out = try_file(&file, 16 * MIB, false);
    assert_int_equal(out.opened, GVC_OK);
    assert_int_equal(out.decoded, GVC_ERROR_LIMIT);
    assert_true(out.peak <= 16 * MIB);
    gvc_buffer_free(&file);
    free_three(&record, &key, &longer);
}

/** Counts of 2^31 and more where a box says how many things follow. */
static void test_counts(void **state) {
    (void)state;
    static const uint32_t type[] = {GVC_BOX_TRUN, GVC_BOX_TFRA, GVC_BOX_STSD, GVC_BOX_ELST};
    gvc_config config = config_of(32, 32, 16);
    gvc_buffer record = make_record(16), image[2] = {make_key(16), make_key(16)};
    gvc_buffer file = make_exact(&config, &record, image);
    for (size_t i = 0; i + 24 < file.size; i++) {
        for (unsigned t = 0; t < 4; t++) {
            const uint8_t *at = file.data + i;
            uint32_t found = (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | at[2] << 8 | at[3];
            if (found != type[t]) continue;
            for (size_t k = 4; k < 20; k += 4) { /* version and flags, then counts and others */
                uint8_t kept[4];
                memcpy(kept, file.data + i + k, 4);
                memset(file.data + i + k, 0x7f, 4);
                outcome out = try_file(&file, MIB / 4, true); /* checksums are wrong as well */
                assert_true(out.peak <= MIB / 4 + MEMORY_ALLOWANCE);
                memcpy(file.data + i + k, kept, 4);
            }
        }
    }
    gvc_buffer_free(&file);
    free_three(&record, &image[0], &image[1]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_greatest_picture),
        cmocka_unit_test(test_great_images),
        cmocka_unit_test(test_bombs),
        cmocka_unit_test(test_many_charts),
        cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_long_sample),
        cmocka_unit_test(test_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
