/* SPDX-License-Identifier: MIT */
/**
 * @file tracking.c
 * The flow of Sect. 3.3: what is done once per segment, and what in every later frame. The graph is
 * put together in the same order in every frame: root, tips, handles. So it is the same graph, up
 * to the handles, over any number of segments.
 */
#include "descriptor/tracked.h"

#include "base/memory.h"
#include "descriptor/consistent.h"
#include "descriptor/geodesic.h"
#include "descriptor/handle_graph.h"
#include "descriptor/match.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* An extremum is not matched over a greater distance, in diagonals, */
static const double match_gate = 0.2;
/* nor if its normalised geodesic distance to another one changed by more than this. */
static const double shape_gate = 0.25;

/* How far a tip or the root goes from where the warp takes it to where this frame alone would put
 * it: the warp is some ten times as exact, but its errors add up. */
static const double renewal = 0.1;

/* If a handle is this close to the root, in diagonals, the root moves to it: otherwise the handle
 * would move from one side of it to the other. */
static const double join_reach = 0.02;
/* A handle that is gone is looked for again for so many frames. */
enum { HANDLE_MEMORY = 8 };

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

static void forget(gvc_tracked *t) {
    for (size_t i = 0; i < t->link_count; i++) gvc_link_free(&t->link[i]);
    for (size_t i = 0; i < t->handle_count; i++) gvc_handle_link_free(&t->handle[i]);
    free(t->tip);
    free(t->tip_point);
    free(t->root_point);
    free(t->link);
    free(t->handle);
    free(t->side);
    *t = (gvc_tracked){0};
}

void gvc_tracker_destroy(gvc_tracker **tracker) {
    if (!tracker || !*tracker) return;
    forget(&(*tracker)->known);
    forget(&(*tracker)->aside);
    gvc_pathfinder_destroy(&(*tracker)->finder);
    free(*tracker);
    *tracker = NULL;
}

/* Memory for what is remembered of `tips` tips. */
static bool make_room(gvc_tracked *t, size_t tips) {
    size_t dimension = tips + 4;
    t->tip_point = gvc_alloc(tips * dimension, sizeof *t->tip_point);
    t->root_point = gvc_alloc(dimension, sizeof *t->root_point);
    t->link = gvc_alloc(tips, sizeof *t->link);
    return t->tip_point && t->root_point && t->link;
}

/* Takes over what a frame that follows needs, with room for `handles` handles: all but the border.
 */
static gvc_result copy_tracked(const gvc_tracked *from, size_t handles, gvc_tracked *to,
                               gvc_error *error) {
    size_t n = from->tip_count + 4;
    gvc_result result = GVC_OK;
    *to = *from;
    to->link_count = to->handle_count = to->side_count = 0;
    to->side = NULL;
    to->handle = gvc_alloc(handles, sizeof *to->handle);
    to->tip = gvc_alloc(from->tip_count, sizeof *to->tip);
    if (!make_room(to, from->tip_count) || !to->tip || !to->handle)
        GVC_CHECK(gvc_fail_memory(error));
    memcpy(to->tip, from->tip, from->tip_count * sizeof *to->tip);
    memcpy(to->tip_point, from->tip_point, from->tip_count * n * sizeof *to->tip_point);
    memcpy(to->root_point, from->root_point, n * sizeof *to->root_point);
    for (; to->link_count < from->link_count; to->link_count++) {
        size_t i = to->link_count;
        GVC_CHECK(gvc_link_copy(&from->link[i], &to->link[i], error));
    }
    for (; to->handle_count < from->handle_count; to->handle_count++) {
        size_t i = to->handle_count;
        GVC_CHECK(gvc_handle_link_copy(&from->handle[i], &to->handle[i], error));
    }
cleanup:
    if (result != GVC_OK) forget(to);
    return result;
}

/* What one frame is worked on with. */
typedef struct workspace {
    gvc_routing routing;
    uint32_t *tip; /* vertices */
    uint32_t root;
    uint32_t *point;      /* routing.obstacles: vertices of handles, then the tips */
    const gvc_warp *warp; /* from the frame before; NULL in the first one, or if nothing moved */
} workspace;

static void workspace_free(workspace *w) {
    gvc_coordinates_detach(w->routing.mesh, &w->routing.coordinates);
    free(w->tip);
    free(w->point);
    free(w->routing.linked);
}

static void workspace_set(workspace *w, const gvc_tracker *tracker, gvc_halfedges *mesh,
                          gvc_cut_graph *graph) {
    *w = (workspace){
        .routing = {
            .options = &tracker->options, .finder = tracker->finder, .mesh = mesh, .graph = graph}};
    *graph = (gvc_cut_graph){0};
}

static gvc_result workspace_allocate(workspace *w, const gvc_tracked *t, gvc_error *error) {
    w->tip = gvc_alloc(t->tip_count, sizeof *w->tip);
    w->point = gvc_alloc(GVC_HANDLE_POINTS * t->handle_count + t->tip_count, sizeof *w->point);
    w->routing.linked = gvc_alloc(t->tip_count, sizeof *w->routing.linked);
    w->routing.tip = w->tip;
    w->routing.tip_count = t->tip_count;
    w->routing.obstacles.vertex = w->point;
    return w->tip && w->point && w->routing.linked ? GVC_OK : gvc_fail_memory(error);
}

/* Channels: one per tip, then one for the root. */
static gvc_result attach_coordinates(workspace *w, const gvc_tracked *t,
                                     const gvc_features *features, gvc_error *error) {
    GVC_TRY(gvc_coordinates_attach(w->routing.mesh, features, t->tip_count + 1,
                                   &w->routing.coordinates, error));
    w->routing.coordinates.diagonal = t->diagonal;
    w->routing.coordinates.scale = t->scale;
    return GVC_OK;
}

/* Takes down where tips and root are. */
static void remember_points(gvc_tracked *t, const workspace *w, bool first) {
    const gvc_routing *r = &w->routing;
    const gvc_coordinates *c = &r->coordinates;
    size_t n = c->dimension;
    for (size_t i = 0; i < t->tip_count; i++) {
        gvc_coordinates_of_vertex(r->mesh, c, w->tip[i], t->tip_point + i * n);
        t->tip[i].vertex = w->tip[i];
        memcpy(t->tip[i].position, r->mesh->position + 3 * (size_t)w->tip[i],
               sizeof t->tip[i].position);
    }
    if (first)
        gvc_coordinates_of_vertex(r->mesh, c, w->root, t->root_point);
    else
        gvc_coordinates_place(c, r->mesh->position + 3 * (size_t)w->root, t->root_point);
}

/* Walks the border of the opened surface; `*disk` tells whether that is one disk. */
static gvc_result walk_border(gvc_tracked *t, const workspace *w, bool *disk, gvc_error *error) {
    const gvc_cut_graph *graph = w->routing.graph;
    t->side = gvc_alloc(2 * graph->edge_count, sizeof *t->side);
    if (!t->side) return gvc_fail_memory(error);
    GVC_TRY(gvc_cut_graph_walk(w->routing.mesh, graph, t->side, &t->side_count, error));
    *disk = t->side_count == 2 * graph->edge_count &&
            graph->node_count + 2 * t->genus == graph->edge_count + 1;
    return GVC_OK;
}

static gvc_result add_root(const workspace *w, gvc_error *error) {
    uint32_t index;
    gvc_cut_node root = {GVC_NODE_ROOT, 0, w->root};
    return gvc_cut_graph_add_node(w->routing.graph, root, &index, error);
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

/* Takes the first extrema of the list; the root cannot be one. */
static gvc_result take_extrema(gvc_tracked *t, const gvc_features *features, uint32_t root,
                               gvc_error *error) {
    size_t room = t->wanted < features->extremum_count ? t->wanted : features->extremum_count;
    t->tip = gvc_alloc(room + 2, sizeof *t->tip); /* two may be made up */
    if (!t->tip) return gvc_fail_memory(error);
    for (size_t i = 0; i < room; i++)
        if (features->extremum[i].vertex != root) t->tip[t->tip_count++] = features->extremum[i];
    t->matched_count = t->tip_count;
    return GVC_OK;
}

/* A sphere-like surface needs two tips: the point farthest from the only one, or from the root. */
static gvc_result make_up_tips(gvc_tracked *t, const gvc_halfedges *mesh, uint32_t root,
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

/* Handles found by themselves, in the order in which they were found. */
typedef struct handle_list {
    gvc_handle *handle;
    size_t count;
    gvc_cut_graph graph; /* their loops, two edges each */
} handle_list;

static void handle_list_free(handle_list *list) {
    for (size_t i = 0; i < list->count; i++) gvc_handle_free(&list->handle[i]);
    free(list->handle);
    for (size_t e = 0; e < list->graph.edge_count; e++) list->graph.edge[e].vertex = NULL;
    gvc_cut_graph_free(&list->graph);
}

/* The edges of the list's graph borrow the loops. */
static gvc_result list_handle(handle_list *list, gvc_error *error) {
    const gvc_handle *handle = &list->handle[list->count++];
    gvc_cut_node base = {GVC_NODE_JUNCTION, 0, handle->loop[0][0]};
    uint32_t node, edge;
    GVC_TRY(gvc_cut_graph_add_node(&list->graph, base, &node, error));
    for (int i = 0; i < 2; i++)
        GVC_TRY(gvc_cut_graph_add_edge(&list->graph, node, node, handle->loop[i], handle->count[i],
                                       &edge, error));
    return GVC_OK;
}

/* The vertex from which handles are looked for. */
static uint32_t search_start(const gvc_tracked *t, const workspace *w) {
    if (t->search < GVC_HANDLES_NEAR_TIP || t->tip_count == 0) return w->root;
    size_t tip = t->search - GVC_HANDLES_NEAR_TIP;
    return w->tip[tip < t->tip_count ? tip : t->tip_count - 1];
}

static void join_root(const gvc_tracked *t, workspace *w, const gvc_handle *handle) {
    const double *p = w->routing.mesh->position + 3 * (size_t)w->root;
    const double *q = w->routing.mesh->position + 3 * (size_t)handle->loop[0][0];
    double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
    if (away <= join_reach * t->diagonal) w->root = handle->loop[0][0];
}

/* Finds the handles before anything else, so that their loops are short; root and tips are left
 * free. */
static gvc_result find_handles(const gvc_tracked *t, workspace *w, handle_list *list,
                               gvc_error *error) {
    uint32_t *avoid = gvc_alloc(t->tip_count + 1, sizeof *avoid);
    list->handle = gvc_alloc(t->genus, sizeof *list->handle);
    gvc_result result = avoid && list->handle ? GVC_OK : gvc_fail_memory(error);
    for (size_t i = 0; avoid && i < t->tip_count; i++) avoid[i] = w->tip[i];
    if (avoid) avoid[t->tip_count] = w->root;
    const gvc_obstacles obstacles = {&list->graph, avoid, t->tip_count + 1};
    for (size_t i = 0; result == GVC_OK && i < t->genus; i++) {
        gvc_handle *handle = &list->handle[i];
        result = gvc_handle_find(w->routing.finder, w->routing.mesh, &obstacles, search_start(t, w),
                                 t->search != GVC_HANDLES_SHORT, handle, error);
        if (result == GVC_OK && handle->count[0] == 0)
            result = gvc_fail(error, GVC_ERROR_MESH,
                              "only %zu of %zu handles can be cut: the surface has several "
                              "components",
                              i, t->genus);
        if (result == GVC_OK)
            result = gvc_handle_face(w->routing.finder, w->routing.mesh, &obstacles, w->root,
                                     handle, error);
        if (result == GVC_OK && i == 0) join_root(t, w, handle);
        if (result != GVC_OK)
            gvc_handle_free(handle);
        else
            result = list_handle(list, error);
    }
    free(avoid);
    return result;
}

/* Puts the graph together: root, handles, tips. */
static gvc_result link_everything(gvc_tracked *t, workspace *w, const handle_list *handles,
                                  gvc_error *error) {
    w->routing.obstacles = (gvc_obstacles){.graph = &handles->graph};
    GVC_TRY(add_root(w, error));
    for (size_t i = 0; i < t->genus; i++)
        GVC_TRY(gvc_handle_link_first(&w->routing, &handles->handle[i],
                                      &t->handle[t->handle_count++], error));
    w->routing.obstacles = (gvc_obstacles){0};
    for (size_t i = 0; i < t->tip_count; i++)
        GVC_TRY(gvc_link_nearest(&w->routing, &t->link[t->link_count++], error));
    return GVC_OK;
}

static gvc_result check_disk(const gvc_tracked *t, const gvc_cut_graph *graph, bool disk,
                             gvc_error *error) {
    if (disk) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_INTERNAL,
                    "the cut graph has %zu nodes, %zu edges and a border of %zu sides, which is "
                    "no disk on a surface of genus %zu",
                    graph->node_count, graph->edge_count, t->side_count, t->genus);
}

static gvc_result start(gvc_tracked *t, const gvc_features *features, workspace *w,
                        handle_list *handles, gvc_error *error) {
    gvc_halfedges *mesh = w->routing.mesh;
    const gvc_coordinates *coordinates = &w->routing.coordinates;
    bool disk = false;
    w->root = features->root;
    GVC_TRY(take_extrema(t, features, w->root, error));
    GVC_TRY(make_up_tips(t, mesh, w->root, error));
    t->handle = gvc_alloc(t->genus, sizeof *t->handle);
    if (!make_room(t, t->tip_count) || !t->handle) return gvc_fail_memory(error);
    GVC_TRY(workspace_allocate(w, t, error));
    for (size_t i = 0; i < t->tip_count; i++) w->tip[i] = t->tip[i].vertex;
    GVC_TRY(find_handles(t, w, handles, error));
    GVC_TRY(attach_coordinates(w, t, features, error));
    GVC_TRY(gvc_coordinates_measure(mesh, coordinates, 0, w->tip, t->tip_count, error));
    GVC_TRY(gvc_coordinates_measure(mesh, coordinates, t->tip_count, &w->root, 1, error));
    GVC_TRY(link_everything(t, w, handles, error));
    GVC_TRY(walk_border(t, w, &disk, error));
    GVC_TRY(check_disk(t, w->routing.graph, disk, error));
    remember_points(t, w, true);
    return GVC_OK;
}

/* Cuts all handles by one graph, whose node nearest to the root of `features` becomes the root. */
static gvc_result begin_graph(const gvc_features *features, workspace *w, gvc_error *error) {
    gvc_cut_graph *graph = w->routing.graph;
    double least = INFINITY;
    uint32_t nearest = 0;
    GVC_TRY(gvc_handle_graph(w->routing.finder, w->routing.mesh, features->root, graph, error));
    const double *p = w->routing.mesh->position + 3 * (size_t)features->root;
    for (uint32_t n = 0; n < graph->node_count; n++) {
        const double *q = w->routing.mesh->position + 3 * (size_t)graph->node[n].vertex;
        double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        if (away >= least) continue;
        least = away;
        nearest = n;
    }
    graph->node[nearest].kind = GVC_NODE_ROOT;
    w->root = graph->node[nearest].vertex;
    return GVC_OK;
}

/* Leaves out extrema that lie on the graph already. */
static void drop_covered_tips(gvc_tracked *t, const gvc_cut_graph *graph) {
    size_t kept = 0;
    for (size_t i = 0; i < t->tip_count; i++) {
        uint32_t node, edge;
        size_t place;
        gvc_cut_graph_locate(graph, t->tip[i].vertex, &node, &edge, &place);
        if (node == GVC_NONE && edge == GVC_NONE) t->tip[kept++] = t->tip[i];
    }
    t->tip_count = t->matched_count = kept;
}

/* A cut for one frame only. */
static gvc_result start_single(gvc_tracked *t, const gvc_features *features, workspace *w,
                               gvc_error *error) {
    bool disk = false;
    GVC_TRY(begin_graph(features, w, error));
    GVC_TRY(take_extrema(t, features, w->root, error));
    drop_covered_tips(t, w->routing.graph);
    if (!make_room(t, t->tip_count)) return gvc_fail_memory(error);
    GVC_TRY(workspace_allocate(w, t, error));
    for (size_t i = 0; i < t->tip_count; i++) w->tip[i] = t->tip[i].vertex;
    GVC_TRY(attach_coordinates(w, t, features, error));
    for (size_t i = 0; i < t->tip_count; i++)
        GVC_TRY(gvc_link_nearest(&w->routing, &t->link[t->link_count++], error));
    GVC_TRY(walk_border(t, w, &disk, error));
    return check_disk(t, w->routing.graph, disk, error);
}

gvc_result gvc_tracker_start(gvc_tracker *tracker, const gvc_features *features,
                             size_t extremum_count, unsigned search, gvc_halfedges *mesh,
                             gvc_cut_graph *graph, gvc_error *error) {
    workspace w;
    handle_list handles = {0};
    gvc_tracked *t = &tracker->known;
    forget(t);
    workspace_set(&w, tracker, mesh, graph);
    t->genus = gvc_mesh_genus(mesh);
    t->wanted = extremum_count;
    t->search = search;
    t->diagonal = features->diagonal > 0 ? features->diagonal : 1;
    t->scale = features->geodesic_scale > 0 ? features->geodesic_scale : 1;
    tracker->lost = false;
    bool single = t->genus > 0 && search == GVC_HANDLES_GRAPH;
    gvc_result result =
        single ? start_single(t, features, &w, error) : start(t, features, &w, &handles, error);
    handle_list_free(&handles);
    workspace_free(&w);
    t->started = result == GVC_OK;
    if (result != GVC_OK) gvc_cut_graph_free(graph);
    if (result != GVC_OK || single) forget(t);
    t->single = result == GVC_OK && single;
    return result;
}

/* --------------------------------------------------------------------------- frames that follow */

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

/* Moves a feature that was at `before` (coordinates), and would be at `*vertex` by this frame
 * alone, to where the surface that was there is now. */
static gvc_result steady(workspace *w, const double *before, uint32_t *vertex, gvc_error *error) {
    gvc_halfedges *mesh = w->routing.mesh;
    double moved[3];
    if (!w->warp) return GVC_OK;
    gvc_coordinates_position(&w->routing.coordinates, before, moved);
    gvc_warp_point(w->warp, moved, moved);
    for (size_t k = 0; k < 3; k++)
        moved[k] += renewal * (mesh->position[3 * (size_t)*vertex + k] - moved[k]);
    return gvc_warp_pin(w->warp, mesh, moved, vertex, error);
}

/* True if the first `count` tips are as far from each other as they were: a hand is not taken for
 * the other one. */
static bool same_shape(const gvc_tracked *t, const workspace *w, size_t count) {
    const gvc_routing *r = &w->routing;
    size_t n = r->coordinates.dimension, channels = r->mesh->attribute_count;
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < count; j++) {
            double now = r->mesh->attribute[w->tip[i] * channels + r->coordinates.first + j];
            if (fabs(now - t->tip_point[i * n + j]) > shape_gate) return false;
        }
    return true;
}

/* The tips that are extrema: where the surface has gone, but for the renewal. A hand that touches a
 * hip may then be pinned to the hip, which distances show; this frame's own extrema serve there.
 * After a change of handles distances are others anyway. */
static gvc_result place_extrema(const gvc_tracked *t, workspace *w, bool resume, bool *kept,
                                gvc_error *error) {
    gvc_routing *r = &w->routing;
    size_t n = r->coordinates.dimension, count = t->matched_count;
    for (size_t i = 0; i < count; i++) {
        w->tip[i] = t->tip[i].vertex;
        GVC_TRY(steady(w, t->tip_point + i * n, &w->tip[i], error));
    }
    GVC_TRY(gvc_coordinates_measure(r->mesh, &r->coordinates, 0, w->tip, count, error));
    *kept = resume || same_shape(t, w, count);
    if (*kept || !w->warp) return GVC_OK;
    for (size_t i = 0; i < count; i++) w->tip[i] = t->tip[i].vertex;
    GVC_TRY(gvc_coordinates_measure(r->mesh, &r->coordinates, 0, w->tip, count, error));
    *kept = same_shape(t, w, count);
    return GVC_OK;
}

/* Finds the tips: matched extrema first, the made up ones by geodesic consistency to those. Unless
 * `resume`, they must be as far from each other as they were. */
static gvc_result find_tips(gvc_tracked *t, const gvc_features *features, workspace *w, bool resume,
                            bool *kept, gvc_error *error) {
    gvc_routing *r = &w->routing;
    size_t n = r->coordinates.dimension;
    for (size_t i = 0; w->warp && i < t->matched_count; i++)
        gvc_warp_point(w->warp, t->tip[i].position, t->tip[i].position);
    GVC_TRY(gvc_match_extrema(t->tip, t->matched_count, features, match_gate, w->tip, kept, error));
    if (!*kept) return GVC_OK;
    for (size_t i = 0; i < t->matched_count; i++) t->tip[i] = features->extremum[w->tip[i]];
    GVC_TRY(place_extrema(t, w, resume, kept, error));
    if (!*kept) return GVC_OK;
    for (size_t i = t->matched_count; i < t->tip_count; i++) {
        const double *wanted = t->tip_point + i * n;
        GVC_TRY(gvc_consistent_vertex(r->mesh, &r->coordinates, i, wanted, w->tip, i, &w->tip[i],
                                      error));
        *kept = w->tip[i] != GVC_NONE;
        if (!*kept) return GVC_OK;
        GVC_TRY(steady(w, wanted, &w->tip[i], error));
        GVC_TRY(gvc_coordinates_measure(r->mesh, &r->coordinates, i, &w->tip[i], 1, error));
    }
    *kept = resume || same_shape(t, w, t->tip_count);
    return GVC_OK;
}

/* Finds the root by geodesic consistency, near where the motion of the surface takes it. After a
 * change of handles distances are others: then position decides. */
static gvc_result find_root(const gvc_tracked *t, workspace *w, bool resume, bool *kept,
                            gvc_error *error) {
    gvc_routing *r = &w->routing;
    const motion m = {&r->coordinates, w->warp};
    size_t features = resume ? 0 : t->tip_count, n = r->coordinates.dimension;
    double *wanted = gvc_alloc(n, sizeof *wanted);
    if (!wanted) return gvc_fail_memory(error);
    memcpy(wanted, t->root_point, n * sizeof *wanted);
    follow(&m, wanted);
    gvc_result result = gvc_consistent_vertex(r->mesh, &r->coordinates, features, wanted, w->tip,
                                              t->tip_count, &w->root, error);
    free(wanted);
    *kept = result == GVC_OK && w->root != GVC_NONE;
    if (!*kept) return result;
    GVC_TRY(steady(w, t->root_point, &w->root, error));
    return gvc_coordinates_measure(r->mesh, &r->coordinates, t->tip_count, &w->root, 1, error);
}

/* Changes the points of everything that is known of the frame before. */
static void move_everything(gvc_tracked *t, void (*move)(const void *context, double *point),
                            const void *context) {
    for (size_t i = 0; i < t->link_count; i++) {
        gvc_prior_move(&t->link[i].prior, move, context);
        move(context, t->link[i].junction);
    }
    for (size_t i = 0; i < t->handle_count; i++) {
        gvc_handle_link *handle = &t->handle[i];
        for (int k = 0; k < GVC_HANDLE_LINKS; k++) {
            if (!handle->link[k].junction) continue; /* joined: there is no way */
            gvc_prior_move(&handle->link[k].prior, move, context);
            move(context, handle->link[k].junction);
        }
        for (int k = 0; k < GVC_HANDLE_POINTS; k++) move(context, handle->point[k]);
    }
}

/* Gives a point the coordinates of the vertex nearest to it. */
static void settle(const void *context, double *point) {
    const gvc_routing *r = context;
    gvc_coordinates_of_vertex(r->mesh, &r->coordinates,
                              gvc_nearest_vertex(r->mesh, &r->coordinates, point), point);
}

/* Finds where base and middle of the handles must have gone, of those that are open or of all;
 * they are kept clear until the handle is placed. */
static gvc_result find_handle_points(const gvc_tracked *t, bool all, workspace *w,
                                     gvc_error *error) {
    gvc_routing *r = &w->routing;
    size_t n = GVC_HANDLE_POINTS * t->handle_count, fixed = t->tip_count + 1;
    uint32_t *taken = gvc_alloc(fixed + n, sizeof *taken);
    if (!taken) return gvc_fail_memory(error);
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < t->tip_count; i++) taken[i] = w->tip[i];
    taken[t->tip_count] = w->root;
    for (size_t i = 0; result == GVC_OK && i < n; i++) {
        const gvc_handle_link *handle = &t->handle[i / GVC_HANDLE_POINTS];
        w->point[i] = GVC_NONE;
        bool root = handle->joined && i % GVC_HANDLE_POINTS == 0;
        if (!root && (handle->open || all))
            result = gvc_consistent_vertex(r->mesh, &r->coordinates, 0,
                                           handle->point[i % GVC_HANDLE_POINTS], taken, fixed + i,
                                           &w->point[i], error);
        taken[fixed + i] = w->point[i];
    }
    memcpy(w->point + n, w->tip, t->tip_count * sizeof *w->point);
    r->obstacles.vertex_count = n + t->tip_count;
    free(taken);
    return result;
}

/* Places one handle where it was, or, within a segment, where else there is one: cut open, all
 * handles are alike. */
static gvc_result place_handle(workspace *w, size_t index, bool resume, gvc_handle_link *handle,
                               bool *placed, gvc_error *error) {
    gvc_routing *r = &w->routing;
    uint32_t *clear = w->point + GVC_HANDLE_POINTS * index, point[GVC_HANDLE_POINTS];
    size_t edges = r->graph->edge_count;
    *placed = true;
    for (int k = 0; k < GVC_HANDLE_POINTS; k++) {
        point[k] = k == 0 && handle->joined ? w->root : clear[k];
        clear[k] = GVC_NONE;
        *placed = *placed && point[k] != GVC_NONE;
    }
    if (*placed) GVC_TRY(gvc_handle_link_again(r, point, resume, handle, placed, error));
    if (*placed || resume || r->graph->edge_count != edges) return GVC_OK;
    return gvc_handle_link_elsewhere(r, handle, placed, error);
}

/* Places the handles that were open, or as many of all that are known as there are now. */
static gvc_result place_handles(gvc_tracked *t, workspace *w, bool resume, bool *kept,
                                gvc_error *error) {
    size_t open = 0;
    for (size_t i = 0; i < t->handle_count; i++) {
        gvc_handle_link *handle = &t->handle[i];
        bool due = resume ? open < t->genus : handle->open, placed = false;
        if (handle->joined && w->routing.graph->edge_count > 0) due = false;
        if (due) GVC_TRY(place_handle(w, i, resume, handle, &placed, error));
        handle->open = placed;
        handle->since = placed ? 0 : handle->since + 1;
        open += placed;
        *kept = *kept && (resume || placed == due);
        if (!*kept) return GVC_OK;
    }
    return GVC_OK;
}

/* Finds the handles that were not there before. */
static gvc_result add_handles(gvc_tracked *t, workspace *w, gvc_error *error) {
    gvc_routing *r = &w->routing;
    size_t open = 0;
    for (size_t i = 0; i < t->handle_count; i++) open += t->handle[i].open;
    for (; open < t->genus; open++) {
        const gvc_obstacles obstacles = {r->graph, w->tip, t->tip_count};
        gvc_handle found;
        GVC_TRY(gvc_handle_find(r->finder, r->mesh, &obstacles, w->root, false, &found, error));
        if (found.count[0] == 0)
            return gvc_fail(error, GVC_ERROR_MESH, "only %zu of %zu handles can be cut", open,
                            t->genus);
        gvc_result result = gvc_handle_face(r->finder, r->mesh, &obstacles, w->root, &found, error);
        if (result == GVC_OK)
            result = gvc_handle_link_first(r, &found, &t->handle[t->handle_count++], error);
        gvc_handle_free(&found);
        if (result != GVC_OK) return result;
    }
    return GVC_OK;
}

/* Handles that have been gone for long are forgotten. */
static void forget_handles(gvc_tracked *t) {
    size_t kept = 0;
    for (size_t i = 0; i < t->handle_count; i++) {
        if (t->handle[i].since > HANDLE_MEMORY)
            gvc_handle_link_free(&t->handle[i]);
        else
            t->handle[kept++] = t->handle[i];
    }
    t->handle_count = kept;
}

static gvc_result place_everything(gvc_tracked *t, workspace *w, bool resume, bool *kept,
                                   gvc_error *error) {
    GVC_TRY(add_root(w, error));
    GVC_TRY(place_handles(t, w, resume, kept, error));
    w->root = w->routing.graph->node[0].vertex; /* a handle may have taken it along */
    if (resume) {
        w->routing.obstacles = (gvc_obstacles){0};
        GVC_TRY(add_handles(t, w, error));
    }
    for (size_t i = 0; i < t->link_count && *kept; i++)
        GVC_TRY(resume ? gvc_link_resume(&w->routing, &t->link[i], kept, error)
                       : gvc_link_again(&w->routing, &t->link[i], kept, error));
    return GVC_OK;
}

/* True if the border is what it was, or, after a change, that of a disk. */
static gvc_result check_border(gvc_tracked *t, const gvc_tracked *before, const workspace *w,
                               bool resume, bool *kept, gvc_error *error) {
    GVC_TRY(walk_border(t, w, kept, error));
    if (resume || !*kept) return GVC_OK;
    *kept = t->side_count == before->side_count;
    for (size_t i = 0; *kept && i < t->side_count; i++)
        *kept = t->side[i].edge == before->side[i].edge &&
                t->side[i].reversed == before->side[i].reversed;
    return GVC_OK;
}

/* Cuts a frame as the one before, `t` being a copy of what is known of that. If `resume`, the
 * handles may be others. */
static gvc_result track(gvc_tracked *t, const gvc_tracked *before, const gvc_features *features,
                        workspace *w, bool resume, bool *kept, gvc_error *error) {
    GVC_TRY(workspace_allocate(w, t, error));
    GVC_TRY(attach_coordinates(w, t, features, error));
    GVC_TRY(find_tips(t, features, w, resume, kept, error));
    if (!*kept) return GVC_OK;
    GVC_TRY(find_root(t, w, resume, kept, error));
    if (!*kept) return GVC_OK;
    const motion m = {&w->routing.coordinates, w->warp};
    move_everything(t, follow, &m);
    if (resume) move_everything(t, settle, &w->routing);
    GVC_TRY(find_handle_points(t, resume && t->genus > before->genus, w, error));
    GVC_TRY(place_everything(t, w, resume, kept, error));
    if (!*kept) return GVC_OK;
    GVC_TRY(check_border(t, before, w, resume, kept, error));
    forget_handles(t);
    if (*kept) remember_points(t, w, resume);
    return GVC_OK;
}

/* Goes on from what is known; that is replaced only if it succeeds. */
static gvc_result go_on(gvc_tracker *tracker, const gvc_features *features, const gvc_warp *warp,
                        gvc_halfedges *mesh, gvc_cut_graph *graph, bool resume, bool *kept,
                        gvc_error *error) {
    workspace w;
    gvc_tracked now;
    size_t genus = gvc_mesh_genus(mesh), handles = tracker->known.handle_count + genus;
    workspace_set(&w, tracker, mesh, graph);
    w.warp = warp;
    gvc_result result = copy_tracked(&tracker->known, handles, &now, error);
    if (result != GVC_OK) return result;
    now.genus = genus;
    *kept = true;
    result = track(&now, &tracker->known, features, &w, resume, kept, error);
    workspace_free(&w);
    if (result != GVC_OK) *kept = false;
    if (*kept) {
        gvc_tracked before = tracker->known;
        tracker->known = now;
        now = before;
    } else {
        gvc_cut_graph_free(graph);
    }
    forget(&now);
    return result;
}

gvc_result gvc_tracker_next(gvc_tracker *tracker, const gvc_features *features,
                            const gvc_warp *warp, gvc_halfedges *mesh, gvc_cut_graph *graph,
                            bool *kept, gvc_error *error) {
    *graph = (gvc_cut_graph){0};
    *kept = false;
    if (tracker->known.single) return GVC_OK;
    if (!tracker->known.started || tracker->lost)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is no earlier frame to track from");
    gvc_result result = GVC_OK;
    if (gvc_mesh_genus(mesh) == tracker->known.genus)
        result = go_on(tracker, features, warp, mesh, graph, false, kept, error);
    tracker->lost = !*kept;
    return result;
}

gvc_result gvc_tracker_resume(gvc_tracker *tracker, const gvc_features *features,
                              const gvc_warp *warp, size_t extremum_count, gvc_halfedges *mesh,
                              gvc_cut_graph *graph, bool *kept, gvc_error *error) {
    *graph = (gvc_cut_graph){0};
    *kept = false;
    if (!tracker->known.started || tracker->known.wanted != extremum_count ||
        gvc_mesh_genus(mesh) == tracker->known.genus)
        return GVC_OK;
    gvc_result result = go_on(tracker, features, warp, mesh, graph, true, kept, error);
    if (*kept) tracker->lost = false;
    return result;
}

void gvc_tracker_set_aside(gvc_tracker *tracker) {
    forget(&tracker->aside);
    tracker->aside = tracker->known;
    tracker->known = (gvc_tracked){0};
}

void gvc_tracker_take_back(gvc_tracker *tracker) {
    forget(&tracker->known);
    tracker->known = tracker->aside;
    tracker->aside = (gvc_tracked){0};
    tracker->lost = false;
}
