/* SPDX-License-Identifier: MIT */
/** @file avc_config.h  Checks a decoder configuration record before a codec gets to see it. */
#ifndef GVC_CODEC_AVC_CONFIG_H
#define GVC_CODEC_AVC_CONFIG_H

#include "base/result.h"

/** What a decoder needs to know of the sequence parameter set. */
typedef struct gvc_avc_facts {
    unsigned frame_num_bits; /**< length of frame_num in slice headers */
    unsigned references;     /**< max_num_ref_frames, at most 16 */
} gvc_avc_facts;

/** Checks an AVCDecoderConfigurationRecord (ISO/IEC 14496-15 5.3.3.1) of untrusted bytes: exactly
 * one sequence and one picture parameter set, High 10 profile, 4:2:0, 10 bits, frames only, NAL
 * unit lengths of four bytes, pictures of width x height after cropping. GVC_ERROR_CORRUPT or
 * GVC_ERROR_UNSUPPORTED (another profile) otherwise; GVC_ERROR_LIMIT if pictures are coded larger
 * than to the next macroblock, since memory is taken for what is cropped, too. */
gvc_result gvc_avc_config_check(const uint8_t *config, size_t size, uint32_t width, uint32_t height,
                                gvc_avc_facts *facts, gvc_error *error);

#endif
