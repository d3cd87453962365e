/* SPDX-License-Identifier: MIT */
/** @file fuzz_encode.c  Fuzzes the encoder with tiny meshes: good ones, and what bytes make of
 * them.
 *
 * Input: a byte that picks the mesh and what is asked for (below), a byte of quality, a byte of the
 * seed of small motions, then edits of four bytes each, the first of which picks what is done. */
#include "encoding.h"
#include "require.h"
#include "soup.h"

enum {               /* of the first byte */
       BASE = 3,     /* tetrahedron, octahedron, torus, nothing */
       LOSSLESS = 4, /* exact codes */
       PREVIEW = 8,  /* and pictures; of a lossless one only */
       SEARCH = 16,  /* the error is given, not the rate factor */
       LARGER = 32,  /* images of 24 samples a side, not 16 */
       MORE_FRAMES = 64,
       GROUPS = 128 /* of one frame each */
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static double small(uint8_t byte) { return ((int)byte - 128) / 64.0; }

static void edit(soup *s, const uint8_t byte[4]) {
    size_t vertex = s->vertex_count ? byte[1] % s->vertex_count : 0;
    size_t face = s->face_count ? byte[1] % s->face_count : 0;
    switch (byte[0] % 8) {
    case 0: /* move a vertex */
    case 1:
        if (s->vertex_count) s->position[3 * vertex + byte[2] % 3] += small(byte[3]);
        break;
    case 2: /* to where another one is, or far away */
        if (s->vertex_count) s->position[3 * vertex + byte[2] % 3] = ldexp(small(byte[3]), byte[2]);
        break;
    case 3:
        if (s->face_count) soup_split(s, face, 1 + small(byte[2]) / 4);
        break;
    case 4: /* any vertex in a face */
        if (s->face_count) s->face[3 * face + byte[2] % 3] = byte[3] % SOUP_VERTICES;
        break;
    case 5: /* a face less */
        if (s->face_count) {
            s->face_count--;
            memcpy(&s->face[3 * face], &s->face[3 * s->face_count], 3 * sizeof *s->face);
        }
        break;
    case 6:
        soup_face(s, byte[1] % SOUP_VERTICES, byte[2] % SOUP_VERTICES, byte[3] % SOUP_VERTICES);
        break;
    default:
        soup_vertex(s, small(byte[1]), small(byte[2]), small(byte[3]));
    }
}

static void make_soup(const uint8_t *data, size_t size, soup *s) {
    static void (*const base[3])(soup *) = {soup_tetrahedron, soup_octahedron, soup_torus};
    *s = (soup){0};
    if ((data[0] & BASE) < 3) base[data[0] & BASE](s);
    for (size_t i = 3; i + 4 <= size; i += 4) edit(s, data + i);
}

/** Frame `f` of the soup, which turns and pulses; false if it is no mesh at all. */
static bool add_frame(const soup *s, unsigned f, uint8_t seed, small_capture *capture) {
    soup moved = *s;
    gvc_error error;
    gvc_error_init(&error);
    double angle = 0.1 * f, scale = 1 + small(seed) / 8 * f;
    for (size_t v = 0; v < s->vertex_count; v++) {
        const double *p = &s->position[3 * v];
        moved.position[3 * v] = scale * (cos(angle) * p[0] - sin(angle) * p[1]);
        moved.position[3 * v + 1] = sin(angle) * p[0] + cos(angle) * p[1];
    }
    gvc_result result = gvc_mesh_create(moved.position, s->vertex_count, s->face, s->face_count,
                                        &capture->mesh[capture->count], &error);
    if (succeeded(result, &error)) {
        capture->count++;
        return true;
    }
    REQUIRE(result == GVC_ERROR_MESH && !capture->mesh[capture->count]);
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < 3 || size > 3 + 4 * SOUP_FACES) return 0;
    soup s;
    small_capture capture = {0};
    gvc_encode_options options;
    gvc_encode_options_init(&options);
    options.image_size = data[0] & LARGER ? 24 : 16;
    options.lossless = data[0] & LOSSLESS;
    options.with_preview = options.lossless && data[0] & PREVIEW;
    options.crf = data[0] & SEARCH ? NAN : data[1] % 52;
    options.max_rms = 0.001 * (1 + data[1]);
    options.gop = data[0] & GROUPS ? 1 : 60;
    options.threads = 1;
    options.longest_edge = 0.15; /* 50 vertices: as fast as can be */
    make_soup(data, size, &s);
    unsigned frames = data[0] & MORE_FRAMES ? ENCODED_FRAMES : 1;
    bool whole = true;
    for (unsigned f = 0; f < frames && whole; f++) whole = add_frame(&s, f, data[2], &capture);
    gvc_buffer file = {0};
    if (whole) (void)encode_and_check(&capture, &options, &file);
    gvc_buffer_free(&file);
    small_capture_free(&capture);
    return 0;
}
