/* SPDX-License-Identifier: MIT */
/** @file made_surfaces.h  Surfaces with known geometry, made on the spot, for tests of the
 *  descriptor. Every maker asserts its own success; free the result with gvc_halfedges_free. */
#ifndef GVC_TESTS_MADE_SURFACES_H
#define GVC_TESTS_MADE_SURFACES_H

#include "mesh/halfedge.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

/** The same numbers on every machine: a linear congruential generator, uniform in [0,1). */
static inline double made_random(uint64_t *state) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

static inline gvc_halfedges made_halfedges(const double *position, size_t vertex_count,
                                           const uint32_t *face, size_t face_count) {
    gvc_mesh *mesh;
    gvc_halfedges halfedges;
    assert_int_equal(gvc_mesh_allocate(vertex_count, face_count, &mesh, NULL), GVC_OK);
    for (size_t i = 0; i < 3 * vertex_count; i++) mesh->position[i] = position[i];
    for (size_t i = 0; i < 3 * face_count; i++) mesh->face[i] = face[i];
    assert_int_equal(gvc_halfedges_build(mesh, 0, &halfedges, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    return halfedges;
}

/** Every face in four, new vertices in the middle of edges. */
static inline gvc_halfedges made_finer(const gvc_halfedges *coarse) {
    size_t edges = 0, v = coarse->vertex_count, f = coarse->face_count;
    uint32_t *middle = calloc(3 * f, sizeof *middle);
    for (uint32_t h = 0; h < 3 * f; h++) {
        bool first = coarse->twin[h] == GVC_NONE || coarse->twin[h] > h;
        middle[h] = first ? (uint32_t)(v + edges++) : middle[coarse->twin[h]];
    }
    double *position = calloc(3 * (v + edges), sizeof *position);
    uint32_t *face = calloc(12 * f, sizeof *face);
    for (size_t i = 0; i < 3 * v; i++) position[i] = coarse->position[i];
    for (uint32_t h = 0; h < 3 * f; h++) {
        const double *a = coarse->position + 3 * coarse->vertex[h];
        const double *b = coarse->position + 3 * coarse->vertex[gvc_next(h)];
        for (int k = 0; k < 3; k++) position[3 * middle[h] + k] = 0.5 * (a[k] + b[k]);
        uint32_t *corner = face + 12 * (h / 3) + 3 * (h % 3), *centre = face + 12 * (h / 3) + 9;
        corner[0] = coarse->vertex[h], corner[1] = middle[h], corner[2] = middle[gvc_prev(h)];
        centre[h % 3] = middle[h];
    }
    gvc_halfedges fine = made_halfedges(position, v + edges, face, 4 * f);
    free(middle), free(position), free(face);
    return fine;
}

static inline void made_unit(double p[3]) {
    double length = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (int k = 0; k < 3; k++) p[k] /= length;
}

/** Unit sphere from an octahedron, whose vertices are 0 to 5 (+x -x +y -y +z -z). 4^(k+1) + 2
 *  vertices: 1026 for 4. */
static inline gvc_halfedges made_sphere(int subdivisions) {
    static const double position[] = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
    static const uint32_t face[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                    2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    gvc_halfedges sphere = made_halfedges(position, 6, face, 8);
    for (int i = 0; i < subdivisions; i++) {
        gvc_halfedges fine = made_finer(&sphere);
        gvc_halfedges_free(&sphere);
        sphere = fine;
        for (size_t v = 0; v < sphere.vertex_count; v++) made_unit(sphere.position + 3 * v);
    }
    return sphere;
}

/** Unit sphere of meridians and parallels with the poles +z and -z as its last vertices. Vertex
 *  (r, s), r = 1..rings-1, is number (r - 1) * segments + s. */
static inline gvc_halfedges made_globe(uint32_t rings, uint32_t segments) {
    uint32_t north = (rings - 1) * segments, south = north + 1;
    double *position = calloc(3 * (size_t)(south + 1), sizeof *position);
    uint32_t *face = calloc(6 * (size_t)segments * rings, sizeof *face), *at = face;
    position[3 * north + 2] = 1, position[3 * south + 2] = -1;
    for (uint32_t r = 1; r < rings; r++)
        for (uint32_t s = 0; s < segments; s++) {
            double polar = PI * r / rings, azimuth = 2 * PI * s / segments;
            double *p = position + 3 * ((r - 1) * segments + s);
            p[0] = sin(polar) * cos(azimuth), p[1] = sin(polar) * sin(azimuth), p[2] = cos(polar);
        }
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t s = 0; s < segments; s++) {
            uint32_t t = (s + 1) % segments, upper = (r - 1) * segments, lower = r * segments;
            if (r > 0) {
                *at++ = upper + s;
                *at++ = r + 1 < rings ? lower + s : south;
                *at++ = upper + t;
            }
            if (r + 1 < rings) {
                *at++ = r > 0 ? upper + t : north;
                *at++ = lower + s;
                *at++ = lower + t;
            }
        }
    gvc_halfedges globe = made_halfedges(position, south + 1, face, (size_t)(at - face) / 3);
    free(position), free(face);
    return globe;
}

/** Torus around z: radius 1, tube radius `tube`. */
static inline gvc_halfedges made_torus(uint32_t around, uint32_t across, double tube) {
    double *position = calloc(3 * (size_t)around * across, sizeof *position);
    uint32_t *face = calloc(6 * (size_t)around * across, sizeof *face), *at = face;
    for (uint32_t i = 0; i < around; i++)
        for (uint32_t j = 0; j < across; j++) {
            double u = 2 * PI * i / around, v = 2 * PI * j / across, r = 1 + tube * cos(v);
            double *p = position + 3 * (i * across + j);
            p[0] = r * cos(u), p[1] = r * sin(u), p[2] = tube * sin(v);
            uint32_t ii = (i + 1) % around, jj = (j + 1) % across;
            uint32_t a = i * across + j, b = ii * across + j, c = ii * across + jj,
                     d = i * across + jj;
            *at++ = a, *at++ = b, *at++ = c, *at++ = a, *at++ = c, *at++ = d;
        }
    gvc_halfedges torus =
        made_halfedges(position, (size_t)around * across, face, 2 * (size_t)around * across);
    free(position), free(face);
    return torus;
}

/** Flat grid of (columns + 1) x (rows + 1) vertices, row by row, over a parallelogram: vertex
 *  (x, y) is at (x + shear * y, y), and off by up to `jitter` inside. */
static inline gvc_halfedges made_grid(uint32_t columns, uint32_t rows, double shear,
                                      double jitter) {
    uint32_t width = columns + 1;
    size_t count = (size_t)width * (rows + 1);
    double *position = calloc(3 * count, sizeof *position);
    uint32_t *face = calloc(6 * (size_t)columns * rows, sizeof *face), *at = face;
    uint64_t state = 1;
    for (uint32_t y = 0; y <= rows; y++)
        for (uint32_t x = 0; x <= columns; x++) {
            double *p = position + 3 * (y * width + x);
            bool inside = x > 0 && y > 0 && x < columns && y < rows;
            p[0] = x + shear * y + (inside ? jitter * (2 * made_random(&state) - 1) : 0);
            p[1] = y + (inside ? jitter * (2 * made_random(&state) - 1) : 0);
        }
    for (uint32_t y = 0; y < rows; y++)
        for (uint32_t x = 0; x < columns; x++) {
            uint32_t a = y * width + x, b = a + 1, d = a + width, c = d + 1;
            *at++ = a, *at++ = b, *at++ = c, *at++ = a, *at++ = c, *at++ = d;
        }
    gvc_halfedges grid = made_halfedges(position, count, face, 2 * (size_t)columns * rows);
    free(position), free(face);
    return grid;
}

/** Surface of the unit cubes marked '#' in a plate of one layer: holes in the plate are handles.
 *  `plate` has `rows` rows of `columns` characters. Cubes must not touch in an edge only. */
static inline gvc_halfedges made_plate(const char *plate, int columns, int rows) {
    size_t width = (size_t)columns + 1, layer = width * ((size_t)rows + 1);
    uint32_t *number = calloc(2 * layer, sizeof *number); /* plus one; 0: not used */
    double *position = calloc(6 * layer, sizeof *position);
    uint32_t *face = calloc(36 * (size_t)columns * (size_t)rows, sizeof *face), *at = face;
    uint32_t count = 0;
    /* The four corners of a cube's sides, counter-clockwise from outside, as bits x 1, y 2, z 4. */
    static const int side[6][6] = {{0, 4, 6, 2, -1, 0}, {1, 3, 7, 5, 1, 0}, {0, 1, 5, 4, 0, -1},
                                   {2, 6, 7, 3, 0, 1},  {0, 2, 3, 1, 0, 0}, {4, 5, 7, 6, 0, 0}};
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            for (int s = 0; s < 6 && plate[y * columns + x] == '#'; s++) {
                int nx = x + side[s][4], ny = y + side[s][5];
                bool beside = nx != x || ny != y;
                if (beside && nx >= 0 && ny >= 0 && nx < columns && ny < rows &&
                    plate[ny * columns + nx] == '#')
                    continue;
                uint32_t corner[4];
                for (int k = 0; k < 4; k++) {
                    int bits = side[s][k], cx = x + (bits & 1), cy = y + (bits >> 1 & 1);
                    size_t place = (size_t)(bits >> 2) * layer + (size_t)cy * width + (size_t)cx;
                    if (number[place] == 0) {
                        double *p = position + 3 * count;
                        p[0] = cx, p[1] = cy, p[2] = bits >> 2;
                        number[place] = ++count;
                    }
                    corner[k] = number[place] - 1;
                }
                *at++ = corner[0], *at++ = corner[1], *at++ = corner[2];
                *at++ = corner[0], *at++ = corner[2], *at++ = corner[3];
            }
    gvc_halfedges surface = made_halfedges(position, count, face, (size_t)(at - face) / 3);
    free(number), free(position), free(face);
    return surface;
}

/** Directions and heights of the limbs grown by made_limbs. */
enum { LIMB_COUNT = 5 };
static const double LIMB[LIMB_COUNT][4] = {
    {0, 0, 1, 1.2}, {1, 0, 0.2, 1.6}, {-1, 0, 0.2, 1.6}, {0.5, 0.2, -1, 2.4}, {-0.5, 0.2, -1, 2.2}};

/** Moves the vertices of a unit sphere outward to a body with five limbs. */
static inline void made_limbs(gvc_halfedges *sphere) {
    for (size_t v = 0; v < sphere->vertex_count; v++) {
        double *p = sphere->position + 3 * v, radius = 1;
        for (int i = 0; i < LIMB_COUNT; i++) {
            double tip[3] = {LIMB[i][0], LIMB[i][1], LIMB[i][2]};
            made_unit(tip);
            double cosine = p[0] * tip[0] + p[1] * tip[1] + p[2] * tip[2];
            radius += LIMB[i][3] * exp(12 * (cosine - 1));
        }
        for (int k = 0; k < 3; k++) p[k] *= radius;
    }
}

/** A surface of two separate copies of the given one. */
static inline gvc_halfedges made_twice(const gvc_halfedges *one) {
    size_t v = one->vertex_count, f = one->face_count;
    double *position = calloc(6 * v, sizeof *position);
    uint32_t *face = calloc(6 * f, sizeof *face);
    for (size_t i = 0; i < 6 * v; i++)
        position[i] = one->position[i % (3 * v)] + (i >= 3 * v ? 10 : 0);
    for (size_t i = 0; i < 6 * f; i++)
        face[i] = one->vertex[i % (3 * f)] + (i >= 3 * f ? (uint32_t)v : 0);
    gvc_halfedges two = made_halfedges(position, 2 * v, face, 2 * f);
    free(position), free(face);
    return two;
}

#endif
