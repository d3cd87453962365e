/* SPDX-License-Identifier: MIT */
/**
 * @file predict.h
 * What the codes of a geometry image are expected to be, from those before them in raster order and
 * from the image of the frame before. Exact: the same prediction on any machine.
 *
 * Images are 3 planes (x, y, z) of size * size codes. A predictor is taken over an image sample by
 * sample: gvc_predict gives the three codes expected at (x, y), gvc_predict_learn is told that they
 * are known.
 */
#ifndef GVC_CODEC_PREDICT_H
#define GVC_CODEC_PREDICT_H

#include "base/result.h"

/** Numbers as in the file. */
typedef enum gvc_predictor_kind {
    /** Of the difference to the previous image, the median of left, above and left + above - above
     *  left (the predictor of JPEG-LS, ITU-T T.87 A.4.1). Fast. */
    GVC_PREDICTOR_GRADIENT = 0,
    /** A weighted sum of neighbours in both images. The weights, which all three components share,
     *  are fitted anew at every sample to the codes known round it: see predict_squares.h. */
    GVC_PREDICTOR_SQUARES = 1,
} gvc_predictor_kind;
#define GVC_PREDICTOR_KINDS 2

typedef struct gvc_predictor gvc_predictor;

/** Both images are borrowed; `codes` is read only where it is known. */
gvc_result gvc_predictor_create(gvc_predictor_kind kind, uint32_t size, const uint16_t *codes,
                                const uint16_t *previous, gvc_predictor **predictor,
                                gvc_error *error);
void gvc_predictor_destroy(gvc_predictor **predictor);

/** Next sample in raster order: 0 .. 65535 for each component. */
void gvc_predict(gvc_predictor *predictor, uint32_t x, uint32_t y, int32_t expected[3]);
/** The codes of the sample just predicted are known now. */
void gvc_predict_learn(gvc_predictor *predictor, uint32_t x, uint32_t y);

#endif
