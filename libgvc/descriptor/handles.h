/* SPDX-License-Identifier: MIT */
/** @file handles.h  Short loops that cut the handles of a surface of genus > 0, one handle at a
 * time. */
#ifndef GVC_DESCRIPTOR_HANDLES_H
#define GVC_DESCRIPTOR_HANDLES_H

#include "descriptor/loops.h"
#include "descriptor/path.h"

/** Two loops along edges of the mesh that meet in one vertex, their base, and cross there.
 * Counter-clockwise round the base follow: first loop out, second out, first in, second in. Cutting
 * along both takes one handle off and leaves one hole in its place, whatever the handle is like, so
 * all handles are alike as parts of a cut graph. */
typedef struct gvc_handle {
    uint32_t *loop[2]; /**< vertices; the first and the last are the base */
    size_t count[2];
} gvc_handle;

void gvc_handle_free(gvc_handle *handle);

/** Finds a handle of a closed surface by the greedy system of loops (Erickson & Whittlesey 2005):
 *  the shortest of its loops through (or else round) `from`, and a shortest loop that crosses it.
 *  Unless `near`, the search goes on from the shortest loops to still shorter ones elsewhere.
 *  Refines the mesh. `handle` is empty if there is none. GVC_ERROR_MESH if the surface is in pieces
 *  or open. */
gvc_result gvc_handle_find(gvc_pathfinder *finder, gvc_halfedges *mesh,
                           const gvc_obstacles *obstacles, uint32_t from, bool near,
                           gvc_handle *handle, gvc_error *error);

/** Moves the base to where the loops are nearest to the obstacles' graph and the vertex `from`, and
 * turns them so that the way from there reaches it after the second loop coming in. */
gvc_result gvc_handle_face(gvc_pathfinder *finder, gvc_halfedges *mesh,
                           const gvc_obstacles *obstacles, uint32_t from, gvc_handle *handle,
                           gvc_error *error);

/** Moves the base to the point of the loops that is nearest to a vertex in space. */
gvc_result gvc_handle_rebase(gvc_pathfinder *finder, gvc_halfedges *mesh,
                             const gvc_obstacles *obstacles, uint32_t near, gvc_handle *handle,
                             gvc_error *error);

/** Turns the two loops into the next of the four pairs that are one handle: the second, then the
 * first reversed. */
void gvc_handle_turn(gvc_handle *handle);

#endif
