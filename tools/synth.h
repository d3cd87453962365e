/* SPDX-License-Identifier: MIT */
/** @file synth.h  A sample capture made from nothing: a dancing figure whose mesh has its own
 *  connectivity in every frame, as in 3D video. */
#ifndef GVC_TOOLS_SYNTH_H
#define GVC_TOOLS_SYNTH_H

#include "gvc/gvc.h"

#define SYNTH_MAX_GENUS 4u

typedef struct synth_options {
    uint64_t frame_count;
    unsigned genus;      /**< 0 .. SYNTH_MAX_GENUS: number of rings on the figure */
    size_t vertex_count; /**< about so many; 1500 + 500 * genus .. 1000000 */
    uint64_t seed;       /**< another seed, another dance and other meshes */
    double frame_rate;   /**< frames per second */
} synth_options;

/** 60 frames of genus 0 with about 6000 vertices, 30 per second. */
void synth_options_init(synth_options *options);

/** One frame: a closed, manifold, oriented mesh of one component and the genus asked for, in
 * metres, y up, facing z, vertices on a smooth surface that moves smoothly with time. Depends on
 * nothing but its arguments; thread-safe. The caller destroys the mesh. GVC_ERROR_ARGUMENT for
 * options out of range; GVC_ERROR_MESH if no grid position gives such a mesh (too few vertices). */
gvc_result synth_frame(const synth_options *options, uint64_t frame, gvc_mesh **mesh,
                       gvc_error *error);

#endif
