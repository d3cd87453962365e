/* SPDX-License-Identifier: MIT */
/** @file test_layout.c  Steps, starts, and the border's place on the square. */
#include "cut_maker.h"

#include <math.h>
#include <string.h>

#include "chart/layout.h"

/* ---------------------------------------------------------------------------------------- steps */

/** A path of `count` edges, edge 0 closed to a loop if asked for; only for the minima. */
static gvc_cut_graph plain_graph(uint32_t count, bool loop) {
    gvc_cut_graph graph = {.node_count = count + 1, .edge_count = count};
    graph.node = calloc(count + 1, sizeof *graph.node);
    graph.edge = calloc(count, sizeof *graph.edge);
    assert_true(graph.node && graph.edge);
    for (uint32_t e = 0; e < count; e++) graph.edge[e] = (gvc_cut_edge){{e, e + 1}, NULL, 0};
    if (loop) graph.edge[0].node[1] = 0;
    return graph;
}

/** There and back along a path. */
static void plain_runs(uint32_t count, gvc_border_run *run) {
    for (uint32_t e = 0; e < count; e++) {
        run[e] = (gvc_border_run){e, false, e, 1};
        run[2 * count - 1 - e] = (gvc_border_run){e, true, 2 * count - 1 - e, 1};
    }
}

static gvc_result make(uint32_t count, bool loop, const double *length, uint32_t size,
                       gvc_side_table *table) {
    gvc_border_run run[64];
    gvc_cut_graph graph = plain_graph(count, loop);
    plain_runs(count, run);
    gvc_result result = gvc_layout_make(run, 2 * count, &graph, length, size, table, NULL);
    gvc_cut_graph_free(&graph);
    return result;
}

static void check_steps(uint32_t count, bool loop, const double *length, uint32_t size,
                        const uint32_t *expected) {
    gvc_side_table table;
    assert_int_equal(make(count, loop, length, size, &table), GVC_OK);
    assert_int_equal(table.size, size);
    assert_int_equal(table.start, 0);
    assert_memory_equal(table.steps, expected, count * sizeof *expected);
    for (uint32_t i = 0; i < 2 * count; i++) {
        assert_int_equal(table.side[i].edge, i < count ? i : 2 * count - 1 - i);
        assert_int_equal(table.side[i].reversed, i >= count);
    }
    gvc_side_table_free(&table);
}

static void test_apportions_steps(void **state) {
    (void)state;
    check_steps(1, false, (double[]){3}, 16, (uint32_t[]){30});
    check_steps(3, false, (double[]){1, 1, 1}, 16, (uint32_t[]){10, 10, 10});
    check_steps(3, false, (double[]){0, 0, 0}, 16, (uint32_t[]){10, 10, 10});
    check_steps(2, false, (double[]){1e-9, 1}, 16, (uint32_t[]){2, 28});
    check_steps(2, true, (double[]){1e-9, 1}, 16, (uint32_t[]){3, 27});
    /* 7.5 each: ties go to the first edges */
    check_steps(4, false, (double[]){5, 5, 5, 5}, 16, (uint32_t[]){8, 8, 7, 7});
    /* 10.7, 10.6, 8.7: the largest remainders, the first of equal ones */
    check_steps(3, false, (double[]){10.7, 10.6, 8.7}, 16, (uint32_t[]){11, 10, 9});
    /* raising the short ones takes from the others in proportion, which lowers the third in turn */
    check_steps(4, false, (double[]){0, 0, 2.05, 27.95}, 16, (uint32_t[]){2, 2, 2, 24});
    check_steps(15, false, (double[]){1, 9, 3, 4, 5, 6, 7, 1, 1, 1, 1, 1, 1, 1, 1}, 16,
                (uint32_t[]){2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2});
}

static void test_apportions_anything(void **state) {
    (void)state;
    uint64_t random = 5;
    for (int round = 0; round < 2000; round++) {
        uint32_t count = 1 + random_below(&random, 15), size = 17 + random_below(&random, 300);
        double length[15], whole = 0;
        for (uint32_t e = 0; e < count; e++) {
            length[e] = random_below(&random, 1000) * (random_below(&random, 4) ? 1 : 1e-3);
            whole += length[e];
        }
        gvc_side_table table;
        assert_int_equal(make(count, round % 2, length, size, &table), GVC_OK);
        uint32_t sum = 0, half = 2 * (size - 1);
        for (uint32_t e = 0; e < count; e++) {
            sum += table.steps[e];
            assert_true(table.steps[e] >= (e == 0 && round % 2 ? 3u : 2u));
            if (whole > 0) assert_true(table.steps[e] <= length[e] / whole * half + 3);
        }
        assert_int_equal(sum, half);
        gvc_side_table_free(&table);
    }
}

static void test_refuses_bad_requests(void **state) {
    (void)state;
    gvc_side_table table;
    double many[16] = {0}, bad[2] = {1, NAN}, negative[2] = {1, -1}, huge[2] = {1e308, 1e308};
    assert_int_equal(make(16, false, many, 16, &table), GVC_ERROR_MESH);
    assert_null(table.steps);
    assert_int_equal(make(15, true, many, 16, &table), GVC_ERROR_MESH);
    assert_int_equal(make(2, false, bad, 16, &table), GVC_ERROR_ARGUMENT);
    assert_int_equal(make(2, false, negative, 16, &table), GVC_ERROR_ARGUMENT);
    assert_int_equal(make(2, false, huge, 16, &table), GVC_ERROR_ARGUMENT);
    assert_int_equal(make(2, false, many, 15, &table), GVC_ERROR_ARGUMENT);
    assert_int_equal(make(2, false, many, 2050, &table), GVC_ERROR_ARGUMENT);
}

static void test_resizes(void **state) {
    (void)state;
    gvc_cut_graph graph = plain_graph(3, false);
    gvc_side_table table, resized;
    assert_int_equal(make(3, false, (double[]){1, 2, 5}, 65, &table), GVC_OK);
    table.start = 100;
    assert_int_equal(gvc_layout_resize(&table, &graph, 129, &resized, NULL), GVC_OK);
    assert_memory_equal(resized.steps, ((uint32_t[]){32, 64, 160}), 3 * sizeof(uint32_t));
    assert_int_equal(resized.start, 200);
    assert_int_equal(resized.size, 129);
    assert_memory_equal(resized.side, table.side, 6 * sizeof *table.side);
    gvc_side_table_free(&resized);
    table.start = 255; /* rounds to a whole turn */
    assert_int_equal(gvc_layout_resize(&table, &graph, 17, &resized, NULL), GVC_OK);
    assert_int_equal(resized.start, 0);
    assert_memory_equal(resized.steps, ((uint32_t[]){4, 8, 20}), 3 * sizeof(uint32_t));
    gvc_side_table_free(&resized);
    gvc_side_table_free(&table);
    gvc_cut_graph_free(&graph);
}

static void test_starts_are_those_the_weld_allows(void **state) {
    (void)state;
    uint64_t random = 12;
    static uint32_t starts[4 * 2048];
    for (unsigned round = 0; round < 60; round++) {
        uint32_t size = 16 + random_below(&random, 25);
        gvc_side_table table = table_allocate(size, 1 + random_below(&random, 10));
        if (round % 2)
            table_random_tree(&table, &random);
        else
            table_random_gluing(&table, &random);
        table_random_steps(&table, 3, &random);
        size_t count, next = 0;
        table.start = 12345; /* not looked at */
        assert_int_equal(gvc_layout_starts(&table, starts, &count, NULL), GVC_OK);
        for (table.start = 0; table.start < gvc_border_length(size); table.start++) {
            gvc_weld weld;
            bool allowed = gvc_weld_build(&table, &weld, NULL) == GVC_OK;
            bool listed = next < count && starts[next] == table.start;
            assert_int_equal(allowed, listed);
            next += listed;
            gvc_weld_free(&weld);
        }
        assert_int_equal(next, count);
        gvc_side_table_free(&table);
    }
    gvc_side_table large = table_star(2049, 7);
    size_t count;
    assert_int_equal(gvc_layout_starts(&large, starts, &count, NULL), GVC_OK);
    assert_int_equal(count, 8192 - 7 * 4 * 3);
    large.steps[0]++;
    assert_int_equal(gvc_layout_starts(&large, starts, &count, NULL), GVC_ERROR_CORRUPT);
    assert_int_equal(count, 0);
    gvc_side_table_free(&large);
}

/* ---------------------------------------------------------------------------------------- place */

static double area(const gvc_halfedges *m) {
    double sum = 0;
    for (size_t f = 0; f < m->face_count; f++) {
        double e[2][3], n[3];
        for (int k = 0; k < 3; k++) {
            const double *a = m->position + 3 * m->vertex[3 * f];
            e[0][k] = m->position[3 * m->vertex[3 * f + 1] + k] - a[k];
            e[1][k] = m->position[3 * m->vertex[3 * f + 2] + k] - a[k];
        }
        for (int k = 0; k < 3; k++)
            n[k] = e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3];
        sum += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return sum;
}

/** Border position of a point that must lie exactly on the border of the square. */
static double position_of(const double *uv, uint32_t size) {
    double last = size - 1;
    assert_true(uv[0] >= 0 && uv[0] <= last && uv[1] >= 0 && uv[1] <= last);
    if (uv[1] == 0 && uv[0] < last) return uv[0];
    if (uv[0] == last && uv[1] < last) return last + uv[1];
    if (uv[1] == last && uv[0] > 0) return 3 * last - uv[0];
    assert_true(uv[0] == 0);
    return 4 * last - uv[1];
}

/** Positions ascend along the border; corners of the square and nodes are exactly there; the border
 *  arrays fit each other. */
static void check_border(const gvc_disk *disk, const gvc_side_table *table, const double *uv) {
    const gvc_halfedges *m = &disk->mesh;
    double length = gvc_border_length(table->size), before = -1, begin = 0;
    unsigned corners = 0;
    size_t next = 0;
    for (size_t r = 0; r < disk->run_count; r++) {
        const gvc_border_run *run = &disk->run[r];
        assert_int_equal(run->first, next);
        double along = 0;
        for (size_t i = 0; i < run->count; i++, next++) {
            uint32_t v = disk->border[next], h = m->outgoing[v];
            assert_int_equal(m->twin[h], GVC_NONE);
            assert_int_equal(m->vertex[gvc_next(h)], disk->border[(next + 1) % disk->border_count]);
            assert_true(fabs(disk->border_length[next] - along) < 1e-9);
            along += gvc_halfedge_length(m, h);
            double p = position_of(uv + 2 * v, table->size) - table->start;
            if (p < 0) p += length;
            if (i == 0) assert_true(p == begin);
            assert_true(p > before);
            before = p;
            bool at_x = uv[2 * v] == 0 || uv[2 * v] == table->size - 1;
            bool at_y = uv[2 * v + 1] == 0 || uv[2 * v + 1] == table->size - 1;
            corners += at_x && at_y;
        }
        begin += table->steps[run->edge];
    }
    assert_true(before < length);
    assert_int_equal(next, disk->border_count);
    assert_int_equal(corners, 4);
}

/** Uniform weights put every inner vertex strictly inside, and no face is flat or turned over
 *  (Tutte 1963, Floater 2003), if and only if the border was prepared rightly. */
static void check_embeds(const gvc_disk *disk, double *uv) {
    const gvc_halfedges *m = &disk->mesh;
    uint8_t *on_border = calloc(m->vertex_count, 1);
    assert_non_null(on_border);
    for (size_t i = 0; i < disk->border_count; i++) on_border[disk->border[i]] = 1;
    for (int round = 0; round < 3000; round++)
        for (uint32_t v = 0; v < m->vertex_count; v++) {
            if (on_border[v]) continue;
            double sum[2] = {0, 0}, degree = 0;
            uint32_t h = m->outgoing[v];
            do {
                uint32_t w = m->vertex[gvc_next(h)];
                sum[0] += uv[2 * w], sum[1] += uv[2 * w + 1], degree++;
                h = gvc_turn(m, h);
            } while (h != m->outgoing[v]);
            uv[2 * v] = sum[0] / degree, uv[2 * v + 1] = sum[1] / degree;
        }
    double whole = 0;
    for (size_t f = 0; f < m->face_count; f++) {
        const double *a = uv + 2 * m->vertex[3 * f], *b = uv + 2 * m->vertex[3 * f + 1],
                     *c = uv + 2 * m->vertex[3 * f + 2];
        double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert_true(twice > 0);
        whole += twice;
    }
    double side = 0;
    for (size_t i = 0; i < 2 * m->vertex_count; i++) side = fmax(side, uv[i]);
    assert_true(fabs(whole / 2 - side * side) < 1e-6 * side * side);
    free(on_border);
}

static void check_no_chords(const gvc_disk *disk) {
    const gvc_halfedges *m = &disk->mesh;
    uint8_t *on_border = calloc(m->vertex_count, 1);
    assert_non_null(on_border);
    for (size_t i = 0; i < disk->border_count; i++) on_border[disk->border[i]] = 1;
    for (uint32_t h = 0; h < 3 * m->face_count; h++)
        assert_false(m->twin[h] != GVC_NONE && on_border[m->vertex[h]] &&
                     on_border[m->vertex[gvc_next(h)]]);
    free(on_border);
}

static gvc_side_table table_for(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                                const gvc_disk *disk, uint32_t size) {
    double *length = calloc(graph->edge_count, sizeof *length);
    assert_non_null(length);
    for (size_t e = 0; e < graph->edge_count; e++)
        length[e] = gvc_cut_edge_length(mesh, &graph->edge[e]);
    gvc_side_table table;
    assert_int_equal(gvc_layout_make(disk->run, disk->run_count, graph, length, size, &table, NULL),
                     GVC_OK);
    free(length);
    return table;
}

static void check_place(const gvc_halfedges *mesh, const gvc_cut_graph *graph, int genus,
                        gvc_side_table *table, uint32_t start, bool embed) {
    gvc_disk disk;
    double *uv;
    table->start = start;
    assert_int_equal(gvc_disk_open(mesh, graph, &disk, NULL), GVC_OK);
    size_t vertices = disk.mesh.vertex_count;
    assert_int_equal(gvc_layout_place(&disk, table, &uv, NULL), GVC_OK);
    assert_true(fabs(area(&disk.mesh) - area(mesh)) < 1e-9 * area(mesh));
    for (size_t v = vertices; v < disk.mesh.vertex_count; v++)
        assert_int_equal(disk.original[v], GVC_NONE);
    check_border(&disk, table, uv);
    check_no_chords(&disk);
    if (embed) check_embeds(&disk, uv);
    gvc_weld weld;
    assert_int_equal(gvc_weld_build(table, &weld, NULL), GVC_OK);
    assert_int_equal(weld.genus, genus);
    gvc_weld_free(&weld);
    free(uv);
    gvc_disk_free(&disk);
}

/** `mesh` cut at random, placed at several starts. */
static void check_mesh(const gvc_halfedges *mesh, int genus, uint32_t size, uint32_t tips,
                       uint64_t seed, size_t start_count) {
    gvc_cut_graph graph = made_cut(mesh, tips, seed);
    if (graph.edge_count > 0) {
        gvc_disk disk;
        assert_int_equal(gvc_disk_open(mesh, &graph, &disk, NULL), GVC_OK);
        gvc_side_table table = table_for(mesh, &graph, &disk, size);
        gvc_disk_free(&disk);
        static uint32_t starts[4 * 2048];
        size_t count;
        assert_int_equal(gvc_layout_starts(&table, starts, &count, NULL), GVC_OK);
        for (size_t i = 0; i < count; i += 1 + count / start_count)
            check_place(mesh, &graph, genus, &table, starts[i], i == 0);
        gvc_side_table_free(&table);
    }
    gvc_cut_graph_free(&graph);
}

static void test_places_random_cuts(void **state) {
    (void)state;
    for (int genus = 0; genus <= 3; genus++)
        for (int jitter = 0; jitter < 2; jitter++) {
            gvc_halfedges mesh = made_bar(genus, 1 + (genus < 2), jitter * 0.2);
            for (uint64_t seed = 0; seed < 12; seed++)
                check_mesh(&mesh, genus, 40 + 5 * (uint32_t)seed, 2 + seed % 5, seed, 6);
            gvc_halfedges_free(&mesh);
        }
}

/** So coarse that nearly every face has only border vertices. */
static void test_places_an_octahedron(void **state) {
    (void)state;
    gvc_halfedges mesh = made_octahedron();
    for (uint64_t seed = 0; seed < 60; seed++)
        check_mesh(&mesh, 0, 16 + (uint32_t)seed % 8, 2 + seed % 6, seed, 60);
    gvc_halfedges_free(&mesh);
}

/** A path of six mesh edges of nearly equal length on 36 steps: corners of the square fall within
 *  1e-3 pixels of border vertices, which then move, to either side, and get no neighbour. */
static void test_corners_on_vertices(void **state) {
    (void)state;
    gvc_halfedges mesh = made_bar(0, 3, 0);
    uint64_t random = 8;
    uint32_t path[8], count = 0; /* the lattice points (0..3, 0, 0), then up in y */
    for (int i = 0; i < 7; i++)
        for (uint32_t v = 0; v < mesh.vertex_count; v++) {
            const double *p = mesh.position + 3 * v;
            double x = i < 3 ? i : 3, y = i < 3 ? 0 : i - 3;
            if (p[0] == x && p[1] == y && p[2] == 0) path[count++] = v;
        }
    assert_int_equal(count, 7);
    for (size_t i = 0; i < 3 * mesh.vertex_count; i++)
        mesh.position[i] += 1e-6 * (random_below(&random, 41) - 20.0);
    gvc_cut_node nodes[2] = {{GVC_NODE_ROOT, 0, path[0]}, {GVC_NODE_EXTREMUM, 0, path[6]}};
    gvc_cut_edge edge = {{0, 1}, path, count};
    gvc_cut_graph graph = {2, 1, nodes, &edge};
    gvc_disk disk;
    assert_int_equal(gvc_disk_open(&mesh, &graph, &disk, NULL), GVC_OK);
    gvc_side_table table = table_for(&mesh, &graph, &disk, 19); /* 36 steps, six per mesh edge */
    size_t border_count = disk.border_count;
    double *uv;
    table.start = 6; /* corners at 0, 18, 36 and 54: all on vertices */
    assert_int_equal(gvc_layout_place(&disk, &table, &uv, NULL), GVC_OK);
    assert_int_equal(disk.border_count, border_count);
    check_border(&disk, &table, uv);
    free(uv);
    table.start = 7; /* none is */
    assert_int_equal(gvc_layout_place(&disk, &table, &uv, NULL), GVC_OK);
    assert_int_equal(disk.border_count, border_count + 4);
    check_border(&disk, &table, uv);
    free(uv);
    table.side[0].reversed = true;
    assert_int_equal(gvc_layout_place(&disk, &table, &uv, NULL), GVC_ERROR_ARGUMENT);
    assert_null(uv);
    gvc_side_table_free(&table);
    gvc_disk_free(&disk);
    gvc_halfedges_free(&mesh);
}

/** Mesh edges of no length, up to whole cut edges, get room on the border all the same. */
static void test_edges_of_no_length(void **state) {
    (void)state;
    gvc_halfedges mesh = made_bar(1, 2, 0.1);
    for (size_t v = 0; v < mesh.vertex_count; v++) /* one half of the bar falls into a point */
        if (mesh.position[3 * v] > 3)
            for (int k = 0; k < 3; k++) mesh.position[3 * v + k] = 3;
    for (uint64_t seed = 0; seed < 10; seed++) check_mesh(&mesh, 1, 64, 6, seed, 5);
    gvc_halfedges_free(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_apportions_steps),
        cmocka_unit_test(test_apportions_anything),
        cmocka_unit_test(test_refuses_bad_requests),
        cmocka_unit_test(test_resizes),
        cmocka_unit_test(test_starts_are_those_the_weld_allows),
        cmocka_unit_test(test_places_random_cuts),
        cmocka_unit_test(test_places_an_octahedron),
        cmocka_unit_test(test_corners_on_vertices),
        cmocka_unit_test(test_edges_of_no_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
