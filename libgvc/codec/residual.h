/* SPDX-License-Identifier: MIT */
/**
 * @file residual.h
 * Lossless coding of a geometry image by its difference to a prediction, which an adaptive binary
 * range coder writes down. All arithmetic is exact.
 *
 * A residual sample:
 *
 *   offset  type  field
 *     0     u8    predictor   gvc_predictor_kind: 0 gradient, 1 least squares
 *     1     u8    reference   0: the previous image counts as all 0; 1: it is that of the frame
 * before 2     u16   size        S: samples a side, 16 .. 2049 4           range coded bits
 * (residual_bits.h) up to the end of the sample
 *
 * Samples are coded in raster order, the three components of a sample one after the other. Of each
 * the residual e = code - expected is coded, modulo 2^16 taken from -2^15 to 2^15 - 1:
 *
 *   u = |e|, n = floor(log2(u + 1)), from 0 to 15
 *   1. n in unary: n bits 1, then, unless n is 15, a bit 0. Model: [activity][bits so far].
 *   2. the n bits of u + 1 below its greatest, from the greatest on. Models for the first three:
 *      [n][bits so far behind a leading 1]; the rest with even odds.
 *   3. unless u is 0, a bit 1 if e < 0. Model: [signs of the residuals of the components before],
 *      a number in base 3 whose digit is 0 for no residual, 1 for a positive, 2 for a negative one.
 *
 * The activity says how well prediction did nearby. m is the sum of |e| of this component left and
 * above, twice each, and above left, above right, two to the left and two above, once each (0
 * outside the image), plus twice the |e| of each component k' < k of this sample; divided (rounding
 * down) by 8, 10 or 12 for k = 0, 1, 2, after multiplication by 8. It is m itself below 4, else
 * 4 (b - 2) + (m >> (b - 3)) mod 4 with b the number of bits of m.
 *
 * There is no checksum here: the container has one for each sample.
 */
#ifndef GVC_CODEC_RESIDUAL_H
#define GVC_CODEC_RESIDUAL_H

#include "base/bytes.h"
#include "codec/predict.h"

/** Appends the residual sample of an image (3 planes of size * size codes). `previous` is the image
 * of the frame before, of the same size, or NULL. Same input, same bytes. */
gvc_result gvc_residual_encode(uint32_t size, const uint16_t *codes, const uint16_t *previous,
                               gvc_predictor_kind predictor, gvc_buffer *bytes, gvc_error *error);

/** Decodes untrusted bytes that must be exactly one residual sample of an image of `size`. `codes`
 * gets 3 * size * size codes; on failure its content is undefined. `previous` is NULL if there is
 * no frame to refer to. GVC_ERROR_UNSUPPORTED for a predictor not known, GVC_ERROR_CORRUPT for
 * another size, a missing reference, and bits that end early, late, or give a residual that cannot
 * be. Needs at most 3.1 kB * size of memory, and 6 * size * size bytes more without reference. */
gvc_result gvc_residual_decode(const uint8_t *data, size_t data_size, uint32_t size,
                               const uint16_t *previous, uint16_t *codes, gvc_error *error);

#endif
