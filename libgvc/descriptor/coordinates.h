/* SPDX-License-Identifier: MIT */
/**
 * @file coordinates.h
 * Geodesic coordinates (Definition 2): the distances of a point to all features, normalised. They
 * are carried as additional attributes of the mesh, so that edge splits interpolate them.
 */
#ifndef GVC_DESCRIPTOR_COORDINATES_H
#define GVC_DESCRIPTOR_COORDINATES_H

#include "descriptor/features.h"

typedef struct gvc_coordinates {
    size_t first;     /**< attributes the mesh had before */
    size_t count;     /**< channels added: one per feature */
    size_t dimension; /**< count + 3: distances, then weighted position */
    double scale;     /**< divides distances */
    double diagonal;  /**< divides positions */
} gvc_coordinates;

/** Adds `count` channels, all zero, to the mesh. */
gvc_result gvc_coordinates_attach(gvc_halfedges *mesh, const gvc_features *features, size_t count,
                                  gvc_coordinates *coordinates, gvc_error *error);
/** Takes them off again; does nothing if none are attached. */
void gvc_coordinates_detach(gvc_halfedges *mesh, gvc_coordinates *coordinates);
/** Fills channel `channel` with the distances to each of `vertex`, and `channel` + 1, ... likewise.
 */
gvc_result gvc_coordinates_measure(gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                                   size_t channel, const uint32_t *vertex, size_t count,
                                   gvc_error *error);
/** The coordinates of a point of the mesh with these attributes; `point` has room for dimension. */
void gvc_coordinates_get(const gvc_coordinates *coordinates, const double position[3],
                         const double *attribute, double *point);
/** The position that coordinates hold, in the unit of the mesh, and its change. */
void gvc_coordinates_position(const gvc_coordinates *coordinates, const double *point,
                              double position[3]);
void gvc_coordinates_place(const gvc_coordinates *coordinates, const double position[3],
                           double *point);
/** The coordinates of a vertex. */
void gvc_coordinates_of_vertex(const gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                               uint32_t vertex, double *point);

#endif
