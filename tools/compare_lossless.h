/* SPDX-License-Identifier: MIT */
/** @file compare_lossless.h  `gvc compare --lossless`: what exact geometry images cost, and what
 *  they would cost otherwise. */
#ifndef GVC_TOOLS_COMPARE_LOSSLESS_H
#define GVC_TOOLS_COMPARE_LOSSLESS_H

#include "compare.h"

#define COMPARE_LOSSLESS_ROWS 6

/** Measures, in this order: this format's lossless file; its images before they are rounded to 16
 * bits (errors only); all frames as OpenEXR files, with ZIP and with PIZ; the codes of each group,
 * as they lie in memory (little-endian, x plane, y plane, z plane), compressed by zstd at level 19
 * and by xz at level 9, both with a window over the whole group (bytes only: the errors are those
 * of the first row). `encode` must be lossless. `row` has room for COMPARE_LOSSLESS_ROWS. */
gvc_result compare_lossless(const gvc_source *source, const gvc_encode_options *encode,
                            const compare_options *options, compare_row *row, gvc_error *error);

#endif
