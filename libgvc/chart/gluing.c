/* SPDX-License-Identifier: MIT */
/** @file gluing.c  Vertices of the border: union-find over loop coordinates. */
#include "chart/gluing.h"

#include <stdlib.h>

#include "base/disjoint.h"
#include "base/memory.h"

#define UNSEEN UINT32_MAX

/** Loop coordinates where the two sides of an edge begin, or UNSEEN. */
typedef struct edge_sides {
    uint32_t forward, reversed;
} edge_sides;

gvc_result gvc_glue_check_size(uint32_t size, gvc_error *error) {
    if (size < GVC_MIN_IMAGE_SIZE || size > GVC_MAX_IMAGE_SIZE)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "image size %u is not within %u..%u", size,
                        GVC_MIN_IMAGE_SIZE, GVC_MAX_IMAGE_SIZE);
    return GVC_OK;
}

static gvc_result check_steps(const gvc_side_table *table, gvc_error *error) {
    GVC_TRY(gvc_glue_check_size(table->size, error));
    uint32_t half = gvc_border_length(table->size) / 2;
    if (table->edge_count < 1 || table->edge_count > half / GVC_MIN_STEPS)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu cut edges do not fit an image of size %u",
                        table->edge_count, table->size);
    if (table->side_count != 2 * table->edge_count)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu sides for %zu cut edges", table->side_count,
                        table->edge_count);
    uint64_t sum = 0;
    for (size_t e = 0; e < table->edge_count; e++) {
        if (table->steps[e] < GVC_MIN_STEPS)
            return gvc_fail(error, GVC_ERROR_CORRUPT, "cut edge %zu has only %u steps", e,
                            table->steps[e]);
        sum += table->steps[e];
    }
    if (sum != half)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the cut edges have %llu steps instead of %u",
                        (unsigned long long)sum, half);
    return GVC_OK;
}

/** Finds where the sides of each edge begin, and that each edge has one of both kinds. As there are
 *  two sides per edge, no edge can lack one if none has one too many. */
static gvc_result locate_sides(const gvc_side_table *table, edge_sides *sides, gvc_error *error) {
    for (size_t e = 0; e < table->edge_count; e++) sides[e] = (edge_sides){UNSEEN, UNSEEN};
    uint32_t coordinate = 0;
    for (size_t i = 0; i < table->side_count; i++) {
        const gvc_side *side = &table->side[i];
        if (side->edge >= table->edge_count)
            return gvc_fail(error, GVC_ERROR_CORRUPT, "side %zu belongs to edge %u of %zu", i,
                            side->edge, table->edge_count);
        uint32_t *begin = side->reversed ? &sides[side->edge].reversed : &sides[side->edge].forward;
        if (*begin != UNSEEN)
            return gvc_fail(error, GVC_ERROR_CORRUPT, "side %zu is the second %s side of edge %u",
                            i, side->reversed ? "reversed" : "forward", side->edge);
        *begin = coordinate;
        coordinate += table->steps[side->edge];
    }
    return GVC_OK;
}

gvc_result gvc_glue_border(const gvc_side_table *table, uint32_t *representative,
                           gvc_error *error) {
    GVC_TRY(check_steps(table, error));
    edge_sides *sides = gvc_alloc(table->edge_count, sizeof *sides);
    if (!sides) return gvc_fail_memory(error);
    gvc_result result;
    GVC_CHECK(locate_sides(table, sides, error));

    uint32_t length = gvc_border_length(table->size);
    for (uint32_t i = 0; i < length; i++) representative[i] = i;
    for (size_t e = 0; e < table->edge_count; e++) {
        uint32_t n = table->steps[e];
        for (uint32_t j = 0; j <= n; j++)
            gvc_disjoint_unite(representative, (sides[e].forward + j) % length,
                               (sides[e].reversed + n - j) % length);
    }
    /* Parents come first (the least number is the root), so one pass flattens every tree. */
    for (uint32_t i = 0; i < length; i++) representative[i] = representative[representative[i]];

    for (size_t e = 0; e < table->edge_count; e++) {
        uint32_t begin = sides[e].forward, end = (begin + table->steps[e]) % length;
        if (table->steps[e] < 3 && representative[begin] == representative[end]) {
            result = gvc_fail(error, GVC_ERROR_CORRUPT,
                              "cut edge %zu is a loop of %u steps, at least 3 are needed", e,
                              table->steps[e]);
            goto cleanup;
        }
    }
cleanup:
    free(sides);
    return result;
}

bool gvc_glue_allows_corner(const uint32_t *representative, uint32_t border_length,
                            uint32_t corner) {
    enum { AROUND = 5 };
    uint32_t seen[AROUND];
    for (uint32_t i = 0; i < AROUND; i++) {
        seen[i] = representative[(corner + border_length - AROUND / 2 + i) % border_length];
        for (uint32_t k = 0; k < i; k++)
            if (seen[k] == seen[i]) return false;
    }
    return true;
}
