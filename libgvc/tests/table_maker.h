/* SPDX-License-Identifier: MIT */
/** @file table_maker.h  Side tables for tests: random trees and random gluings. */
#ifndef GVC_TESTS_TABLE_MAKER_H
#define GVC_TESTS_TABLE_MAKER_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "chart/side_table.h"

/** xorshift64*: the same numbers everywhere. */
static inline uint32_t random_below(uint64_t *state, uint32_t bound) {
    *state ^= *state >> 12;
    *state ^= *state << 25;
    *state ^= *state >> 27;
    return (uint32_t)((*state * UINT64_C(0x2545F4914F6CDD1D)) >> 33) % bound;
}

static inline gvc_side_table table_allocate(uint32_t size, size_t edge_count) {
    gvc_side_table table = {.size = size, .edge_count = edge_count, .side_count = 2 * edge_count};
    table.steps = calloc(edge_count, sizeof *table.steps);
    table.side = calloc(2 * edge_count, sizeof *table.side);
    assert_non_null(table.steps);
    assert_non_null(table.side);
    return table;
}

/** At least `minimum` steps for each edge, the rest spread at random. */
static inline void table_random_steps(gvc_side_table *table, uint32_t minimum, uint64_t *random) {
    uint32_t half = gvc_border_length(table->size) / 2;
    assert_true(table->edge_count * minimum <= half);
    uint32_t rest = half - (uint32_t)table->edge_count * minimum;
    for (size_t e = 0; e < table->edge_count; e++) table->steps[e] = minimum;
    if (random_below(random, 4) == 0) { /* one edge takes nearly all: the others stay short */
        uint32_t most = rest - rest / 8;
        table->steps[random_below(random, (uint32_t)table->edge_count)] += most;
        rest -= most;
    }
    for (; rest > 0; rest--) table->steps[random_below(random, (uint32_t)table->edge_count)]++;
}

/** A planar tree: walking around it opens an edge, or goes back along the latest open one. */
static inline void table_random_tree(gvc_side_table *table, uint64_t *random) {
    uint32_t open[64], depth = 0, next = 0;
    for (size_t i = 0; i < table->side_count; i++) {
        bool can_open = next<table->edge_count, can_close = depth> 0;
        if (can_open && (!can_close || random_below(random, 2))) {
            table->side[i] = (gvc_side){next, false};
            open[depth++] = next++;
        } else {
            table->side[i] = (gvc_side){open[--depth], true};
        }
    }
}

/** Any order of the sides whatsoever; genus is what comes out. */
static inline void table_random_gluing(gvc_side_table *table, uint64_t *random) {
    for (size_t e = 0; e < table->edge_count; e++) {
        table->side[2 * e] = (gvc_side){(uint32_t)e, false};
        table->side[2 * e + 1] = (gvc_side){(uint32_t)e, true};
    }
    for (size_t i = table->side_count - 1; i > 0; i--) {
        size_t k = random_below(random, (uint32_t)i + 1);
        gvc_side swap = table->side[i];
        table->side[i] = table->side[k];
        table->side[k] = swap;
    }
}

/** A star: `tips` edges of about equal length from one node. */
static inline gvc_side_table table_star(uint32_t size, uint32_t tips) {
    gvc_side_table table = table_allocate(size, tips);
    uint32_t half = gvc_border_length(size) / 2;
    for (uint32_t e = 0; e < tips; e++) {
        table.steps[e] = half * (e + 1) / tips - half * e / tips;
        table.side[2 * e] = (gvc_side){e, false};
        table.side[2 * e + 1] = (gvc_side){e, true};
    }
    return table;
}

#endif
