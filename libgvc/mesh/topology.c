/* SPDX-License-Identifier: MIT */
/** @file topology.c  What a triangle soup is as a surface: components, borders, fans, genus. */
#include "base/disjoint.h"
#include "base/memory.h"
#include "mesh/order.h"

#include <stdlib.h>

/* Degenerate faces have no surface and take no part in edges, components and fans. Faces and
 * corners are connected only across edges with exactly two faces, so that a non-manifold edge, like
 * a border, separates. */

/** What the counting shares. Sets are union-find forests: `parent[x] == x` at the roots. */
typedef struct survey {
    const gvc_mesh *mesh;
    uint32_t *order;     /**< halfedges, edge by edge */
    uint32_t *component; /**< forest of faces */
    uint32_t *fan;       /**< forest of corners: those of one fan around a vertex */
    uint32_t *loop;      /**< forest of halfedges: the border edges of one loop */
    uint32_t *at_vertex; /**< per vertex: fans */
    uint32_t *at_fan;    /**< per fan root: a border edge that ends there, + 1; or 0 */
} survey;

static uint32_t next_corner(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

static void free_survey(survey *s) {
    free(s->order);
    free(s->component);
    free(s->fan);
    free(s->loop);
    free(s->at_vertex);
    free(s->at_fan);
}

static gvc_result begin_survey(const gvc_mesh *mesh, survey *s, gvc_error *error) {
    *s = (survey){.mesh = mesh};
    GVC_TRY(gvc_order_halfedges(mesh, &s->order, error));
    size_t corners = 3 * mesh->face_count;
    s->component = gvc_alloc(mesh->face_count, sizeof(uint32_t));
    s->fan = gvc_alloc(corners, sizeof(uint32_t));
    s->loop = gvc_alloc(corners, sizeof(uint32_t));
    s->at_vertex = gvc_alloc(mesh->vertex_count, sizeof(uint32_t));
    s->at_fan = gvc_alloc(corners, sizeof(uint32_t));
    if (!s->component || !s->fan || !s->loop || !s->at_vertex || !s->at_fan) {
        free_survey(s);
        return gvc_fail_memory(error);
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) s->component[f] = f;
    for (uint32_t h = 0; h < corners; h++) s->fan[h] = s->loop[h] = h;
    return GVC_OK;
}

/** Joins the two faces of an edge, and their corners at both of its ends. */
static void join_faces(survey *s, uint32_t g, uint32_t h) {
    bool same_way = gvc_start_of(s->mesh, g) == gvc_start_of(s->mesh, h);
    uint32_t g_end = next_corner(g), h_end = next_corner(h);
    gvc_disjoint_unite(s->component, g / 3, h / 3);
    gvc_disjoint_unite(s->fan, g, same_way ? h : h_end);
    gvc_disjoint_unite(s->fan, g_end, same_way ? h_end : h);
}

static void count_edges(survey *s, gvc_topology *t) {
    size_t count = 3 * s->mesh->face_count;
    for (size_t i = 0, next; i < count; i = next) {
        uint32_t h = s->order[i], faces = 0, met[2] = {0, 0};
        for (next = i; next < count && gvc_same_edge(s->mesh, h, s->order[next]); next++) {
            if (gvc_is_degenerate(s->mesh, s->order[next] / 3)) continue;
            if (faces < 2) met[faces] = s->order[next];
            faces++;
        }
        if (faces == 0) continue;
        t->edge_count++;
        if (faces == 1) t->boundary_edge_count++;
        if (faces > 2) t->nonmanifold_edge_count++;
        if (faces != 2) continue;
        join_faces(s, met[0], met[1]);
        if (gvc_start_of(s->mesh, met[0]) == gvc_start_of(s->mesh, met[1]))
            t->misoriented_edge_count++;
    }
}

static void count_fans_and_components(survey *s, gvc_topology *t) {
    const gvc_mesh *mesh = s->mesh;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        if (gvc_is_degenerate(mesh, h / 3)) {
            t->degenerate_face_count += h % 3 == 0;
            continue;
        }
        if (h % 3 == 0 && s->component[h / 3] == h / 3) t->component_count++;
        if (s->fan[h] != h) continue;
        uint32_t fans = ++s->at_vertex[mesh->face[h]];
        if (fans == 2) t->nonmanifold_vertex_count++;
    }
}

/** A vertex of degenerate faces only counts as referenced. */
static void count_unreferenced(survey *s, gvc_topology *t) {
    const gvc_mesh *mesh = s->mesh;
    for (size_t v = 0; v < mesh->vertex_count; v++) s->at_vertex[v] = 0;
    for (size_t i = 0; i < 3 * mesh->face_count; i++) s->at_vertex[mesh->face[i]] = 1;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        t->unreferenced_vertex_count += !s->at_vertex[v];
}

/** A loop goes on from one border edge to the other at the two ends of the fan between them. A
 * chain that stops at a non-manifold edge counts as a loop too. */
static void count_loops(survey *s, gvc_topology *t) {
    size_t count = 3 * s->mesh->face_count;
    uint64_t joined = 0;
    for (size_t i = 0, next; i < count; i = next) {
        uint32_t h = s->order[i], faces = 0, border = h;
        for (next = i; next < count && gvc_same_edge(s->mesh, h, s->order[next]); next++) {
            if (gvc_is_degenerate(s->mesh, s->order[next] / 3)) continue;
            border = s->order[next];
            faces++;
        }
        if (faces != 1) continue;
        uint32_t corners[2] = {border, next_corner(border)};
        for (int k = 0; k < 2; k++) {
            uint32_t *other = &s->at_fan[gvc_disjoint_root(s->fan, corners[k])];
            if (*other == 0) {
                *other = border + 1;
            } else if (gvc_disjoint_root(s->loop, border) !=
                       gvc_disjoint_root(s->loop, *other - 1)) {
                gvc_disjoint_unite(s->loop, border, *other - 1);
                joined++;
            }
        }
    }
    t->boundary_loop_count = t->boundary_edge_count - joined;
}

static gvc_result count_duplicates(const gvc_mesh *mesh, gvc_topology *t, gvc_error *error) {
    bool *repeated = gvc_alloc(mesh->face_count, sizeof *repeated);
    gvc_result result = repeated ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_mark_repeated_faces(mesh, repeated, error);
    for (size_t f = 0; result == GVC_OK && f < mesh->face_count; f++) {
        t->duplicate_face_count += repeated[f] && !gvc_is_degenerate(mesh, (uint32_t)f);
    }
    free(repeated);
    return result;
}

static void conclude(gvc_topology *t) {
    t->closed_manifold = t->face_count > 0 && t->boundary_edge_count == 0 &&
                         t->nonmanifold_edge_count == 0 && t->nonmanifold_vertex_count == 0 &&
                         t->misoriented_edge_count == 0 && t->degenerate_face_count == 0 &&
                         t->duplicate_face_count == 0;
    t->genus = -1;
    if (!t->closed_manifold) return;
    /* Euler: V - E + F = 2 C - 2 g */
    int64_t vertices = (int64_t)(t->vertex_count - t->unreferenced_vertex_count);
    int64_t characteristic = vertices - (int64_t)t->edge_count + (int64_t)t->face_count;
    t->genus = (int64_t)t->component_count - characteristic / 2;
}

gvc_result gvc_mesh_topology(const gvc_mesh *mesh, gvc_topology *topology, gvc_error *error) {
    if (!mesh || !topology) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no mesh or no topology");
    gvc_topology t = {.vertex_count = mesh->vertex_count, .face_count = mesh->face_count};
    survey s;
    GVC_TRY(begin_survey(mesh, &s, error));
    count_edges(&s, &t);
    count_fans_and_components(&s, &t);
    count_unreferenced(&s, &t);
    count_loops(&s, &t);
    gvc_result result = count_duplicates(mesh, &t, error);
    free_survey(&s);
    if (result != GVC_OK) return result;
    conclude(&t);
    *topology = t;
    return GVC_OK;
}
