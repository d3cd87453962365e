/* SPDX-License-Identifier: MIT */
/** @file order.c  Sorting edges and faces of a mesh by their vertices: radix sort, vertex by
 * vertex.
 */
#include "mesh/order.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

/** One stable counting sort: `order` by `key[order[i]]`, into `sorted`. `start` has room for every
 *  vertex and one more. */
static void sort_by_key(const uint32_t *key, const uint32_t *order, size_t count, size_t key_count,
                        size_t *start, uint32_t *sorted) {
    for (size_t v = 0; v <= key_count; v++) start[v] = 0;
    for (size_t i = 0; i < count; i++) start[key[i] + (size_t)1]++;
    for (size_t v = 0; v < key_count; v++) start[v + 1] += start[v];
    for (size_t i = 0; i < count; i++) sorted[start[key[order[i]]]++] = order[i];
}

/** Sorts 0..count-1 by `keys[0]`, then `keys[1]`, ..., `keys[key_number - 1]`, each of `count`
 *  entries below `key_count`. */
static gvc_result sort_by_keys(uint32_t *const *keys, int key_number, size_t count,
                               size_t key_count, uint32_t **order, gvc_error *error) {
    uint32_t *sorted = gvc_alloc(count, sizeof *sorted);
    uint32_t *scratch = gvc_alloc(count, sizeof *scratch);
    size_t *start = key_count < SIZE_MAX ? gvc_alloc(key_count + 1, sizeof *start) : NULL;
    if (!sorted || !scratch || !start) {
        free(sorted);
        free(scratch);
        free(start);
        return gvc_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++) sorted[i] = (uint32_t)i;
    for (int k = key_number; k-- > 0;) {
        sort_by_key(keys[k], sorted, count, key_count, start, scratch);
        uint32_t *swap = sorted;
        sorted = scratch;
        scratch = swap;
    }
    free(scratch);
    free(start);
    *order = sorted;
    return GVC_OK;
}

static gvc_result check_size(const gvc_mesh *mesh, gvc_error *error) {
    if (mesh->face_count > (UINT32_MAX - 1) / 3 || mesh->vertex_count >= UINT32_MAX)
        return gvc_fail(error, GVC_ERROR_MESH, "%zu vertices and %zu faces are too many",
                        mesh->vertex_count, mesh->face_count);
    return GVC_OK;
}

gvc_result gvc_order_halfedges(const gvc_mesh *mesh, uint32_t **order, gvc_error *error) {
    *order = NULL;
    GVC_TRY(check_size(mesh, error));
    size_t count = 3 * mesh->face_count;
    uint32_t *keys[2] = {gvc_alloc(count, sizeof(uint32_t)), gvc_alloc(count, sizeof(uint32_t))};
    gvc_result result = GVC_OK;
    if (keys[0] && keys[1]) {
        for (uint32_t h = 0; h < count; h++) {
            uint32_t a = gvc_start_of(mesh, h), b = gvc_end_of(mesh, h);
            keys[0][h] = a < b ? a : b;
            keys[1][h] = a < b ? b : a;
        }
        result = sort_by_keys(keys, 2, count, mesh->vertex_count, order, error);
    } else {
        result = gvc_fail_memory(error);
    }
    free(keys[0]);
    free(keys[1]);
    return result;
}

static void order_pair(uint32_t *a, uint32_t *b) {
    if (*a <= *b) return;
    uint32_t swap = *a;
    *a = *b;
    *b = swap;
}

/** The vertices of a face in ascending order. */
static void face_key(const gvc_mesh *mesh, uint32_t face, uint32_t key[3]) {
    for (int k = 0; k < 3; k++) key[k] = mesh->face[3 * (size_t)face + (size_t)k];
    order_pair(&key[0], &key[1]);
    order_pair(&key[1], &key[2]);
    order_pair(&key[0], &key[1]);
}

/** Every face, sorted by its set of vertices, then by index: faces with the same three vertices are
 *  neighbours. `*order` holds face_count indices; free with free(). */
static gvc_result order_faces(const gvc_mesh *mesh, uint32_t **order, gvc_error *error) {
    *order = NULL;
    GVC_TRY(check_size(mesh, error));
    size_t count = mesh->face_count;
    uint32_t *keys[3];
    for (int k = 0; k < 3; k++) keys[k] = gvc_alloc(count, sizeof(uint32_t));
    gvc_result result = GVC_OK;
    if (keys[0] && keys[1] && keys[2]) {
        for (uint32_t f = 0; f < count; f++) {
            uint32_t key[3];
            face_key(mesh, f, key);
            for (int k = 0; k < 3; k++) keys[k][f] = key[k];
        }
        result = sort_by_keys(keys, 3, count, mesh->vertex_count, order, error);
    } else {
        result = gvc_fail_memory(error);
    }
    for (int k = 0; k < 3; k++) free(keys[k]);
    return result;
}

gvc_result gvc_mark_repeated_faces(const gvc_mesh *mesh, bool *repeated, gvc_error *error) {
    uint32_t *order;
    GVC_TRY(order_faces(mesh, &order, error));
    uint32_t last[3] = {0, 0, 0};
    for (size_t i = 0; i < mesh->face_count; i++) {
        uint32_t key[3];
        face_key(mesh, order[i], key);
        repeated[order[i]] = i > 0 && memcmp(key, last, sizeof key) == 0;
        memcpy(last, key, sizeof last);
    }
    free(order);
    return GVC_OK;
}
