/* SPDX-License-Identifier: MIT */
/** @file residual_bits.c  Adaptive binary range coder. */
#include "codec/residual_bits.h"

#define UNIT_BITS 15
#define LEAST_RANGE (UINT32_C(1) << 24)
#define TAIL_BYTES 4u

void gvc_bit_models_init(gvc_bit_model *model, size_t count) {
    for (size_t i = 0; i < count; i++) {
        model[i] = (gvc_bit_model){.zero = 1u << (UNIT_BITS - 1)};
    }
}

gvc_bit_coder gvc_bit_encoder(gvc_buffer *out) {
    return (gvc_bit_coder){.out = out, .begin = out->size, .range = UINT32_MAX};
}

gvc_bit_coder gvc_bit_decoder(const uint8_t *data, size_t size) {
    gvc_bit_coder coder = {.in = gvc_cursor_make(data, size), .range = UINT32_MAX};
    coder.low = gvc_read_u32(&coder.in);
    return coder;
}

/* low has passed 2^32: one more in the bytes written. Their value is below 1 as a binary fraction,
 * so there is always a byte that takes the carry. */
static void carry(gvc_bit_coder *coder) {
    gvc_buffer *out = coder->out;
    if (out->failed) return;
    for (size_t i = out->size; i > coder->begin && ++out->data[i - 1] == 0; i--) {
    }
}

static unsigned code(gvc_bit_coder *coder, uint32_t bound, unsigned bit) {
    if (!coder->out) bit = coder->low >= bound;
    if (!bit) {
        coder->range = bound;
    } else {
        coder->range -= bound;
        if (coder->out) {
            coder->low += bound;
            if (coder->low < bound) carry(coder);
        } else {
            coder->low -= bound;
        }
    }
    while (coder->range < LEAST_RANGE) {
        coder->range <<= 8;
        if (coder->out) {
            gvc_write_u8(coder->out, (uint8_t)(coder->low >> 24));
            coder->low <<= 8;
        } else {
            coder->low = coder->low << 8 | gvc_read_u8(&coder->in);
        }
    }
    return bit;
}

unsigned gvc_bit_code(gvc_bit_coder *coder, gvc_bit_model *model, unsigned bit) {
    bit = code(coder, (coder->range >> UNIT_BITS) * model->zero, bit);
    if (model->count < GVC_BIT_RATE) model->count++;
    if (bit) {
        model->zero = (uint16_t)(model->zero - (model->zero >> model->count));
    } else {
        model->zero = (uint16_t)(model->zero + (((1u << UNIT_BITS) - model->zero) >> model->count));
    }
    return bit;
}

unsigned gvc_bit_code_even(gvc_bit_coder *coder, unsigned bit) {
    return code(coder, coder->range >> 1, bit);
}

void gvc_bit_encoder_end(gvc_bit_coder *coder) {
    for (unsigned i = 0; i < TAIL_BYTES; i++) {
        gvc_write_u8(coder->out, (uint8_t)(coder->low >> 24));
        coder->low <<= 8;
    }
}

bool gvc_bit_decoder_ended(const gvc_bit_coder *coder) {
    return !coder->in.failed && gvc_cursor_left(&coder->in) == 0 && coder->low == 0;
}
