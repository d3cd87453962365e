/* SPDX-License-Identifier: MIT */
/** @file flat_disk.h  Disks for the tests: a grid of triangles over the square, put into space. */
#ifndef GVC_TESTS_FLAT_DISK_H
#define GVC_TESTS_FLAT_DISK_H

#include "chart/open.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/** Where the point (u, v) of the unit square lies in space. */
typedef void (*flat_shape)(double u, double v, double position[3]);

/** Pseudo-random number in [0,1) of a pair of indices. */
static double flat_noise(uint32_t i, uint32_t seed) {
    uint32_t x = i * 2654435761u + seed * 40503u + 12345u;
    x ^= x >> 15;
    x *= 2246822519u;
    x ^= x >> 13;
    x *= 3266489917u;
    x ^= x >> 16;
    return x / 4294967296.0;
}

/** n x n vertices; inner ones moved by up to `jitter` cells in the parameter domain, diagonals
 * chosen by chance. `uv` gets places in a square of `size` pixels, to be freed by the caller.
 * The diagonals in the corners run to the corner, so that no inner edge joins two sides. */
static gvc_result flat_disk_make(uint32_t n, double jitter, uint32_t size, flat_shape shape,
                                 gvc_disk *disk, double **uv, gvc_error *error) {
    gvc_mesh *mesh = NULL;
    memset(disk, 0, sizeof *disk);
    *uv = NULL;
    GVC_TRY(gvc_mesh_allocate((size_t)n * n, 2 * (size_t)(n - 1) * (n - 1), &mesh, error));
    *uv = malloc(2 * (size_t)n * n * sizeof **uv);
    disk->original = malloc((size_t)n * n * sizeof *disk->original);
    disk->border_count = 4 * (size_t)(n - 1);
    disk->border = malloc(disk->border_count * sizeof *disk->border);
    disk->border_length = calloc(disk->border_count, sizeof *disk->border_length);
    if (!*uv || !disk->original || !disk->border || !disk->border_length) {
        gvc_mesh_destroy(&mesh);
        return gvc_fail_memory(error);
    }
    for (uint32_t i = 0; i < n * n; i++) {
        uint32_t x = i % n, y = i / n;
        int inner = x > 0 && y > 0 && x + 1 < n && y + 1 < n;
        double u = (x + inner * jitter * (2 * flat_noise(i, 1) - 1)) / (n - 1);
        double v = (y + inner * jitter * (2 * flat_noise(i, 2) - 1)) / (n - 1);
        (*uv)[2 * i] = u * (size - 1);
        (*uv)[2 * i + 1] = v * (size - 1);
        shape(u, v, mesh->position + 3 * i);
        disk->original[i] = i;
    }
    uint32_t *face = mesh->face;
    for (uint32_t y = 0; y + 1 < n; y++)
        for (uint32_t x = 0; x + 1 < n; x++) {
            uint32_t a = y * n + x, b = a + 1, c = b + n, d = a + n;
            int corner = (x == 0 && y == 0) || (x == n - 2 && y == n - 2) ? 1
                         : (x == 0 && y == n - 2) || (x == n - 2 && y == 0)
                             ? 0
                             : flat_noise(a, 3) < 0.5;
            uint32_t one[6] = {a, b, c, a, c, d}, other[6] = {a, b, d, b, c, d};
            memcpy(face, corner ? one : other, sizeof one);
            face += 6;
        }
    uint32_t *border = disk->border;
    for (uint32_t i = 0; i + 1 < n; i++) *border++ = i;
    for (uint32_t i = 0; i + 1 < n; i++) *border++ = i * n + n - 1;
    for (uint32_t i = n - 1; i > 0; i--) *border++ = (n - 1) * n + i;
    for (uint32_t i = n - 1; i > 0; i--) *border++ = i * n;
    gvc_result result = gvc_halfedges_build(mesh, 0, &disk->mesh, error);
    gvc_mesh_destroy(&mesh);
    return result;
}

static void flat_disk_free(gvc_disk *disk, double *uv) {
    gvc_halfedges_free(&disk->mesh);
    free(disk->original);
    free(disk->border);
    free(disk->border_length);
    free(uv);
}

#endif
