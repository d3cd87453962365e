/* SPDX-License-Identifier: MIT */
/** @file test_side_table.c  The rules on side tables, and the weld they give. */
#include "table_maker.h"

#include <string.h>

static gvc_result try_build(const gvc_side_table *table) {
    gvc_weld weld;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_weld_build(table, &weld, &error);
    assert_int_equal(error.code, result);
    if (result != GVC_OK) {
        assert_true(error.message[0] != '\0');
        assert_null(weld.vertex);
        assert_null(weld.ring);
        assert_null(weld.fold);
    }
    gvc_weld_free(&weld);
    return result;
}

/** A star of four tips on 33 x 33 with sides of 16 steps: folds at start + 16, 48, 80, 112. */
static gvc_side_table good_table(void) {
    gvc_side_table table = table_star(33, 4);
    table.start = 8;
    return table;
}

static void test_border_pixels(void **state) {
    (void)state;
    for (uint32_t size = 16; size < 40; size += 7) {
        uint32_t length = gvc_border_length(size), px = 0, py = 0;
        for (uint32_t p = 0; p <= length; p++) {
            uint32_t x, y;
            gvc_border_pixel(size, p, &x, &y);
            assert_true(x == 0 || y == 0 || x == size - 1 || y == size - 1);
            assert_int_equal(gvc_border_position(size, x, y), p % length);
            if (p > 0) assert_int_equal((x > px ? x - px : px - x) + (y > py ? y - py : py - y), 1);
            px = x, py = y;
        }
        uint32_t x, y;
        gvc_border_pixel(size, size - 1, &x, &y);
        assert_int_equal(x, size - 1);
        assert_int_equal(y, 0);
    }
}

static void test_rejects_broken_tables(void **state) {
    (void)state;
    gvc_side_table table = good_table(), bad;
    assert_int_equal(try_build(&table), GVC_OK);
#define REJECTED(change)                                                                           \
    do {                                                                                           \
        assert_int_equal(gvc_side_table_copy(&table, &bad, NULL), GVC_OK);                         \
        change;                                                                                    \
        assert_int_equal(try_build(&bad), GVC_ERROR_CORRUPT);                                      \
        gvc_side_table_free(&bad);                                                                 \
    } while (0)
    REJECTED(bad.size = 15);
    REJECTED(bad.size = 0);
    REJECTED(bad.size = 34);
    REJECTED(bad.size = 2050);
    REJECTED(bad.size = UINT32_MAX);
    REJECTED(bad.start = 128);
    REJECTED(bad.start = UINT32_MAX);
    REJECTED(bad.edge_count = 0);
    REJECTED(bad.edge_count = 0; bad.side_count = 0);
    REJECTED(bad.edge_count = SIZE_MAX);
    REJECTED(bad.side_count = 7);
    REJECTED(bad.edge_count = 3);
    REJECTED(bad.steps[0]++);
    REJECTED(bad.steps[0] -= 15; bad.steps[1] += 15);
    REJECTED(bad.steps[0] = 0; bad.steps[1] = 32);
    REJECTED(bad.steps[0] += UINT32_MAX);
    REJECTED(bad.side[0].edge = 4);
    REJECTED(bad.side[0].edge = UINT32_MAX);
    REJECTED(bad.side[0].edge = 1);
    REJECTED(bad.side[0].reversed = true);
    REJECTED(bad.start = 16); /* puts the first fold on a corner */
    REJECTED(bad.start = 15); /* one step from it */
    REJECTED(bad.start = 17);
#undef REJECTED
    gvc_side_table_free(&table);
}

static void test_folds_two_steps_from_corners_are_fine(void **state) {
    (void)state;
    gvc_side_table table = good_table();
    table.start = 14;
    assert_int_equal(try_build(&table), GVC_OK);
    table.start = 18;
    assert_int_equal(try_build(&table), GVC_OK);
    gvc_side_table_free(&table);
}

/** On a torus a b a' b' both edges are loops: two steps would join the same vertices twice. */
static void test_loops_need_three_steps(void **state) {
    (void)state;
    gvc_side_table table = table_allocate(33, 2);
    gvc_side sides[4] = {{0, false}, {1, false}, {0, true}, {1, true}};
    memcpy(table.side, sides, sizeof sides);
    table.start = 9;
    table.steps[0] = 2, table.steps[1] = 62;
    assert_int_equal(try_build(&table), GVC_ERROR_CORRUPT);
    table.steps[0] = 3, table.steps[1] = 61;
    assert_int_equal(try_build(&table), GVC_OK);
    gvc_weld weld;
    assert_int_equal(gvc_weld_build(&table, &weld, NULL), GVC_OK);
    assert_int_equal(weld.genus, 1);
    for (uint32_t p = 0; p < weld.border_count; p++) assert_false(weld.fold[p]);
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

static uint32_t vertex_at(const gvc_weld *weld, uint32_t position) {
    uint32_t x, y;
    gvc_border_pixel(weld->size, position, &x, &y);
    return weld->vertex[y * weld->size + x];
}

static void test_star_weld(void **state) {
    (void)state;
    gvc_side_table table = good_table();
    gvc_weld weld;
    assert_int_equal(gvc_weld_build(&table, &weld, NULL), GVC_OK);
    assert_int_equal(weld.size, 33);
    assert_int_equal(weld.border_count, 128);
    assert_int_equal(weld.genus, 0);
    assert_int_equal(weld.vertex_count, 31 * 31 + 4 * 16 + 1);
    for (uint32_t p = 0; p < 128; p++) {
        uint32_t along = (p + 128 - 8) % 128, within = along % 32;
        uint32_t twin = (8 + along - within + (32 - within)) % 128;
        assert_int_equal(vertex_at(&weld, p), vertex_at(&weld, twin));
        assert_int_equal(weld.fold[p], within == 16);
        uint32_t members = 1;
        for (uint32_t q = weld.ring[p]; q != p; q = weld.ring[q]) {
            assert_int_equal(vertex_at(&weld, q), vertex_at(&weld, p));
            members++;
        }
        assert_int_equal(members, within == 16 ? 1 : within == 0 ? 4 : 2);
    }
    uint32_t next = 0; /* numbered in raster order of the first sample */
    for (size_t i = 0; i < 33 * 33; i++) {
        assert_true(weld.vertex[i] <= next);
        if (weld.vertex[i] == next) next++;
    }
    assert_int_equal(next, weld.vertex_count);
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

/** The rule must not be too strict: what keeps folds away from corners is nearly always allowed. */
static void test_most_starts_are_accepted(void **state) {
    (void)state;
    uint64_t random = 11;
    unsigned candidates = 0, accepted = 0;
    for (unsigned round = 0; round < 12; round++) {
        uint32_t size = 48 + 19 * round;
        gvc_side_table table = table_star(size, 5);
        if (round % 2) { /* five tips of a body: two junctions, five limbs */
            gvc_side_table_free(&table);
            table = table_allocate(size, 6);
            gvc_side sides[12] = {{0, false}, {0, true},  {1, false}, {1, true},
                                  {2, false}, {3, false}, {3, true},  {4, false},
                                  {4, true},  {2, true},  {5, false}, {5, true}};
            memcpy(table.side, sides, sizeof sides);
            table_random_steps(&table, 4, &random);
        }
        uint32_t length = gvc_border_length(size);
        for (table.start = 0; table.start < length; table.start += 1 + size / 32) {
            bool fold_is_near = false;
            uint32_t at = table.start;
            for (size_t i = 0; i < table.side_count; i++) {
                uint32_t edge = table.side[i].edge;
                uint32_t before = table.side[(i + table.side_count - 1) % table.side_count].edge;
                uint32_t beside = at % (size - 1);
                if (edge == before && (beside < 2 || beside > size - 3)) fold_is_near = true;
                at += table.steps[edge];
            }
            gvc_result result = try_build(&table);
            if (fold_is_near) {
                assert_int_equal(result, GVC_ERROR_CORRUPT);
            } else {
                candidates++;
                accepted += result == GVC_OK;
            }
        }
        gvc_side_table_free(&table);
    }
    print_message("%u of %u starts accepted\n", accepted, candidates);
    assert_true(candidates > 150);
    assert_true(accepted * 100 >= candidates * 97);
}

static void test_largest_table(void **state) {
    (void)state;
    gvc_side_table table = table_star(2049, 2048), copy;
    for (table.start = 0; try_build(&table) != GVC_OK; table.start++)
        assert_true(table.start < 8); /* two steps per side: a fold at every fourth position */
    assert_int_equal(gvc_side_table_copy(&table, &copy, NULL), GVC_OK);
    assert_int_equal(copy.start, table.start);
    assert_memory_equal(copy.side, table.side, table.side_count * sizeof *table.side);
    gvc_side_table_free(&copy);
    gvc_side_table_free(&copy);
    gvc_side_table_free(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_border_pixels),
        cmocka_unit_test(test_rejects_broken_tables),
        cmocka_unit_test(test_folds_two_steps_from_corners_are_fine),
        cmocka_unit_test(test_loops_need_three_steps),
        cmocka_unit_test(test_star_weld),
        cmocka_unit_test(test_most_starts_are_accepted),
        cmocka_unit_test(test_largest_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
