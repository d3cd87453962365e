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

/** Number of border positions of an image, P = 4 (size - 1). */
static inline uint32_t gvc_border_length(uint32_t size) { return 4 * (size - 1); }

/** Pixel of a border position (taken modulo P). */
void gvc_border_pixel(uint32_t size, uint32_t position, uint32_t *x, uint32_t *y);
/** Border position of a pixel, which must lie on the border: the inverse of gvc_border_pixel. */
uint32_t gvc_border_position(uint32_t size, uint32_t x, uint32_t y);

/** Which samples of the image are one point of the surface. */
typedef struct gvc_weld {
    uint32_t size;
    uint32_t vertex_count; /**< V: number of welded vertices, numbered in raster order of their
                                first sample */
    uint32_t *vertex;      /**< per sample (row-major, size * size): its welded vertex */
    uint32_t border_count; /**< P */
    uint32_t *ring;        /**< per border position: the next greater one of the same vertex, cyclic
                                (itself if it is the only one) */
    uint8_t *fold;         /**< per border position: 1 if both neighbours are the same vertex */
    uint32_t genus;
} gvc_weld;

/**
 * Checks the table and derives the weld.
 *
 * Let p be the border position where the forward side of an edge of n steps begins, and q where its
 * reversed side begins. Then positions p + j and q + n - j are one vertex for j = 0..n, and two
 * positions are one vertex only if a chain of such pairs joins them. GVC_ERROR_CORRUPT unless
 *  1. the size is within its limits, and `start` is less than P;
 *  2. there is at least one edge, every edge owns exactly one forward and one reversed side, and
 *     there are no other sides;
 *  3. every edge has at least GVC_MIN_STEPS steps, and the steps of all edges sum to P / 2;
 *  4. an edge that begins and ends at one vertex has at least 3 steps;
 *  5. around each corner of the square, at border position c, the five samples c - 2 .. c + 2 are
 *     five different vertices. (So a fold lies at least two steps from every corner.)
 *
 * These rules are what makes the surface of rebuild.h a manifold for any codes. Gluing the sides of
 * a polygon in pairs, one forward and one reversed, always gives a closed oriented surface; what
 * can go wrong is only that two different edges of the triangulation join the same two vertices.
 * Edges of the square's border cannot, by 3 and 4; edges between inner samples cannot; an edge from
 * an inner to a border sample could if two border samples within the inner one's
 * eight-neighbourhood were one vertex. Along a straight side that happens only below a fold, where
 * the diagonals through the fold leave both of its neighbours alone; near a corner rule 5 forbids
 * it, and the diagonal through the corner keeps the samples beside the corner apart.
 *
 * Genus follows from Euler's formula. On failure `weld` is empty. Free with gvc_weld_free.
 */
gvc_result gvc_weld_build(const gvc_side_table *table, gvc_weld *weld, gvc_error *error);
void gvc_weld_free(gvc_weld *weld);

#endif
