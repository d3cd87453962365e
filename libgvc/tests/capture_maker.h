/* SPDX-License-Identifier: MIT */
/** @file capture_maker.h  Captures made on the spot, encoded to memory: for tests of the whole
 *  chain through the public interface. Makers assert their own success. */
#ifndef GVC_TESTS_CAPTURE_MAKER_H
#define GVC_TESTS_CAPTURE_MAKER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "gvc/gvc.h"

#include "synth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_CAPTURE 16

/* ------------------------------------------------------------------------------------- captures */

/** A few meshes that serve as a source. */
typedef struct capture {
    gvc_mesh *mesh[MAX_CAPTURE];
    size_t count;
} capture;

static inline gvc_mesh *mesh_copy(const gvc_mesh *mesh) {
    gvc_mesh *copy;
    assert_int_equal(gvc_mesh_create(gvc_mesh_positions(mesh), gvc_mesh_vertex_count(mesh),
                                     gvc_mesh_faces(mesh), gvc_mesh_face_count(mesh), &copy, NULL),
                     GVC_OK);
    return copy;
}

/** The mesh with each coordinate times `scale`, plus `offset`. */
static inline gvc_mesh *mesh_moved(const gvc_mesh *mesh, double scale, double offset) {
    size_t count = 3 * gvc_mesh_vertex_count(mesh);
    double *position = malloc(count * sizeof *position);
    gvc_mesh *moved;
    assert_non_null(position);
    for (size_t i = 0; i < count; i++) position[i] = scale * gvc_mesh_positions(mesh)[i] + offset;
    assert_int_equal(gvc_mesh_create(position, count / 3, gvc_mesh_faces(mesh),
                                     gvc_mesh_face_count(mesh), &moved, NULL),
                     GVC_OK);
    free(position);
    return moved;
}

static inline gvc_result capture_read(void *user, uint64_t frame, gvc_mesh **mesh,
                                      gvc_error *error) {
    const gvc_mesh *kept = ((const capture *)user)->mesh[frame];
    return gvc_mesh_create(gvc_mesh_positions(kept), gvc_mesh_vertex_count(kept),
                           gvc_mesh_faces(kept), gvc_mesh_face_count(kept), mesh, error);
}

static inline gvc_source capture_source(capture *frames) {
    return (gvc_source){.user = frames, .frame_count = frames->count, .read = capture_read};
}

static inline void capture_free(capture *frames) {
    for (size_t i = 0; i < frames->count; i++) gvc_mesh_destroy(&frames->mesh[i]);
    frames->count = 0;
}

/** `count` frames of the dancing figure; frames [first, first + count) of its dance. */
static inline void capture_add_figure(capture *frames, unsigned genus, uint64_t seed,
                                      uint64_t first, size_t count) {
    synth_options options;
    synth_options_init(&options);
    options.genus = genus;
    options.seed = seed;
    options.vertex_count = 1500 + 500 * genus;
    for (size_t i = 0; i < count; i++) {
        gvc_mesh **mesh = &frames->mesh[frames->count++];
        assert_true(frames->count <= MAX_CAPTURE);
        assert_int_equal(synth_frame(&options, first + i, mesh, NULL), GVC_OK);
    }
}

/* -------------------------------------------------------------------------------------- shapes */

/** Grid of columns x rows points, closed to a torus in both directions, or, if `poles`, to a sphere
 *  by one pole before the first row and one after the last. Positions are filled by the caller:
 *  point (i, j) is at i + columns * j, poles at the end. */
static inline gvc_mesh *mesh_from_grid(const double *position, uint32_t columns, uint32_t rows,
                                       bool poles) {
    size_t vertices = (size_t)columns * rows + (poles ? 2 : 0);
    uint32_t *face = calloc(6 * (size_t)columns * (rows + 1), sizeof *face), *at = face;
    uint32_t first_pole = columns * rows, last_pole = first_pole + 1;
    assert_non_null(face);
    for (uint32_t i = 0; i < columns; i++) {
        uint32_t next = (i + 1) % columns;
        for (uint32_t j = 0; j + (poles ? 1 : 0) < rows; j++) {
            uint32_t a = i + columns * j, b = next + columns * j;
            uint32_t c = next + columns * ((j + 1) % rows), d = i + columns * ((j + 1) % rows);
            *at++ = a, *at++ = b, *at++ = c, *at++ = a, *at++ = c, *at++ = d;
        }
        if (poles) {
            uint32_t top = columns * (rows - 1);
            *at++ = first_pole, *at++ = next, *at++ = i;
            *at++ = last_pole, *at++ = top + i, *at++ = top + next;
        }
    }
    gvc_mesh *mesh;
    assert_int_equal(
        gvc_mesh_create(position, vertices, face, (size_t)(at - face) / 3, &mesh, NULL), GVC_OK);
    free(face);
    return mesh;
}

/** Ellipsoid with half axes x, y, z; the poles lie on z. `phase` turns its connectivity. */
static inline gvc_mesh *mesh_ellipsoid(double x, double y, double z, uint32_t columns,
                                       uint32_t rows, double phase) {
    const double pi = acos(-1);
    double *position = calloc(3 * ((size_t)columns * rows + 2), sizeof *position), *p = position;
    assert_non_null(position);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            double polar = pi * (rows - j) / (rows + 1), azimuth = 2 * pi * i / columns + phase;
            *p++ = x * sin(polar) * cos(azimuth);
            *p++ = y * sin(polar) * sin(azimuth);
            *p++ = z * cos(polar);
        }
    p[2] = -z, p[5] = z;
    gvc_mesh *mesh = mesh_from_grid(position, columns, rows, true);
    free(position);
    return mesh;
}

/** Torus of radius 1 around z with a tube of radius `tube`. */
static inline gvc_mesh *mesh_torus(double tube, uint32_t columns, uint32_t rows, double phase) {
    const double pi = acos(-1);
    double *position = calloc(3 * (size_t)columns * rows, sizeof *position), *p = position;
    assert_non_null(position);
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            double u = 2 * pi * i / columns + phase, v = 2 * pi * j / rows;
            *p++ = (1 + tube * cos(v)) * cos(u);
            *p++ = (1 + tube * cos(v)) * sin(u);
            *p++ = tube * sin(v);
        }
    gvc_mesh *mesh = mesh_from_grid(position, columns, rows, false);
    free(position);
    return mesh;
}

/** Box with sharp edges, half sides x, y, z, n squares a side. */
static inline gvc_mesh *mesh_box(double x, double y, double z, uint32_t n) {
    double *position = calloc(18 * (size_t)(n + 1) * (n + 1), sizeof *position), *p = position;
    uint32_t *face = calloc(36 * (size_t)n * n, sizeof *face), *at = face;
    uint32_t *number = malloc((size_t)(n + 1) * (n + 1) * (n + 1) * sizeof *number), count = 0;
    const double half[3] = {x, y, z};
    assert_true(position && face && number);
    memset(number, 0xff, (size_t)(n + 1) * (n + 1) * (n + 1) * sizeof *number);
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t end = 0; end <= n; end += n)
            for (uint32_t j = 0; j < n; j++)
                for (uint32_t i = 0; i < n; i++) {
                    uint32_t corner[4];
                    for (uint32_t c = 0; c < 4; c++) {
                        uint32_t cell[3];
                        cell[axis] = end;
                        cell[(axis + 1) % 3] = i + (c == 1 || c == 2);
                        cell[(axis + 2) % 3] = j + (c >= 2);
                        size_t key = cell[0] + (size_t)(n + 1) * (cell[1] + (n + 1) * cell[2]);
                        if (number[key] == UINT32_MAX) {
                            for (int k = 0; k < 3; k++) *p++ = half[k] * (2.0 * cell[k] / n - 1);
                            number[key] = count++;
                        }
                        corner[end ? c : 3 - c] = number[key];
                    }
                    *at++ = corner[0], *at++ = corner[1], *at++ = corner[2];
                    *at++ = corner[0], *at++ = corner[2], *at++ = corner[3];
                }
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_create(position, count, face, (size_t)(at - face) / 3, &mesh, NULL),
                     GVC_OK);
    free(position), free(face), free(number);
    return mesh;
}

/* -------------------------------------------------------------------------------------- coding */

typedef struct bytes {
    uint8_t *data;
    size_t size, capacity;
    size_t room; /**< write fails past so many bytes; 0: never */
} bytes;

static inline gvc_result bytes_write(void *user, const void *data, size_t size, gvc_error *error) {
    bytes *file = user;
    if (file->room && file->size + size > file->room) {
        snprintf(error->message, sizeof error->message, "the sink is full");
        return error->code = GVC_ERROR_IO;
    }
    if (file->size + size > file->capacity) {
        file->capacity = 2 * (file->size + size);
        file->data = realloc(file->data, file->capacity);
        assert_non_null(file->data);
    }
    memcpy(file->data + file->size, data, size);
    file->size += size;
    return GVC_OK;
}

static inline gvc_sink bytes_sink(bytes *file) {
    return (gvc_sink){.user = file, .write = bytes_write};
}

static inline void bytes_free(bytes *file) {
    free(file->data);
    *file = (bytes){0};
}

/** Options of a quick encode: fixed size and rate factor, two threads. */
static inline gvc_encode_options quick_options(uint32_t image_size, double crf, uint32_t gop) {
    gvc_encode_options options;
    gvc_encode_options_init(&options);
    options.image_size = image_size;
    options.crf = crf;
    options.gop = gop;
    options.threads = 2;
    return options;
}

/** Encodes or fails the test, telling why. */
static inline bytes encode(capture *frames, const gvc_encode_options *options,
                           gvc_encode_report *report) {
    bytes file = {0};
    gvc_error error;
    gvc_error_init(&error);
    gvc_source source = capture_source(frames);
    gvc_sink sink = bytes_sink(&file);
    if (gvc_encode(&source, &sink, options, report, &error) != GVC_OK) {
        fail_msg("size %u, crf %g: frame %lld: %s", options->image_size, options->crf,
                 (long long)error.frame, error.message);
    }
    assert_int_equal(error.code, GVC_OK); /* nothing is left of what was tried in vain */
    assert_string_equal(error.message, "");
    return file;
}

static inline void assert_same_bytes(const bytes *a, const bytes *b) {
    assert_int_equal(a->size, b->size);
    assert_memory_equal(a->data, b->data, a->size);
}

static inline void assert_same_mesh(const gvc_mesh *a, const gvc_mesh *b) {
    assert_int_equal(gvc_mesh_vertex_count(a), gvc_mesh_vertex_count(b));
    assert_int_equal(gvc_mesh_face_count(a), gvc_mesh_face_count(b));
    assert_memory_equal(gvc_mesh_positions(a), gvc_mesh_positions(b),
                        3 * gvc_mesh_vertex_count(a) * sizeof(double));
    assert_memory_equal(gvc_mesh_faces(a), gvc_mesh_faces(b),
                        3 * gvc_mesh_face_count(a) * sizeof(uint32_t));
}

/** A reader and one decoder of it. */
typedef struct player {
    gvc_reader *reader;
    gvc_decoder *decoder;
} player;

static inline player player_open(const bytes *file, const gvc_read_options *options) {
    player made;
    gvc_error error;
    gvc_error_init(&error);
    if (gvc_reader_open_memory(file->data, file->size, options, &made.reader, &error) != GVC_OK) {
        fail_msg("cannot open: byte %llu: %s: %s", (unsigned long long)error.offset, error.where,
                 error.message);
    }
    assert_int_equal(gvc_decoder_create(made.reader, &made.decoder, NULL), GVC_OK);
    return made;
}

static inline void player_close(player *made) {
    gvc_decoder_destroy(&made->decoder);
    gvc_reader_close(&made->reader);
}

static inline gvc_mesh *player_frame(const player *made, uint64_t frame) {
    gvc_mesh *mesh;
    gvc_error error;
    gvc_error_init(&error);
    if (gvc_decoder_frame(made->decoder, frame, &mesh, &error) != GVC_OK) {
        fail_msg("frame %llu: %s", (unsigned long long)frame, error.message);
    }
    return mesh;
}

#define NO_BOUND 1.0 /**< settings so coarse that only the topology is promised */

/* Of the worse direction, as a fraction of the diagonal. */
static inline double rms_distance(const gvc_mesh *original, const gvc_mesh *mesh) {
    gvc_distance d;
    assert_int_equal(gvc_mesh_distance(original, mesh, 2000, &d, NULL), GVC_OK);
    return fmax(d.rms[0], d.rms[1]) / d.diagonal;
}

/* Decodes every frame (which verifies its digest) and checks it against the original; `bound` is on
 * the RMS distance. */
static inline void check_frames(const bytes *file, const capture *original, double bound) {
    player made = player_open(file, NULL);
    gvc_info info;
    gvc_reader_info(made.reader, &info);
    assert_int_equal(info.frame_count, original->count);
    assert_int_equal(info.declared_count, original->count);
    for (size_t i = 0; i < original->count; i++) {
        gvc_mesh *mesh = player_frame(&made, i);
        gvc_topology before, after;
        gvc_frame_info facts;
        assert_int_equal(gvc_mesh_topology(original->mesh[i], &before, NULL), GVC_OK);
        assert_int_equal(gvc_mesh_topology(mesh, &after, NULL), GVC_OK);
        assert_int_equal(gvc_reader_frame_info(made.reader, i, &facts, NULL), GVC_OK);
        assert_true(after.closed_manifold);
        assert_int_equal(after.component_count, 1);
        assert_int_equal(after.genus, before.genus);
        assert_int_equal(facts.genus, before.genus);
        assert_int_equal(after.degenerate_face_count + after.duplicate_face_count, 0);
        assert_int_equal(after.unreferenced_vertex_count, 0);
        if (bound < NO_BOUND) {
            double rms = rms_distance(original->mesh[i], mesh);
            if (!(rms <= bound)) fail_msg("frame %zu: RMS distance %g exceeds %g", i, rms, bound);
        }
        gvc_mesh_destroy(&mesh);
    }
    player_close(&made);
}

#endif
