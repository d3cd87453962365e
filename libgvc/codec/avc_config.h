/* SPDX-License-Identifier: MIT */
/** @file avc_config.h  Checks a decoder configuration record before a codec gets to see it. */
#ifndef GVC_CODEC_AVC_CONFIG_H
#define GVC_CODEC_AVC_CONFIG_H

#include "base/result.h"

/** Checks an AVCDecoderConfigurationRecord (ISO/IEC 14496-15 5.3.3.1) of untrusted bytes: exactly
 * one sequence and one picture parameter set, High 10 profile, 4:2:0, 10 bits, frames only, NAL
 * unit lengths of four bytes, pictures of width x height after cropping. GVC_ERROR_CORRUPT or
 * GVC_ERROR_UNSUPPORTED (another profile) otherwise. */
gvc_result gvc_avc_config_check(const uint8_t *config, size_t size, uint32_t width, uint32_t height,
                                unsigned *frame_num_bits, gvc_error *error);

#endif
