/* SPDX-License-Identifier: MIT */
/** @file link.c  Places the paths of the cut graph, in a first frame and in those that follow. */
#include "descriptor/link.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const gvc_edge_end no_end = {GVC_NONE, 0};
/* Paths that reach an edge this close to a node (in diagonals) start from the node: a shorter edge
 * would be stretched over the two pixels it needs at least. */
static const double node_reach = 0.02;
/* Standard deviation of E_d and E_p in normalised coordinates, less round a narrow handle: at most
 * this part of the length of the path. And where the exponents level off. */
static const double usual_deviation = 0.05, handle_deviation = 1, greatest_exponent = 50;
/* A path is given up if its mean distance to the one before is over this. */
static const double greatest_departure = 1;

void gvc_link_free(gvc_link *link) {
    free(link->junction);
    gvc_prior_free(&link->prior);
    *link = (gvc_link){0};
}

static void *copy_of(const double *from, size_t count) {
    double *to = gvc_alloc(count, sizeof *to);
    if (to) memcpy(to, from, count * sizeof *to);
    return to;
}

gvc_result gvc_link_copy(const gvc_link *from, gvc_link *to, gvc_error *error) {
    size_t n = from->prior.dimensions;
    *to = *from;
    to->junction = copy_of(from->junction, n);
    to->prior.sample = copy_of(from->prior.sample, n * (GVC_PRIOR_SEGMENTS + 1));
    to->prior.box = copy_of(from->prior.box, n * 4 * GVC_PRIOR_SEGMENTS);
    if (to->junction && to->prior.sample && to->prior.box) return GVC_OK;
    gvc_link_free(to);
    return gvc_fail_memory(error);
}

static double gap(const gvc_halfedges *mesh, uint32_t a, uint32_t b) {
    const double *p = mesh->position + 3 * (size_t)a, *q = mesh->position + 3 * (size_t)b;
    double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
    return sqrt(x * x + y * y + z * z);
}

/* ------------------------------------------------------------------------- paths in coordinates */

/* Sets `prior` to a path given by points of the mesh. */
static gvc_result set_prior(const gvc_routing *r, const gvc_surface_point *point, size_t count,
                            gvc_prior *prior, gvc_error *error) {
    const gvc_coordinates *c = &r->coordinates;
    double *coordinates = gvc_alloc(count * c->dimension, sizeof *coordinates);
    double *length = gvc_alloc(count, sizeof *length);
    double *attribute = gvc_alloc(r->mesh->attribute_count, sizeof *attribute);
    gvc_result result = GVC_OK;
    if (!coordinates || !length || !attribute) GVC_CHECK(gvc_fail_memory(error));
    double before[3] = {0};
    for (size_t i = 0; i < count; i++) {
        double p[3];
        gvc_surface_point_get(r->mesh, &point[i], p, attribute);
        gvc_coordinates_get(c, p, attribute, coordinates + i * c->dimension);
        double x = p[0] - before[0], y = p[1] - before[1], z = p[2] - before[2];
        length[i] = i > 0 ? length[i - 1] + sqrt(x * x + y * y + z * z) : 0;
        memcpy(before, p, sizeof before);
    }
    result = gvc_prior_set(prior, c->dimension, coordinates, length, count, error);
cleanup:
    free(coordinates);
    free(length);
    free(attribute);
    return result;
}

static double chain_length(const gvc_routing *r, const uint32_t *chain, size_t count) {
    double length = 0;
    for (size_t i = 0; i + 1 < count; i++) length += gap(r->mesh, chain[i], chain[i + 1]);
    return length;
}

/* Keeps in the link where its path and its first node are in this frame. */
static gvc_result remember(const gvc_routing *r, gvc_link *link, const uint32_t *chain,
                           size_t count, gvc_error *error) {
    gvc_surface_point *point = gvc_alloc(count, sizeof *point);
    if (!link->junction)
        link->junction = gvc_alloc(r->coordinates.dimension, sizeof *link->junction);
    gvc_result result = point && link->junction ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        for (size_t i = 0; i < count; i++) point[i] = (gvc_surface_point){chain[i], GVC_NONE, 0};
        gvc_coordinates_of_vertex(r->mesh, &r->coordinates, chain[0], link->junction);
        result = set_prior(r, point, count, &link->prior, error);
        link->length = chain_length(r, chain, count) / r->coordinates.diagonal;
        link->deviation = usual_deviation;
        if (link->tip == GVC_NONE)
            link->deviation = fmin(link->deviation, handle_deviation * link->length);
    }
    free(point);
    return result;
}

/* ------------------------------------------------------------------------------------ searching */

/* Begins a search with the tips that are not linked yet, and the obstacles, blocked. */
static gvc_result begin(const gvc_routing *r, gvc_error *error) {
    const gvc_obstacles *o = &r->obstacles;
    GVC_TRY(gvc_pathfinder_begin(r->finder, r->mesh, r->graph, error));
    for (size_t i = 0; i < o->vertex_count; i++)
        if (o->vertex[i] != GVC_NONE)
            gvc_pathfinder_mark_vertex(r->finder, o->vertex[i], GVC_CORNER_BLOCKED);
    for (size_t e = 0; o->graph && e < o->graph->edge_count; e++)
        GVC_TRY(gvc_pathfinder_block(r->finder, o->graph->edge[e].vertex,
                                     o->graph->edge[e].vertex_count, error));
    for (size_t i = 0; i < r->tip_count; i++)
        if (!r->linked[i]) gvc_pathfinder_mark_vertex(r->finder, r->tip[i], GVC_CORNER_BLOCKED);
    return GVC_OK;
}

/* Gives the corners of a node between an edge end and the next one a role. */
static void mark_end(const gvc_routing *r, uint32_t node, gvc_edge_end after,
                     gvc_corner_role role) {
    if (after.edge == GVC_NONE)
        gvc_pathfinder_mark_vertex(r->finder, r->graph->node[node].vertex, role);
    else
        gvc_pathfinder_mark_sector(r->finder, gvc_edge_end_halfedge(r->mesh, r->graph, after),
                                   role);
}

/* The end of a link is where its path leads to. */
static void mark_target(const gvc_routing *r, const gvc_link *link) {
    if (link->tip != GVC_NONE)
        gvc_pathfinder_mark_vertex(r->finder, r->tip[link->tip], GVC_CORNER_TARGET);
    else
        mark_end(r, link->node[1], link->after[1], GVC_CORNER_TARGET);
}

/* Begins a search between the two ends of the link. */
static gvc_result begin_link(const gvc_routing *r, const gvc_link *link, gvc_error *error) {
    GVC_TRY(begin(r, error));
    mark_end(r, link->node[0], link->after[0], GVC_CORNER_SOURCE);
    mark_target(r, link);
    return GVC_OK;
}

/* Adds the path to mesh and graph. The first node, and the last if it is not a tip, exist. */
static gvc_result add_path(gvc_routing *r, gvc_link *link, const gvc_surface_path *path,
                           gvc_error *error) {
    uint32_t *chain = NULL, added;
    size_t count = 0;
    gvc_result result = gvc_surface_path_insert(r->mesh, path, &chain, &count, error);
    if (result != GVC_OK) return result;
    GVC_CHECK(remember(r, link, chain, count, error));
    uint32_t leaving = gvc_halfedge_between(r->mesh, chain[0], chain[1]);
    link->after[0] = gvc_edge_end_before(r->mesh, r->graph, link->node[0], leaving);
    if (link->tip != GVC_NONE) {
        gvc_cut_node node = {GVC_NODE_EXTREMUM, link->tip, chain[count - 1]};
        GVC_CHECK(gvc_cut_graph_add_node(r->graph, node, &link->node[1], error));
        link->after[1] = no_end;
        r->linked[link->tip] = true;
    }
    GVC_CHECK(gvc_cut_graph_add_edge(r->graph, link->node[0], link->node[1], chain, count, &added,
                                     error));
    return GVC_OK;
cleanup:
    free(chain);
    return result;
}

/* ---------------------------------------------------------------------------------- first frame */

/* The node within reach of the inner vertex `place` of an edge, or GVC_NONE. */
static uint32_t node_nearby(const gvc_routing *r, uint32_t edge, size_t place) {
    const gvc_cut_edge *e = &r->graph->edge[edge];
    double back = 0, ahead = 0;
    for (size_t i = 0; i + 1 < e->vertex_count; i++)
        *(i < place ? &back : &ahead) += gap(r->mesh, e->vertex[i], e->vertex[i + 1]);
    double least = fmin(back, ahead);
    if (least > node_reach * r->coordinates.diagonal) return GVC_NONE;
    return e->node[back <= ahead ? 0 : 1];
}

static uint32_t tip_at(const gvc_routing *r, uint32_t vertex) {
    for (uint32_t i = 0; i < r->tip_count; i++)
        if (r->tip[i] == vertex) return i;
    return GVC_NONE;
}

/* Finds or makes the node from which the path leaves the graph; if that is not where the path
 * begins, the path is found anew. */
static gvc_result attach(gvc_routing *r, gvc_link *link, gvc_path_weight weight,
                         const void *context, gvc_surface_path *path, gvc_error *error) {
    uint32_t edge;
    size_t place;
    link->parent = GVC_NONE;
    gvc_cut_graph_locate(r->graph, path->point[0].a, &link->node[0], &edge, &place);
    if (link->node[0] != GVC_NONE) return GVC_OK;
    link->node[0] = node_nearby(r, edge, place);
    if (link->node[0] == GVC_NONE) {
        link->parent = edge;
        return gvc_cut_graph_split_edge(r->graph, edge, place, &link->node[0], error);
    }
    GVC_TRY(begin(r, error));
    gvc_pathfinder_mark_vertex(r->finder, r->graph->node[link->node[0]].vertex, GVC_CORNER_SOURCE);
    mark_target(r, link);
    return gvc_pathfinder_find(r->finder, weight, context, path, error);
}

gvc_result gvc_link_nearest(gvc_routing *r, gvc_link *link, gvc_error *error) {
    gvc_surface_path path = {0};
    gvc_result result = GVC_OK;
    GVC_CHECK(begin(r, error));
    gvc_pathfinder_mark_graph(r->finder, GVC_CORNER_SOURCE);
    for (size_t i = 0; i < r->tip_count; i++)
        if (!r->linked[i]) gvc_pathfinder_mark_vertex(r->finder, r->tip[i], GVC_CORNER_TARGET);
    GVC_CHECK(gvc_pathfinder_find(r->finder, NULL, NULL, &path, error));
    if (path.count == 0)
        GVC_CHECK(gvc_fail(error, GVC_ERROR_MESH,
                           "an extremum cannot be reached from the cut graph: the surface has "
                           "several components"));
    link->tip = tip_at(r, path.point[path.count - 1].a);
    GVC_CHECK(attach(r, link, NULL, NULL, &path, error));
    if (path.count == 0)
        GVC_CHECK(gvc_fail(error, GVC_ERROR_INTERNAL, "no path from node %u", link->node[0]));
    result = add_path(r, link, &path, error);
cleanup:
    gvc_surface_path_free(&path);
    return result;
}

gvc_result gvc_link_attach(gvc_routing *r, size_t nodes, size_t edges, gvc_link *link, bool *kept,
                           gvc_error *error) {
    gvc_surface_path path = {0};
    gvc_result result = begin(r, error);
    if (result != GVC_OK) return result;
    for (size_t n = 0; n < nodes; n++)
        gvc_pathfinder_mark_vertex(r->finder, r->graph->node[n].vertex, GVC_CORNER_SOURCE);
    for (size_t e = 0; e < edges; e++)
        for (size_t i = 1; i + 1 < r->graph->edge[e].vertex_count; i++)
            gvc_pathfinder_mark_vertex(r->finder, r->graph->edge[e].vertex[i], GVC_CORNER_SOURCE);
    mark_target(r, link);
    result = gvc_pathfinder_find(r->finder, NULL, NULL, &path, error);
    if (result == GVC_OK && path.count > 0) result = attach(r, link, NULL, NULL, &path, error);
    *kept = result == GVC_OK && path.count > 0;
    if (*kept) result = add_path(r, link, &path, error);
    gvc_surface_path_free(&path);
    return result;
}

/* --------------------------------------------------------------------------- frames that follow */

static double square_distance(const double *a, const double *b, size_t dimension) {
    double sum = 0;
    for (size_t k = 0; k < dimension; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

typedef struct chain_place {
    size_t place; /* index of the chain's vertex */
    double t;     /* between it and the next one */
    double length;
} chain_place;

enum { CHAIN_STEPS = 8 }; /* between two vertices of the chain */

/* Eq. 10: the point of the edge that is nearest to both the old junction and the point where the
 * shortest path meets the graph, in coordinates. Squares, because with lambda 0.5 every point
 * between the two would do for the sum of distances itself. `work` has room for 3 points. */
static chain_place best_junction(const gvc_routing *r, const gvc_cut_edge *edge, const double *old,
                                 const double *shortest, double *work) {
    size_t n = r->coordinates.dimension;
    double *a = work, *b = work + n, *x = work + 2 * n, lambda = r->options->lambda;
    double total = gvc_cut_edge_length(r->mesh, edge), passed = 0, least = INFINITY;
    double margin = fmin(node_reach * r->coordinates.diagonal, 0.25 * total);
    chain_place best = {0, 0.5, 0};
    for (size_t i = 0; i + 1 < edge->vertex_count; i++) {
        double step = gap(r->mesh, edge->vertex[i], edge->vertex[i + 1]);
        gvc_coordinates_of_vertex(r->mesh, &r->coordinates, edge->vertex[i], a);
        gvc_coordinates_of_vertex(r->mesh, &r->coordinates, edge->vertex[i + 1], b);
        for (int j = 0; j < CHAIN_STEPS; j++) {
            double t = (double)j / CHAIN_STEPS, at = passed + t * step;
            if (at < margin || at > total - margin) continue;
            for (size_t k = 0; k < n; k++) x[k] = a[k] + t * (b[k] - a[k]);
            double cost = lambda * square_distance(x, old, n);
            if (shortest) cost += (1 - lambda) * square_distance(x, shortest, n);
            if (cost < least) {
                least = cost;
                best = (chain_place){i, t, step};
            }
        }
        passed += step;
    }
    return best;
}

/* Makes the junction of a link on its parent edge; needs a shortest path if Eq. 10 weighs it. */
static gvc_result make_junction(gvc_routing *r, gvc_link *link, gvc_surface_path *path, bool *kept,
                                gvc_error *error) {
    size_t n = r->coordinates.dimension;
    double *work = gvc_alloc(4 * n, sizeof *work), *shortest = NULL;
    gvc_result result = work ? GVC_OK : gvc_fail_memory(error);
    if (result != GVC_OK) return result;
    if (r->options->lambda < 1 && link->tip != GVC_NONE) {
        GVC_CHECK(begin(r, error));
        gvc_pathfinder_mark_graph(r->finder, GVC_CORNER_SOURCE);
        gvc_pathfinder_mark_vertex(r->finder, r->tip[link->tip], GVC_CORNER_TARGET);
        GVC_CHECK(gvc_pathfinder_find(r->finder, NULL, NULL, path, error));
        *kept = path->count > 0;
        if (!*kept) goto cleanup;
        shortest = work + 3 * n;
        gvc_coordinates_of_vertex(r->mesh, &r->coordinates, path->point[0].a, shortest);
    }
    gvc_cut_edge *edge = &r->graph->edge[link->parent];
    chain_place best = best_junction(r, edge, link->junction, shortest, work);
    if (best.t > 0 || best.place == 0) {
        uint32_t vertex, h = gvc_halfedge_between(r->mesh, edge->vertex[best.place],
                                                  edge->vertex[best.place + 1]);
        GVC_CHECK(gvc_halfedges_split(r->mesh, h, best.t > 0 ? best.t : 0.5, &vertex, error));
        GVC_CHECK(gvc_cut_graph_insert_vertex(r->graph, link->parent, best.place, vertex, error));
        best.place++;
    }
    result = gvc_cut_graph_split_edge(r->graph, link->parent, best.place, &link->node[0], error);
cleanup:
    free(work);
    return result;
}

/* What a path costs: the exponents of E_p and E_d (Eqs. 7 and 8), so that the path of least cost is
 * the one of greatest probability (Eq. 9). */
typedef struct evidence {
    const gvc_coordinates *coordinates;
    const gvc_prior *previous, *shortest;
    double previous_weight, shortest_weight, variance;
    double *point; /* room for one */
} evidence;

static double exponent(const gvc_prior *prior, const double *point, double variance) {
    return gvc_prior_distance(prior, point, greatest_exponent * variance) / variance;
}

static double evidence_weight(const void *context, const double position[3],
                              const double *attribute) {
    const evidence *e = context;
    double weight = 0;
    gvc_coordinates_get(e->coordinates, position, attribute, e->point);
    if (e->previous_weight > 0)
        weight += e->previous_weight * exponent(e->previous, e->point, e->variance);
    if (e->shortest_weight > 0)
        weight += e->shortest_weight * exponent(e->shortest, e->point, e->variance);
    return weight;
}

/* Finds the path of Eq. 9 between the ends of a link. */
static gvc_result best_path(gvc_routing *r, const gvc_link *link, gvc_surface_path *path,
                            gvc_error *error) {
    gvc_prior shortest = {0};
    double variance = link->deviation * link->deviation;
    evidence e = {&r->coordinates,
                  &link->prior,
                  &shortest,
                  r->options->prior_weight,
                  r->options->shortest_weight,
                  variance,
                  NULL};
    gvc_result result = GVC_OK;
    e.point = gvc_alloc(r->coordinates.dimension, sizeof *e.point);
    if (!e.point) GVC_CHECK(gvc_fail_memory(error));
    GVC_CHECK(begin_link(r, link, error));
    if (e.shortest_weight > 0) {
        GVC_CHECK(gvc_pathfinder_find(r->finder, NULL, NULL, path, error));
        if (path->count == 0) goto cleanup;
        GVC_CHECK(set_prior(r, path->point, path->count, &shortest, error));
    }
    result = gvc_pathfinder_find(r->finder, evidence_weight, &e, path, error);
cleanup:
    free(e.point);
    gvc_prior_free(&shortest);
    return result;
}

/* True if the path stays, on average, where the prior is. */
static bool stays(const gvc_routing *r, const gvc_prior *now, const gvc_prior *before) {
    double sum = 0;
    for (size_t i = 0; i <= GVC_PRIOR_SEGMENTS; i++)
        sum += sqrt(gvc_prior_distance(before, now->sample + i * r->coordinates.dimension, 100));
    return sum / (GVC_PRIOR_SEGMENTS + 1) <= greatest_departure;
}

gvc_result gvc_link_again(gvc_routing *r, gvc_link *link, bool *kept, gvc_error *error) {
    gvc_surface_path path = {0};
    gvc_prior now = {0};
    gvc_result result = GVC_OK;
    *kept = true;
    if (link->parent != GVC_NONE) {
        GVC_CHECK(make_junction(r, link, &path, kept, error));
        if (!*kept) goto cleanup;
    }
    GVC_CHECK(best_path(r, link, &path, error));
    *kept = path.count > 0;
    if (!*kept) goto cleanup;
    GVC_CHECK(set_prior(r, path.point, path.count, &now, error));
    /* A handle need not: it may open and close elsewhere, and what matters is that it is one. */
    *kept = link->tip == GVC_NONE || stays(r, &now, &link->prior);
    if (*kept) result = add_path(r, link, &path, error);
cleanup:
    gvc_surface_path_free(&path);
    gvc_prior_free(&now);
    return result;
}

gvc_result gvc_link_resume(gvc_routing *r, gvc_link *link, bool *kept, gvc_error *error) {
    gvc_surface_path path = {0};
    evidence e = {.coordinates = &r->coordinates,
                  .previous = &link->prior,
                  .previous_weight = r->options->prior_weight,
                  .variance = link->deviation * link->deviation};
    gvc_result result = GVC_OK;
    e.point = gvc_alloc(r->coordinates.dimension, sizeof *e.point);
    if (!e.point) GVC_CHECK(gvc_fail_memory(error));
    GVC_CHECK(begin(r, error));
    gvc_pathfinder_mark_graph(r->finder, GVC_CORNER_SOURCE);
    mark_target(r, link);
    GVC_CHECK(gvc_pathfinder_find(r->finder, evidence_weight, &e, &path, error));
    if (path.count > 0) GVC_CHECK(attach(r, link, evidence_weight, &e, &path, error));
    *kept = path.count > 0;
    if (*kept) result = add_path(r, link, &path, error);
cleanup:
    free(e.point);
    gvc_surface_path_free(&path);
    return result;
}

/* ----------------------------------------------------------------------------- handles as links */

gvc_result gvc_link_of_edge(const gvc_routing *r, uint32_t edge, gvc_link *link, gvc_error *error) {
    const gvc_cut_edge *e = &r->graph->edge[edge];
    gvc_cut_graph before = *r->graph;
    before.edge_count = edge;
    gvc_link_free(link);
    *link = (gvc_link){.tip = GVC_NONE, .parent = GVC_NONE, .node = {e->node[0], e->node[1]}};
    for (unsigned i = 0; i < 2; i++) {
        uint32_t h = gvc_edge_end_halfedge(r->mesh, r->graph, (gvc_edge_end){edge, i});
        link->after[i] = gvc_edge_end_before(r->mesh, &before, e->node[i], h);
    }
    return remember(r, link, e->vertex, e->vertex_count, error);
}
