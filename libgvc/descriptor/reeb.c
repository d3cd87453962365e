/* SPDX-License-Identifier: MIT */
/**
 * @file reeb.c
 * Reeb graph of a piecewise linear function at a finite number of levels.
 *
 * Every face is clipped into pieces, one per level it reaches into. A piece is convex, hence
 * connected, so nodes are the classes of pieces of one level joined across shared edges, and arcs
 * join the nodes of successive pieces of a face. A value on the bound of two levels belongs to the
 * upper one, for all vertices alike: this decides which pieces exist without any tolerance, so
 * touching pieces agree. Such pieces may have no area; the function raised by an infinitesimal has
 * the same graph, and there they do.
 */
#include "descriptor/reeb.h"

#include "base/disjoint.h"
#include "base/memory.h"
#include "descriptor/clip.h"

#include <math.h>
#include <stdlib.h>

typedef struct pieces {
    const gvc_halfedges *mesh;
    const double *mu;
    unsigned levels;
    unsigned *level;  /* per vertex */
    uint32_t *first;  /* face_count + 1: first piece of each face, lowest level first */
    uint32_t *parent; /* per piece: union-find, later the piece's node */
    size_t count;
} pieces;

static unsigned least_level(const pieces *p, size_t face) {
    const uint32_t *v = p->mesh->vertex + 3 * face;
    unsigned a = p->level[v[0]], b = p->level[v[1]], c = p->level[v[2]];
    unsigned ab = a < b ? a : b;
    return ab < c ? ab : c;
}

static unsigned greatest_level(const pieces *p, size_t face) {
    const uint32_t *v = p->mesh->vertex + 3 * face;
    unsigned a = p->level[v[0]], b = p->level[v[1]], c = p->level[v[2]];
    unsigned ab = a > b ? a : b;
    return ab > c ? ab : c;
}

static uint32_t piece_of(const pieces *p, size_t face, unsigned level) {
    return p->first[face] + (level - least_level(p, face));
}

/* ----------------------------------------------------------------------------------- components */

static gvc_result cut_faces(pieces *p, gvc_error *error) {
    const gvc_halfedges *mesh = p->mesh;
    p->level = gvc_alloc(mesh->vertex_count, sizeof *p->level);
    p->first = gvc_alloc(mesh->face_count + 1, sizeof *p->first);
    if (!p->level || !p->first) return gvc_fail_memory(error);
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        double mu = p->mu[v];
        if (!(mu >= 0 && mu <= 1))
            return gvc_fail(error, GVC_ERROR_ARGUMENT, "mu of vertex %zu is %g, not in [0,1]", v,
                            mu);
        unsigned level = (unsigned)(mu * p->levels);
        p->level[v] = level < p->levels ? level : p->levels - 1;
    }
    for (size_t f = 0; f < mesh->face_count; f++) {
        p->first[f] = (uint32_t)p->count;
        p->count += greatest_level(p, f) - least_level(p, f) + 1;
        if (p->count >= UINT32_MAX)
            return gvc_fail(error, GVC_ERROR_LIMIT, "%u levels on %zu faces are too many",
                            p->levels, mesh->face_count);
    }
    p->first[mesh->face_count] = (uint32_t)p->count;
    p->parent = gvc_alloc(p->count, sizeof *p->parent);
    return p->parent ? GVC_OK : gvc_fail_memory(error);
}

/* Joins the pieces that share a part of an edge: one for each level the edge reaches into. */
static void join_across_edges(pieces *p) {
    const gvc_halfedges *mesh = p->mesh;
    for (uint32_t i = 0; i < p->count; i++) p->parent[i] = i;
    for (uint32_t h = 0; h < 3 * mesh->face_count; h++) {
        uint32_t twin = mesh->twin[h];
        if (twin == GVC_NONE || twin < h) continue;
        unsigned low = p->level[mesh->vertex[h]], high = p->level[mesh->vertex[gvc_next(h)]];
        if (low > high) {
            unsigned swap = low;
            low = high;
            high = swap;
        }
        for (unsigned level = low; level <= high; level++)
            gvc_disjoint_unite(p->parent, piece_of(p, h / 3, level), piece_of(p, twin / 3, level));
    }
}

/* ------------------------------------------------------------------------------------ nodes */

/* Turns `parent` into node numbers: by level, then by first piece. */
static gvc_result number_nodes(pieces *p, gvc_reeb_graph *graph, gvc_error *error) {
    uint32_t *start = gvc_alloc((size_t)p->levels + 1, sizeof *start);
    if (!start) return gvc_fail_memory(error);
    for (uint32_t i = 0; i < p->count; i++) p->parent[i] = gvc_disjoint_root(p->parent, i);
    for (size_t f = 0; f < p->mesh->face_count; f++)
        for (uint32_t i = p->first[f]; i < p->first[f + 1]; i++)
            if (p->parent[i] == i) start[least_level(p, f) + (i - p->first[f]) + 1]++;
    for (unsigned level = 0; level < p->levels; level++) start[level + 1] += start[level];
    graph->node_count = start[p->levels];
    graph->node = gvc_alloc(graph->node_count, sizeof *graph->node);
    if (!graph->node) {
        free(start);
        return gvc_fail_memory(error);
    }
    /* A root comes before its class: when its number is written, it is read through it only. */
    for (size_t f = 0; f < p->mesh->face_count; f++)
        for (uint32_t i = p->first[f]; i < p->first[f + 1]; i++) {
            unsigned level = least_level(p, f) + (i - p->first[f]);
            if (p->parent[i] != i) {
                p->parent[i] = p->parent[p->parent[i]];
                continue;
            }
            p->parent[i] = start[level]++;
            graph->node[p->parent[i]] = (gvc_reeb_node){.level = level, .mu_low = 1, .mu_high = 0};
        }
    free(start);
    return GVC_OK;
}

/* Adds the pieces of one face to their nodes. The outer bounds of the lowest and highest piece are
 * the face's own, so that the parts always sum to the whole face. */
static void measure_face(const pieces *p, size_t face, double whole, gvc_reeb_graph *graph) {
    const uint32_t *v = p->mesh->vertex + 3 * face;
    double value[3] = {p->mu[v[0]], p->mu[v[1]], p->mu[v[2]]};
    double low = fmin(value[0], fmin(value[1], value[2]));
    double high = fmax(value[0], fmax(value[1], value[2]));
    double share = whole > 0 ? gvc_face_area(p->mesh, face) / whole : 0, below = 0;
    unsigned level = least_level(p, face);
    for (uint32_t i = p->first[face]; i < p->first[face + 1]; i++, level++) {
        bool last = i + 1 == p->first[face + 1];
        double upper = last ? high : (double)(level + 1) / p->levels;
        double below_upper = last ? 1 : gvc_part_below(value, upper);
        gvc_reeb_node *node = &graph->node[p->parent[i]];
        node->area += share * (below_upper - below);
        node->mu_low = fmin(node->mu_low, low);
        node->mu_high = fmax(node->mu_high, upper);
        below = below_upper;
        low = upper;
    }
}

static void measure_nodes(const pieces *p, gvc_reeb_graph *graph) {
    double whole = 0;
    for (size_t f = 0; f < p->mesh->face_count; f++) whole += gvc_face_area(p->mesh, f);
    for (size_t f = 0; f < p->mesh->face_count; f++) measure_face(p, f, whole, graph);
}

/* ------------------------------------------------------------------------------------ arcs */

static int compare_arcs(const void *left, const void *right) {
    const uint32_t *a = left, *b = right;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    if (a[1] != b[1]) return a[1] < b[1] ? -1 : 1;
    return 0;
}

static gvc_result join_nodes(const pieces *p, gvc_reeb_graph *graph, gvc_error *error) {
    size_t room = p->count - p->mesh->face_count, count = 0, kept = 0;
    graph->arc = gvc_alloc(room, sizeof *graph->arc);
    if (!graph->arc) return gvc_fail_memory(error);
    for (size_t f = 0; f < p->mesh->face_count; f++)
        for (uint32_t i = p->first[f]; i + 1 < p->first[f + 1]; i++) {
            graph->arc[count][0] = p->parent[i];
            graph->arc[count++][1] = p->parent[i + 1];
        }
    qsort(graph->arc, count, sizeof *graph->arc, compare_arcs);
    for (size_t i = 0; i < count; i++) {
        if (kept > 0 && compare_arcs(graph->arc[kept - 1], graph->arc[i]) == 0) continue;
        graph->arc[kept][0] = graph->arc[i][0];
        graph->arc[kept++][1] = graph->arc[i][1];
    }
    graph->arc_count = kept;
    for (size_t i = 0; i < kept; i++) {
        graph->node[graph->arc[i][0]].valence++;
        graph->node[graph->arc[i][1]].valence++;
    }
    return GVC_OK;
}

static gvc_result place_vertices(const pieces *p, gvc_reeb_graph *graph, gvc_error *error) {
    graph->top_node = gvc_alloc(p->mesh->vertex_count, sizeof *graph->top_node);
    if (!graph->top_node) return gvc_fail_memory(error);
    for (size_t v = 0; v < p->mesh->vertex_count; v++)
        graph->top_node[v] = p->parent[piece_of(p, p->mesh->outgoing[v] / 3, p->level[v])];
    return GVC_OK;
}

gvc_result gvc_reeb_graph_build(const gvc_halfedges *mesh, const double *mu, unsigned levels,
                                gvc_reeb_graph *graph, gvc_error *error) {
    *graph = (gvc_reeb_graph){.levels = levels};
    if (levels == 0) return gvc_fail(error, GVC_ERROR_ARGUMENT, "a Reeb graph of 0 levels");
    pieces p = {.mesh = mesh, .mu = mu, .levels = levels};
    gvc_result result = GVC_OK;
    GVC_CHECK(cut_faces(&p, error));
    join_across_edges(&p);
    GVC_CHECK(number_nodes(&p, graph, error));
    measure_nodes(&p, graph);
    GVC_CHECK(join_nodes(&p, graph, error));
    result = place_vertices(&p, graph, error);
cleanup:
    free(p.level);
    free(p.first);
    free(p.parent);
    if (result != GVC_OK) gvc_reeb_graph_free(graph);
    return result;
}

void gvc_reeb_graph_free(gvc_reeb_graph *graph) {
    free(graph->node);
    free(graph->arc);
    free(graph->top_node);
    *graph = (gvc_reeb_graph){0};
}
