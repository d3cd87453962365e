/* SPDX-License-Identifier: MIT */
/**
 * @file extrema.c
 * Maxima of mu with their persistence, from the merge tree of its superlevel sets.
 *
 * Vertices are met from the highest to the lowest. Each begins a component, or joins those of its
 * neighbours met before; where two components meet, the one with the lower maximum ends (elder
 * rule), and its height above that saddle is its persistence (Edelsbrunner, Letscher & Zomorodian
 * 2002). Equal values are told apart by vertex number (simulation of simplicity), so every mesh has
 * a strict order and no plateau needs care.
 */
#include "base/disjoint.h"
#include "base/memory.h"
#include "descriptor/clip.h"
#include "descriptor/reeb.h"

#include <math.h>
#include <stdlib.h>

/* Levels of the Reeb graph that valences are read from. */
enum { VALENCE_LEVELS = 24 };

/* A limb ends where it meets another limb: a maximum this persistent, which is what an encoder by
 * default takes for a feature. Bumps below that do not end it. */
static const double LIMB_PERSISTENCE = 0.2;

/* Where the component of the maximum `younger` ended. */
typedef struct merge {
    uint32_t younger, elder; /* maxima */
    uint32_t saddle;
} merge;

typedef struct merge_tree {
    const gvc_halfedges *mesh;
    const double *mu;
    uint32_t *order;   /* vertices, highest first */
    uint32_t *rank;    /* per vertex: its place in that order */
    uint32_t *parent;  /* per vertex: union-find */
    uint32_t *maximum; /* per root: the highest vertex of the component */
    merge *merge;
    size_t merge_count, merge_capacity;
} merge_tree;

static void merge_tree_free(merge_tree *t) {
    free(t->order);
    free(t->rank);
    free(t->parent);
    free(t->maximum);
    free(t->merge);
}

typedef struct ranked_vertex {
    double mu;
    uint32_t vertex;
} ranked_vertex;

static int compare_ranked(const void *left, const void *right) {
    const ranked_vertex *a = left, *b = right;
    if (a->mu != b->mu) return a->mu > b->mu ? -1 : 1;
    return a->vertex < b->vertex ? -1 : a->vertex > b->vertex;
}

static gvc_result sort_vertices(merge_tree *t, gvc_error *error) {
    size_t count = t->mesh->vertex_count;
    ranked_vertex *ranked = gvc_alloc(count, sizeof *ranked);
    if (!ranked) return gvc_fail_memory(error);
    for (size_t v = 0; v < count; v++) ranked[v] = (ranked_vertex){t->mu[v], (uint32_t)v};
    qsort(ranked, count, sizeof *ranked, compare_ranked);
    for (size_t i = 0; i < count; i++) {
        t->order[i] = ranked[i].vertex;
        t->rank[ranked[i].vertex] = (uint32_t)i;
    }
    free(ranked);
    return GVC_OK;
}

/* Lets the components of `vertex` and of its higher neighbour meet. */
static gvc_result meet(merge_tree *t, uint32_t vertex, uint32_t higher, gvc_error *error) {
    uint32_t a = gvc_disjoint_root(t->parent, vertex), b = gvc_disjoint_root(t->parent, higher);
    if (a == b) return GVC_OK;
    uint32_t elder = t->maximum[a], younger = t->maximum[b];
    if (t->rank[younger] < t->rank[elder]) {
        uint32_t swap = elder;
        elder = younger;
        younger = swap;
    }
    t->parent[b] = a;
    t->maximum[a] = elder;
    if (younger == vertex) return GVC_OK; /* no maximum: it joins its first higher neighbour */
    void *data = t->merge;
    if (!gvc_grow(&data, &t->merge_capacity, t->merge_count + 1, sizeof *t->merge))
        return gvc_fail_memory(error);
    t->merge = data;
    t->merge[t->merge_count++] = (merge){younger, elder, vertex};
    return GVC_OK;
}

/* Calls meet for all neighbours of `vertex` that are higher. */
static gvc_result lower_to(merge_tree *t, uint32_t vertex, gvc_error *error) {
    const gvc_halfedges *mesh = t->mesh;
    t->parent[vertex] = vertex;
    t->maximum[vertex] = vertex;
    uint32_t first = mesh->outgoing[vertex], h = first;
    do {
        uint32_t ahead = mesh->vertex[gvc_next(h)], behind = mesh->vertex[gvc_prev(h)];
        if (t->rank[ahead] < t->rank[vertex]) GVC_TRY(meet(t, vertex, ahead, error));
        /* Met again as the next one's `ahead`, except at a border. */
        if (t->rank[behind] < t->rank[vertex]) GVC_TRY(meet(t, vertex, behind, error));
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first);
    return GVC_OK;
}

static gvc_result merge_tree_build(merge_tree *t, gvc_error *error) {
    size_t count = t->mesh->vertex_count;
    t->order = gvc_alloc(count, sizeof *t->order);
    t->rank = gvc_alloc(count, sizeof *t->rank);
    t->parent = gvc_alloc(count, sizeof *t->parent);
    t->maximum = gvc_alloc(count, sizeof *t->maximum);
    if (!t->order || !t->rank || !t->parent || !t->maximum) return gvc_fail_memory(error);
    GVC_TRY(sort_vertices(t, error));
    for (size_t i = 0; i < count; i++) GVC_TRY(lower_to(t, t->order[i], error));
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ limbs */

static double height(const merge_tree *t, const merge *m) {
    return t->mu[m->younger] - t->mu[m->saddle];
}

/* The saddle at which the limb of a maximum ends: the highest one where it meets a higher maximum
 * or a lower one that is a limb, too. So two like limbs have like areas, whichever is the higher
 * today. GVC_NONE if there is none. */
static uint32_t limb_end(const merge_tree *t, uint32_t maximum) {
    uint32_t end = GVC_NONE;
    for (size_t i = 0; i < t->merge_count; i++) {
        const merge *m = &t->merge[i];
        bool ends =
            m->younger == maximum || (m->elder == maximum && height(t, m) >= LIMB_PERSISTENCE);
        if (ends && (end == GVC_NONE || t->rank[m->saddle] < t->rank[end])) end = m->saddle;
    }
    return end;
}

/* Work space of the floods. */
typedef struct flood {
    uint32_t *stack; /* vertices */
    uint32_t *mark;  /* per vertex: the tip that reached it last */
} flood;

/* Adds the neighbours of `v` above `end` that this flood has not met. */
static size_t flood_from(const merge_tree *t, flood *f, uint32_t tip, uint32_t end, uint32_t v,
                         size_t depth) {
    const gvc_halfedges *mesh = t->mesh;
    uint32_t first = mesh->outgoing[v], h = first;
    do {
        uint32_t corner[2] = {mesh->vertex[gvc_next(h)], mesh->vertex[gvc_prev(h)]};
        for (int k = 0; k < 2; k++)
            if (f->mark[corner[k]] != tip && t->rank[corner[k]] < t->rank[end]) {
                f->mark[corner[k]] = tip;
                f->stack[depth++] = corner[k];
            }
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first);
    return depth;
}

/* Area above `level` of the faces whose highest corner is `v`. */
static double area_topped_by(const merge_tree *t, uint32_t v, double level) {
    const gvc_halfedges *mesh = t->mesh;
    uint32_t first = mesh->outgoing[v], h = first;
    double area = 0;
    do {
        uint32_t a = mesh->vertex[gvc_next(h)], b = mesh->vertex[gvc_prev(h)];
        if (t->rank[v] < t->rank[a] && t->rank[v] < t->rank[b]) {
            double value[3] = {t->mu[v], t->mu[a], t->mu[b]};
            area += gvc_face_area(mesh, h / 3) * (1 - gvc_part_below(value, level));
        }
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first);
    return area;
}

/* Area above the saddle `end` on the tip's side, relative to the whole surface: floods from the tip
 * over the vertices above the saddle; the highest corner of every face of the limb is among them.
 */
static double limb_area(const merge_tree *t, flood *f, uint32_t tip, uint32_t end, double whole) {
    if (end == GVC_NONE || !(whole > 0)) return 1;
    size_t depth = 0;
    double area = 0;
    f->mark[tip] = tip;
    f->stack[depth++] = tip;
    while (depth > 0) {
        uint32_t v = f->stack[--depth];
        area += area_topped_by(t, v, t->mu[end]);
        depth = flood_from(t, f, tip, end, v, depth);
    }
    return area / whole;
}

/* ------------------------------------------------------------------------------------ valence */

/* For every node the first node of a lower level it is joined to, GVC_NONE for a minimum. */
static gvc_result list_descents(const gvc_reeb_graph *graph, uint32_t **descent, gvc_error *error) {
    *descent = gvc_alloc(graph->node_count, sizeof **descent);
    if (!*descent) return gvc_fail_memory(error);
    for (size_t i = 0; i < graph->node_count; i++) (*descent)[i] = GVC_NONE;
    for (size_t i = graph->arc_count; i-- > 0;) (*descent)[graph->arc[i][1]] = graph->arc[i][0];
    return GVC_OK;
}

/* Valence of the first branching node on the way down, or of the last node if there is none. */
static unsigned branch_valence(const gvc_reeb_graph *graph, const uint32_t *descent,
                               uint32_t vertex) {
    uint32_t node = graph->top_node[vertex];
    while (graph->node[node].valence < 3 && descent[node] != GVC_NONE) node = descent[node];
    return graph->node[node].valence;
}

/* ------------------------------------------------------------------------------------ the list */

static int compare_extrema(const void *left, const void *right) {
    const gvc_extremum *a = left, *b = right;
    if (a->persistence != b->persistence) return a->persistence > b->persistence ? -1 : 1;
    return a->vertex < b->vertex ? -1 : a->vertex > b->vertex;
}

static gvc_extremum extremum_at(const merge_tree *t, uint32_t vertex, double persistence) {
    const double *p = t->mesh->position + 3 * (size_t)vertex;
    return (gvc_extremum){.vertex = vertex,
                          .position = {p[0], p[1], p[2]},
                          .persistence = persistence,
                          .mu = t->mu[vertex]};
}

/* Lists the maxima: those never merged (one per component) and those merged after a long life. */
static gvc_result list_maxima(merge_tree *t, double least, gvc_extremum **list, size_t *count,
                              gvc_error *error) {
    size_t vertex_count = t->mesh->vertex_count, room = t->merge_count, n = 0;
    for (size_t v = 0; v < vertex_count; v++) room += t->parent[v] == v;
    *list = gvc_alloc(room, sizeof **list);
    if (!*list) return gvc_fail_memory(error);
    for (size_t v = 0; v < vertex_count; v++)
        if (t->parent[v] == v && least <= 1) (*list)[n++] = extremum_at(t, t->maximum[v], 1);
    for (size_t i = 0; i < t->merge_count; i++) {
        double persistence = height(t, &t->merge[i]);
        /* At 0 it is no maximum, only an artefact of telling equal values apart. */
        if (persistence > 0 && persistence >= least)
            (*list)[n++] = extremum_at(t, t->merge[i].younger, persistence);
    }
    qsort(*list, n, sizeof **list, compare_extrema);
    *count = n;
    return GVC_OK;
}

static gvc_result measure_limbs(const merge_tree *t, gvc_extremum *list, size_t count,
                                gvc_error *error) {
    size_t vertex_count = t->mesh->vertex_count;
    flood f = {gvc_alloc(vertex_count, sizeof *f.stack), gvc_alloc(vertex_count, sizeof *f.mark)};
    gvc_result result = GVC_OK;
    if (!f.stack || !f.mark) {
        result = gvc_fail_memory(error);
    } else {
        double whole = 0;
        for (size_t i = 0; i < t->mesh->face_count; i++) whole += gvc_face_area(t->mesh, i);
        for (size_t v = 0; v < vertex_count; v++) f.mark[v] = GVC_NONE;
        for (size_t i = 0; i < count; i++)
            list[i].area = limb_area(t, &f, list[i].vertex, limb_end(t, list[i].vertex), whole);
    }
    free(f.stack);
    free(f.mark);
    return result;
}

static gvc_result measure_valences(const merge_tree *t, gvc_extremum *list, size_t count,
                                   gvc_error *error) {
    gvc_reeb_graph graph;
    uint32_t *descent = NULL;
    GVC_TRY(gvc_reeb_graph_build(t->mesh, t->mu, VALENCE_LEVELS, &graph, error));
    gvc_result result = list_descents(&graph, &descent, error);
    for (size_t i = 0; result == GVC_OK && i < count; i++)
        list[i].valence = branch_valence(&graph, descent, list[i].vertex);
    free(descent);
    gvc_reeb_graph_free(&graph);
    return result;
}

gvc_result gvc_extrema_find(const gvc_halfedges *mesh, const double *mu, double least,
                            gvc_extremum **list, size_t *count, gvc_error *error) {
    *list = NULL;
    *count = 0;
    merge_tree t = {.mesh = mesh, .mu = mu};
    gvc_result result = GVC_OK;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (!(mu[v] >= 0 && mu[v] <= 1))
            return gvc_fail(error, GVC_ERROR_ARGUMENT, "mu of vertex %zu is %g, not in [0,1]", v,
                            mu[v]);
    GVC_CHECK(merge_tree_build(&t, error));
    GVC_CHECK(list_maxima(&t, least, list, count, error));
    GVC_CHECK(measure_limbs(&t, *list, *count, error));
    result = measure_valences(&t, *list, *count, error);
cleanup:
    merge_tree_free(&t);
    if (result != GVC_OK) {
        free(*list);
        *list = NULL;
        *count = 0;
    }
    return result;
}
