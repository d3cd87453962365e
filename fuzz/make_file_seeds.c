/* SPDX-License-Identifier: MIT */
/** @file make_file_seeds.c  Writes small encoded captures, one for each feature of the format, into
 * a folder, and seeds for fuzz_encode into another; and, for the replay tests, files with
 * single bytes changed and checksums made right again into a third. */
#include "encoding.h"
#include "memory_file.h"
#include "require.h"
#include "reseal.h"
#include "seed.h"
#include "soup.h"

#define FRAMES 2u

typedef struct kind {
    const char *name;
    void (*base)(soup *);
    bool lossless, preview;
    uint32_t gop, image_size;
} kind;

static void make_pear(soup *s) {
    soup_octahedron(s);
    for (size_t f = 0; f < 12; f += 3) soup_split(s, f, 1.5);
}

enum { GROUPS = 4 }; /* the one of several fragments */
static const kind kinds[] = {
    {"lossy.gvc", make_pear, false, false, 60, 16},
    {"torus.gvc", soup_torus, false, false, 60, 18},
    {"lossless.gvc", make_pear, true, false, 60, 16},
    {"preview.gvc", soup_octahedron, true, true, 2, 16},
    [GROUPS] = {"groups.gvc", soup_tetrahedron, false, false, 1, 17},
};

/** The surface, turning. */
static void make_capture(const kind *k, small_capture *capture) {
    soup s = {0};
    k->base(&s);
    for (unsigned f = 0; f < FRAMES; f++) {
        double position[3 * SOUP_VERTICES], angle = 0.2 * f;
        for (size_t v = 0; v < s.vertex_count; v++) {
            const double *p = &s.position[3 * v];
            position[3 * v] = cos(angle) * p[0] - sin(angle) * p[1];
            position[3 * v + 1] = sin(angle) * p[0] + cos(angle) * p[1];
            position[3 * v + 2] = (1 + 0.1 * f) * p[2];
        }
        REQUIRE(gvc_mesh_create(position, s.vertex_count, s.face, s.face_count,
                                &capture->mesh[capture->count++], NULL) == GVC_OK);
    }
}

/** Whether it could not be done. */
static int encode_kind(const kind *k, gvc_buffer *file) {
    small_capture capture = {0};
    gvc_encode_options options;
    make_capture(k, &capture);
    gvc_encode_options_init(&options);
    options.image_size = k->image_size;
    options.lossless = k->lossless;
    options.with_preview = k->preview;
    options.crf = 24;
    options.best_effort = true;
    options.gop = k->gop;
    options.threads = 1;
    options.longest_edge = 0.15; /* 50 vertices: as fast as can be */
    bool good = encode_and_check(&capture, &options, file);
    small_capture_free(&capture);
    return !good;
}

/* -------------------------------------------------------------------------------- damage, repair
 */

/** A file without its end, one with a wrong head, one with wrong data, and the last repaired. */
static int save_damaged(const char *folder, gvc_buffer *file) {
    gvc_buffer cut = *file, repaired = {0};
    cut.size = cut.size * 3 / 4;
    int failed = seed_save(folder, "cut.gvc", SEED_PLAIN, &cut);
    file->data[100] ^= 1;
    failed |= seed_save(folder, "damaged_head.gvc", SEED_PLAIN, file);
    file->data[100] ^= 1;
    file->data[file->size / 2] ^= 1;
    failed |= seed_save(folder, "damaged.gvc", SEED_PLAIN, file);
    gvc_read_options reading;
    gvc_reader *reader;
    gvc_read_options_init(&reading);
    reading.keep_going = true;
    gvc_sink sink = {&repaired, sink_write};
    REQUIRE(gvc_reader_open_memory(file->data, file->size, &reading, &reader, NULL) == GVC_OK);
    failed |= gvc_repair(reader, &sink, NULL, NULL, NULL, NULL) != GVC_OK;
    gvc_reader_close(&reader);
    failed |= seed_save(folder, "repaired.gvc", SEED_PLAIN, &repaired);
    gvc_buffer_free(&repaired);
    file->data[file->size / 2] ^= 1;
    return failed;
}

/* ----------------------------------------------------------------------------------------- files
 */

static int save_kind(const kind *k, const char *folder, const char *changed) {
    gvc_buffer file = {0};
    int failed = encode_kind(k, &file) || seed_save(folder, k->name, SEED_PLAIN, &file);
    if (!failed && k == &kinds[GROUPS]) failed = save_damaged(folder, &file);
    for (size_t i = 0; changed && !failed && i < file.size; i += 61) {
        char name[64];
        snprintf(name, sizeof name, "changed_%04zu_%s", i, k->name);
        gvc_buffer copy = {0};
        gvc_write_bytes(&copy, file.data, file.size);
        copy.data[i] ^= (uint8_t)(1u << i % 8);
        reseal(copy.data, copy.size);
        failed |= seed_save(changed, name, SEED_PLAIN, &copy);
        gvc_buffer_free(&copy);
    }
    gvc_buffer_free(&file);
    return failed;
}

/** Of each base and choice, with edits of each sort. */
static int save_encode_seeds(const char *folder) {
    static const uint8_t edits[] = {0, 1, 2, 90, 3, 2, 140, 0, 3, 5, 150, 0, 1, 3, 0, 200};
    static const uint8_t bad[] = {4, 1, 1, 5, 2, 1, 100, 77, 5, 0, 0, 0, 6, 1, 2, 3, 7, 9, 9, 9};
    static const uint8_t choice[6] = {0, 4, 4 + 8, 32 + 64, 64 + 128, 0};
    int failed = 0;
    for (unsigned i = 0; i < 6; i++) {
        char name[32];
        uint8_t head[3] = {(uint8_t)((i == 5 ? 2 : i % 2) | choice[i]), (uint8_t)(20 + i),
                           (uint8_t)(120 + i)};
        gvc_buffer seed = {0};
        gvc_write_bytes(&seed, head, sizeof head);
        if (i % 4 != 1) gvc_write_bytes(&seed, edits, sizeof edits);
        if (i % 4 == 3) gvc_write_bytes(&seed, bad, 4 * (1 + i % 5));
        snprintf(name, sizeof name, "mesh_%02u", i);
        failed |= seed_save(folder, name, SEED_PLAIN, &seed);
        gvc_buffer_free(&seed);
    }
    return failed;
}

int main(int argc, char **argv) {
    if (argc != 3 && argc != 4) {
        fprintf(stderr, "usage: make_file_seeds FILE_FOLDER ENCODE_FOLDER [CHANGED_FOLDER]\n");
        return 2;
    }
    int failed = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        failed |= save_kind(&kinds[i], argv[1], argc == 4 ? argv[3] : NULL);
    }
    failed |= save_encode_seeds(argv[2]);
    if (failed) fprintf(stderr, "make_file_seeds: cannot make %s, %s\n", argv[1], argv[2]);
    return failed;
}
