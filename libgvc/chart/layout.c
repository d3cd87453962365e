/* SPDX-License-Identifier: MIT */
/** @file layout.c  Whole pixel steps for the sides, and where the sides may start. */
#include "chart/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "chart/gluing.h"

#define LOOP_STEPS 3u /* of an edge whose two nodes are one, see gvc_weld_build */

/** One edge's claim on the steps. */
typedef struct share {
    double length;
    double remainder; /**< what rounding down took away */
    uint32_t minimum, steps;
    bool at_minimum; /**< its proportional part would be less than the minimum */
} share;

/** Steps still to give, and the length they are in proportion to, when edges at their minimum are
 *  left out. */
static double free_length(const share *shares, size_t count, uint32_t total, uint32_t *steps) {
    double length = 0;
    *steps = total;
    for (size_t i = 0; i < count; i++) {
        if (shares[i].at_minimum)
            *steps -= shares[i].minimum;
        else
            length += shares[i].length;
    }
    return length;
}

/** Rounds the proportional parts down and gives the rest to the largest remainders, the first of
 *  equal ones. */
static void round_shares(share *shares, size_t count, double length, uint32_t steps) {
    uint32_t left = steps;
    for (size_t i = 0; i < count; i++) {
        share *s = &shares[i];
        s->remainder = -1;
        s->steps = s->minimum;
        if (s->at_minimum) continue;
        double part = s->length / length * steps;
        s->steps = (uint32_t)part;
        s->remainder = part - s->steps;
        left -= s->steps;
    }
    for (; left > 0; left--) {
        share *largest = &shares[0];
        for (size_t i = 1; i < count; i++)
            if (shares[i].remainder > largest->remainder) largest = &shares[i];
        largest->steps++;
        largest->remainder = -1;
    }
}

/** Divides `total` steps in proportion to length, none below its minimum. */
static gvc_result apportion(share *shares, size_t count, uint32_t total, gvc_error *error) {
    uint64_t needed = 0;
    double whole = 0;
    for (size_t i = 0; i < count; i++) {
        needed += shares[i].minimum;
        whole += shares[i].length;
        if (!(shares[i].length >= 0) || !isfinite(whole))
            return gvc_fail(error, GVC_ERROR_ARGUMENT, "cut edge %zu has the length %g", i,
                            shares[i].length);
    }
    if (needed > total)
        return gvc_fail(error, GVC_ERROR_MESH,
                        "%zu cut edges need %llu steps, the image has only %u", count,
                        (unsigned long long)needed, total);
    for (size_t i = 0; i < count && whole == 0; i++) shares[i].length = 1;

    uint32_t steps;
    double length;
    bool changed;
    do { /* each edge raised to its minimum leaves less to the others */
        length = free_length(shares, count, total, &steps);
        changed = false;
        for (size_t i = 0; i < count; i++) {
            share *s = &shares[i];
            if (s->at_minimum || s->length / length * steps >= s->minimum) continue;
            s->at_minimum = changed = true;
        }
    } while (changed);
    round_shares(shares, count, length, steps);
    return GVC_OK;
}

/** Fills table->steps for table->size. */
static gvc_result divide_steps(const gvc_cut_graph *graph, const double *length,
                               gvc_side_table *table, gvc_error *error) {
    share *shares = gvc_alloc(table->edge_count, sizeof *shares);
    if (!shares) return gvc_fail_memory(error);
    for (size_t e = 0; e < table->edge_count; e++) {
        const uint32_t *node = graph->edge[e].node;
        shares[e].length = length[e];
        shares[e].minimum = node[0] == node[1] ? LOOP_STEPS : GVC_MIN_STEPS;
    }
    gvc_result result =
        apportion(shares, table->edge_count, gvc_border_length(table->size) / 2, error);
    for (size_t e = 0; e < table->edge_count; e++) table->steps[e] = shares[e].steps;
    free(shares);
    return result;
}

static gvc_result check_request(uint32_t size, size_t edge_count, size_t side_count,
                                const gvc_cut_graph *graph, gvc_error *error) {
    if (size < GVC_MIN_IMAGE_SIZE || size > GVC_MAX_IMAGE_SIZE)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "image size %u is not within %u..%u", size,
                        GVC_MIN_IMAGE_SIZE, GVC_MAX_IMAGE_SIZE);
    if (edge_count == 0 || edge_count != graph->edge_count || side_count != 2 * edge_count)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "%zu sides for %zu cut edges", side_count,
                        graph->edge_count);
    return GVC_OK;
}

gvc_result gvc_layout_make(const gvc_border_run *run, size_t run_count, const gvc_cut_graph *graph,
                           const double *length, uint32_t size, gvc_side_table *table,
                           gvc_error *error) {
    *table = (gvc_side_table){0};
    GVC_TRY(check_request(size, graph->edge_count, run_count, graph, error));
    table->size = size;
    table->edge_count = graph->edge_count;
    table->side_count = run_count;
    table->steps = gvc_alloc(table->edge_count, sizeof *table->steps);
    table->side = gvc_alloc(table->side_count, sizeof *table->side);
    gvc_result result = table->steps && table->side ? divide_steps(graph, length, table, error)
                                                    : gvc_fail_memory(error);
    if (result != GVC_OK) {
        gvc_side_table_free(table);
        return result;
    }
    for (size_t i = 0; i < run_count; i++)
        table->side[i] = (gvc_side){run[i].edge, run[i].reversed};
    return GVC_OK;
}

gvc_result gvc_layout_resize(const gvc_side_table *table, const gvc_cut_graph *graph, uint32_t size,
                             gvc_side_table *resized, gvc_error *error) {
    *resized = (gvc_side_table){0};
    GVC_TRY(check_request(size, table->edge_count, table->side_count, graph, error));
    double *length = gvc_alloc(table->edge_count, sizeof *length);
    gvc_result result =
        length ? gvc_side_table_copy(table, resized, error) : gvc_fail_memory(error);
    if (result == GVC_OK) {
        for (size_t e = 0; e < table->edge_count; e++) length[e] = table->steps[e];
        uint64_t from = gvc_border_length(table->size), to = gvc_border_length(size);
        resized->size = size;
        resized->start = (uint32_t)((2 * table->start * to + from) / (2 * from) % to);
        result = divide_steps(graph, length, resized, error);
    }
    if (result != GVC_OK) gvc_side_table_free(resized);
    free(length);
    return result;
}

gvc_result gvc_layout_starts(const gvc_side_table *table, uint32_t *starts, size_t *count,
                             gvc_error *error) {
    *count = 0;
    GVC_TRY(gvc_glue_check_size(table->size, error));
    uint32_t length = gvc_border_length(table->size), last = table->size - 1;
    uint32_t *representative = gvc_alloc(length, sizeof *representative);
    bool *allowed = gvc_alloc(length, sizeof *allowed); /* a corner at this loop coordinate */
    gvc_result result = GVC_OK;
    if (!representative || !allowed) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(gvc_glue_border(table, representative, error));
    for (uint32_t c = 0; c < length; c++)
        allowed[c] = gvc_glue_allows_corner(representative, length, c);
    for (uint32_t start = 0; start < length; start++) {
        bool all = true;
        for (uint32_t k = 0; k < 4; k++) all &= allowed[(k * last + length - start) % length];
        if (all) starts[(*count)++] = start;
    }
cleanup:
    free(allowed);
    free(representative);
    return result;
}
