/* SPDX-License-Identifier: MIT */
/** @file stretch.h  Where a parameterization stretches most. */
#ifndef GVC_ENCODE_STRETCH_H
#define GVC_ENCODE_STRETCH_H

#include "chart/open.h"

/** The vertex of the uncut mesh that lies inside the disk on the face of greatest geometric stretch
 * (the L2 stretch of Sander, Snyder, Gortler and Hoppe 2001); of several the one with the most
 * stretched faces around. `uv` has 2 coordinates per disk vertex and turns no face over. GVC_NONE
 * if there is no inner vertex of the uncut mesh. */
uint32_t gvc_stretch_extremum(const gvc_disk *disk, const double *uv);

#endif
