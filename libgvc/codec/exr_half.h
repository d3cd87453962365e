/* SPDX-License-Identifier: MIT */
/** @file exr_half.h  16-bit codes as two IEEE 754 binary16 numbers, the HALF of OpenEXR, and back.
 */
#ifndef GVC_CODEC_EXR_HALF_H
#define GVC_CODEC_EXR_HALF_H

#include <stdbool.h>
#include <stdint.h>

/** Names of the channels in the order OpenEXR keeps them, the alphabet: X, X.lo, Y, ... */
#define GVC_EXR_CHANNELS 6
extern const char *const gvc_exr_channel_name[GVC_EXR_CHANNELS];

/** Bits of the HALF of (code div 32) / 2048, which goes into channel X. Zero or normal. */
uint16_t gvc_exr_high(uint16_t code);
/** Bits of the HALF of 1/2 + (code mod 32) / 2048, which goes into channel X.lo. Normal. */
uint16_t gvc_exr_low(uint16_t code);
/** The code of two such numbers; false if they are none. */
bool gvc_exr_code(uint16_t high, uint16_t low, uint16_t *code);

/** Attributes of this format. */
#define GVC_EXR_VERSION_NAME "gvcVersion"
#define GVC_EXR_ORIGIN_NAME "gvcOrigin"
#define GVC_EXR_STEP_NAME "gvcStep"
#define GVC_EXR_TIME_NAME "gvcTime"
#define GVC_EXR_UNIT_NAME "gvcUnit"
#define GVC_EXR_VERSION 0

#endif
