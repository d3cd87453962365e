/* SPDX-License-Identifier: MIT */
/** @file synth_figure.h  The moving figure as an implicit surface. */
#ifndef GVC_TOOLS_SYNTH_FIGURE_H
#define GVC_TOOLS_SYNTH_FIGURE_H

#include "vec3.h"

#include <stdint.h>

#define FIGURE_MAX_BONES 24
#define FIGURE_MAX_RINGS 4

/** A cone with rounded ends: radius `radius[0]` at `end[0]`, `radius[1]` at `end[1]`. */
typedef struct figure_bone {
    vec3 end[2];
    double radius[2];
} figure_bone;

/** A torus. */
typedef struct figure_ring {
    vec3 centre, axis; /**< axis: unit normal of its plane */
    double radius, thickness;
} figure_ring;

/** The figure at one moment: the surface figure_value == 0. */
typedef struct figure {
    unsigned bone_count, ring_count;
    figure_bone bone[FIGURE_MAX_BONES];
    figure_ring ring[FIGURE_MAX_RINGS];
} figure;

/** Pose at `seconds`; `rings` <= FIGURE_MAX_RINGS. */
void figure_pose(figure *f, double seconds, unsigned rings, uint64_t seed);

/** About the signed distance (negative inside), smooth. It never changes faster than
 * FIGURE_LIPSCHITZ times the way. */
double figure_value(const figure *f, vec3 point);
#define FIGURE_LIPSCHITZ 1.5

/** Moves a point near the surface onto it. */
vec3 figure_project(const figure *f, vec3 point);

/** Box that holds the whole figure with some room around, in the coordinates of `axes`. */
void figure_bounds(const figure *f, const frame3 *axes, vec3 *minimum, vec3 *maximum);

/** Uniform number in [0,1) that depends on the three arguments only (splitmix64, Steele et al.
 * 2014).
 */
double figure_random(uint64_t seed, uint64_t stream, uint64_t index);

#endif
