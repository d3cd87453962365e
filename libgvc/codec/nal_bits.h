/* SPDX-License-Identifier: MIT */
/** @file nal_bits.h  Bits of the headers in H.264 NAL units. */
#ifndef GVC_CODEC_NAL_BITS_H
#define GVC_CODEC_NAL_BITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Borrowed payload bytes (emulation prevention removed), read most significant bit first. After a
 * read past the end `failed` is set and every further read gives 0. */
typedef struct gvc_nal_bits {
    const uint8_t *data;
    size_t bit_count, position;
    bool failed;
} gvc_nal_bits;

uint32_t gvc_nal_bit(gvc_nal_bits *bits);
/** u(n), at most 32 bits. */
uint32_t gvc_nal_bits_read(gvc_nal_bits *bits, unsigned count);
/** ue(v) and se(v), ISO/IEC 14496-10 9.1; more than 31 leading zeros fail. */
uint32_t gvc_nal_ue(gvc_nal_bits *bits);
int64_t gvc_nal_se(gvc_nal_bits *bits);

/** Removes the emulation prevention bytes (ISO/IEC 14496-10 7.3.1: 00 00 03 stands for 00 00).
 *  `payload` has room for `size` bytes. Returns the length. */
size_t gvc_nal_unescape(const uint8_t *nal, size_t size, uint8_t *payload);

#endif
