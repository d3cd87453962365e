/* SPDX-License-Identifier: MIT */
/** @file test_api.c  The public interface: ways to open a file, limits, refusals of bad sources,
 *  sinks and arguments, and what their errors say. */
#include "capture_maker.h"

#include <unistd.h>

/* ---------------------------------------------------------------------------------- bad sources */

/* A good capture of which one frame is another mesh, or fails. */
typedef struct bad_source {
    capture *good;
    uint64_t frame;
    const gvc_mesh *mesh; /* NULL: reading fails */
    bool silent;          /* without saying why */
} bad_source;

static gvc_result bad_read(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    const bad_source *source = user;
    if (frame != source->frame) return capture_read(source->good, frame, mesh, error);
    *mesh = NULL;
    if (source->mesh) {
        *mesh = mesh_copy(source->mesh);
        return GVC_OK;
    }
    if (source->silent) return GVC_ERROR_IO;
    snprintf(error->message, sizeof error->message, "the camera is off");
    return error->code = GVC_ERROR_IO;
}

static const char *bad_name(void *user, uint64_t frame) {
    static const char *const name[] = {"zero.obj", "one.obj", "two.obj"};
    (void)user;
    return name[frame % 3];
}

static gvc_error refuse(bad_source *bad, gvc_result expected) {
    bytes file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_source source = {
        .user = bad, .frame_count = bad->good->count, .read = bad_read, .name = bad_name};
    gvc_sink sink = bytes_sink(&file);
    gvc_encode_options options = quick_options(17, 30, 60);
    assert_int_equal(gvc_encode(&source, &sink, &options, NULL, &error), expected);
    assert_int_equal(error.code, expected);
    assert_int_equal(error.frame, (int64_t)bad->frame);
    assert_int_equal(file.size, 0);
    bytes_free(&file);
    return error;
}

static capture three_spheres(void) {
    capture frames = {.count = 3};
    for (int i = 0; i < 3; i++)
        frames.mesh[i] = mesh_ellipsoid(1, 1, 1.5 + 0.1 * i, 16, 12, 0.1 * i);
    return frames;
}

static void a_failing_read_names_its_frame(void **state) {
    (void)state;
    capture good = three_spheres();
    for (uint64_t frame = 0; frame < 3; frame++) {
        bad_source bad = {.good = &good, .frame = frame};
        gvc_error error = refuse(&bad, GVC_ERROR_IO);
        assert_string_equal(error.message, "the camera is off");
        assert_string_equal(error.where, bad_name(NULL, frame));
        bad.silent = true;
        error = refuse(&bad, GVC_ERROR_IO);
        assert_true(error.message[0] != '\0');
    }
    capture_free(&good);
}

/* Copy of a mesh without its first `drop` faces and with `extra` ones. */
static gvc_mesh *edited(const gvc_mesh *mesh, size_t drop, const uint32_t (*extra)[3],
                        size_t extra_count) {
    size_t kept = gvc_mesh_face_count(mesh) - drop;
    uint32_t *face = malloc(3 * (kept + extra_count) * sizeof *face + 1);
    gvc_mesh *made;
    assert_non_null(face);
    memcpy(face, gvc_mesh_faces(mesh) + 3 * drop, 3 * kept * sizeof *face);
    if (extra_count) memcpy(face + 3 * kept, extra, 3 * extra_count * sizeof *face);
    assert_int_equal(gvc_mesh_create(gvc_mesh_positions(mesh), gvc_mesh_vertex_count(mesh), face,
                                     kept + extra_count, &made, NULL),
                     GVC_OK);
    free(face);
    return made;
}

static gvc_mesh *two_copies(const gvc_mesh *mesh) {
    size_t v = gvc_mesh_vertex_count(mesh), f = gvc_mesh_face_count(mesh);
    double *position = malloc(6 * v * sizeof *position);
    uint32_t *face = malloc(6 * f * sizeof *face);
    gvc_mesh *made;
    assert_true(position && face);
    for (size_t i = 0; i < 6 * v; i++)
        position[i] = gvc_mesh_positions(mesh)[i % (3 * v)] + (i < 3 * v ? 0 : 7);
    for (size_t i = 0; i < 6 * f; i++)
        face[i] = gvc_mesh_faces(mesh)[i % (3 * f)] + (uint32_t)(i < 3 * f ? 0 : v);
    assert_int_equal(gvc_mesh_create(position, 2 * v, face, 2 * f, &made, NULL), GVC_OK);
    free(position), free(face);
    return made;
}

static void check_refused_mesh(capture *good, gvc_mesh *mesh, const char *count, const char *word) {
    bad_source bad = {.good = good, .frame = 1, .mesh = mesh};
    gvc_error error = refuse(&bad, GVC_ERROR_MESH);
    assert_string_equal(error.where, "one.obj");
    if (!strstr(error.message, count) || !strstr(error.message, word)) {
        fail_msg("\"%s\" does not tell of %s %s", error.message, count, word);
    }
    gvc_mesh_destroy(&mesh);
}

static void unsuitable_meshes_are_named_and_counted(void **state) {
    (void)state;
    capture good = three_spheres();
    const gvc_mesh *sphere = good.mesh[0];
    const uint32_t *f = gvc_mesh_faces(sphere);
    const uint32_t fin[1][3] = {{f[0], f[1], (f[0] + f[1] + 90) % 190}};
    const uint32_t flipped[1][3] = {{f[0], f[2], f[1]}};
    check_refused_mesh(&good, edited(sphere, 1, NULL, 0), "3", "boundary");
    check_refused_mesh(&good, edited(sphere, 0, fin, 1), "1", "not manifold");
    check_refused_mesh(&good, edited(sphere, 1, flipped, 1), "3", "orient");
    check_refused_mesh(&good, two_copies(sphere), "2", "components");
    check_refused_mesh(&good, edited(sphere, gvc_mesh_face_count(sphere), NULL, 0), "no", "faces");
    check_refused_mesh(&good, mesh_moved(sphere, -1e38, 0), "e+37", "coordinate");
    check_refused_mesh(&good, mesh_moved(sphere, 1e-34, 0), "e-34", "across");
    capture_free(&good);
}

/* A ball with small tips all over, at the points of a spiral. */
static gvc_mesh *thorny_ball(unsigned tips) {
    gvc_mesh *ball = mesh_ellipsoid(1, 1, 1, 24, 16, 0), *made;
    size_t v = gvc_mesh_vertex_count(ball);
    double *position = malloc(3 * v * sizeof *position);
    assert_non_null(position);
    memcpy(position, gvc_mesh_positions(ball), 3 * v * sizeof *position);
    for (size_t i = 0; i < v; i++) {
        double *p = position + 3 * i, nearest = -1;
        for (unsigned t = 0; t < tips; t++) {
            double z = (2 * t + 1.0) / tips - 1, r = sqrt(1 - z * z), turn = 2.4 * t;
            nearest = fmax(nearest, p[0] * r * cos(turn) + p[1] * r * sin(turn) + p[2] * z);
        }
        double scale = 1 + 0.2 * exp(40 * (nearest - 1));
        for (int k = 0; k < 3; k++) p[k] *= scale;
    }
    assert_int_equal(
        gvc_mesh_create(position, v, gvc_mesh_faces(ball), gvc_mesh_face_count(ball), &made, NULL),
        GVC_OK);
    free(position);
    gvc_mesh_destroy(&ball);
    return made;
}

/* More cut edges than steps fit round an image of 16 x 16: cuts to all tips are tried in vain. */
static void cuts_that_do_not_fit_are_done_without(void **state) {
    (void)state;
    capture frames = {.count = 1, .mesh = {thorny_ball(20)}};
    gvc_encode_options options = quick_options(16, 30, 60);
    options.longest_edge = 0.1;
    options.best_effort = true;
    bytes file = encode(&frames, &options, NULL);
    bytes_free(&file);
    capture_free(&frames);
}

static void a_point_is_no_surface(void **state) {
    (void)state;
    capture good = three_spheres();
    gvc_mesh *mesh = mesh_moved(good.mesh[0], 0, 0);
    bad_source bad = {.good = &good, .frame = 2, .mesh = mesh};
    (void)refuse(&bad, GVC_ERROR_MESH);
    gvc_mesh_destroy(&mesh);
    capture_free(&good);
}

static void meshes_are_checked_when_made(void **state) {
    (void)state;
    static const double good[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t face[3] = {0, 1, 2}, beyond[3] = {0, 1, 3};
    gvc_mesh *mesh = (gvc_mesh *)(uintptr_t)1;
    gvc_error error;
    gvc_error_init(&error);
    assert_int_equal(gvc_mesh_create(good, 3, beyond, 1, &mesh, &error), GVC_ERROR_MESH);
    assert_null(mesh);
    assert_true(strstr(error.message, "3") != NULL);
    for (int i = 0; i < 3; i++) {
        double bad[9];
        const double value[3] = {NAN, INFINITY, -INFINITY};
        memcpy(bad, good, sizeof bad);
        bad[4] = value[i];
        assert_int_equal(gvc_mesh_create(bad, 3, face, 1, &mesh, &error), GVC_ERROR_MESH);
        assert_null(mesh);
    }
}

/* ---------------------------------------------------------------------------- sinks, cancelling */

static void a_failing_sink_fails_the_encode(void **state) {
    (void)state;
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 30, 1);
    bytes whole = encode(&frames, &options, NULL);
    for (size_t room = 1; room < whole.size; room += 1 + whole.size / 4) {
        bytes file = {.room = room};
        gvc_source source = capture_source(&frames);
        gvc_sink sink = bytes_sink(&file);
        gvc_error error;
        gvc_error_init(&error);
        assert_int_equal(gvc_encode(&source, &sink, &options, NULL, &error), GVC_ERROR_IO);
        assert_string_equal(error.message, "the sink is full");
        assert_memory_equal(file.data ? file.data : whole.data, whole.data, file.size);
        bytes_free(&file);
    }
    bytes_free(&whole);
    capture_free(&frames);
}

typedef struct countdown {
    int left;
    uint64_t done[2], total;
    bool backwards;
} countdown;

static bool count_down(void *user, gvc_stage stage, uint64_t done, uint64_t total) {
    countdown *c = user;
    c->backwards |= done < c->done[stage] || done > total;
    c->done[stage] = done;
    c->total = total;
    return c->left-- > 0;
}

static void progress_can_cancel(void **state) {
    (void)state;
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 30, 1);
    bool finished = false;
    for (int calls = 0; !finished; calls++) {
        countdown c = {.left = calls};
        bytes file = {0};
        gvc_error error;
        gvc_error_init(&error);
        gvc_source source = capture_source(&frames);
        gvc_sink sink = bytes_sink(&file);
        options.progress = count_down;
        options.user = &c;
        gvc_result result = gvc_encode(&source, &sink, &options, NULL, &error);
        finished = result == GVC_OK;
        if (!finished) {
            assert_int_equal(result, GVC_ERROR_CANCELLED);
            assert_int_equal(error.code, GVC_ERROR_CANCELLED);
            assert_int_equal(c.left, -1); /* not asked again after it said no */
        } else {
            assert_true(calls >= 4);
            assert_int_equal(c.done[GVC_STAGE_SCAN], 3);
            assert_int_equal(c.done[GVC_STAGE_ENCODE], 3);
        }
        assert_int_equal(c.total, 3);
        assert_false(c.backwards);
        bytes_free(&file);
        assert_true(calls < 100);
    }
    capture_free(&frames);
}

static void check_options_refused(const gvc_encode_options *options, uint64_t frame_count) {
    capture frames = three_spheres();
    bytes file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_source source = capture_source(&frames);
    gvc_sink sink = bytes_sink(&file);
    source.frame_count = frame_count;
    assert_int_equal(gvc_encode(&source, &sink, options, NULL, &error), GVC_ERROR_ARGUMENT);
    assert_true(error.message[0] != '\0');
    assert_int_equal(file.size, 0);
    capture_free(&frames);
}

static void bad_encode_options_are_refused(void **state) {
    (void)state;
    const gvc_encode_options good = quick_options(17, 30, 60);
    gvc_encode_options o = good;
    check_options_refused(&good, 0);
    o.struct_size--;
    check_options_refused(&o, 3);
    static const uint32_t sizes[] = {1, 15, 2050, UINT32_MAX};
    for (int i = 0; i < 4; i++) {
        o = good, o.image_size = sizes[i];
        check_options_refused(&o, 3);
    }
    static const double crfs[] = {-12.5, 51.5, INFINITY};
    for (int i = 0; i < 3; i++) {
        o = good, o.crf = crfs[i];
        check_options_refused(&o, 3);
    }
    static const double errors[] = {0, -1, 1, NAN};
    for (int i = 0; i < 4; i++) {
        o = good, o.max_rms = errors[i];
        check_options_refused(&o, 3);
    }
    o = good, o.gop = 0;
    check_options_refused(&o, 3);
    o = good, o.frame_rate_den = 0;
    check_options_refused(&o, 3);
    o = good, o.persistence = NAN;
    check_options_refused(&o, 3);
    o = good, o.prior_weight = -1;
    check_options_refused(&o, 3);
}

static void an_error_out_of_reach_is_told(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    gvc_encode_options options = quick_options(16, NAN, 60);
    options.max_rms = 1e-6;
    bytes file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_source source = capture_source(&frames);
    gvc_sink sink = bytes_sink(&file);
    assert_int_equal(gvc_encode(&source, &sink, &options, NULL, &error), GVC_ERROR_QUALITY);
    assert_int_equal(error.frame, 0);
    assert_true(strstr(error.message, "16") != NULL);
    bytes_free(&file);
    capture_free(&frames);
}

/* -------------------------------------------------------------------------------------- readers */

static gvc_result io_read(void *user, uint64_t offset, void *data, size_t size, gvc_error *error) {
    const bytes *file = user;
    (void)error;
    assert_true(offset <= file->size && size <= file->size - offset);
    memcpy(data, file->data + offset, size);
    return GVC_OK;
}

static gvc_result io_fail(void *user, uint64_t offset, void *data, size_t size, gvc_error *error) {
    (void)user, (void)offset;
    memset(data, 0, size);
    snprintf(error->message, sizeof error->message, "the line is dead");
    return error->code = GVC_ERROR_IO;
}

static void check_same_content(gvc_reader *a, gvc_reader *b) {
    player one = {.reader = a}, two = {.reader = b};
    gvc_info x, y;
    gvc_reader_info(a, &x);
    gvc_reader_info(b, &y);
    assert_int_equal(x.byte_count, y.byte_count);
    assert_int_equal(x.frame_count, y.frame_count);
    assert_int_equal(x.gop_count, y.gop_count);
    assert_string_equal(x.encoder, y.encoder);
    assert_int_equal(gvc_decoder_create(a, &one.decoder, NULL), GVC_OK);
    assert_int_equal(gvc_decoder_create(b, &two.decoder, NULL), GVC_OK);
    for (uint64_t i = 0; i < x.frame_count; i++) {
        gvc_mesh *first = player_frame(&one, i), *second = player_frame(&two, i);
        assert_same_mesh(first, second);
        gvc_mesh_destroy(&first);
        gvc_mesh_destroy(&second);
    }
    gvc_decoder_destroy(&one.decoder);
    gvc_decoder_destroy(&two.decoder);
}

static void file_memory_and_callbacks_agree(void **state) {
    (void)state;
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 20, 2);
    bytes file = encode(&frames, &options, NULL);
    char path[] = "test_api-XXXXXX";
    int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    assert_int_equal(write(descriptor, file.data, file.size), file.size);
    close(descriptor);

    gvc_io io = {.user = &file, .size = file.size, .read = io_read};
    gvc_reader *from_file, *from_memory, *from_io;
    assert_int_equal(gvc_reader_open_file(path, NULL, &from_file, NULL), GVC_OK);
    assert_int_equal(gvc_reader_open_memory(file.data, file.size, NULL, &from_memory, NULL),
                     GVC_OK);
    assert_int_equal(gvc_reader_open_io(&io, NULL, &from_io, NULL), GVC_OK);
    unlink(path); /* an open file needs no name */
    check_same_content(from_file, from_memory);
    check_same_content(from_memory, from_io);
    gvc_reader_close(&from_file);
    gvc_reader_close(&from_memory);
    gvc_reader_close(&from_io);
    assert_null(from_io);
    gvc_reader_close(&from_io); /* closing twice is fine */

    gvc_error error;
    gvc_error_init(&error);
    io.read = io_fail;
    assert_int_equal(gvc_reader_open_io(&io, NULL, &from_io, &error), GVC_ERROR_IO);
    assert_string_equal(error.message, "the line is dead");
    assert_null(from_io);
    assert_int_equal(gvc_reader_open_file(path, NULL, &from_file, &error), GVC_ERROR_IO);
    assert_int_equal(gvc_reader_open_file("/", NULL, &from_file, &error), GVC_ERROR_IO);
    assert_null(from_file);
    bytes_free(&file);
    capture_free(&frames);
}

static void options_are_recorded(void **state) {
    (void)state;
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 20, 2);
    options.frame_rate_num = 30000;
    options.frame_rate_den = 1001;
    snprintf(options.unit, sizeof options.unit, "mm");
    bytes file = encode(&frames, &options, NULL);
    player made = player_open(&file, NULL);
    gvc_info info;
    gvc_reader_info(made.reader, &info);
    assert_int_equal(info.frame_rate_num, 30000);
    assert_int_equal(info.frame_rate_den, 1001);
    assert_string_equal(info.unit, "mm");
    assert_int_equal(info.image_size, 17);
    assert_int_equal(info.declared_count, 3);
    assert_int_equal(info.byte_count, file.size);
    assert_int_equal(info.damage_count, 0);
    player_close(&made);
    bytes_free(&file);
    capture_free(&frames);
}

static gvc_result open_limited(const bytes *file, const gvc_read_options *options) {
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_reader_open_memory(file->data, file->size, options, &reader, &error);
    if (result == GVC_OK) {
        result = gvc_decoder_create(reader, &decoder, &error);
        gvc_decoder_destroy(&decoder);
    }
    if (result != GVC_OK) assert_true(error.message[0] != '\0');
    gvc_reader_close(&reader);
    return result;
}

static void limits_hold(void **state) {
    (void)state;
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 20, 2);
    bytes file = encode(&frames, &options, NULL);
    gvc_read_options defaults, o;
    gvc_read_options_init(&defaults);
    assert_int_equal(open_limited(&file, &defaults), GVC_OK);
    for (int keep_going = 0; keep_going < 2; keep_going++) {
        defaults.keep_going = keep_going;
        o = defaults, o.max_frames = 3, o.max_image_size = 17;
        assert_int_equal(open_limited(&file, &o), GVC_OK);
        o = defaults, o.max_frames = 2;
        assert_int_equal(open_limited(&file, &o), GVC_ERROR_LIMIT);
        o = defaults, o.max_image_size = 16;
        assert_int_equal(open_limited(&file, &o), GVC_ERROR_LIMIT);
        o = defaults, o.max_memory = 10000;
        assert_int_equal(open_limited(&file, &o), GVC_ERROR_LIMIT);
    }
    o = defaults, o.struct_size++;
    assert_int_equal(open_limited(&file, &o), GVC_ERROR_ARGUMENT);
    bytes_free(&file);
    capture_free(&frames);
}

static void frames_out_of_range_are_refused(void **state) {
    (void)state;
    static const uint64_t outside[] = {3, 4, 1u << 31, UINT64_MAX};
    capture frames = three_spheres();
    gvc_encode_options options = quick_options(17, 20, 2);
    bytes file = encode(&frames, &options, NULL);
    player made = player_open(&file, NULL);
    for (int i = 0; i < 4; i++) {
        gvc_mesh *mesh = (gvc_mesh *)(uintptr_t)1;
        gvc_frame_info info;
        assert_int_equal(gvc_decoder_frame(made.decoder, outside[i], &mesh, NULL),
                         GVC_ERROR_ARGUMENT);
        assert_null(mesh);
        assert_int_equal(gvc_reader_frame_info(made.reader, outside[i], &info, NULL),
                         GVC_ERROR_ARGUMENT);
        mesh = player_frame(&made, 2);
        gvc_mesh_destroy(&mesh);
    }
    player_close(&made);
    bytes_free(&file);
    capture_free(&frames);
}

static void destroying_nothing_is_fine(void **state) {
    (void)state;
    gvc_mesh *mesh = NULL;
    gvc_reader *reader = NULL;
    gvc_decoder *decoder = NULL;
    gvc_mesh_destroy(&mesh), gvc_mesh_destroy(NULL);
    gvc_reader_close(&reader), gvc_reader_close(NULL);
    gvc_decoder_destroy(&decoder), gvc_decoder_destroy(NULL);
    gvc_error_init(NULL);
    for (int i = -1; i < 120; i++) assert_non_null(gvc_result_string((gvc_result)i));
    assert_non_null(gvc_version());
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_failing_read_names_its_frame),
        cmocka_unit_test(unsuitable_meshes_are_named_and_counted),
        cmocka_unit_test(cuts_that_do_not_fit_are_done_without),
        cmocka_unit_test(a_point_is_no_surface),
        cmocka_unit_test(meshes_are_checked_when_made),
        cmocka_unit_test(a_failing_sink_fails_the_encode),
        cmocka_unit_test(progress_can_cancel),
        cmocka_unit_test(bad_encode_options_are_refused),
        cmocka_unit_test(an_error_out_of_reach_is_told),
        cmocka_unit_test(file_memory_and_callbacks_agree),
        cmocka_unit_test(options_are_recorded),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(frames_out_of_range_are_refused),
        cmocka_unit_test(destroying_nothing_is_fine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
