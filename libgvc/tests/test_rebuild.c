/* SPDX-License-Identifier: MIT */
/** @file test_rebuild.c  The promise of the format: whatever the codes, the surface is closed. */
#include "table_maker.h"

#include <math.h>
#include <string.h>

#include "base/digest.h"
#include "chart/rebuild.h"
#include "surface_check.h"

enum { LARGEST = 40 };
static uint16_t plane[3 * LARGEST * LARGEST], code[3 * LARGEST * LARGEST];
static uint32_t face[6 * LARGEST * LARGEST];

/** Codes of several kinds: all equal, two values (many ties), anything, extremes. */
static void random_planes(uint32_t size, uint32_t kind, uint64_t *random) {
    for (size_t i = 0; i < (size_t)3 * size * size; i++) switch (kind) {
        case 0:
            plane[i] = 777;
            break;
        case 1:
            plane[i] = (uint16_t)random_below(random, 2);
            break;
        case 2:
            plane[i] = (uint16_t)random_below(random, 65536);
            break;
        default:
            plane[i] = random_below(random, 2) ? 65535 : 0;
            break;
        }
}

static int64_t characteristic(const gvc_weld *weld) {
    int64_t faces = 2 * (int64_t)(weld->size - 1) * (weld->size - 1);
    return (int64_t)weld->vertex_count - faces / 2;
}

static void check_closed(const gvc_weld *weld, uint64_t *random) {
    assert_int_equal(characteristic(weld), 2 - 2 * (int64_t)weld->genus);
    for (uint32_t kind = 0; kind < 4; kind++) {
        random_planes(weld->size, kind, random);
        gvc_weld_codes(weld, plane, code);
        gvc_rebuild_faces(weld, code, face);
        size_t face_count = gvc_rebuild_face_count(weld);
        assert_int_equal(face_count, 2 * (weld->size - 1) * (weld->size - 1));
        assert_true(surface_is_closed_manifold(face, face_count, weld->vertex_count));
    }
}

/** Random tables of one kind; returns how many were accepted. */
static unsigned property(bool tree, unsigned rounds, uint64_t seed, unsigned genus_seen[16]) {
    uint64_t random = seed;
    unsigned accepted = 0;
    for (unsigned round = 0; round < rounds; round++) {
        uint32_t size = 16 + random_below(&random, LARGEST - 16 + 1);
        uint32_t edges = 1 + random_below(&random, tree ? 14 : 9);
        gvc_side_table table = table_allocate(size, edges);
        if (tree)
            table_random_tree(&table, &random);
        else
            table_random_gluing(&table, &random);
        table_random_steps(&table, GVC_MIN_STEPS, &random);
        table.start = random_below(&random, gvc_border_length(size));
        gvc_weld weld;
        gvc_error error;
        gvc_result result = gvc_weld_build(&table, &weld, &error);
        if (result == GVC_OK) {
            accepted++;
            if (tree) assert_int_equal(weld.genus, 0);
            if (weld.genus < 16) genus_seen[weld.genus]++;
            check_closed(&weld, &random);
        } else {
            assert_int_equal(result, GVC_ERROR_CORRUPT);
            assert_null(weld.vertex);
        }
        gvc_weld_free(&weld);
        gvc_side_table_free(&table);
    }
    return accepted;
}

static void test_trees_are_closed(void **state) {
    (void)state;
    unsigned genus_seen[16] = {0};
    unsigned accepted = property(true, 3000, 1, genus_seen);
    print_message("trees: %u of 3000 accepted\n", accepted);
    assert_true(accepted > 1000);
}

static void test_gluings_are_closed(void **state) {
    (void)state;
    unsigned genus_seen[16] = {0};
    unsigned accepted = property(false, 3000, 2, genus_seen);
    print_message("gluings: %u of 3000 accepted, of genus 0: %u, 1: %u, 2: %u, 3: %u, 4: %u\n",
                  accepted, genus_seen[0], genus_seen[1], genus_seen[2], genus_seen[3],
                  genus_seen[4]);
    for (int genus = 0; genus <= 4; genus++) assert_true(genus_seen[genus] > 20);
}

/** Every start of short-sided tables, so that nothing depends on luck around the corners. */
static void test_every_start_is_closed(void **state) {
    (void)state;
    uint64_t random = 3;
    for (unsigned round = 0; round < 30; round++) {
        gvc_side_table table = table_allocate(16, 15);
        if (round % 2) {
            table_random_tree(&table, &random);
        } else {
            table.edge_count = 10, table.side_count = 20;
            table_random_gluing(&table, &random);
        }
        table_random_steps(&table, 2, &random);
        for (table.start = 0; table.start < 60; table.start++) {
            gvc_weld weld;
            if (gvc_weld_build(&table, &weld, NULL) == GVC_OK) check_closed(&weld, &random);
            gvc_weld_free(&weld);
        }
        gvc_side_table_free(&table);
    }
}

static void test_library_agrees_on_topology(void **state) {
    (void)state;
    uint64_t random = 4;
    unsigned tried = 0;
    for (unsigned round = 0; tried < 50; round++) {
        assert_true(round < 5000);
        gvc_side_table table = table_allocate(24, 5);
        table_random_gluing(&table, &random);
        table_random_steps(&table, 3, &random);
        table.start = random_below(&random, 92);
        gvc_weld weld;
        if (gvc_weld_build(&table, &weld, NULL) == GVC_OK) {
            tried++;
            random_planes(24, round % 4, &random);
            gvc_mesh *mesh;
            gvc_topology topology;
            assert_int_equal(gvc_rebuild_mesh(&weld, plane, (double[3]){1, 2, 3}, 0.5, &mesh, NULL),
                             GVC_OK);
            assert_int_equal(mesh->face_count, 2 * 23 * 23);
            assert_int_equal(gvc_mesh_topology(mesh, &topology, NULL), GVC_OK);
            assert_true(topology.closed_manifold);
            assert_int_equal(topology.component_count, 1);
            assert_int_equal(topology.genus, weld.genus);
            gvc_mesh_destroy(&mesh);
        }
        gvc_weld_free(&weld);
        gvc_side_table_free(&table);
    }
}

static void test_codes_are_rounded_means(void **state) {
    (void)state;
    uint64_t random = 5;
    gvc_side_table table = table_star(20, 5);
    gvc_weld weld;
    table.start = 4;
    while (gvc_weld_build(&table, &weld, NULL) != GVC_OK) table.start++;
    random_planes(20, 3, &random);
    gvc_weld_codes(&weld, plane, code);
    for (uint32_t v = 0; v < weld.vertex_count; v++)
        for (size_t c = 0; c < 3; c++) {
            uint64_t sum = 0, count = 0;
            for (size_t i = 0; i < 400; i++)
                if (weld.vertex[i] == v) sum += plane[400 * c + i], count++;
            assert_true(count > 0);
            assert_int_equal(code[3 * v + c], (2 * sum + count) / (2 * count));
        }
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

/** Differences of 65535 in all components overflow 32 bits: the longer diagonal must not win. */
static void test_diagonals(void **state) {
    (void)state;
    gvc_side_table table = table_star(16, 3);
    gvc_weld weld;
    while (gvc_weld_build(&table, &weld, NULL) != GVC_OK) table.start++;
    memset(plane, 0, sizeof plane);
    size_t c = 6 * 16 + 6, b = 5 * 16 + 6; /* quad (5,5): a to c is 65535 * sqrt 3, b to d 40000 */
    for (size_t k = 0; k < 3; k++) plane[k * 256 + c] = 65535;
    plane[b] = 40000;
    gvc_weld_codes(&weld, plane, code);
    gvc_rebuild_faces(&weld, code, face);
    const uint32_t *quad = face + 6 * (5 * 15 + 5);
    uint32_t expected[6] = {weld.vertex[5 * 16 + 5], weld.vertex[b], weld.vertex[6 * 16 + 5],
                            weld.vertex[b],          weld.vertex[c], weld.vertex[6 * 16 + 5]};
    assert_memory_equal(quad, expected, sizeof expected);

    plane[b] = 0; /* quad (4,5) and others are tied: a to c */
    gvc_weld_codes(&weld, plane, code);
    gvc_rebuild_faces(&weld, code, face);
    quad = face + 6 * (8 * 15 + 8);
    uint32_t tied[6] = {weld.vertex[8 * 16 + 8], weld.vertex[8 * 16 + 9], weld.vertex[9 * 16 + 9],
                        weld.vertex[8 * 16 + 8], weld.vertex[9 * 16 + 9], weld.vertex[9 * 16 + 8]};
    assert_memory_equal(quad, tied, sizeof tied);
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

static void test_positions_and_limits(void **state) {
    (void)state;
    gvc_side_table table = table_star(16, 3);
    gvc_weld weld;
    while (gvc_weld_build(&table, &weld, NULL) != GVC_OK) table.start++;
    uint64_t random = 6;
    random_planes(16, 2, &random);
    double origin[3] = {-0.1, 1e6, 0}, step = 1.0 / 3;
    gvc_mesh *mesh;
    assert_int_equal(gvc_rebuild_mesh(&weld, plane, origin, step, &mesh, NULL), GVC_OK);
    gvc_weld_codes(&weld, plane, code);
    for (size_t i = 0; i < 3 * (size_t)weld.vertex_count; i++)
        assert_true(mesh->position[i] == (double)(float)(origin[i % 3] + step * code[i]));
    gvc_mesh_destroy(&mesh);

    gvc_error error;
    assert_int_equal(gvc_rebuild_mesh(&weld, plane, origin, 1e36, &mesh, &error),
                     GVC_ERROR_CORRUPT);
    assert_null(mesh);
    double nowhere[3] = {0, NAN, 0};
    assert_int_equal(gvc_rebuild_mesh(&weld, plane, nowhere, 1, &mesh, &error), GVC_ERROR_CORRUPT);
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

/** First eight bytes of the digest of `charts` equal charts. */
static void digest_of(const gvc_weld *weld, int charts, uint8_t digest[8]) {
    uint8_t whole[32];
    gvc_sha256 *sha = gvc_sha256_begin();
    assert_non_null(sha);
    for (int k = 0; k < charts; k++)
        assert_int_equal(gvc_rebuild_digest_update(sha, weld, code, face, NULL), GVC_OK);
    gvc_sha256_end(sha, whole);
    memcpy(digest, whole, 8);
}

/** The digest against the bytes written out one by one. */
static void test_digest(void **state) {
    (void)state;
    gvc_side_table table = table_star(33, 4);
    gvc_weld weld;
    while (gvc_weld_build(&table, &weld, NULL) != GVC_OK) table.start++;
    uint64_t random = 7;
    random_planes(33, 2, &random);
    gvc_weld_codes(&weld, plane, code);
    gvc_rebuild_faces(&weld, code, face);
    uint32_t counts[2] = {weld.vertex_count, 2 * 32 * 32};
    size_t indices = 3 * (size_t)counts[1], codes = 3 * (size_t)counts[0], n = 0;
    uint8_t *bytes = malloc(8 + 2 * codes + 4 * indices), whole[32], digest[8];
    assert_non_null(bytes);
    for (int k = 0; k < 2; k++)
        for (int shift = 24; shift >= 0; shift -= 8) bytes[n++] = (uint8_t)(counts[k] >> shift);
    for (size_t i = 0; i < codes; i++)
        bytes[n++] = (uint8_t)(code[i] >> 8), bytes[n++] = (uint8_t)code[i];
    for (size_t i = 0; i < indices; i++)
        for (int shift = 24; shift >= 0; shift -= 8) bytes[n++] = (uint8_t)(face[i] >> shift);
    for (int charts = 1; charts <= 2; charts++) {
        gvc_sha256 *sha = gvc_sha256_begin();
        assert_non_null(sha);
        for (int k = 0; k < charts; k++) gvc_sha256_update(sha, bytes, n);
        gvc_sha256_end(sha, whole);
        digest_of(&weld, charts, digest);
        assert_memory_equal(digest, whole, 8);
    }
    code[0] ^= 1;
    digest_of(&weld, 2, digest);
    assert_memory_not_equal(digest, whole, 8);
    free(bytes);
    gvc_weld_free(&weld);
    gvc_side_table_free(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trees_are_closed),
        cmocka_unit_test(test_gluings_are_closed),
        cmocka_unit_test(test_every_start_is_closed),
        cmocka_unit_test(test_library_agrees_on_topology),
        cmocka_unit_test(test_codes_are_rounded_means),
        cmocka_unit_test(test_diagonals),
        cmocka_unit_test(test_positions_and_limits),
        cmocka_unit_test(test_digest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
