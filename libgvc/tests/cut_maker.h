/* SPDX-License-Identifier: MIT */
/** @file cut_maker.h  Closed surfaces of any genus, and random cut graphs on them, for tests. */
#ifndef GVC_TESTS_CUT_MAKER_H
#define GVC_TESTS_CUT_MAKER_H

#include "table_maker.h"

#include "descriptor/cut_graph.h"

/** Whether a cell belongs to a bar with `genus` square holes, cells being divided in `fine`. */
static inline bool bar_has(int genus, int fine, int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x >= (2 * genus + 1) * fine || y >= 3 * fine || z >= fine)
        return false;
    return !(x / fine % 2 == 1 && y / fine == 1);
}

/** The lattice points used so far, by their place. */
typedef struct lattice {
    int nx, ny, nz;
    uint32_t *vertex, count;
} lattice;

static inline uint32_t lattice_vertex(lattice *l, const int p[3], double *position) {
    uint32_t *v = &l->vertex[(p[2] * l->ny + p[1]) * l->nx + p[0]];
    if (*v == GVC_NONE) {
        *v = l->count++;
        for (int k = 0; k < 3; k++) position[3 * *v + k] = p[k];
    }
    return *v;
}

/** Surface of the bar: closed, of the genus asked for, all edges 1 or sqrt 2 long, moved by up to
 *  `jitter` in each component. */
static inline gvc_halfedges made_bar(int genus, int fine, double jitter) {
    lattice l = {(2 * genus + 1) * fine + 1, 3 * fine + 1, fine + 1, NULL, 0};
    size_t points = (size_t)(l.nx * l.ny * l.nz);
    l.vertex = malloc(points * sizeof *l.vertex);
    double *position = calloc(3 * points, sizeof *position);
    uint32_t *face = calloc(36 * points, sizeof *face), *at = face;
    assert_true(l.vertex && position && face);
    for (size_t i = 0; i < points; i++) l.vertex[i] = GVC_NONE;
    for (int z = 0; z < l.nz; z++)
        for (int y = 0; y < l.ny; y++)
            for (int x = 0; x < l.nx; x++)
                for (int axis = 0; axis < 3; axis++)
                    for (int up = 0; up < 2; up++) {
                        int beside[3] = {x, y, z}, corner[4][3], u = (axis + 1) % 3,
                            w = (axis + 2) % 3;
                        beside[axis] += up ? 1 : -1;
                        if (!bar_has(genus, fine, x, y, z) ||
                            bar_has(genus, fine, beside[0], beside[1], beside[2]))
                            continue;
                        uint32_t v[4];
                        for (int k = 0; k < 4; k++) {
                            corner[k][0] = x, corner[k][1] = y, corner[k][2] = z;
                            corner[k][axis] += up;
                            corner[k][u] += up ? (k == 1 || k == 2) : (k == 2 || k == 3);
                            corner[k][w] += up ? (k == 2 || k == 3) : (k == 1 || k == 2);
                            v[k] = lattice_vertex(&l, corner[k], position);
                        }
                        *at++ = v[0], *at++ = v[1], *at++ = v[2];
                        *at++ = v[0], *at++ = v[2], *at++ = v[3];
                    }
    uint64_t random = 99;
    for (size_t i = 0; i < 3 * (size_t)l.count; i++)
        position[i] += jitter * ((double)random_below(&random, 1000) / 500 - 1);
    gvc_mesh *mesh;
    gvc_halfedges made;
    assert_int_equal(gvc_mesh_create(position, l.count, face, (size_t)(at - face) / 3, &mesh, NULL),
                     GVC_OK);
    assert_int_equal(gvc_halfedges_build(mesh, 0, &made, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    free(l.vertex), free(position), free(face);
    return made;
}

static inline gvc_halfedges made_octahedron(void) {
    static const double position[] = {1, 0, 0, -1, 0, 0, 0, 2, 0, 0, -1, 0, 0, 0, 3, 0, 0, -1};
    static const uint32_t face[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                    2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    gvc_mesh *mesh;
    gvc_halfedges made;
    assert_int_equal(gvc_mesh_create(position, 6, face, 8, &mesh, NULL), GVC_OK);
    assert_int_equal(gvc_halfedges_build(mesh, 0, &made, NULL), GVC_OK);
    gvc_mesh_destroy(&mesh);
    return made;
}

/** Marks all edges that a random spanning tree of the faces does not cross: the surface cut along
 *  them is a disk. Then drops dead ends, but for those at `tip` vertices. `degree` is per vertex.
 */
static inline void mark_cut(const gvc_halfedges *mesh, const uint8_t *tip, uint8_t *cut,
                            uint32_t *degree, uint64_t *random) {
    uint32_t count = (uint32_t)mesh->face_count, waiting = 1;
    uint32_t *queue = calloc(count + 1, sizeof *queue);
    uint8_t *seen = calloc(count, 1);
    assert_true(queue && seen);
    for (uint32_t h = 0; h < 3 * count; h++) cut[h] = 1;
    queue[0] = random_below(random, count);
    seen[queue[0]] = 1;
    while (waiting > 0) {
        uint32_t pick = random_below(random, waiting < 4 ? waiting : 4), f = queue[pick];
        queue[pick] = queue[--waiting];
        for (uint32_t k = 0, turn = random_below(random, 3); k < 3; k++) {
            uint32_t h = 3 * f + (k + turn) % 3, twin = mesh->twin[h];
            if (seen[twin / 3]) continue;
            seen[twin / 3] = 1;
            cut[h] = cut[twin] = 0;
            queue[waiting++] = twin / 3;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) degree[v] = 0;
    for (uint32_t h = 0; h < 3 * count; h++) degree[mesh->vertex[h]] += cut[h];
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t h = 0; h < 3 * count; h++) {
            uint32_t from = mesh->vertex[h], to = mesh->vertex[gvc_next(h)];
            if (!cut[h] || degree[from] != 1 || tip[from]) continue;
            cut[h] = cut[mesh->twin[h]] = 0;
            degree[from]--, degree[to]--;
            changed = true;
        }
    }
    free(queue), free(seen);
}

/** Follows the cut from the node where `h` starts to the next node. */
static inline void trace_edge(const gvc_halfedges *mesh, uint8_t *cut, const uint32_t *node,
                              uint32_t h, gvc_cut_edge *edge) {
    edge->vertex = calloc(mesh->vertex_count + 1, sizeof *edge->vertex);
    assert_non_null(edge->vertex);
    edge->node[0] = node[mesh->vertex[h]];
    edge->vertex[edge->vertex_count++] = mesh->vertex[h];
    for (;;) {
        uint32_t v = mesh->vertex[gvc_next(h)];
        edge->vertex[edge->vertex_count++] = v;
        cut[h] = cut[mesh->twin[h]] = 0;
        edge->node[1] = node[v];
        if (node[v] != GVC_NONE) return;
        for (h = mesh->outgoing[v]; !cut[h];) h = gvc_turn(mesh, h);
    }
}

/** A cut graph that opens `mesh` to a disk and ends at `tip_count` random tips. */
static inline gvc_cut_graph made_cut(const gvc_halfedges *mesh, uint32_t tip_count, uint64_t seed) {
    uint64_t random = seed * 7919 + 1;
    uint32_t vertices = (uint32_t)mesh->vertex_count, *degree, *node;
    uint8_t *tip = calloc(vertices, 1), *cut = calloc(3 * mesh->face_count, 1);
    degree = calloc(vertices, sizeof *degree);
    node = calloc(vertices, sizeof *node);
    gvc_cut_graph graph = {0};
    graph.node = calloc(vertices, sizeof *graph.node);
    graph.edge = calloc(vertices, sizeof *graph.edge);
    assert_true(tip && cut && degree && node && graph.node && graph.edge);
    for (uint32_t i = 0; i < tip_count; i++) tip[random_below(&random, vertices)] = 1;
    mark_cut(mesh, tip, cut, degree, &random);
    for (uint32_t v = 0; v < vertices; v++) {
        bool is_node = degree[v] > 2 || (tip[v] && degree[v] > 0);
        node[v] = is_node ? (uint32_t)graph.node_count : GVC_NONE;
        if (is_node) graph.node[graph.node_count++] = (gvc_cut_node){GVC_NODE_JUNCTION, 0, v};
    }
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++)
        if (cut[h] && node[mesh->vertex[h]] != GVC_NONE)
            trace_edge(mesh, cut, node, h, &graph.edge[graph.edge_count++]);
    free(tip), free(cut), free(degree), free(node);
    return graph;
}

#endif
