/* SPDX-License-Identifier: MIT */
/** @file layout.h  Puts the border of the disk on the border of the square. */
#ifndef GVC_CHART_LAYOUT_H
#define GVC_CHART_LAYOUT_H

#include "chart/open.h"
#include "chart/side_table.h"

/** Whole pixel steps for each edge in proportion to `length`, at least GVC_MIN_STEPS (3 for an edge
 * whose two nodes are one), 2 * sum == 4 (size - 1), and the sides in the order of `run`. `start`
 * is set to 0. GVC_ERROR_MESH if the image is too small for so many edges. */
gvc_result gvc_layout_make(const gvc_border_run *run, size_t run_count, const gvc_cut_graph *graph,
                           const double *length, uint32_t size, gvc_side_table *table,
                           gvc_error *error);

/** The same layout at another image size: steps re-allocated in proportion, `start` scaled. */
gvc_result gvc_layout_resize(const gvc_side_table *table, const gvc_cut_graph *graph, uint32_t size,
                             gvc_side_table *resized, gvc_error *error);

/** All values of `start` allowed by gvc_weld_build, ascending. `starts` has room for 4 (size - 1).
 */
gvc_result gvc_layout_starts(const gvc_side_table *table, uint32_t *starts, size_t *count,
                             gvc_error *error);

/** Places every border vertex: `uv` (2 per disk vertex, in pixels, 0 .. size-1) gets its position,
 * arc length within a side; nodes land exactly on pixels. Inserts border vertices at the corners of
 * the square, and splits inner edges that join two border vertices, and triangles with all corners
 * on one side of the square, so that no triangle is flat in the parameter domain. `uv` is
 * (re)allocated for the disk's vertices, inner ones zero; the caller frees it. */
gvc_result gvc_layout_place(gvc_disk *disk, const gvc_side_table *table, double **uv,
                            gvc_error *error);

#endif
