/* SPDX-License-Identifier: MIT */
/** @file exact.h  The exact track of a group of frames: 16-bit codes, coded without loss. */
#ifndef GVC_ENCODE_EXACT_H
#define GVC_ENCODE_EXACT_H

#include "encode/group.h"

/** Quantises an image (3 planes of doubles) to 16-bit codes of the segment's cube. Equal
 * coordinates give equal codes, so twins, which are one point of the surface, stay twins. */
void gvc_exact_quantise(const gvc_segment *segment, const double *image, uint16_t *codes);

/** Codes the group's exact images: an OpenEXR file for the first frame, residuals for the others.
 * Sets `exact` of every frame. Deterministic on any number of threads. */
gvc_result gvc_exact_code(gvc_group *group, const gvc_encode_options *options, gvc_error *error);

#endif
