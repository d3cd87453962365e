/* SPDX-License-Identifier: MIT */
/** @file config.h  The `gvcC` box: facts that hold for the whole file. */
#ifndef GVC_CONTAINER_CONFIG_H
#define GVC_CONTAINER_CONFIG_H

#include "base/bytes.h"
#include "base/result.h"

#define GVC_FORMAT_MAJOR 0
#define GVC_FORMAT_MINOR 1

/** A picture of the geometry track holds three planes, x above y above z, each `plane_height` rows
 * of `picture_width` samples. Charts lie in a plane at the rectangles their shape records name.
 * Samples outside all charts are padding. luma code v (10 bits) means the 16-bit code v <<
 * code_shift (6). */
typedef struct gvc_config {
    uint16_t version_major, version_minor;
    uint32_t features;      /**< bits a decoder must know; 0 in this version */
    uint32_t picture_width; /**< even; multiple of 16 as written here */
    uint32_t plane_height;  /**< picture height = 3 * plane_height, even */
    uint32_t image_size;    /**< greatest S of any chart, informative */
    uint8_t code_bits;      /**< 10 */
    uint8_t code_shift;     /**< 6 */
    uint32_t frame_rate_num, frame_rate_den;
    uint64_t declared_frames; /**< 0: unknown */
    char unit[16];            /**< UTF-8, NUL-terminated here; "" unknown */
    char encoder[64];         /**< program and version */
    char settings[256];       /**< encoder settings as text, informative */
} gvc_config;

/** Content of the box, without its header. */
void gvc_config_write(const gvc_config *config, gvc_buffer *buffer);
/** GVC_ERROR_UNSUPPORTED for a greater major version or an unknown feature bit; a greater minor
 * version and bytes after the known fields are accepted. */
gvc_result gvc_config_read(gvc_cursor *cursor, gvc_config *config, gvc_error *error);

#endif
