/* SPDX-License-Identifier: MIT */
/** @file clip.h  Areas of faces and of their parts below a level of a linear function. */
#ifndef GVC_DESCRIPTOR_CLIP_H
#define GVC_DESCRIPTOR_CLIP_H

#include "mesh/halfedge.h"

/** Area of a face, in the unit of the mesh squared. */
double gvc_face_area(const gvc_halfedges *mesh, size_t face);

/** Part (0 to 1) of a triangle's area where the linear function with these values at its corners is
 *  below `level`; 0 if no corner is below, 1 if all are at or below and not all are at `level`. */
double gvc_part_below(const double value[3], double level);

#endif
