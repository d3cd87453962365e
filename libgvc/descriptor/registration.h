/* SPDX-License-Identifier: MIT */
/**
 * @file registration.h
 * Dense motion from one frame to the next, without correspondence: the earlier surface is bent as
 * rigidly as possible (Sorkine & Alexa 2007) over a graph of nodes (embedded deformation: Sumner et
 * al. 2007) until it lies on the later one (iterated closest points to planes: Chen & Medioni
 * 1992).
 *
 * One step from the previous frame is good to a few thousandths of the diagonal. It is not used to
 * track through a sequence, which loses limbs: the descriptor anchors every frame anew.
 */
#ifndef GVC_DESCRIPTOR_REGISTRATION_H
#define GVC_DESCRIPTOR_REGISTRATION_H

#include "mesh/distance.h"
#include "mesh/halfedge.h"

/** Where every vertex of `from` (closed, unrefined) has gone in the later frame, whose surface is
 * `to`, with its hierarchy: 3 coordinates each into `moved`, near that surface but not on it.
 * Deterministic. */
gvc_result gvc_register(const gvc_halfedges *from, const gvc_halfedges *to, const gvc_bvh *bvh,
                        double *moved, gvc_error *error);

#endif
