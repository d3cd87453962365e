/* SPDX-License-Identifier: MIT */
/** @file test_reference.c  Frames cut by themselves, and the tap on the encoder's images. */
#include "capture_maker.h"
#include "flat_disk.h"

#include "chart/rebuild.h"
#include "encode/reference.h"
#include "encode/stretch.h"
#include "encode/tap.h"

#define SIZE 48

/* ------------------------------------------------------------------------------------- extremum */

/* A plane with a needle in the middle. */
static void needle(double u, double v, double position[3]) {
    double d = hypot(u - 0.5, v - 0.5);
    position[0] = u, position[1] = v, position[2] = d < 0.02 ? 3 : 0;
}

static void the_extremum_is_where_the_map_stretches_most(void **state) {
    (void)state;
    gvc_disk disk;
    double *uv;
    assert_int_equal(flat_disk_make(21, 0.2, 64, needle, &disk, &uv, NULL), GVC_OK);
    assert_int_equal(gvc_stretch_extremum(&disk, uv), 10 * 21 + 10);
    /* a vertex that the uncut mesh has not is no choice, one on the border neither */
    for (size_t v = 0; v < disk.mesh.vertex_count; v++) disk.original[v] = GVC_NONE;
    disk.original[3 * 21 + 4] = 7;
    disk.original[5] = 8;
    assert_int_equal(gvc_stretch_extremum(&disk, uv), 7);
    disk.original[3 * 21 + 4] = GVC_NONE;
    assert_int_equal(gvc_stretch_extremum(&disk, uv), GVC_NONE);
    flat_disk_free(&disk, uv);
}

/* --------------------------------------------------------------------------------------- frames */

typedef struct cut_frame {
    gvc_frame_work work;
    gvc_segment segment;
    gvc_reference_report report;
    double *image;
} cut_frame;

static gvc_result try_frame(capture *frames, uint64_t number, uint32_t size, cut_frame *made,
                            gvc_error *error) {
    const gvc_source source = capture_source(frames);
    *made = (cut_frame){.work.number = number};
    made->segment.step = 4.0 / UINT16_MAX;
    for (int k = 0; k < 3; k++) made->segment.origin[k] = -2;
    made->segment.image_options.parameterize.stretch_exponent = 1.1;
    made->segment.image_options.fit = true;
    made->image = calloc((size_t)3 * size * size, sizeof *made->image);
    return gvc_reference_frame(&source, true, size, &made->work, &made->segment, made->image,
                               &made->report, error);
}

static void cut_frame_free(cut_frame *made) {
    gvc_frame_free(&made->work);
    gvc_segment_free(&made->segment);
    free(made->image);
}

static cut_frame make_frame(capture *frames, uint64_t number) {
    cut_frame made;
    gvc_error error;
    gvc_error_init(&error);
    if (try_frame(frames, number, SIZE, &made, &error) != GVC_OK) fail_msg("%s", error.message);
    return made;
}

/* The frame's surface comes back from its image: closed, of its genus, and near. */
static void check_surface(capture *frames, const cut_frame *made, double bound) {
    const gvc_segment *segment = &made->segment;
    size_t count = (size_t)3 * SIZE * SIZE;
    uint16_t *plane = calloc(count, sizeof *plane);
    gvc_mesh *mesh;
    gvc_topology before, after;
    for (size_t i = 0; i < count; i++) {
        double code = (made->image[i] - segment->origin[3 * i / count]) / segment->step;
        plane[i] = (uint16_t)lrint(fmin(fmax(code, 0), UINT16_MAX));
    }
    assert_int_equal(
        gvc_rebuild_mesh(&segment->weld, plane, segment->origin, segment->step, &mesh, NULL),
        GVC_OK);
    const gvc_mesh *original = frames->mesh[made->work.number];
    assert_int_equal(gvc_mesh_topology(original, &before, NULL), GVC_OK);
    assert_int_equal(gvc_mesh_topology(mesh, &after, NULL), GVC_OK);
    assert_true(after.closed_manifold);
    assert_int_equal(after.genus, before.genus);
    double rms = rms_distance(original, mesh);
    if (!(rms < bound)) fail_msg("RMS distance %g", rms);
    gvc_mesh_destroy(&mesh);
    free(plane);
}

static void frames_of_any_genus_are_cut(void **state) {
    (void)state;
    for (unsigned genus = 0; genus < 3; genus++) {
        capture frames = {0};
        capture_add_figure(&frames, genus, 5, 0, 1);
        cut_frame made = make_frame(&frames, 0);
        assert_int_equal(made.segment.weld.genus, genus);
        assert_int_equal(made.work.graph.node_count + 2 * genus, made.work.graph.edge_count + 1);
        check_surface(&frames, &made, 0.01);
        cut_frame_free(&made);
        capture_free(&frames);
    }
}

/* The figure has a head, two hands and two feet: two adjacent edges are a cut of stretch beyond
 * all use, and paths to its tips mend that. */
static void paths_are_added_while_stretch_falls(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 5, 0, 1);
    cut_frame made = make_frame(&frames, 0);
    assert_true(made.report.path_count >= 3);
    assert_true(made.report.stretch < 4);
    assert_int_equal(made.work.graph.edge_count,
                     made.work.graph.node_count - 1); /* a tree on a sphere */
    cut_frame_free(&made);
    capture_free(&frames);
}

static void the_same_frame_gives_the_same_image(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 1, 2, 0, 1);
    cut_frame a = make_frame(&frames, 0), b = make_frame(&frames, 0);
    assert_memory_equal(a.image, b.image, (size_t)3 * SIZE * SIZE * sizeof *a.image);
    cut_frame_free(&a);
    cut_frame_free(&b);
    capture_free(&frames);
}

static void what_cannot_be_cut_is_refused(void **state) {
    (void)state;
    capture frames = {0};
    cut_frame made;
    gvc_error error;
    const double p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t f[] = {0, 1, 2};
    assert_int_equal(gvc_mesh_create(p, 3, f, 1, &frames.mesh[frames.count++], NULL), GVC_OK);
    gvc_error_init(&error);
    assert_int_equal(try_frame(&frames, 0, SIZE, &made, &error), GVC_ERROR_MESH);
    assert_int_equal(error.frame, 0);
    assert_true(error.message[0] != '\0');
    cut_frame_free(&made);
    capture_free(&frames);
}

/* ------------------------------------------------------------------------------------------- tap
 */

typedef struct tapped {
    uint32_t size;
    unsigned calls[MAX_CAPTURE];
    double middle[MAX_CAPTURE][3];
    gvc_result fail; /* GVC_OK: does not */
} tapped;

static gvc_result look(void *user, uint64_t frame, const double *image, uint32_t size,
                       gvc_error *error) {
    tapped *t = user;
    if (t->fail != GVC_OK) return gvc_fail(error, t->fail, "seen enough");
    t->size = size;
    t->calls[frame]++;
    for (size_t k = 0; k < 3; k++) {
        t->middle[frame][k] = image[(k * size + size / 2) * size + size / 2];
    }
    return GVC_OK;
}

static gvc_result encode_tapped(capture *frames, tapped *t, bytes *file, gvc_error *error) {
    const gvc_source source = capture_source(frames);
    const gvc_sink sink = bytes_sink(file);
    const gvc_encode_options options = quick_options(33, -12, 4);
    const gvc_image_tap tap = {t, look};
    *file = (bytes){0};
    return gvc_encode_tapped(&source, &sink, &options, &tap, NULL, error);
}

static void the_tap_sees_what_is_coded(void **state) {
    (void)state;
    capture frames = {0};
    tapped seen = {0};
    bytes file;
    capture_add_figure(&frames, 0, 1, 0, 6);
    assert_int_equal(encode_tapped(&frames, &seen, &file, NULL), GVC_OK);
    gvc_encode_options options = quick_options(33, -12, 4);
    bytes plain = encode(&frames, &options, NULL);
    assert_same_bytes(&plain, &file);
    player made = player_open(&file, NULL);
    assert_int_equal(seen.size, 33);
    for (uint64_t f = 0; f < 6; f++) {
        assert_true(seen.calls[f] >= 1);
        gvc_mesh *mesh = player_frame(&made, f);
        double nearest = INFINITY;
        for (size_t v = 0; v < gvc_mesh_vertex_count(mesh); v++) {
            const double *p = gvc_mesh_positions(mesh) + 3 * v, *q = seen.middle[f];
            nearest = fmin(nearest, hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]));
        }
        assert_true(nearest < 0.005); /* a few steps of 10 bits over two metres */
        gvc_mesh_destroy(&mesh);
    }
    player_close(&made);
    bytes_free(&plain);
    bytes_free(&file);
    capture_free(&frames);
}

static void a_failing_tap_ends_the_encode(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    const gvc_result codes[] = {GVC_ERROR_CANCELLED, GVC_ERROR_MESH};
    for (int i = 0; i < 2; i++) {
        tapped seen = {.fail = codes[i]};
        bytes file;
        gvc_error error;
        gvc_error_init(&error);
        assert_int_equal(encode_tapped(&frames, &seen, &file, &error), codes[i]);
        assert_string_equal(error.message, "seen enough");
        bytes_free(&file);
    }
    capture_free(&frames);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_extremum_is_where_the_map_stretches_most),
        cmocka_unit_test(frames_of_any_genus_are_cut),
        cmocka_unit_test(paths_are_added_while_stretch_falls),
        cmocka_unit_test(the_same_frame_gives_the_same_image),
        cmocka_unit_test(what_cannot_be_cut_is_refused),
        cmocka_unit_test(the_tap_sees_what_is_coded),
        cmocka_unit_test(a_failing_tap_ends_the_encode),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
