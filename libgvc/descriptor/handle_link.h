/* SPDX-License-Identifier: MIT */
/**
 * @file handle_link.h
 * Handles as parts of the cut graph: a base and a way to it from the graph as it was before, as to
 * a tip, and two loops that cross at the base. So the graph of a surface with handles is the graph
 * of one without them, and more: what it was stays as it was when a handle opens or closes.
 */
#ifndef GVC_DESCRIPTOR_HANDLE_LINK_H
#define GVC_DESCRIPTOR_HANDLE_LINK_H

#include "descriptor/link.h"

enum { GVC_HANDLE_POINTS = 2, GVC_HANDLE_LINKS = 4 };

/** A handle in the frame before. */
typedef struct gvc_handle_link {
    /** Base and middle of the first loop, which is there so that the loop can be found again by
     * shortest paths. Coordinates; dimension doubles each. */
    double *point[GVC_HANDLE_POINTS];
    /** From base to middle, on to the base, the second loop, and the way to the base. */
    gvc_link link[GVC_HANDLE_LINKS];
    bool joined;  /**< its base is the graph's first node, so there is no way to it */
    bool open;    /**< false: the frame before does not have it */
    size_t since; /**< frames for which it has not been there */
} gvc_handle_link;

void gvc_handle_link_free(gvc_handle_link *handle);
gvc_result gvc_handle_link_copy(const gvc_handle_link *from, gvc_handle_link *to, gvc_error *error);

/** Puts a handle found by gvc_handle_find into the graph, and makes the shortest way to it unless
 * its base is the vertex of the first node. Only the first handle put into a graph may be like
 * that. */
gvc_result gvc_handle_link_first(gvc_routing *routing, const gvc_handle *found,
                                 gvc_handle_link *handle, gvc_error *error);

/** Places the loops of the frame before again, round the vertices `point` (base, if it is not
 * joined, and middle). If `anew` the way to them is the shortest there is, otherwise that of the
 * frame before. `*kept` is false, and the graph as it was, if the loops would be no handle or much
 * longer. */
gvc_result gvc_handle_link_again(gvc_routing *routing, const uint32_t *point, bool anew,
                                 gvc_handle_link *handle, bool *kept, gvc_error *error);

/** Replaces the loops of the frame before by those of the nearest handle there is, with the way of
 * the frame before to them; if they are joined, the first node moves to them. `*kept` is false if
 * there is none, or none with loops of about the same lengths. */
gvc_result gvc_handle_link_elsewhere(gvc_routing *routing, gvc_handle_link *handle, bool *kept,
                                     gvc_error *error);

#endif
