/* SPDX-License-Identifier: MIT */
/** @file clean.c  Makes a captured mesh ready for coding: welds seams, drops what is no surface. */
#include "base/memory.h"
#include "mesh/order.h"

#include <stdlib.h>
#include <string.h>

/** Copies the faces that are not to be dropped, and the vertices that those use, both in order.
 *  `number` has an entry per vertex and is overwritten. */
static gvc_result copy_kept(const gvc_mesh *mesh, const bool *drop, uint32_t *number,
                            gvc_mesh **kept, gvc_error *error) {
    size_t face_count = 0, vertex_count = 0;
    memset(number, 0, mesh->vertex_count * sizeof *number);
    for (size_t f = 0; f < mesh->face_count; f++) {
        if (drop[f]) continue;
        face_count++;
        for (size_t k = 0; k < 3; k++) number[mesh->face[3 * f + k]] = 1;
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) vertex_count += number[v];
    GVC_TRY(gvc_mesh_allocate(vertex_count, face_count, kept, error));
    uint32_t next = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        if (!number[v]) continue;
        memcpy((*kept)->position + 3 * (size_t)next, mesh->position + 3 * v, 3 * sizeof(double));
        number[v] = next++;
    }
    uint32_t *corner = (*kept)->face;
    for (size_t f = 0; f < mesh->face_count; f++) {
        for (size_t k = 0; k < 3 && !drop[f]; k++) *corner++ = number[mesh->face[3 * f + k]];
    }
    return GVC_OK;
}

/** A copy without degenerate and duplicate faces and unreferenced vertices. */
static gvc_result drop_useless(const gvc_mesh *mesh, gvc_mesh **kept, gvc_error *error) {
    *kept = NULL;
    bool *drop = gvc_alloc(mesh->face_count, sizeof *drop);
    uint32_t *number = gvc_alloc(mesh->vertex_count, sizeof *number);
    gvc_result result = drop && number ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_mark_repeated_faces(mesh, drop, error);
    for (size_t f = 0; result == GVC_OK && f < mesh->face_count; f++)
        drop[f] |= gvc_is_degenerate(mesh, (uint32_t)f);
    if (result == GVC_OK) result = copy_kept(mesh, drop, number, kept, error);
    free(drop);
    free(number);
    return result;
}

/* -------------------------------------------------------------------------------------- welding */

static uint64_t hash_position(const double *p) {
    uint64_t hash = 0;
    for (int k = 0; k < 3; k++) {
        double value = p[k] + 0.0; /* makes -0 and 0 alike */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = (hash ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 32;
    }
    return hash;
}

static bool same_position(const double *p, const double *q) {
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/** Sets target[v] to the first vertex at v's position; `*merged` counts those that are not. Open
 *  addressing with at most half of the slots used; a slot holds vertex + 1. */
static gvc_result find_coincident(const gvc_mesh *mesh, uint32_t *target, size_t *merged,
                                  gvc_error *error) {
    size_t slots = 16;
    while (slots / 2 < mesh->vertex_count && slots <= SIZE_MAX / 4) slots *= 2;
    uint32_t *table = gvc_alloc(slots, sizeof *table);
    if (!table) return gvc_fail_memory(error);
    *merged = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        const double *p = mesh->position + 3 * v;
        size_t slot = (size_t)hash_position(p) & (slots - 1);
        while (table[slot] && !same_position(p, mesh->position + 3 * (size_t)(table[slot] - 1)))
            slot = (slot + 1) & (slots - 1);
        if (!table[slot]) table[slot] = (uint32_t)v + 1;
        target[v] = table[slot] - 1;
        *merged += target[v] != v;
    }
    free(table);
    return GVC_OK;
}

/** A cleaned copy with equal positions merged. */
static gvc_result weld_positions(const gvc_mesh *mesh, gvc_mesh **welded, size_t *merged,
                                 gvc_error *error) {
    *welded = NULL;
    gvc_mesh renamed = *mesh;
    uint32_t *target = gvc_alloc(mesh->vertex_count, sizeof *target);
    renamed.face = gvc_alloc(mesh->face_count, 3 * sizeof *renamed.face);
    gvc_result result = target && renamed.face ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = find_coincident(mesh, target, merged, error);
    for (size_t i = 0; result == GVC_OK && i < 3 * mesh->face_count; i++)
        renamed.face[i] = target[mesh->face[i]];
    if (result == GVC_OK) result = drop_useless(&renamed, welded, error);
    free(target);
    free(renamed.face);
    return result;
}

/** Replaces `*clean` by its welded form unless welding joins what only touches. */
static gvc_result try_weld(gvc_mesh **clean, size_t *merged, gvc_error *error) {
    gvc_mesh *welded = NULL;
    gvc_topology before, after;
    size_t count = 0;
    gvc_result result = gvc_mesh_topology(*clean, &before, error);
    if (result != GVC_OK || before.boundary_edge_count == 0) return result;
    GVC_CHECK(weld_positions(*clean, &welded, &count, error));
    GVC_CHECK(gvc_mesh_topology(welded, &after, error));
    if (count > 0 && after.nonmanifold_edge_count <= before.nonmanifold_edge_count &&
        after.nonmanifold_vertex_count <= before.nonmanifold_vertex_count) {
        gvc_mesh *swap = *clean;
        *clean = welded;
        welded = swap;
        *merged = count;
    }
cleanup:
    gvc_mesh_destroy(&welded);
    return result;
}

gvc_result gvc_mesh_clean(const gvc_mesh *mesh, bool weld, gvc_mesh **clean, size_t *welded,
                          gvc_error *error) {
    *clean = NULL;
    size_t merged = 0;
    gvc_mesh *made;
    GVC_TRY(drop_useless(mesh, &made, error));
    if (weld) {
        gvc_result result = try_weld(&made, &merged, error);
        if (result != GVC_OK) {
            gvc_mesh_destroy(&made);
            return result;
        }
    }
    if (welded) *welded = merged;
    *clean = made;
    return GVC_OK;
}
