/* SPDX-License-Identifier: MIT */
/**
 * @file path.h
 * Shortest paths over the surface that never touch or cross the cut graph except at their ends.
 *
 * The search runs over a Steiner graph (Lanthier, Maheshwari & Sack 2001): the vertices of the mesh
 * and GVC_STEINER_POINTS points inside every edge, two of them joined wherever they lie on one
 * face. The path found is then made of mesh edges by splitting those it crosses, so it is
 * straighter than any path along the edges of the mesh as given.
 */
#ifndef GVC_DESCRIPTOR_PATH_H
#define GVC_DESCRIPTOR_PATH_H

#include "descriptor/cut_graph.h"

enum { GVC_STEINER_POINTS = 3 };

/** A point of the surface: the vertex `a` if `b` is GVC_NONE, else the point a + t (b - a) inside
 *  the mesh edge between a and b. */
typedef struct gvc_surface_point {
    uint32_t a, b;
    double t;
} gvc_surface_point;

/** Points from source to target; consecutive ones lie on one face, any others on none. Empty if the
 *  target cannot be reached. Zero-initialise before use; free with gvc_surface_path_free. */
typedef struct gvc_surface_path {
    gvc_surface_point *point;
    size_t count, capacity;
    double cost; /**< weighted length */
} gvc_surface_path;

void gvc_surface_path_free(gvc_surface_path *path);

/** What a path may do at a corner of a face. A vertex of the cut graph has corners on several sides
 *  of the graph; roles tell from which side a path may leave or reach it. */
typedef enum gvc_corner_role {
    GVC_CORNER_FREE = 0,    /**< no end of the path; all corners of a vertex are free or none */
    GVC_CORNER_BLOCKED = 1, /**< must not be touched */
    GVC_CORNER_SOURCE = 2,
    GVC_CORNER_TARGET = 3
} gvc_corner_role;

/** Weight of a point, >= 0: a piece of the path costs its length times one plus the mean weight of
 *  its ends. `attribute` are the attributes of the mesh, interpolated. */
typedef double (*gvc_path_weight)(const void *context, const double position[3],
                                  const double *attribute);

typedef struct gvc_pathfinder gvc_pathfinder; /**< reusable work space, one thread at a time */

gvc_result gvc_pathfinder_create(gvc_pathfinder **finder, gvc_error *error);
void gvc_pathfinder_destroy(gvc_pathfinder **finder);

/** Begins a search on `mesh` as it is now (borrowed until the search is done). The edges of `graph`
 *  and all corners at its nodes and edges are blocked, everything else is free. */
gvc_result gvc_pathfinder_begin(gvc_pathfinder *finder, const gvc_halfedges *mesh,
                                const gvc_cut_graph *graph, gvc_error *error);
/** Blocks the edges between consecutive vertices of a chain, and all corners at them, as if the
 * chain were an edge of the graph. */
gvc_result gvc_pathfinder_block(gvc_pathfinder *finder, const uint32_t *chain, size_t count,
                                gvc_error *error);
/** Gives all corners of a vertex one role. */
void gvc_pathfinder_mark_vertex(gvc_pathfinder *finder, uint32_t vertex, gvc_corner_role role);
/** Gives the corners of one sector a role: those met turning counter-clockwise round its vertex
 * from halfedge `h` up to the next edge of the graph (all of them if there is none). */
void gvc_pathfinder_mark_sector(gvc_pathfinder *finder, uint32_t h, gvc_corner_role role);
/** Gives every corner at the vertices of the graph, on all sides, one role. */
void gvc_pathfinder_mark_graph(gvc_pathfinder *finder, gvc_corner_role role);
/** True if the edge of halfedge `h` belongs to the graph. */
bool gvc_pathfinder_on_graph(const gvc_pathfinder *finder, uint32_t h);

/** Finds the cheapest path from any source to any target corner; `weight` may be NULL. Fails only
 *  for lack of memory; `path` is empty if there is no path. */
gvc_result gvc_pathfinder_find(gvc_pathfinder *finder, gvc_path_weight weight, const void *context,
                               gvc_surface_path *path, gvc_error *error);

/** Position and attributes of a point; either may be NULL. */
void gvc_surface_point_get(const gvc_halfedges *mesh, const gvc_surface_point *point,
                           double position[3], double *attribute);

/** Splits the edges a path crosses and gives the chain of vertices from source to target, each
 * joined to the next by an edge of the mesh. `*vertex` is freed by the caller with free(). */
gvc_result gvc_surface_path_insert(gvc_halfedges *mesh, const gvc_surface_path *path,
                                   uint32_t **vertex, size_t *count, gvc_error *error);

#endif
