/* SPDX-License-Identifier: MIT */
/**
 * @file predict_squares.h
 * Prediction by least squares. From frame to frame the samples of a geometry image slide over a
 * surface that moves: a code is close to a weighted sum of its neighbours' codes, with weights that
 * change from place to place but are the same for x, y and z. So they can be learned from what has
 * been decoded (as Wu, Barthel and Zhang 1998 do for photographs), and cost no bytes.
 *
 * At each sample (x, y) there are GVC_SQUARES_TERMS differences r[i] for each component: seven
 * codes of this image, and eleven of the previous one, each minus the code of the previous image at
 * (x, y) itself; t is the code sought minus the same. Weights w minimise
 *
 *     sum over samples s before (x, y):  2^-distance(s) * sum over k: (t - sum of w[i] r[i])^2
 *
 * with distance = |dx| + |dy|, plus a weak pull of w to 0. The sums are integers; they are halved
 * from sample to sample and from row to row, which is what makes the weights 2^-distance. The
 * system of 18 equations is solved in IEEE 754 binary64 by +, -, * and one division a row, in an
 * order that the code states: any machine gives the same bits.
 */
#ifndef GVC_CODEC_PREDICT_SQUARES_H
#define GVC_CODEC_PREDICT_SQUARES_H

#include <stdint.h>

#define GVC_SQUARES_TERMS 18

typedef struct gvc_squares gvc_squares;

/** About 3 kB a column. NULL when out of memory. */
gvc_squares *gvc_squares_create(uint32_t size, const uint16_t *codes, const uint16_t *previous);
void gvc_squares_destroy(gvc_squares *squares);
/** See predict.h. */
void gvc_squares_predict(gvc_squares *squares, uint32_t x, uint32_t y, int32_t expected[3]);
void gvc_squares_learn(gvc_squares *squares, uint32_t x, uint32_t y);

#endif
