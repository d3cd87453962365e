/* SPDX-License-Identifier: MIT */
/** @file layout.h  Puts the border of the disk on the border of the square. */
#ifndef GVC_CHART_LAYOUT_H
#define GVC_CHART_LAYOUT_H

#include "chart/open.h"
#include "chart/side_table.h"

/** Whole pixel steps for each edge in proportion to `length` (one per edge of the graph, any unit;
 * all zero counts as all equal), by largest remainders, at least GVC_MIN_STEPS (3 for an edge whose
 * two nodes are one), 2 * sum == 4 (size - 1), and the sides in the order of `run`. `start` is set
 * to 0, which gvc_weld_build may not allow: see gvc_layout_starts. GVC_ERROR_MESH if the image is
 * too small for so many edges. Free with gvc_side_table_free; empty on failure. */
gvc_result gvc_layout_make(const gvc_border_run *run, size_t run_count, const gvc_cut_graph *graph,
                           const double *length, uint32_t size, gvc_side_table *table,
                           gvc_error *error);

/** The same layout at another image size: steps re-allocated in proportion, `start` scaled and
 * rounded (which may make it one that gvc_weld_build does not allow). Errors as above. */
gvc_result gvc_layout_resize(const gvc_side_table *table, const gvc_cut_graph *graph, uint32_t size,
                             gvc_side_table *resized, gvc_error *error);

/** All values of `start` allowed by gvc_weld_build, ascending; table->start is not looked at.
 *  `starts` has room for 4 (size - 1). GVC_ERROR_CORRUPT if the table breaks another rule. */
gvc_result gvc_layout_starts(const gvc_side_table *table, uint32_t *starts, size_t *count,
                             gvc_error *error);

/** Places every border vertex: `uv` (2 per disk vertex, in pixels, 0 .. size-1) gets its position,
 * arc length within a side; nodes land exactly on pixels. Run 0 begins at border position
 * table->start. Makes the disk fit for an embedding in the square (Floater 2003):
 *  - there is a border vertex exactly at each corner of the square, by an insertion (without one at
 *    the twin place) or by moving a border vertex less than a thousandth of a pixel away;
 *  - no inner edge joins two border vertices: such edges are split in the middle. Then every face
 *    has an inner vertex, so none need be flat because its corners lie on one side of the square.
 * The surface stays where it is. `*uv` is set to a new array, inner vertices zero, which the caller
 * frees; NULL on failure, when the disk may have been split but is still whole.
 * GVC_ERROR_ARGUMENT if the table is not one of this disk's. */
gvc_result gvc_layout_place(gvc_disk *disk, const gvc_side_table *table, double **uv,
                            gvc_error *error);

#endif
