/* SPDX-License-Identifier: MIT */
/** @file rebuild.c  From the codes of a geometry image to a closed mesh. */
#include "chart/rebuild.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/** Mean of the codes of one border vertex in one plane, `first` being its smallest position. A sum
 * is at most P * 65535 < 2^30, so twice the sum and the count fit 32 bits. */
static uint16_t mean_code(const gvc_weld *weld, const uint16_t *plane, uint32_t first) {
    uint32_t sum = 0, count = 0, p = first;
    do {
        uint32_t x, y;
        gvc_border_pixel(weld->size, p, &x, &y);
        sum += plane[(size_t)y * weld->size + x];
        count++;
        p = weld->ring[p];
    } while (p != first);
    return (uint16_t)((2 * sum + count) / (2 * count));
}

/** Whether no smaller position is the same vertex: the ring ascends, and falls only where it
 * closes. */
static bool first_of_vertex(const gvc_weld *weld, uint32_t position) {
    uint32_t p = position;
    while (weld->ring[p] > p) p = weld->ring[p];
    return weld->ring[p] == position;
}

void gvc_weld_codes(const gvc_weld *weld, const uint16_t *plane, uint16_t *code) {
    size_t count = (size_t)weld->size * weld->size;
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < count; i++)
            code[3 * (size_t)weld->vertex[i] + c] = plane[c * count + i];

    for (uint32_t p = 0; p < weld->border_count; p++) {
        if (!first_of_vertex(weld, p)) continue;
        uint32_t x, y;
        gvc_border_pixel(weld->size, p, &x, &y);
        uint16_t *welded = &code[3 * (size_t)weld->vertex[(size_t)y * weld->size + x]];
        for (size_t c = 0; c < 3; c++) welded[c] = mean_code(weld, plane + c * count, p);
    }
}

typedef enum diagonal { DIAGONAL_FREE, DIAGONAL_AC, DIAGONAL_BD } diagonal;

/** The diagonal that the square's corners and the folds demand of the quad at (x, y). */
static diagonal demanded_diagonal(const gvc_weld *weld, uint32_t x, uint32_t y) {
    uint32_t last = weld->size - 1;
    uint32_t corner[4][2] = {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
    for (int pass = 0; pass < 2; pass++) /* corners of the square, then folds */
        for (int k = 0; k < 4; k++) {
            uint32_t cx = corner[k][0], cy = corner[k][1];
            bool at_x = cx == 0 || cx == last, at_y = cy == 0 || cy == last;
            bool through =
                pass == 0 ? at_x && at_y
                          : (at_x || at_y) && weld->fold[gvc_border_position(weld->size, cx, cy)];
            if (through) return k % 2 == 0 ? DIAGONAL_AC : DIAGONAL_BD;
        }
    return DIAGONAL_FREE;
}

/** Squared distance of two codes: up to 3 * 65535^2, beyond 32 bits. */
static int64_t squared_distance(const uint16_t *a, const uint16_t *b) {
    int64_t sum = 0;
    for (int c = 0; c < 3; c++) {
        int64_t difference = (int64_t)a[c] - (int64_t)b[c];
        sum += difference * difference;
    }
    return sum;
}

size_t gvc_rebuild_face_count(const gvc_weld *weld) {
    return 2 * (size_t)(weld->size - 1) * (weld->size - 1);
}

void gvc_rebuild_faces(const gvc_weld *weld, const uint16_t *code, uint32_t *face) {
    uint32_t size = weld->size, quads = size - 1;
    for (uint32_t y = 0; y < quads; y++) {
        const uint32_t *row = weld->vertex + (size_t)y * size, *below = row + size;
        for (uint32_t x = 0; x < quads; x++) {
            uint32_t a = row[x], b = row[x + 1], c = below[x + 1], d = below[x];
            bool at_border = x == 0 || y == 0 || x == quads - 1 || y == quads - 1;
            diagonal way = at_border ? demanded_diagonal(weld, x, y) : DIAGONAL_FREE;
            if (way == DIAGONAL_FREE) {
                int64_t ac = squared_distance(code + 3 * (size_t)a, code + 3 * (size_t)c);
                int64_t bd = squared_distance(code + 3 * (size_t)b, code + 3 * (size_t)d);
                way = ac <= bd ? DIAGONAL_AC : DIAGONAL_BD;
            }
            bool split_ac = way == DIAGONAL_AC;
            *face++ = a, *face++ = b, *face++ = split_ac ? c : d;
            *face++ = split_ac ? a : b, *face++ = c, *face++ = d;
        }
    }
}

void gvc_rebuild_positions(const gvc_weld *weld, const uint16_t *code, const double origin[3],
                           double step, double *position) {
    for (size_t v = 0; v < weld->vertex_count; v++)
        for (size_t c = 0; c < 3; c++)
            position[3 * v + c] = (float)(origin[c] + step * (double)code[3 * v + c]);
}

/** The map is monotone in the code, so its two ends tell whether all positions are float32. */
static gvc_result check_affine_map(const double origin[3], double step, gvc_error *error) {
    for (int c = 0; c < 3; c++) {
        double end = origin[c] + step * (double)UINT16_MAX;
        if (!(fabs(origin[c]) <= FLT_MAX) || !(fabs(end) <= FLT_MAX))
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "coordinates from %g in steps of %g are beyond float32", origin[c],
                            step);
    }
    return GVC_OK;
}

gvc_result gvc_rebuild_mesh(const gvc_weld *weld, const uint16_t *plane, const double origin[3],
                            double step, gvc_mesh **mesh, gvc_error *error) {
    *mesh = NULL;
    GVC_TRY(check_affine_map(origin, step, error));
    uint16_t *code = gvc_alloc(weld->vertex_count, 3 * sizeof *code);
    if (!code) return gvc_fail_memory(error);
    gvc_result result =
        gvc_mesh_allocate(weld->vertex_count, gvc_rebuild_face_count(weld), mesh, error);
    if (result == GVC_OK) {
        gvc_weld_codes(weld, plane, code);
        gvc_rebuild_faces(weld, code, (*mesh)->face);
        gvc_rebuild_positions(weld, code, origin, step, (*mesh)->position);
    }
    free(code);
    return result;
}

static void put_u16(uint8_t *out, uint16_t value) {
    out[0] = (uint8_t)(value >> 8);
    out[1] = (uint8_t)value;
}

static void put_u32(uint8_t *out, uint32_t value) {
    put_u16(out, (uint16_t)(value >> 16));
    put_u16(out + 2, (uint16_t)value);
}

gvc_result gvc_rebuild_digest_update(gvc_sha256 *digest, const gvc_weld *weld, const uint16_t *code,
                                     const uint32_t *face, gvc_error *error) {
    (void)error; /* hashing cannot fail */
    enum { CHUNK = 1024 };
    uint8_t bytes[4 * CHUNK];
    size_t face_count = gvc_rebuild_face_count(weld);
    put_u32(bytes, weld->vertex_count);
    put_u32(bytes + 4, (uint32_t)face_count);
    gvc_sha256_update(digest, bytes, 8);

    size_t codes = 3 * (size_t)weld->vertex_count, indices = 3 * face_count;
    for (size_t i = 0; i < codes;) {
        size_t n = 0;
        for (; n < CHUNK && i < codes; n++) put_u16(bytes + 2 * n, code[i++]);
        gvc_sha256_update(digest, bytes, 2 * n);
    }
    for (size_t i = 0; i < indices;) {
        size_t n = 0;
        for (; n < CHUNK && i < indices; n++) put_u32(bytes + 4 * n, face[i++]);
        gvc_sha256_update(digest, bytes, 4 * n);
    }
    return GVC_OK;
}
