/* SPDX-License-Identifier: MIT */
/** @file surface_check.h  An independent check that triangles form a closed oriented surface. */
#ifndef GVC_TESTS_SURFACE_CHECK_H
#define GVC_TESTS_SURFACE_CHECK_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

/** Whether the (w, x) of the triangles (v, w, x) around one vertex v form a single cycle of at
 * least three, w to x, with every vertex met once. */
static inline bool one_fan(const uint32_t (*wedge)[2], uint32_t count) {
    uint32_t at = wedge[0][0], steps = 0;
    do {
        uint32_t found = UINT32_MAX;
        for (uint32_t i = 0; i < count; i++)
            if (wedge[i][0] == at) {
                if (found != UINT32_MAX) return false; /* two faces begin with this edge */
                found = i;
            }
        if (found == UINT32_MAX || ++steps > count) return false;
        at = wedge[found][1];
    } while (at != wedge[0][0]);
    return steps == count && count >= 3;
}

/** Every vertex has one cyclic fan of consistently oriented triangles: then every edge has exactly
 *  two faces, and no face is degenerate or double. */
static inline bool surface_is_closed_manifold(const uint32_t *face, size_t face_count,
                                              uint32_t vertex_count) {
    uint32_t *first = calloc((size_t)vertex_count + 2, sizeof *first);
    uint32_t(*wedge)[2] = calloc(3 * face_count + 1, sizeof *wedge);
    bool good = first && wedge;
    for (size_t i = 0; good && i < 3 * face_count; i++) {
        good = face[i] < vertex_count;
        if (good) first[face[i] + 2]++;
    }
    for (uint32_t v = 0; good && v < vertex_count; v++) first[v + 2] += first[v + 1];
    for (size_t f = 0; good && f < face_count; f++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *t = face + 3 * f;
            uint32_t v = t[k], w = t[(k + 1) % 3], x = t[(k + 2) % 3];
            if (v == w) good = false;
            uint32_t place = first[v + 1]++;
            wedge[place][0] = w;
            wedge[place][1] = x;
        }
    for (uint32_t v = 0; good && v < vertex_count; v++)
        good = first[v + 1] > first[v] &&
               one_fan((const uint32_t(*)[2])wedge + first[v], first[v + 1] - first[v]);
    free(first);
    free(wedge);
    return good;
}

#endif
