/* SPDX-License-Identifier: MIT */
/**
 * @file residual_bits.h
 * Adaptive binary range coder. One function codes in both directions, so that what an encoder
 * writes and what a decoder reads can never drift apart.
 *
 * A probability `zero` is that of a 0 in units of 2^-15. With a 32-bit range R and a bit b:
 *
 *     B = (R >> 15) * zero              b = 0: R = B      b = 1: low += B, R -= B
 *
 * and whenever R < 2^24 both R and low move up by a byte. The decoder holds D, the four bytes at
 * hand minus low: b = (D >= B), then D -= B. The encoder ends with the four bytes of low, so a
 * decoder has read exactly all bytes and is left with D = 0.
 */
#ifndef GVC_CODEC_RESIDUAL_BITS_H
#define GVC_CODEC_RESIDUAL_BITS_H

#include "base/bytes.h"

/** Probability that learns: fast at first, then by a 64th of what it was wrong. */
typedef struct gvc_bit_model {
    uint16_t zero;  /**< probability of a 0, 2^-15: never 0, never 1 */
    uint16_t count; /**< bits seen, up to GVC_BIT_RATE */
} gvc_bit_model;

#define GVC_BIT_RATE 6

/** Sets `count` models to one half. */
void gvc_bit_models_init(gvc_bit_model *model, size_t count);

typedef struct gvc_bit_coder {
    gvc_buffer *out; /**< NULL in a decoder */
    size_t begin;    /**< encoder: first byte of `out` that is its own */
    gvc_cursor in;   /**< decoder; `failed` after a read past the end */
    uint32_t range;
    uint32_t low; /**< encoder: low; decoder: D */
} gvc_bit_coder;

/** Coder that appends to `out`, which is borrowed. */
gvc_bit_coder gvc_bit_encoder(gvc_buffer *out);
/** Coder that reads `size` borrowed bytes. */
gvc_bit_coder gvc_bit_decoder(const uint8_t *data, size_t size);

/** Codes one bit and lets the model learn it. An encoder writes `bit` and gives it back; a decoder
 * ignores `bit` and gives what it read. */
unsigned gvc_bit_code(gvc_bit_coder *coder, gvc_bit_model *model, unsigned bit);
/** One bit with fixed probabilities of one half. */
unsigned gvc_bit_code_even(gvc_bit_coder *coder, unsigned bit);

/** Encoder: writes what is left. */
void gvc_bit_encoder_end(gvc_bit_coder *coder);
/** Decoder: whether exactly all bytes have been used and they end as an encoder ends. */
bool gvc_bit_decoder_ended(const gvc_bit_coder *coder);

#endif
