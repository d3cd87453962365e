/* SPDX-License-Identifier: MIT */
/**
 * @file bending.h
 * A surface that bends as rigidly as possible: nodes spread over it evenly, each with a rotation,
 * joined to their neighbours on the surface; every vertex moves with the nodes next to it (embedded
 * deformation: Sumner, Schmid & Pauly 2007; rotations: Sorkine & Alexa 2007).
 */
#ifndef GVC_DESCRIPTOR_BENDING_H
#define GVC_DESCRIPTOR_BENDING_H

#include "mesh/halfedge.h"

enum { GVC_BENDING_INFLUENCES = 4 };

typedef struct gvc_bending {
    size_t node_count, vertex_count, edge_count;
    double *rest;     /**< 3 per node: where it was */
    double *normal;   /**< 3 per node: unit normal of the surface there, as it was */
    double *place;    /**< 3 per node: where it is */
    double *rotation; /**< 9 per node, row-major */
    uint32_t *first;  /**< node_count + 1: its neighbours are neighbour[first[i]] ... */
    uint32_t *neighbour;
    uint32_t *influence; /**< GVC_BENDING_INFLUENCES nodes per vertex; GVC_NONE: fewer */
    double *weight;      /**< of each; they sum to 1 */
} gvc_bending;

/** About `nodes` nodes on `mesh`, at rest. Free with gvc_bending_free; empty on failure. */
gvc_result gvc_bending_create(const gvc_halfedges *mesh, size_t nodes, gvc_bending *bending,
                              gvc_error *error);
void gvc_bending_free(gvc_bending *bending);

/** Rotation of every node that takes its edges at rest nearest to what they are. */
void gvc_bending_rotate(gvc_bending *bending);

/** Where the vertices of the mesh are: 3 coordinates each. */
void gvc_bending_vertices(const gvc_bending *bending, const gvc_halfedges *mesh, double *moved);

#endif
