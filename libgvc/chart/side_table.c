/* SPDX-License-Identifier: MIT */
/** @file side_table.c  From a side table to the weld of the image's border samples. */
#include "chart/side_table.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "chart/gluing.h"

#define UNNUMBERED UINT32_MAX

void gvc_side_table_free(gvc_side_table *table) {
    if (!table) return;
    free(table->steps);
    free(table->side);
    *table = (gvc_side_table){0};
}

gvc_result gvc_side_table_copy(const gvc_side_table *from, gvc_side_table *to, gvc_error *error) {
    gvc_side_table copy = *from;
    copy.steps = gvc_alloc(from->edge_count, sizeof *copy.steps);
    copy.side = gvc_alloc(from->side_count, sizeof *copy.side);
    *to = (gvc_side_table){0};
    if (!copy.steps || !copy.side) {
        gvc_side_table_free(&copy);
        return gvc_fail_memory(error);
    }
    if (from->edge_count) memcpy(copy.steps, from->steps, from->edge_count * sizeof *copy.steps);
    if (from->side_count) memcpy(copy.side, from->side, from->side_count * sizeof *copy.side);
    *to = copy;
    return GVC_OK;
}

void gvc_border_pixel(uint32_t size, uint32_t position, uint32_t *x, uint32_t *y) {
    uint32_t last = size - 1, p = position % gvc_border_length(size), along = p % last;
    switch (p / last) {
    case 0:
        *x = along, *y = 0;
        break;
    case 1:
        *x = last, *y = along;
        break;
    case 2:
        *x = last - along, *y = last;
        break;
    default:
        *x = 0, *y = last - along;
        break;
    }
}

uint32_t gvc_border_position(uint32_t size, uint32_t x, uint32_t y) {
    uint32_t last = size - 1;
    if (y == 0) return x;
    if (x == last) return last + y;
    if (y == last) return 3 * last - x;
    return 4 * last - y;
}

/** Rule 5, and rule 1 as far as `start` is concerned. */
static gvc_result check_start(const gvc_side_table *table, const uint32_t *representative,
                              gvc_error *error) {
    uint32_t length = gvc_border_length(table->size);
    if (table->start >= length)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "start %u is not one of %u border positions",
                        table->start, length);
    for (uint32_t k = 0; k < 4; k++) {
        uint32_t corner = (k * (table->size - 1) + length - table->start) % length;
        if (!gvc_glue_allows_corner(representative, length, corner))
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "two of the five samples around corner %u of the square are one vertex",
                            k);
    }
    return GVC_OK;
}

/** Numbers the vertices in raster order and links the positions of each. `number` is scratch, one
 *  per loop coordinate. */
static void number_vertices(gvc_weld *weld, const uint32_t *representative, uint32_t start,
                            uint32_t *number) {
    uint32_t size = weld->size, length = weld->border_count, next = 0, border_vertices = 0;
    for (uint32_t i = 0; i < length; i++) number[i] = UNNUMBERED;
    for (uint32_t y = 0; y < size; y++) {
        bool whole_row = y == 0 || y == size - 1;
        for (uint32_t x = 0; x < size; x++) {
            uint32_t *vertex = &weld->vertex[(size_t)y * size + x];
            if (!whole_row && x != 0 && x != size - 1) {
                *vertex = next++;
                continue;
            }
            uint32_t position = gvc_border_position(size, x, y);
            uint32_t *known = &number[representative[(position + length - start) % length]];
            if (*known == UNNUMBERED) {
                *known = next++;
                border_vertices++;
            }
            *vertex = *known;
        }
    }
    weld->vertex_count = next;
    /* V - E + F with F = 2 (size - 1)^2 and E = 3 F / 2. */
    weld->genus = (2 * size - 1 - border_vertices) / 2;
}

static uint32_t border_vertex(const gvc_weld *weld, uint32_t position) {
    uint32_t x, y;
    gvc_border_pixel(weld->size, position, &x, &y);
    return weld->vertex[(size_t)y * weld->size + x];
}

/** Links the positions of each vertex in ascending order, cyclically. `latest` is scratch: per loop
 * coordinate that represents a vertex, the vertex's greatest position so far. */
static void link_ring(gvc_weld *weld, const uint32_t *representative, uint32_t start,
                      uint32_t *latest) {
    uint32_t length = weld->border_count;
    for (uint32_t i = 0; i < length; i++) latest[i] = UNNUMBERED;
    for (uint32_t p = 0; p < length; p++) {
        uint32_t *last = &latest[representative[(p + length - start) % length]];
        if (*last == UNNUMBERED) {
            weld->ring[p] = p;
        } else {
            weld->ring[p] = weld->ring[*last];
            weld->ring[*last] = p;
        }
        *last = p;
    }
}

static void mark_folds(gvc_weld *weld) {
    uint32_t length = weld->border_count;
    for (uint32_t p = 0; p < length; p++)
        weld->fold[p] = border_vertex(weld, p + 1) == border_vertex(weld, p + length - 1);
}

gvc_result gvc_weld_build(const gvc_side_table *table, gvc_weld *weld, gvc_error *error) {
    *weld = (gvc_weld){0};
    GVC_TRY(gvc_glue_check_size(table->size, error));
    uint32_t size = table->size, length = gvc_border_length(size);
    gvc_weld built = {.size = size, .border_count = length};
    gvc_result result = GVC_OK;
    uint32_t *representative = gvc_alloc(length, sizeof *representative);
    uint32_t *scratch = gvc_alloc(length, sizeof *scratch);
    if (!representative || !scratch) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(gvc_glue_border(table, representative, error));
    GVC_CHECK(check_start(table, representative, error));

    built.vertex = gvc_alloc((size_t)size * size, sizeof *built.vertex);
    built.ring = gvc_alloc(length, sizeof *built.ring);
    built.fold = gvc_alloc(length, sizeof *built.fold);
    if (!built.vertex || !built.ring || !built.fold) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    number_vertices(&built, representative, table->start, scratch);
    link_ring(&built, representative, table->start, scratch);
    mark_folds(&built);
    *weld = built;
    built = (gvc_weld){0};
cleanup:
    gvc_weld_free(&built);
    free(scratch);
    free(representative);
    return result;
}

void gvc_weld_free(gvc_weld *weld) {
    if (!weld) return;
    free(weld->vertex);
    free(weld->ring);
    free(weld->fold);
    *weld = (gvc_weld){0};
}
