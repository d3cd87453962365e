/* SPDX-License-Identifier: MIT */
/** @file make_seeds.c  Writes valid seed inputs for fuzz_container and fuzz_record into the
 * folders given, and, for the replay tests, each of them with single bytes changed. */
#include "container/shape_record.h"
#include "container/writer.h"
#include "memory_file.h"
#include "seed.h"
#include "seed_torus.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIZE 33u
#define FRAMES 5u

/** One chart: a star of four tips. Its parts live in `parts`. */
typedef struct star_parts {
    gvc_shape_node node[5];
    gvc_shape_edge edge[4];
    uint32_t steps[4];
    gvc_side side[8];
    gvc_chart_shape chart;
} star_parts;

static gvc_shape make_star(star_parts *parts) {
    *parts = (star_parts){0};
    for (uint32_t i = 0; i < 4; i++) {
        parts->node[i + 1] = (gvc_shape_node){1, i};
        parts->edge[i] = (gvc_shape_edge){{0, i + 1}};
        parts->steps[i] = (SIZE - 1) / 2;
        parts->side[2 * i] = (gvc_side){i, false};
        parts->side[2 * i + 1] = (gvc_side){i, true};
    }
    parts->chart = (gvc_chart_shape){.step = 0.001,
                                     .node_count = 5,
                                     .edge_count = 4,
                                     .node = parts->node,
                                     .edge = parts->edge,
                                     .sides = {SIZE, 8, 4, parts->steps, 8, parts->side}};
    return (gvc_shape){.chart_count = 1, .chart = &parts->chart};
}

/** record_NAME and, if asked for, changed_NAME. */
static int save_record(const char *folder, const char *name, const gvc_shape *shape,
                       const gvc_shape_frame *facts, bool changed) {
    char plain[32], stem[32];
    gvc_buffer record = {0};
    snprintf(plain, sizeof plain, "record_%s", name);
    snprintf(stem, sizeof stem, "changed_%s", name);
    int failed = gvc_shape_record_write(shape, facts, &record, NULL) != GVC_OK ||
                 seed_save(folder, plain, SEED_PLAIN, &record);
    if (changed) failed |= seed_save_changed(folder, stem, SEED_PLAIN, &record, 1);
    gvc_buffer_free(&record);
    return failed;
}

/** Two stars, the second one higher up in the plane. */
static int save_two(const char *folder, bool changed) {
    star_parts parts[2];
    gvc_chart_shape chart[2];
    const gvc_shape_frame facts = {.same = false};
    for (unsigned i = 0; i < 2; i++) chart[i] = *make_star(&parts[i]).chart;
    chart[0].x = chart[0].y = SIZE;
    gvc_shape two = {.segment = 1, .chart_count = 2, .chart = chart};
    return save_record(folder, "two", &two, &facts, changed);
}

static int save_torus(const char *folder, bool changed) {
    torus_parts parts;
    gvc_shape torus = make_torus(&parts, SIZE);
    const gvc_shape_frame facts = {.has_preview = true};
    return save_record(folder, "torus", &torus, &facts, changed);
}

/** Which tracks of geometry images a file has. */
typedef struct tracks {
    bool video, exact;
} tracks;

static gvc_result write_samples(gvc_writer *writer, tracks has, const gvc_buffer *first,
                                const gvc_buffer *same) {
    static const uint8_t picture[12] = {0, 0, 0, 8, 0x65, 1, 2, 3, 4, 5, 6, 7};
    static const int32_t order[4] = {0, 2, -1, -1};
    static const uint8_t image[5] = {0x76, 0x2f, 0x31, 1, 2};
    gvc_sample geometry[4], shape[4], exact[4];
    for (size_t i = 0; i < 4; i++) {
        const gvc_buffer *record = i ? same : first;
        geometry[i] = (gvc_sample){picture, sizeof picture - i, order[i], i == 0};
        shape[i] = (gvc_sample){record->data, record->size, 0, i == 0};
        exact[i] = (gvc_sample){image, sizeof image - i, 0, i == 0};
    }
    gvc_fragment fragment = {0, 4, has.video ? geometry : NULL, shape, has.exact ? exact : NULL};
    GVC_TRY(gvc_writer_fragment(writer, &fragment, NULL));
    fragment.first_frame = 4;
    fragment.frame_count = FRAMES - 4;
    GVC_TRY(gvc_writer_fragment(writer, &fragment, NULL));
    return gvc_writer_finish(writer, NULL);
}

static gvc_result make_file(tracks has, const gvc_buffer *first, const gvc_buffer *same,
                            gvc_buffer *file) {
    static const uint8_t avc[] = {1, 110, 0, 42, 255};
    gvc_config config = {.version_minor = GVC_FORMAT_MINOR,
                         .features = has.exact ? GVC_FEATURE_EXACT : 0,
                         .picture_width = 48,
                         .plane_height = 48,
                         .image_size = SIZE,
                         .code_bits = 10,
                         .code_shift = 6,
                         .frame_rate_num = 30,
                         .frame_rate_den = 1,
                         .declared_frames = FRAMES,
                         .unit = "m",
                         .encoder = "seed"};
    gvc_sink sink = {file, sink_write};
    gvc_writer *writer;
    GVC_TRY(gvc_writer_create(&sink, &config, has.video ? avc : NULL, sizeof avc, &writer, NULL));
    gvc_result result = write_samples(writer, has, first, same);
    gvc_writer_destroy(&writer);
    return result;
}

static int save(const char *files, const char *records, bool changed, gvc_buffer *file,
                gvc_buffer *exact, gvc_buffer *both, gvc_buffer *first, gvc_buffer *same) {
    int failed = seed_save(files, "video.gvc", SEED_PLAIN, file);
    failed |= seed_save(files, "exact.gvc", SEED_PLAIN, exact);
    failed |= seed_save(files, "both.gvc", SEED_PLAIN, both);
    failed |= seed_save(records, "record", SEED_PLAIN, first);
    failed |= seed_save(records, "record_same", SEED_PLAIN, same);
    failed |= save_two(records, changed) | save_torus(records, changed);
    if (changed) {
        failed |= seed_save_changed(files, "changed_video", SEED_PLAIN, file, 7);
        failed |= seed_save_changed(files, "changed_exact", SEED_PLAIN, exact, 11);
        failed |= seed_save_changed(records, "changed_record", SEED_PLAIN, first, 1);
    }
    return failed;
}

int main(int argc, char **argv) {
    bool changed = argc == 4 && strcmp(argv[3], "--changed") == 0;
    if (argc != 3 && !changed) {
        fprintf(stderr, "usage: make_seeds CONTAINER_FOLDER RECORD_FOLDER [--changed]\n");
        return 2;
    }
    star_parts parts;
    gvc_shape star = make_star(&parts);
    gvc_shape_frame frame = {.digest = {1, 2, 3, 4, 5, 6, 7, 8}, .source = "0001.obj"};
    gvc_shape_frame next = {.same = true, .digest = {8, 7, 6, 5, 4, 3, 2, 1}};
    gvc_buffer first = {0}, same = {0}, file = {0}, exact = {0}, both = {0};
    int failed = gvc_shape_record_write(&star, &frame, &first, NULL) != GVC_OK ||
                 gvc_shape_record_write(NULL, &next, &same, NULL) != GVC_OK ||
                 make_file((tracks){true, false}, &first, &same, &file) != GVC_OK ||
                 make_file((tracks){false, true}, &first, &same, &exact) != GVC_OK ||
                 make_file((tracks){true, true}, &first, &same, &both) != GVC_OK || file.failed ||
                 exact.failed || both.failed;
    if (!failed) failed = save(argv[1], argv[2], changed, &file, &exact, &both, &first, &same);
    if (failed) fprintf(stderr, "make_seeds: cannot write to %s, %s\n", argv[1], argv[2]);
    gvc_buffer_free(&first);
    gvc_buffer_free(&same);
    gvc_buffer_free(&file);
    gvc_buffer_free(&exact);
    gvc_buffer_free(&both);
    return failed;
}
