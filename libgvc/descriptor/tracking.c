/* SPDX-License-Identifier: MIT */
/**
 * @file tracking.c
 * The flow of Sect. 3.3: what is done once per segment, and what in every later frame.
 */
#include "descriptor/tracking.h"

#include "base/memory.h"
#include "descriptor/consistent.h"
#include "descriptor/geodesic.h"
#include "descriptor/handles.h"
#include "descriptor/link.h"
#include "descriptor/match.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An extremum is not matched over a greater distance, in diagonals, */
static const double match_gate = 0.2;
/* nor if its normalised geodesic distance to another one changed by more than this. */
static const double shape_gate = 0.25;

/* How far a tip or node goes from where the warp takes it to where this frame alone would put it:
 * the warp is some ten times as exact, but its errors add up. */
static const double renewal = 0.1;

struct gvc_tracker {
    gvc_tracker_options options;
    gvc_pathfinder *finder;
    bool started;
    size_t genus;
    /* Of the segment's first frame: each frame is compared with the one before it, and a
     * normalisation of its own would only add the noise of two greatest distances. */
    double diagonal, scale;
    size_t tip_count,
        matched_count;  /* tips made up for want of extrema come after the matched ones */
    gvc_extremum *tip;  /* as last seen */
    double *tip_point;  /* their coordinates */
    size_t base_count;  /* nodes of the initial graph: the root alone if there are no handles */
    uint32_t root;      /* which of them is the root */
    double *base_point; /* their coordinates: distances as in the first frame, so that nothing
                           drifts along with small errors; positions as last seen */
    size_t link_count;
    gvc_link *link;
    size_t side_count; /* the border of the opened surface */
    gvc_border_side *side;
};

void gvc_tracker_options_init(gvc_tracker_options *options) {
    *options = (gvc_tracker_options){.prior_weight = 1, .shortest_weight = 0.05, .lambda = 0.95};
}

gvc_result gvc_tracker_create(const gvc_tracker_options *options, gvc_tracker **tracker,
                              gvc_error *error) {
    *tracker = gvc_alloc(1, sizeof **tracker);
    if (!*tracker) return gvc_fail_memory(error);
    (*tracker)->options = *options;
    gvc_result result = gvc_pathfinder_create(&(*tracker)->finder, error);
    if (result != GVC_OK) gvc_tracker_destroy(tracker);
    return result;
}

static void forget(gvc_tracker *t) {
    for (size_t i = 0; i < t->link_count; i++) gvc_link_free(&t->link[i]);
    free(t->tip);
    free(t->tip_point);
    free(t->base_point);
    free(t->link);
    free(t->side);
    *t = (gvc_tracker){.options = t->options, .finder = t->finder};
}

void gvc_tracker_destroy(gvc_tracker **tracker) {
    if (!tracker || !*tracker) return;
    forget(*tracker);
    gvc_pathfinder_destroy(&(*tracker)->finder);
    free(*tracker);
    *tracker = NULL;
}

/* What one frame is worked on with. */
typedef struct workspace {
    gvc_routing routing;
    uint32_t *tip; /* vertices */
    uint32_t *base;
    const gvc_warp *warp; /* from the frame before; NULL in the first one, or if nothing moved */
} workspace;

static void workspace_free(workspace *w) {
    gvc_coordinates_detach(w->routing.mesh, &w->routing.coordinates);
    free(w->tip);
    free(w->base);
    free(w->routing.linked);
}

static void workspace_set(workspace *w, gvc_tracker *t, gvc_halfedges *mesh, gvc_cut_graph *graph) {
    *w = (workspace){
        .routing = {.options = &t->options, .finder = t->finder, .mesh = mesh, .graph = graph}};
}

/* Channels: one per tip, then one for the root. */
static gvc_result attach_coordinates(workspace *w, const gvc_tracker *t,
                                     const gvc_features *features, gvc_error *error) {
    GVC_TRY(gvc_coordinates_attach(w->routing.mesh, features, t->tip_count + 1,
                                   &w->routing.coordinates, error));
    w->routing.coordinates.diagonal = t->diagonal;
    w->routing.coordinates.scale = t->scale;
    return GVC_OK;
}

/* Takes down where tips and initial nodes are. */
static void remember_points(gvc_tracker *t, const workspace *w) {
    const gvc_routing *r = &w->routing;
    const gvc_coordinates *c = &r->coordinates;
    size_t n = c->dimension;
    for (size_t i = 0; i < t->tip_count; i++) {
        gvc_coordinates_of_vertex(r->mesh, c, w->tip[i], t->tip_point + i * n);
        t->tip[i].vertex = w->tip[i];
        memcpy(t->tip[i].position, r->mesh->position + 3 * (size_t)w->tip[i],
               sizeof t->tip[i].position);
    }
    for (size_t i = 0; i < t->base_count; i++) {
        double *known = t->base_point + i * n;
        if (!t->started) {
            gvc_coordinates_of_vertex(r->mesh, c, w->base[i], known);
        } else {
            gvc_coordinates_place(c, r->mesh->position + 3 * (size_t)w->base[i], known);
        }
    }
}

/* Walks the border of the opened surface; `*disk` tells whether that is one disk. `*side` is freed
 * by the caller. */
static gvc_result walk_border(const gvc_tracker *t, const workspace *w, gvc_border_side **side,
                              size_t *count, bool *disk, gvc_error *error) {
    const gvc_cut_graph *graph = w->routing.graph;
    *side = gvc_alloc(2 * graph->edge_count, sizeof **side);
    if (!*side) return gvc_fail_memory(error);
    GVC_TRY(gvc_cut_graph_walk(w->routing.mesh, graph, *side, count, error));
    *disk = *count == 2 * graph->edge_count &&
            graph->node_count + 2 * t->genus == graph->edge_count + 1;
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------- first frame */

static gvc_result farthest(const gvc_halfedges *mesh, uint32_t from, uint32_t *vertex,
                           gvc_error *error) {
    gvc_marcher *marcher = NULL;
    double *distance = gvc_alloc(mesh->vertex_count, sizeof *distance);
    gvc_result result = distance ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_marcher_create(mesh, &marcher, error);
    if (result == GVC_OK) result = gvc_march(marcher, &from, 1, distance, error);
    *vertex = from;
    for (uint32_t v = 0; result == GVC_OK && v < mesh->vertex_count; v++)
        if (isfinite(distance[v]) && distance[v] > distance[*vertex]) *vertex = v;
    gvc_marcher_destroy(&marcher);
    free(distance);
    return result;
}

/* Takes the first extrema of the list, without those that are nodes of the initial graph already or
 * lie on its edges. */
static void take_extrema(gvc_tracker *t, const gvc_features *features, size_t wanted,
                         const gvc_cut_graph *graph) {
    for (size_t i = 0; i < features->extremum_count && i < wanted; i++) {
        uint32_t node, edge;
        size_t place;
        gvc_cut_graph_locate(graph, features->extremum[i].vertex, &node, &edge, &place);
        if (node == GVC_NONE && edge == GVC_NONE) t->tip[t->tip_count++] = features->extremum[i];
    }
    t->matched_count = t->tip_count;
}

/* A sphere-like surface needs two tips: the point farthest from the only one, or from the root. */
static gvc_result make_up_tips(gvc_tracker *t, const gvc_halfedges *mesh, uint32_t root,
                               gvc_error *error) {
    while (t->genus == 0 && t->tip_count < 2) {
        uint32_t vertex;
        GVC_TRY(farthest(mesh, t->tip_count ? t->tip[0].vertex : root, &vertex, error));
        bool usable = vertex != root && (t->tip_count == 0 || vertex != t->tip[0].vertex);
        if (!usable && t->tip_count > 0) return GVC_OK;
        if (!usable) return gvc_fail(error, GVC_ERROR_MESH, "the surface is a single point");
        t->tip[t->tip_count++] = (gvc_extremum){.vertex = vertex};
    }
    return GVC_OK;
}

/* An edge that returns to its node gets a node in the middle, without which it could not be found
 * again: there would be no telling its two ends apart. */
static gvc_result split_loops(gvc_cut_graph *graph, gvc_error *error) {
    size_t count = graph->edge_count;
    for (uint32_t e = 0; e < count; e++) {
        const gvc_cut_edge *edge = &graph->edge[e];
        uint32_t node;
        if (edge->node[0] == edge->node[1])
            GVC_TRY(gvc_cut_graph_split_edge(graph, e, edge->vertex_count / 2, &node, error));
    }
    return GVC_OK;
}

/* The initial graph: the root, or a graph that cuts the handles, whose node nearest to the root of
 * `features` becomes the root. */
static gvc_result begin_graph(gvc_tracker *t, const gvc_features *features, workspace *w,
                              gvc_error *error) {
    gvc_cut_graph *graph = w->routing.graph;
    const double *position = w->routing.mesh->position;
    if (t->genus == 0) {
        gvc_cut_node root = {GVC_NODE_ROOT, 0, features->root};
        t->base_count = 1;
        return gvc_cut_graph_add_node(graph, root, &t->root, error);
    }
    GVC_TRY(gvc_handles_cut(t->finder, w->routing.mesh, features->root, graph, error));
    GVC_TRY(split_loops(graph, error));
    position = w->routing.mesh->position;
    double least = INFINITY;
    const double *p = position + 3 * (size_t)features->root;
    for (uint32_t n = 0; n < graph->node_count; n++) {
        const double *q = position + 3 * (size_t)graph->node[n].vertex;
        double d = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        if (d >= least) continue;
        least = d;
        t->root = n;
    }
    graph->node[t->root].kind = GVC_NODE_ROOT;
    t->base_count = graph->node_count;
    return GVC_OK;
}

/* Memory for what is remembered once the numbers of tips and initial nodes are known. */
static gvc_result make_room(gvc_tracker *t, workspace *w, gvc_error *error) {
    size_t dimension = t->tip_count + 4, base_edges = w->routing.graph->edge_count;
    t->tip_point = gvc_alloc(t->tip_count * dimension, sizeof *t->tip_point);
    t->base_point = gvc_alloc(t->base_count * dimension, sizeof *t->base_point);
    t->link = gvc_alloc(base_edges + t->tip_count, sizeof *t->link);
    w->tip = gvc_alloc(t->tip_count, sizeof *w->tip);
    w->base = gvc_alloc(t->base_count, sizeof *w->base);
    w->routing.linked = gvc_alloc(t->tip_count, sizeof *w->routing.linked);
    if (!t->tip_point || !t->base_point || !t->link || !w->tip || !w->base || !w->routing.linked)
        return gvc_fail_memory(error);
    for (size_t i = 0; i < t->tip_count; i++) w->tip[i] = t->tip[i].vertex;
    for (size_t i = 0; i < t->base_count; i++) w->base[i] = w->routing.graph->node[i].vertex;
    w->routing.tip = w->tip;
    w->routing.tip_count = t->tip_count;
    return GVC_OK;
}

static gvc_result link_everything(gvc_tracker *t, workspace *w, gvc_error *error) {
    size_t base_edges = w->routing.graph->edge_count;
    for (uint32_t e = 0; e < base_edges; e++)
        GVC_TRY(gvc_link_of_edge(&w->routing, e, &t->link[t->link_count++], error));
    for (size_t i = 0; i < t->tip_count; i++)
        GVC_TRY(gvc_link_nearest(&w->routing, &t->link[t->link_count++], error));
    return GVC_OK;
}

gvc_result gvc_tracker_start(gvc_tracker *t, const gvc_features *features, size_t extremum_count,
                             gvc_halfedges *mesh, gvc_cut_graph *graph, gvc_error *error) {
    workspace w;
    gvc_result result = GVC_OK;
    bool disk = false;
    forget(t);
    *graph = (gvc_cut_graph){0};
    workspace_set(&w, t, mesh, graph);
    t->genus = gvc_mesh_genus(mesh);
    t->diagonal = features->diagonal > 0 ? features->diagonal : 1;
    t->scale = features->geodesic_scale > 0 ? features->geodesic_scale : 1;
    size_t room =
        extremum_count < features->extremum_count ? extremum_count : features->extremum_count;
    t->tip = gvc_alloc(room + 2, sizeof *t->tip);
    if (!t->tip) GVC_CHECK(gvc_fail_memory(error));
    GVC_CHECK(begin_graph(t, features, &w, error));
    take_extrema(t, features, extremum_count, graph);
    GVC_CHECK(make_up_tips(t, mesh, features->root, error));
    GVC_CHECK(make_room(t, &w, error));
    GVC_CHECK(attach_coordinates(&w, t, features, error));
    GVC_CHECK(gvc_coordinates_measure(mesh, &w.routing.coordinates, 0, w.tip, t->tip_count, error));
    GVC_CHECK(gvc_coordinates_measure(mesh, &w.routing.coordinates, t->tip_count, &w.base[t->root],
                                      1, error));
    GVC_CHECK(link_everything(t, &w, error));
    GVC_CHECK(walk_border(t, &w, &t->side, &t->side_count, &disk, error));
    if (!disk)
        GVC_CHECK(
            gvc_fail(error, GVC_ERROR_INTERNAL,
                     "the cut graph has %zu nodes, %zu edges and a border of %zu sides, which is "
                     "no disk on a surface of genus %zu",
                     graph->node_count, graph->edge_count, t->side_count, t->genus));
    remember_points(t, &w);
    t->started = true;
cleanup:
    workspace_free(&w);
    if (result != GVC_OK) {
        gvc_cut_graph_free(graph);
        forget(t);
    }
    return result;
}

/* --------------------------------------------------------------------------- frames that follow */

/* Moves a feature that was at `before`, and would be at `*vertex` by this frame alone, to where the
 * surface that was there is now. */
static gvc_result steady(workspace *w, const double before[3], uint32_t *vertex, gvc_error *error) {
    gvc_halfedges *mesh = w->routing.mesh;
    double moved[3];
    if (!w->warp) return GVC_OK;
    gvc_warp_point(w->warp, before, moved);
    for (size_t k = 0; k < 3; k++)
        moved[k] += renewal * (mesh->position[3 * (size_t)*vertex + k] - moved[k]);
    return gvc_warp_pin(w->warp, mesh, moved, vertex, error);
}

/* Finds the tips: matched extrema first, the made up ones by geodesic consistency to those. */
static gvc_result find_tips(gvc_tracker *t, const gvc_features *features, workspace *w, bool *kept,
                            gvc_error *error) {
    gvc_routing *r = &w->routing;
    double before[3];
    for (size_t i = 0; w->warp && i < t->matched_count; i++)
        gvc_warp_point(w->warp, t->tip[i].position, t->tip[i].position);
    GVC_TRY(gvc_match_extrema(t->tip, t->matched_count, features, match_gate, w->tip, kept, error));
    if (!*kept) return GVC_OK;
    for (size_t i = 0; i < t->matched_count; i++) {
        t->tip[i] = features->extremum[w->tip[i]];
        w->tip[i] = t->tip[i].vertex;
        gvc_coordinates_position(&r->coordinates, t->tip_point + i * r->coordinates.dimension,
                                 before);
        GVC_TRY(steady(w, before, &w->tip[i], error));
    }
    GVC_TRY(gvc_coordinates_measure(r->mesh, &r->coordinates, 0, w->tip, t->matched_count, error));
    for (size_t i = t->matched_count; i < t->tip_count; i++) {
        const double *wanted = t->tip_point + i * r->coordinates.dimension;
        GVC_TRY(gvc_consistent_vertex(r->mesh, &r->coordinates, i, wanted, w->tip, i, &w->tip[i],
                                      error));
        *kept = w->tip[i] != GVC_NONE;
        if (!*kept) return GVC_OK;
        gvc_coordinates_position(&r->coordinates, wanted, before);
        GVC_TRY(steady(w, before, &w->tip[i], error));
        GVC_TRY(gvc_coordinates_measure(r->mesh, &r->coordinates, i, &w->tip[i], 1, error));
    }
    return GVC_OK;
}

/* True if the tips are as far from each other as they were: a hand is not taken for the other one.
 */
static bool same_shape(const gvc_tracker *t, const workspace *w) {
    const gvc_routing *r = &w->routing;
    size_t n = r->coordinates.dimension, channels = r->mesh->attribute_count;
    for (size_t i = 0; i < t->tip_count; i++)
        for (size_t j = 0; j < t->tip_count; j++) {
            double now = r->mesh->attribute[w->tip[i] * channels + r->coordinates.first + j];
            if (fabs(now - t->tip_point[i * n + j]) > shape_gate) return false;
        }
    return true;
}

/* What moves with the surface from the frame before to this one. */
typedef struct motion {
    const gvc_coordinates *coordinates;
    const gvc_warp *warp;
} motion;

/* Moves the position part of a point's coordinates with the surface. */
static void follow(const void *context, double *point) {
    const motion *m = context;
    double position[3];
    if (!m->warp) return;
    gvc_coordinates_position(m->coordinates, point, position);
    gvc_warp_point(m->warp, position, position);
    gvc_coordinates_place(m->coordinates, position, point);
}

/* Finds the nodes of the initial graph by geodesic consistency, the root first: near where the
 * motion of the surface takes them. */
static gvc_result find_base(gvc_tracker *t, workspace *w, bool *kept, gvc_error *error) {
    gvc_routing *r = &w->routing;
    size_t n = r->coordinates.dimension, taken_count = 0;
    const motion m = {&r->coordinates, w->warp};
    double before[3];
    uint32_t *taken = gvc_alloc(t->tip_count + t->base_count, sizeof *taken);
    double *wanted = gvc_alloc(n, sizeof *wanted);
    gvc_result result = taken && wanted ? GVC_OK : gvc_fail_memory(error);
    for (size_t i = 0; result == GVC_OK && i < t->tip_count; i++) taken[taken_count++] = w->tip[i];
    for (size_t i = 0; i < t->base_count; i++) {
        /* the root, then the others in their order */
        size_t node = i == 0 ? t->root : i <= t->root ? i - 1 : i;
        if (result != GVC_OK) break;
        memcpy(wanted, t->base_point + node * n, n * sizeof *wanted);
        follow(&m, wanted);
        result = gvc_consistent_vertex(r->mesh, &r->coordinates, t->tip_count + (i > 0), wanted,
                                       taken, taken_count, &w->base[node], error);
        if (result != GVC_OK) break;
        *kept = w->base[node] != GVC_NONE;
        if (!*kept) break;
        gvc_coordinates_position(&r->coordinates, t->base_point + node * n, before);
        result = steady(w, before, &w->base[node], error);
        if (result != GVC_OK) break;
        taken[taken_count++] = w->base[node];
        if (i == 0)
            result = gvc_coordinates_measure(r->mesh, &r->coordinates, t->tip_count, &w->base[node],
                                             1, error);
    }
    free(taken);
    free(wanted);
    return result;
}

/* Lets what is known of the frame before follow the surface: the cut is looked for where it must
 * have gone. */
static void follow_surface(gvc_tracker *t, const workspace *w) {
    const motion m = {&w->routing.coordinates, w->warp};
    for (size_t i = 0; i < t->link_count; i++) {
        gvc_prior_move(&t->link[i].prior, follow, &m);
        follow(&m, t->link[i].junction);
    }
}

/* Adds the initial nodes, then every link in its turn. */
static gvc_result place_links(gvc_tracker *t, workspace *w, bool *kept, gvc_error *error) {
    for (uint32_t i = 0; i < t->base_count; i++) {
        uint32_t index;
        gvc_cut_node node = {i == t->root ? GVC_NODE_ROOT : GVC_NODE_JUNCTION, 0, w->base[i]};
        GVC_TRY(gvc_cut_graph_add_node(w->routing.graph, node, &index, error));
    }
    for (size_t i = 0; i < t->link_count && *kept; i++)
        GVC_TRY(gvc_link_again(&w->routing, &t->link[i], kept, error));
    return GVC_OK;
}

static gvc_result check_border(gvc_tracker *t, const workspace *w, bool *kept, gvc_error *error) {
    gvc_border_side *side = NULL;
    size_t count = 0;
    gvc_result result = walk_border(t, w, &side, &count, kept, error);
    *kept = result == GVC_OK && *kept && count == t->side_count;
    for (size_t i = 0; *kept && i < count; i++)
        *kept = side[i].edge == t->side[i].edge && side[i].reversed == t->side[i].reversed;
    free(side);
    return result;
}

static gvc_result allocate_workspace(workspace *w, const gvc_tracker *t, gvc_error *error) {
    w->tip = gvc_alloc(t->tip_count, sizeof *w->tip);
    w->base = gvc_alloc(t->base_count, sizeof *w->base);
    w->routing.linked = gvc_alloc(t->tip_count, sizeof *w->routing.linked);
    w->routing.tip = w->tip;
    w->routing.tip_count = t->tip_count;
    return w->tip && w->base && w->routing.linked ? GVC_OK : gvc_fail_memory(error);
}

static gvc_result track(gvc_tracker *t, const gvc_features *features, workspace *w, bool *kept,
                        gvc_error *error) {
    GVC_TRY(allocate_workspace(w, t, error));
    GVC_TRY(attach_coordinates(w, t, features, error));
    GVC_TRY(find_tips(t, features, w, kept, error));
    if (!*kept || !(*kept = same_shape(t, w))) return GVC_OK;
    GVC_TRY(find_base(t, w, kept, error));
    if (!*kept) return GVC_OK;
    follow_surface(t, w);
    GVC_TRY(place_links(t, w, kept, error));
    if (!*kept) return GVC_OK;
    GVC_TRY(check_border(t, w, kept, error));
    if (*kept) remember_points(t, w);
    return GVC_OK;
}

gvc_result gvc_tracker_next(gvc_tracker *t, const gvc_features *features, const gvc_warp *warp,
                            gvc_halfedges *mesh, gvc_cut_graph *graph, bool *kept,
                            gvc_error *error) {
    workspace w;
    *graph = (gvc_cut_graph){0};
    *kept = false;
    if (!t->started)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is no earlier frame to track from");
    workspace_set(&w, t, mesh, graph);
    w.warp = warp;
    gvc_result result = GVC_OK;
    *kept = gvc_mesh_genus(mesh) == t->genus;
    if (*kept) result = track(t, features, &w, kept, error);
    workspace_free(&w);
    if (result != GVC_OK) *kept = false;
    if (!*kept) {
        gvc_cut_graph_free(graph);
        forget(t);
    }
    return result;
}
