/* SPDX-License-Identifier: MIT */
/** @file reference.c  Frames cut by themselves: Gu, Gortler and Hoppe 2002. */
#include "encode/reference.h"

#include "base/memory.h"
#include "chart/layout.h"
#include "chart/parameterize.h"
#include "descriptor/geodesic.h"
#include "descriptor/graph_edit.h"
#include "descriptor/handle_graph.h"
#include "encode/stretch.h"
#include "mesh/refine.h"

#include <math.h>
#include <stdlib.h>

#define TRIAL_SIZE 64 /* of the square that stretch is measured on */
#define MOST_PATHS 32
#define PATIENCE 3 /* paths without gain before the search ends */

/* A cut that grows path by path. */
typedef struct growth {
    gvc_frame_work *work;
    gvc_pathfinder *finder;
    const gvc_parameterize_options *final; /* the map whose stretch counts */
    uint32_t tip[MOST_PATHS];              /* where path i ends */
    double stretch[MOST_PATHS + 1];        /* with the first i paths; INFINITY: no map */
    size_t measured;                       /* entries of `stretch` */
} growth;

/* ------------------------------------------------------------------------------------ first cut */

/* The vertex farthest from `count` others along the surface. */
static gvc_result farthest(const gvc_halfedges *mesh, const uint32_t *from, size_t count,
                           uint32_t *vertex, gvc_error *error) {
    gvc_marcher *marcher = NULL;
    double *distance = gvc_alloc(mesh->vertex_count, sizeof *distance);
    gvc_result result = distance ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_marcher_create(mesh, &marcher, error);
    if (result == GVC_OK) result = gvc_march(marcher, from, count, distance, error);
    *vertex = 0;
    for (uint32_t v = 1; result == GVC_OK && v < mesh->vertex_count; v++) {
        if (distance[v] > distance[*vertex]) *vertex = v;
    }
    gvc_marcher_destroy(&marcher);
    free(distance);
    return result;
}

/* Two edges on opposite sides of `middle`, as one cut edge. */
static gvc_result open_at(const gvc_halfedges *mesh, uint32_t middle, gvc_cut_graph *graph,
                          gvc_error *error) {
    size_t valence = 0;
    uint32_t first = mesh->outgoing[middle], second = first, node[2], edge;
    uint32_t h = first;
    do {
        valence++;
        h = gvc_turn(mesh, h);
    } while (h != first);
    for (size_t i = 0; i < valence / 2; i++) second = gvc_turn(mesh, second);
    uint32_t end[2] = {mesh->vertex[gvc_next(first)], mesh->vertex[gvc_next(second)]};
    GVC_TRY(
        gvc_cut_graph_add_node(graph, (gvc_cut_node){GVC_NODE_ROOT, 0, end[0]}, &node[0], error));
    GVC_TRY(gvc_cut_graph_add_node(graph, (gvc_cut_node){GVC_NODE_EXTREMUM, 0, end[1]}, &node[1],
                                   error));
    uint32_t *chain = gvc_alloc(3, sizeof *chain);
    if (!chain) return gvc_fail_memory(error);
    chain[0] = end[0], chain[1] = middle, chain[2] = end[1];
    gvc_result result = gvc_cut_graph_add_edge(graph, node[0], node[1], chain, 3, &edge, error);
    if (result != GVC_OK) free(chain);
    return result;
}

/* Face 0 is the seed. */
static gvc_result first_cut(growth *g, gvc_error *error) {
    gvc_halfedges *mesh = &g->work->halfedges;
    gvc_cut_graph *graph = &g->work->graph;
    uint32_t middle;
    GVC_TRY(farthest(mesh, mesh->vertex, 3, &middle, error));
    if (gvc_mesh_genus(mesh) == 0) return open_at(mesh, middle, graph, error);
    GVC_TRY(gvc_handle_graph(g->finder, mesh, middle, graph, error));
    graph->node[0].kind = GVC_NODE_ROOT;
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ more paths
 */

/* Joins a vertex to the cut by the shortest path. */
static gvc_result add_path(growth *g, uint32_t tip, gvc_error *error) {
    gvc_halfedges *mesh = &g->work->halfedges;
    gvc_cut_graph *graph = &g->work->graph;
    gvc_surface_path path = {0};
    gvc_cut_node node = {GVC_NODE_EXTREMUM, 0, tip};
    uint32_t *chain = NULL, from, to, edge;
    size_t count = 0, place;
    gvc_result result;
    for (size_t n = 0; n < graph->node_count; n++) {
        node.feature += graph->node[n].kind == GVC_NODE_EXTREMUM;
    }
    GVC_CHECK(gvc_pathfinder_begin(g->finder, mesh, graph, error));
    gvc_pathfinder_mark_graph(g->finder, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_vertex(g->finder, tip, GVC_CORNER_TARGET);
    GVC_CHECK(gvc_pathfinder_find(g->finder, NULL, NULL, &path, error));
    if (path.count == 0) {
        GVC_CHECK(gvc_fail(error, GVC_ERROR_INTERNAL, "no path to vertex %u", tip));
    }
    gvc_cut_graph_locate(graph, path.point[0].a, &from, &edge, &place);
    if (from == GVC_NONE) GVC_CHECK(gvc_cut_graph_split_edge(graph, edge, place, &from, error));
    GVC_CHECK(gvc_surface_path_insert(mesh, &path, &chain, &count, error));
    GVC_CHECK(gvc_cut_graph_add_node(graph, node, &to, error));
    GVC_CHECK(gvc_cut_graph_add_edge(graph, from, to, chain, count, &edge, error));
    chain = NULL;
cleanup:
    free(chain);
    gvc_surface_path_free(&path);
    return result;
}

/* Lays the border of the opened frame out on the square of the trials. */
static gvc_result place_border(const gvc_frame_work *work, gvc_disk *disk, double **uv,
                               gvc_error *error) {
    const gvc_cut_graph *graph = &work->graph;
    gvc_side_table table = {0};
    size_t count = 0, quarter = 0;
    double *length = gvc_alloc(graph->edge_count, sizeof *length);
    uint32_t *starts = gvc_alloc(gvc_border_length(TRIAL_SIZE), sizeof *starts);
    gvc_result result = GVC_OK;
    if (!length || !starts) GVC_CHECK(gvc_fail_memory(error));
    for (size_t e = 0; e < graph->edge_count; e++) {
        length[e] = gvc_cut_edge_length(&work->halfedges, &graph->edge[e]);
    }
    GVC_CHECK(
        gvc_layout_make(disk->run, disk->run_count, graph, length, TRIAL_SIZE, &table, error));
    GVC_CHECK(gvc_layout_starts(&table, starts, &count, error));
    while (quarter < count && starts[quarter] < TRIAL_SIZE - 1) quarter++;
    if (quarter == 0) {
        GVC_CHECK(gvc_fail(error, GVC_ERROR_MESH, "no layout of the cut fits the square"));
    }
    table.start = starts[quarter / 2];
    GVC_CHECK(gvc_layout_place(disk, &table, uv, error));
cleanup:
    free(length);
    free(starts);
    gvc_side_table_free(&table);
    return result;
}

/* Maps the disk; `*mapped` is false if every map tried folds. */
static gvc_result map(const gvc_disk *disk, const gvc_parameterize_options *options, double *uv,
                      double *stretch, bool *mapped, gvc_error *error) {
    gvc_parameterize_report report = {0};
    gvc_error trouble;
    gvc_error_init(&trouble);
    gvc_result result = gvc_parameterize(disk, TRIAL_SIZE, options, uv, &report, &trouble);
    *mapped = result == GVC_OK;
    *stretch = *mapped && isfinite(report.stretch) ? report.stretch : INFINITY;
    if (result == GVC_ERROR_MESH) return GVC_OK;
    return gvc_hand_on(error, result, &trouble);
}

/* Where a map collapses beyond floating point there is no telling where it stretches most: it does
 * so the more the farther from the cut. */
static gvc_result farthest_from_cut(const gvc_frame_work *work, uint32_t *vertex,
                                    gvc_error *error) {
    const gvc_cut_graph *graph = &work->graph;
    size_t count = 0;
    for (size_t e = 0; e < graph->edge_count; e++) count += graph->edge[e].vertex_count;
    uint32_t *on_cut = gvc_alloc(count, sizeof *on_cut);
    if (!on_cut) return gvc_fail_memory(error);
    count = 0;
    for (size_t e = 0; e < graph->edge_count; e++) {
        for (size_t i = 0; i < graph->edge[e].vertex_count; i++) {
            on_cut[count++] = graph->edge[e].vertex[i];
        }
    }
    gvc_result result = farthest(&work->halfedges, on_cut, count, vertex, error);
    free(on_cut);
    uint32_t node, edge;
    size_t place;
    gvc_cut_graph_locate(graph, *vertex, &node, &edge, &place);
    if (node != GVC_NONE || edge != GVC_NONE) *vertex = GVC_NONE; /* all vertices are on it */
    return result;
}

/* The stretch that the final map has with this cut, and the next tip by the mean value map;
 * GVC_NONE if there is none. */
static gvc_result measure(const growth *g, double *stretch, uint32_t *extremum, gvc_error *error) {
    static const gvc_parameterize_options mean_value = {0, 0};
    gvc_disk disk = {0};
    double *uv = NULL, unused;
    bool mapped;
    gvc_result result = gvc_disk_open(&g->work->halfedges, &g->work->graph, &disk, error);
    if (result == GVC_OK) result = place_border(g->work, &disk, &uv, error);
    if (result == GVC_OK) result = map(&disk, g->final, uv, stretch, &mapped, error);
    if (result == GVC_OK) result = map(&disk, &mean_value, uv, &unused, &mapped, error);
    if (result == GVC_OK && mapped) *extremum = gvc_stretch_extremum(&disk, uv);
    free(uv);
    gvc_disk_free(&disk);
    if (result != GVC_OK || mapped) return result;
    return farthest_from_cut(g->work, extremum, error);
}

static size_t best_of(const growth *g) {
    size_t best = 0;
    for (size_t i = 1; i < g->measured; i++) {
        if (g->stretch[i] < g->stretch[best]) best = i;
    }
    return best;
}

/* Adds paths until some of them in a row were no gain. */
static gvc_result grow(growth *g, gvc_error *error) {
    GVC_TRY(first_cut(g, error));
    for (size_t paths = 0;; paths++) {
        uint32_t extremum = GVC_NONE;
        gvc_error trouble;
        gvc_error_init(&trouble);
        gvc_result result = measure(g, &g->stretch[paths], &extremum, &trouble);
        if (result == GVC_ERROR_MESH && g->measured > 0) return GVC_OK; /* the square is full */
        GVC_TRY(gvc_hand_on(error, result, &trouble));
        g->measured = paths + 1;
        bool found = isfinite(g->stretch[best_of(g)]);
        if (paths == MOST_PATHS || extremum == GVC_NONE) return GVC_OK;
        if (found && paths >= best_of(g) + PATIENCE) return GVC_OK;
        g->tip[paths] = extremum;
        GVC_TRY(add_path(g, extremum, error));
    }
}

/* Cuts the frame anew, with the first `paths` paths found. */
static gvc_result cut_again(growth *g, size_t paths, gvc_error *error) {
    GVC_TRY(gvc_frame_uncut(g->work, error));
    GVC_TRY(first_cut(g, error));
    for (size_t i = 0; i < paths; i++) GVC_TRY(add_path(g, g->tip[i], error));
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------------- image */

/* Lays out and samples the cut of least stretch; if that gives charts that fold, the next best. */
static gvc_result make_image(growth *g, uint32_t size, gvc_segment *segment, double *image,
                             gvc_reference_report *report, gvc_error *error) {
    gvc_error trouble;
    gvc_result result;
    do {
        size_t paths = best_of(g);
        gvc_error_init(&trouble);
        report->path_count = paths;
        report->stretch = g->stretch[paths];
        GVC_TRY(cut_again(g, paths, error));
        result = gvc_segment_layout(segment, g->work, size, 1, &trouble);
        if (result == GVC_OK) {
            result = gvc_frame_image(g->work, &segment->sides, &segment->weld,
                                     &segment->image_options, image, &trouble);
        }
        g->stretch[paths] = INFINITY;
    } while (result == GVC_ERROR_MESH && isfinite(g->stretch[best_of(g)]));
    return gvc_hand_on(error, result, &trouble);
}

gvc_result gvc_reference_frame(const gvc_source *source, bool weld, uint32_t size,
                               gvc_frame_work *work, gvc_segment *segment, double *image,
                               gvc_reference_report *report, gvc_error *error) {
    gvc_reference_report made = {0};
    growth g = {.work = work, .final = &segment->image_options.parameterize};
    segment->number = segment->first_frame = work->number;
    work->longest_edge = GVC_LONGEST_EDGE;
    segment->end_frame = work->number + 1;
    GVC_TRY(gvc_load_frame(source, work->number, weld, &work->mesh, NULL, error));
    work->diagonal = gvc_mesh_diagonal(work->mesh);
    gvc_result result = gvc_halfedges_build(work->mesh, 0, &work->halfedges, error);
    if (result == GVC_OK) result = gvc_pathfinder_create(&g.finder, error);
    if (result == GVC_OK) result = grow(&g, error);
    if (result == GVC_OK) result = make_image(&g, size, segment, image, &made, error);
    gvc_pathfinder_destroy(&g.finder);
    if (report) *report = made;
    return gvc_at_frame(error, result, (int64_t)work->number);
}
