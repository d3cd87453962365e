/* SPDX-License-Identifier: MIT */
/** @file config.h  The `gvcC` box: facts that hold for the whole file. */
#ifndef GVC_CONTAINER_CONFIG_H
#define GVC_CONTAINER_CONFIG_H

#include "base/bytes.h"
#include "base/result.h"

#define GVC_FORMAT_MAJOR 0
#define GVC_FORMAT_MINOR 1
#define GVC_MAX_PICTURE_SIDE 16384u /**< samples: width, and height of all three planes */

/** Bit of features: the file has an exact track, and the digests are those of its codes. */
#define GVC_FEATURE_EXACT 1u

/** A picture of the geometry track holds three planes, x above y above z, each `plane_height` rows
 * of `picture_width` samples. Charts lie in a plane at the rectangles their shape records name.
 * Samples outside all charts are padding. luma code v (10 bits) means the 16-bit code v <<
 * code_shift (6). */
typedef struct gvc_config {
    uint16_t version_major, version_minor;
    uint32_t features;      /**< bits a decoder must know: GVC_FEATURE_EXACT */
    uint32_t picture_width; /**< even; multiple of 16 as written here */
    uint32_t plane_height;  /**< picture height = 3 * plane_height, even */
    uint32_t image_size;    /**< no chart has a greater S */
    uint8_t code_bits;      /**< 10 */
    uint8_t code_shift;     /**< 6 */
    uint32_t frame_rate_num, frame_rate_den;
    uint64_t declared_frames; /**< 0: unknown */
    char unit[16];            /**< UTF-8, NUL-terminated here; "" unknown */
    char encoder[64];         /**< program and version */
    char settings[256];       /**< encoder settings as text, informative */
} gvc_config;

/* Layout of the content of gvcC (big-endian):
 *
 *   offset  type   field
 *    0      u16    version_major      0
 *    2      u16    version_minor      1; a reader accepts greater ones
 *    4      u32    features           bit 0: exact track; a reader refuses bits it does not know
 *    8      u32    picture_width      16 .. 16384, even
 *   12      u32    plane_height       16 .. 5460, even: at most 16384 rows in all
 *   16      u32    image_size         16 .. 2049; charts may not exceed it
 *   20      u8     code_bits          10
 *   21      u8     code_shift         6
 *   22      u32    frame_rate_num     >= 1; timescale of movie and tracks
 *   26      u32    frame_rate_den     >= 1; duration of every sample
 *   30      u64    declared_frames    0: unknown; times frame_rate_den below 2^64
 *   38      label  unit               at most 15 bytes
 *    .      label  encoder            at most 63 bytes
 *    .      label  settings           at most 255 bytes
 *    .             bytes that later minor versions may add, ignored
 *
 * A label is a length (u8) and that many bytes of UTF-8 without control characters. */

/** Appends the content of the box, without its header. Bytes that a label may not hold become '?'.
 */
void gvc_config_write(const gvc_config *config, gvc_buffer *buffer);
/** GVC_ERROR_UNSUPPORTED for a greater major version or an unknown feature bit; a greater minor
 * version and bytes after the known fields are accepted. */
gvc_result gvc_config_read(gvc_cursor *cursor, gvc_config *config, gvc_error *error);
/** Whether two configurations are written alike. */
gvc_result gvc_config_equal(const gvc_config *a, const gvc_config *b, bool *equal,
                            gvc_error *error);

#endif
