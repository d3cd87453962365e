/* SPDX-License-Identifier: MIT */
/** @file soup.h  Tiny surfaces, to be spoilt. */
#ifndef GVC_FUZZ_SOUP_H
#define GVC_FUZZ_SOUP_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define SOUP_VERTICES 64u
#define SOUP_FACES 128u

typedef struct soup {
    size_t vertex_count, face_count;
    double position[3 * SOUP_VERTICES];
    uint32_t face[3 * SOUP_FACES];
} soup;

static inline void soup_vertex(soup *s, double x, double y, double z) {
    if (s->vertex_count == SOUP_VERTICES) return;
    double *p = &s->position[3 * s->vertex_count++];
    p[0] = x, p[1] = y, p[2] = z;
}

static inline void soup_face(soup *s, uint32_t a, uint32_t b, uint32_t c) {
    if (s->face_count == SOUP_FACES) return;
    uint32_t *f = &s->face[3 * s->face_count++];
    f[0] = a, f[1] = b, f[2] = c;
}

static inline void soup_tetrahedron(soup *s) {
    static const uint32_t face[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    for (unsigned i = 0; i < 4; i++) {
        soup_vertex(s, i == 1 || i == 2 ? 1 : -1, i == 1 || i == 3 ? 1 : -1, i < 2 ? 1 : -1);
    }
    for (unsigned i = 0; i < 4; i++) soup_face(s, face[i][0], face[i][1], face[i][2]);
}

static inline void soup_octahedron(soup *s) {
    static const uint32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (unsigned i = 0; i < 6; i++) {
        double side = i % 2 ? -1 : 1;
        soup_vertex(s, i < 2 ? side : 0, i == 2 || i == 3 ? side : 0, i > 3 ? 2 * side : 0);
    }
    for (unsigned i = 0; i < 8; i++) soup_face(s, face[i][0], face[i][1], face[i][2]);
}

static inline void soup_torus(soup *s) {
    enum { AROUND = 5, ACROSS = 4 };
    const double turn = 2 * acos(-1);
    for (uint32_t j = 0; j < ACROSS; j++) {
        for (uint32_t i = 0; i < AROUND; i++) {
            double u = turn * i / AROUND, v = turn * j / ACROSS, r = 1 + 0.4 * cos(v);
            soup_vertex(s, r * cos(u), r * sin(u), 0.4 * sin(v));
            uint32_t a = i + AROUND * j, b = (i + 1) % AROUND + AROUND * j;
            uint32_t up = AROUND * ((j + 1) % ACROSS), c = (i + 1) % AROUND + up, d = i + up;
            soup_face(s, a, b, c);
            soup_face(s, a, c, d);
        }
    }
}

/** A face of three gets its middle as a vertex, moved a little. */
static inline void soup_split(soup *s, size_t f, double out) {
    if (s->vertex_count == SOUP_VERTICES || s->face_count + 2 > SOUP_FACES) return;
    uint32_t *corner = &s->face[3 * f], middle = (uint32_t)s->vertex_count;
    double sum[3] = {0};
    for (unsigned c = 0; c < 3; c++) {
        if (corner[c] >= s->vertex_count) return;
        for (unsigned k = 0; k < 3; k++) sum[k] += s->position[3 * corner[c] + k];
    }
    soup_vertex(s, sum[0] / 3 * out, sum[1] / 3 * out, sum[2] / 3 * out);
    soup_face(s, corner[1], corner[2], middle);
    soup_face(s, corner[2], corner[0], middle);
    s->face[3 * f + 2] = middle;
}

#endif
