/* SPDX-License-Identifier: MIT */
/**
 * @file gluing.h
 * The gluing of a side table apart from where it starts: which border positions are one vertex, in
 * loop coordinates, i.e. in steps from the beginning of side[0]. Loop coordinate i is border
 * position (start + i) mod P.
 */
#ifndef GVC_CHART_GLUING_H
#define GVC_CHART_GLUING_H

#include "chart/side_table.h"

/** The limits of rule 1 on an image's size. GVC_ERROR_CORRUPT beyond them. */
gvc_result gvc_glue_check_size(uint32_t size, gvc_error *error);

/** Checks rules 1 (size only) to 4 of gvc_weld_build. `representative` has room for P entries; each
 * gets the smallest loop coordinate of its vertex. GVC_ERROR_CORRUPT if a rule is broken. */
gvc_result gvc_glue_border(const gvc_side_table *table, uint32_t *representative, gvc_error *error);

/** Rule 5 of gvc_weld_build: whether a corner of the square may lie at loop coordinate `corner`. */
bool gvc_glue_allows_corner(const uint32_t *representative, uint32_t border_length,
                            uint32_t corner);

#endif
