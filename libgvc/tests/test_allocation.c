/* SPDX-License-Identifier: MIT */
/** @file test_allocation.c  Memory runs out at every allocation there is: in every one of decoding,
 * and in some of encoding, or all if GVC_ALL_ALLOCATIONS is set. Nothing crashes or leaks, the
 * error says so, and no object and no file comes out.
 *
 *  Only the library's own allocations fail; its dependencies get theirs. */
#include "allocation.h"
#include "capture_maker.h"

#include <inttypes.h>

#define FRAMES 2
#define SIZE 16
#define ENCODES 5u /* tried of each kind, unless all are */

/* Written to without an allocation. */
static struct {
    uint8_t data[1 << 18];
    size_t size;
} written;

static gvc_result keep(void *user, const void *data, size_t size, gvc_error *error) {
    (void)user, (void)error;
    assert_true(size <= sizeof written.data - written.size);
    memcpy(written.data + written.size, data, size);
    written.size += size;
    return GVC_OK;
}

typedef struct made {
    capture frames;
    bytes lossy, lossless;
} made;

static gvc_encode_options tiny_options(bool lossless) {
    gvc_encode_options options = quick_options(SIZE, 30, 1);
    options.lossless = lossless;
    options.with_preview = lossless;
    options.best_effort = true;
    options.threads = 1;
    options.longest_edge = 0.2;
    return options;
}

static int make_all(void **state) {
    static made m;
    for (size_t f = 0; f < FRAMES; f++) {
        m.frames.mesh[m.frames.count++] = mesh_ellipsoid(1, 1, 1.5 + 0.1 * (double)f, 5, 3, 0);
    }
    gvc_encode_options options = tiny_options(false), exact = tiny_options(true);
    m.lossy = encode(&m.frames, &options, NULL);
    m.lossless = encode(&m.frames, &exact, NULL);
    *state = &m;
    return 0;
}

static int free_all(void **state) {
    made *m = *state;
    capture_free(&m->frames);
    bytes_free(&m->lossy);
    bytes_free(&m->lossless);
    return 0;
}

/* ------------------------------------------------------------------------------------ what is done
 */

typedef gvc_result (*task)(const made *m, bool lossless, gvc_error *error);

static bool ignore_defect(void *user, const gvc_defect *defect) {
    (void)user, (void)defect;
    return true;
}

/* Everything a reader can do. */
static gvc_result decode_all(const made *m, bool lossless, gvc_error *error) {
    const bytes *file = lossless ? &m->lossless : &m->lossy;
    gvc_read_options options;
    gvc_reader *reader;
    gvc_decoder *decoder = NULL;
    gvc_mesh *mesh = NULL;
    gvc_frame_info facts;
    gvc_read_options_init(&options);
    options.keep_going = lossless;
    gvc_result result = gvc_reader_open_memory(file->data, file->size, &options, &reader, error);
    if (result != GVC_OK) {
        assert_null(reader);
        return result;
    }
    result = gvc_decoder_create(reader, &decoder, error);
    if (result != GVC_OK) assert_null(decoder);
    for (uint64_t f = 0; result == GVC_OK && f < FRAMES; f++) {
        result = gvc_reader_frame_info(reader, f, &facts, error);
        if (result == GVC_OK) result = gvc_decoder_frame(decoder, f, &mesh, error);
        if (result != GVC_OK) assert_null(mesh);
        gvc_mesh_destroy(&mesh);
    }
    if (result == GVC_OK) result = gvc_reader_check(reader, ignore_defect, NULL, error);
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    return result;
}

/* The head and one group are damaged. */
static gvc_result repair_damaged(const made *m, bool lossless, gvc_error *error) {
    const bytes *good = lossless ? &m->lossless : &m->lossy;
    static uint8_t file[sizeof written.data];
    gvc_sink sink = {.write = keep};
    gvc_read_options options;
    gvc_reader *reader;
    memcpy(file, good->data, good->size);
    file[100] ^= 1;
    file[good->size / 2] ^= 1;
    gvc_read_options_init(&options);
    options.keep_going = true;
    gvc_result result = gvc_reader_open_memory(file, good->size, &options, &reader, error);
    if (result == GVC_OK) result = gvc_repair(reader, &sink, NULL, NULL, NULL, error);
    gvc_reader_close(&reader);
    return result;
}

static gvc_result ignore_line(void *user, const char *line, gvc_error *error) {
    (void)user, (void)line, (void)error;
    return GVC_OK;
}

static gvc_result ignore_state(void *user, const void *data, size_t size, gvc_error *error) {
    (void)user, (void)data, (void)size, (void)error;
    return GVC_OK;
}

static gvc_result encode_all(const made *m, bool lossless, gvc_error *error) {
    gvc_encode_options options = tiny_options(lossless);
    gvc_source source = capture_source((capture *)(uintptr_t)&m->frames);
    gvc_sink sink = {.write = keep};
    options.journal = ignore_line;
    options.checkpoint = ignore_state;
    return gvc_encode(&source, &sink, &options, NULL, error);
}

static gvc_result read_meshes(const made *m, bool lossless, gvc_error *error) {
    static const char *const text[] = {
        "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float "
        "z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 "
        "0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"};
    gvc_result result = GVC_OK;
    (void)m, (void)lossless;
    for (unsigned i = 0; i < 3 && result == GVC_OK; i++) {
        gvc_mesh *mesh;
        gvc_topology topology;
        gvc_distance distance;
        result = gvc_mesh_read_memory(text[i], strlen(text[i]), GVC_MESH_AUTO, "", &mesh, error);
        if (result != GVC_OK) assert_null(mesh);
        if (result == GVC_OK) result = gvc_mesh_topology(mesh, &topology, error);
        if (result == GVC_OK) result = gvc_mesh_distance(mesh, mesh, 50, &distance, error);
        gvc_mesh_destroy(&mesh);
    }
    return result;
}

/* ----------------------------------------------------------------------------------------- failing
 */

/* How many allocations `what` takes; `failing` fails. */
static uint64_t run(task what, const made *m, bool lossless, uint64_t failing) {
    gvc_error error;
    gvc_error_init(&error);
    int64_t blocks = allocation_blocks();
    written.size = 0;
    allocation_begin(failing);
    gvc_result result = what(m, lossless, &error);
    uint64_t count = allocation_count();
    allocation_begin(NEVER_FAIL);
    assert_int_equal(error.code, result);
    assert_true(result == GVC_OK || error.message[0]);
    if (allocation_blocks() != blocks) {
        fail_msg("allocation %" PRIu64 " fails (%s): %" PRId64 " blocks leak", failing,
                 error.message, allocation_blocks() - blocks);
    }
    gvc_result expected = failing == NEVER_FAIL ? GVC_OK : GVC_ERROR_MEMORY;
    if (result != expected) {
        fail_msg("allocation %" PRIu64 " fails: %s: %s", failing, gvc_result_string(result),
                 error.message);
    }
    return count;
}

static void fail_each(task what, const char *name, const made *m, bool lossless, uint64_t tries) {
    uint64_t count = run(what, m, lossless, NEVER_FAIL), stride = 1, tried = 0;
    if (tries && !getenv("GVC_ALL_ALLOCATIONS")) stride = count / tries + 1;
    for (uint64_t n = 0; n < count; n += stride, tried++) run(what, m, lossless, n);
    print_message("%s, %s: %" PRIu64 " of %" PRIu64 " allocations failed\n", name,
                  lossless ? "lossless" : "lossy", tried, count);
}

static void test_decode(void **state) {
    fail_each(decode_all, "decode", *state, false, 0);
    fail_each(decode_all, "decode", *state, true, 0);
}

static void test_repair(void **state) {
    fail_each(repair_damaged, "repair", *state, false, 0);
    fail_each(repair_damaged, "repair", *state, true, 0);
}

static void test_meshes(void **state) { fail_each(read_meshes, "meshes", *state, false, 0); }

static void test_encode(void **state) {
    fail_each(encode_all, "encode", *state, false, ENCODES);
    fail_each(encode_all, "encode", *state, true, ENCODES);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decode),
        cmocka_unit_test(test_repair),
        cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_encode),
    };
    return cmocka_run_group_tests(tests, make_all, free_all);
}
