/* SPDX-License-Identifier: MIT */
/**
 * @file exact_sample.h
 * One chart's image in the exact track: an OpenEXR file (exr.h), told by its first bytes, or a
 * residual (residual.h).
 */
#ifndef GVC_CODEC_EXACT_SAMPLE_H
#define GVC_CODEC_EXACT_SAMPLE_H

#include "base/result.h"

/** Whether these are the bytes of a keyframe, which needs no other image. */
bool gvc_exact_image_is_key(const uint8_t *data, size_t data_size);

/** Decodes untrusted bytes of an image of size * size samples; `previous` is that of the frame
 * before, or NULL. `codes` gets 3 planes; on failure its content is undefined. */
gvc_result gvc_exact_image_decode(const uint8_t *data, size_t data_size, uint32_t size,
                                  const uint16_t *previous, uint16_t *codes, gvc_error *error);

/** Bytes that decoding an image needs besides its codes and data. */
uint64_t gvc_exact_image_memory(uint32_t size);

#endif
