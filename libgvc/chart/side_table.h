/* SPDX-License-Identifier: MIT */
/**
 * @file side_table.h
 * How the border of a square geometry image closes on itself. Needed by encoder and decoder.
 *
 * The border of an S x S image is a loop of P = 4 (S - 1) pixel steps. Position 0 is pixel (0,0);
 * positions grow along the row y = 0 to (S-1,0), down the column x = S-1, back along y = S-1 to
 * (0,S-1), and up x = 0. Each cut edge owns two sides, its twins: runs of steps[edge] steps, one
 * walked from node[0] to node[1], one the other way. The sides follow each other without gap from
 * position `start`.
 */
#ifndef GVC_CHART_SIDE_TABLE_H
#define GVC_CHART_SIDE_TABLE_H

#include "base/result.h"

#define GVC_MIN_IMAGE_SIZE 16u
#define GVC_MAX_IMAGE_SIZE 2049u
#define GVC_MIN_STEPS 2u

typedef struct gvc_side {
    uint32_t edge;
    bool reversed; /**< walked from node[1] to node[0] */
} gvc_side;

typedef struct gvc_side_table {
    uint32_t size;  /**< S */
    uint32_t start; /**< border position where side[0] begins, 0 .. P-1 */
    size_t edge_count;
    uint32_t *steps;   /**< per edge, >= GVC_MIN_STEPS; 2 * sum == P */
    size_t side_count; /**< 2 * edge_count */
    gvc_side *side;    /**< each edge once forward and once reversed, in border order */
} gvc_side_table;

void gvc_side_table_free(gvc_side_table *table);
gvc_result gvc_side_table_copy(const gvc_side_table *from, gvc_side_table *to, gvc_error *error);

/** Pixel of a border position (taken modulo P). */
void gvc_border_pixel(uint32_t size, uint32_t position, uint32_t *x, uint32_t *y);

/** Which samples of the image are one point of the surface. */
typedef struct gvc_weld {
    uint32_t size;
    uint32_t
        vertex_count; /**< V: number of welded vertices, numbered in raster order of first sample */
    uint32_t *vertex; /**< per sample (row-major, size * size): its welded vertex */
    uint32_t border_count; /**< P */
    uint8_t *fold;         /**< per border position: 1 if both neighbours are the same vertex */
    uint32_t genus;
} gvc_weld;

/** Checks the table and derives the weld. GVC_ERROR_CORRUPT if the table breaks a rule of
 *  side_table.h, or if the layout could give a surface that is not a manifold: two border samples
 * that are one vertex lie within the eight-neighbourhood of one inner sample other than as the two
 * neighbours of a fold, or a fold lies less than two steps from a corner of the square. Genus
 * follows from Euler's formula. Free with gvc_weld_free. */
gvc_result gvc_weld_build(const gvc_side_table *table, gvc_weld *weld, gvc_error *error);
void gvc_weld_free(gvc_weld *weld);

#endif
