/* SPDX-License-Identifier: MIT */
/** @file match.h  Matches the extrema of two frames (Sect. 3.1.3). */
#ifndef GVC_DESCRIPTOR_MATCH_H
#define GVC_DESCRIPTOR_MATCH_H

#include "descriptor/features.h"

/** For each of the `count` extrema of the previous frame the index of its match in `features`, so
 * that the sum of differences of position, mu and relative area is least (Hungarian algorithm).
 * `*found` is false if some extremum has no match within `gate` diagonals of its position; `match`
 * (room for `count`) is then meaningless. */
gvc_result gvc_match_extrema(const gvc_extremum *previous, size_t count,
                             const gvc_features *features, double gate, uint32_t *match,
                             bool *found, gvc_error *error);

/** Assignment of least total cost: column_of[row] for each row of a rows x columns matrix, rows <=
 *  columns. */
gvc_result gvc_assign(const double *cost, size_t rows, size_t columns, uint32_t *column_of,
                      gvc_error *error);

#endif
