/* SPDX-License-Identifier: MIT */
/** @file test_open.c  Cutting surfaces of genus 0 to 3 open. */
#include "cut_maker.h"

#include <math.h>
#include <string.h>

#include "chart/open.h"

/** The disk is one manifold piece of characteristic 1 with one border, by an independent count. */
static void check_topology(const gvc_disk *disk) {
    const gvc_halfedges *m = &disk->mesh;
    gvc_mesh *mesh;
    gvc_topology t;
    gvc_halfedges again;
    assert_int_equal(
        gvc_mesh_create(m->position, m->vertex_count, m->vertex, m->face_count, &mesh, NULL),
        GVC_OK);
    assert_int_equal(gvc_mesh_topology(mesh, &t, NULL), GVC_OK);
    assert_int_equal(t.component_count, 1);
    assert_int_equal(t.boundary_loop_count, 1);
    assert_int_equal(t.boundary_edge_count, disk->border_count);
    assert_int_equal(t.nonmanifold_edge_count, 0);
    assert_int_equal(t.nonmanifold_vertex_count, 0);
    assert_int_equal(t.misoriented_edge_count, 0);
    assert_int_equal(t.vertex_count + t.face_count - t.edge_count, 1);
    assert_int_equal(gvc_halfedges_build(mesh, 0, &again, NULL), GVC_OK);
    assert_memory_equal(again.twin, m->twin, 3 * m->face_count * sizeof *m->twin);
    for (size_t v = 0; v < m->vertex_count; v++) {
        assert_int_equal(m->vertex[m->outgoing[v]], v);
        if (m->twin[again.outgoing[v]] == GVC_NONE)
            assert_int_equal(m->outgoing[v], again.outgoing[v]);
    }
    gvc_halfedges_free(&again);
    gvc_mesh_destroy(&mesh);
}

static void check_vertices(const gvc_disk *disk, const gvc_halfedges *mesh) {
    const gvc_halfedges *m = &disk->mesh;
    assert_int_equal(m->face_count, mesh->face_count);
    for (size_t v = 0; v < m->vertex_count; v++) {
        if (v < mesh->vertex_count) assert_int_equal(disk->original[v], v);
        assert_memory_equal(m->position + 3 * v, mesh->position + 3 * disk->original[v],
                            3 * sizeof(double));
        for (size_t k = 0; k < m->attribute_count; k++)
            assert_true(m->attribute[v * m->attribute_count + k] ==
                        mesh->attribute[disk->original[v] * m->attribute_count + k]);
    }
    for (size_t h = 0; h < 3 * m->face_count; h++)
        assert_int_equal(disk->original[m->vertex[h]], mesh->vertex[h]);
}

static void check_border(const gvc_disk *disk, const gvc_cut_graph *graph) {
    const gvc_halfedges *m = &disk->mesh;
    assert_int_equal(disk->run_count, 2 * graph->edge_count);
    assert_int_equal(disk->run[0].edge, 0);
    assert_false(disk->run[0].reversed);
    size_t next = 0;
    for (size_t r = 0; r < disk->run_count; r++) {
        const gvc_border_run *run = &disk->run[r];
        const gvc_cut_edge *edge = &graph->edge[run->edge];
        assert_int_equal(run->first, next);
        assert_int_equal(run->count, edge->vertex_count - 1);
        double length = 0;
        for (size_t i = 0; i < run->count; i++, next++) {
            uint32_t v = disk->border[next], h = m->outgoing[v];
            assert_int_equal(m->twin[h], GVC_NONE);
            assert_int_equal(m->vertex[gvc_next(h)], disk->border[(next + 1) % disk->border_count]);
            assert_int_equal(disk->original[v], edge->vertex[run->reversed ? run->count - i : i]);
            assert_true(fabs(disk->border_length[next] - length) <= 1e-12 * length);
            length += gvc_halfedge_length(m, h);
        }
    }
    assert_int_equal(next, disk->border_count);
}

static void test_opens_to_a_disk(void **state) {
    (void)state;
    for (int genus = 0; genus <= 3; genus++) {
        gvc_halfedges mesh = made_bar(genus, 2, 0.2);
        for (uint64_t seed = 0; seed < 40; seed++) {
            gvc_cut_graph graph = made_cut(&mesh, 2 + seed % 5, seed);
            gvc_disk disk;
            if (graph.edge_count > 0) {
                assert_int_equal((int)graph.node_count - (int)graph.edge_count, 1 - 2 * genus);
                assert_int_equal(gvc_disk_open(&mesh, &graph, &disk, NULL), GVC_OK);
                check_topology(&disk);
                check_vertices(&disk, &mesh);
                check_border(&disk, &graph);
                assert_true(gvc_disk_same_runs(&disk, disk.run, disk.run_count));
                gvc_disk_free(&disk);
            }
            gvc_cut_graph_free(&graph);
        }
        gvc_halfedges_free(&mesh);
    }
}

static void test_attributes_are_copied(void **state) {
    (void)state;
    gvc_halfedges mesh = made_bar(1, 2, 0);
    mesh.attribute_count = 2;
    mesh.attribute = calloc(2 * mesh.vertex_count, sizeof *mesh.attribute);
    assert_non_null(mesh.attribute);
    for (size_t i = 0; i < 2 * mesh.vertex_count; i++) mesh.attribute[i] = sqrt((double)i);
    gvc_cut_graph graph = made_cut(&mesh, 3, 1);
    gvc_disk disk;
    assert_int_equal(gvc_disk_open(&mesh, &graph, &disk, NULL), GVC_OK);
    assert_int_equal(disk.mesh.attribute_count, 2);
    check_vertices(&disk, &mesh);
    gvc_disk_free(&disk);
    gvc_cut_graph_free(&graph);
    gvc_halfedges_free(&mesh);
}

static void check_refused(const gvc_halfedges *mesh, const gvc_cut_graph *graph) {
    gvc_disk disk;
    gvc_error error;
    assert_int_equal(gvc_disk_open(mesh, graph, &disk, &error), GVC_ERROR_INTERNAL);
    assert_null(disk.mesh.vertex);
    assert_null(disk.border);
    assert_null(disk.run);
}

/** Octahedron vertices: 0 and 1, 2 and 3, 4 and 5 are opposite. */
static void test_refuses_what_is_no_disk(void **state) {
    (void)state;
    gvc_halfedges mesh = made_octahedron();
    gvc_cut_node nodes[3] = {{GVC_NODE_ROOT, 0, 0}, {GVC_NODE_EXTREMUM, 0, 1}, {0, 0, 2}};
    uint32_t circle[] = {0, 2, 1, 3, 0}, path[] = {0, 2, 1}, jump[] = {0, 1}, far[] = {0, 17},
             again[] = {2, 0}, lone[] = {0}, eight[] = {0, 2, 4, 0, 5};
    gvc_cut_edge edges[2] = {{{0, 0}, circle, 5}};
    gvc_cut_graph graph = {.node_count = 3, .edge_count = 1, .node = nodes, .edge = edges};
    check_refused(&mesh, &graph); /* falls apart */
    edges[0] = (gvc_cut_edge){{0, 1}, jump, 2};
    check_refused(&mesh, &graph); /* not a mesh edge */
    edges[0] = (gvc_cut_edge){{0, 1}, far, 2};
    check_refused(&mesh, &graph); /* not a vertex */
    edges[0] = (gvc_cut_edge){{0, 1}, lone, 1};
    check_refused(&mesh, &graph);
    edges[0] = (gvc_cut_edge){{0, 1}, eight, 5};
    check_refused(&mesh, &graph); /* meets itself */
    edges[0] = (gvc_cut_edge){{0, 1}, path, 3};
    edges[1] = (gvc_cut_edge){{2, 0}, again, 2};
    graph.edge_count = 2;
    check_refused(&mesh, &graph); /* one mesh edge twice */
    uint32_t branch[] = {2, 4};
    edges[1] = (gvc_cut_edge){{2, 0}, branch, 2};
    check_refused(&mesh, &graph); /* branches off inside edge 0 */
    uint32_t apart[] = {3, 4};
    edges[0] = (gvc_cut_edge){{0, 2}, path, 2};
    edges[1] = (gvc_cut_edge){{2, 0}, apart, 2};
    check_refused(&mesh, &graph); /* two cuts that do not meet */
    graph.edge_count = 0;
    check_refused(&mesh, &graph);
    edges[0] = (gvc_cut_edge){{0, 1}, path, 3};
    graph.edge_count = 1;
    gvc_disk disk;
    assert_int_equal(gvc_disk_open(&mesh, &graph, &disk, NULL), GVC_OK);
    check_refused(&disk.mesh, &graph); /* already open */
    gvc_disk_free(&disk);
    gvc_disk_free(&disk);
    gvc_halfedges_free(&mesh);

    gvc_halfedges torus = made_bar(1, 2, 0); /* a tree leaves the handle */
    uint32_t h = torus.outgoing[0], pair[2] = {0, torus.vertex[gvc_next(h)]};
    edges[0] = (gvc_cut_edge){{0, 1}, pair, 2};
    check_refused(&torus, &graph);
    gvc_halfedges_free(&torus);
}

/** Two loops through one node of a torus, taken for a single edge, do open it to a disk, but its
 * two sides would not be twins: the border is a b a' b' where a b b' a' is needed. */
static void test_refuses_an_edge_through_itself(void **state) {
    (void)state;
    gvc_halfedges mesh = made_bar(1, 1, 0);
    unsigned found = 0;
    for (uint64_t seed = 0; seed < 300; seed++) {
        gvc_cut_graph graph = made_cut(&mesh, 0, seed);
        if (graph.node_count == 1 && graph.edge_count == 2) {
            const gvc_cut_edge *a = &graph.edge[0], *b = &graph.edge[1];
            gvc_cut_edge both = {{0, 0}, NULL, a->vertex_count + b->vertex_count - 1};
            both.vertex = calloc(both.vertex_count, sizeof *both.vertex);
            assert_non_null(both.vertex);
            memcpy(both.vertex, a->vertex, a->vertex_count * sizeof *both.vertex);
            memcpy(both.vertex + a->vertex_count, b->vertex + 1,
                   (b->vertex_count - 1) * sizeof *both.vertex);
            gvc_cut_graph single = {1, 1, graph.node, &both};
            check_refused(&mesh, &single);
            free(both.vertex);
            found++;
        }
        gvc_cut_graph_free(&graph);
    }
    assert_true(found > 0);
    gvc_halfedges_free(&mesh);
}

/** An opened sphere beside a torus has the characteristic of a disk, and one border. */
static void test_refuses_a_second_component(void **state) {
    (void)state;
    gvc_halfedges sphere = made_octahedron(), torus = made_bar(1, 1, 0), pair;
    size_t vertices = 6 + torus.vertex_count, faces = 8 + torus.face_count;
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_allocate(vertices, faces, &mesh, NULL), GVC_OK);
    memcpy(mesh->position, sphere.position, 18 * sizeof(double));
    memcpy(mesh->position + 18, torus.position, 3 * torus.vertex_count * sizeof(double));
    memcpy(mesh->face, sphere.vertex, 24 * sizeof(uint32_t));
    for (size_t i = 0; i < 3 * torus.face_count; i++) mesh->face[24 + i] = 6 + torus.vertex[i];
    assert_int_equal(gvc_halfedges_build(mesh, 0, &pair, NULL), GVC_OK);
    gvc_cut_node nodes[2] = {{GVC_NODE_ROOT, 0, 0}, {GVC_NODE_EXTREMUM, 0, 1}};
    uint32_t path[] = {0, 2, 1};
    gvc_cut_edge edge = {{0, 1}, path, 3};
    gvc_cut_graph graph = {2, 1, nodes, &edge};
    check_refused(&pair, &graph);
    gvc_mesh_destroy(&mesh);
    gvc_halfedges_free(&pair);
    gvc_halfedges_free(&torus);
    gvc_halfedges_free(&sphere);
}

static void test_compares_runs(void **state) {
    (void)state;
    gvc_halfedges mesh = made_bar(1, 2, 0);
    gvc_cut_graph graph = made_cut(&mesh, 3, 2);
    gvc_disk disk;
    assert_int_equal(gvc_disk_open(&mesh, &graph, &disk, NULL), GVC_OK);
    gvc_border_run runs[64];
    assert_true(disk.run_count <= 64);
    memcpy(runs, disk.run, disk.run_count * sizeof *runs);
    runs[1].first += 5, runs[1].count += 7; /* lengths do not matter */
    assert_true(gvc_disk_same_runs(&disk, runs, disk.run_count));
    assert_false(gvc_disk_same_runs(&disk, runs, disk.run_count - 1));
    runs[1].reversed = !runs[1].reversed;
    assert_false(gvc_disk_same_runs(&disk, runs, disk.run_count));
    runs[1].reversed = !runs[1].reversed;
    runs[1].edge++;
    assert_false(gvc_disk_same_runs(&disk, runs, disk.run_count));
    gvc_disk_free(&disk);
    gvc_cut_graph_free(&graph);
    gvc_halfedges_free(&mesh);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_opens_to_a_disk),
        cmocka_unit_test(test_attributes_are_copied),
        cmocka_unit_test(test_refuses_what_is_no_disk),
        cmocka_unit_test(test_refuses_an_edge_through_itself),
        cmocka_unit_test(test_refuses_a_second_component),
        cmocka_unit_test(test_compares_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
