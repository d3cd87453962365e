/* SPDX-License-Identifier: MIT */
/**
 * @file exr.h
 * A geometry image of 16-bit codes as an OpenEXR file in memory, without loss. Any program that
 * reads OpenEXR opens it; those that show channels X, Y and Z (or take them for R, G and B) show
 * the surface.
 *
 * A HALF has 11 significant bits, so each code c becomes two of them, both exact and no subnormals:
 *
 *     channel X:     (c div 32) / 2048          the coordinate as a fraction of the cube, 0 to 1
 *     channel X.lo:  1/2 + (c mod 32) / 2048    the five bits below
 *     c = 65536 * X + 2048 * (X.lo - 1/2)       and so for Y and Z
 *
 * The file is single-part and of scan lines, in increasing order, with ZIP compression; data and
 * display window are (0, 0) - (S - 1, S - 1). Besides the attributes that OpenEXR wants it has:
 *
 *   name       type    meaning
 *   gvcVersion int     0: this mapping of codes
 *   gvcOrigin  v3d     position = gvcOrigin + gvcStep * c
 *   gvcStep    double
 *   gvcTime    double  presentation time, seconds
 *   gvcUnit    string  unit of the position; missing if it is not known
 *
 * Nothing else unless it is asked for, and no dates: the same image gives the same bytes.
 */
#ifndef GVC_CODEC_EXR_H
#define GVC_CODEC_EXR_H

#include "base/bytes.h"
#include "base/result.h"

/** What an image says of itself to a reader that has nothing else. */
typedef struct gvc_exr_facts {
    double origin[3], step; /**< position = origin + step * code; finite, step > 0 */
    double time;            /**< seconds; finite */
    char unit[16];          /**< UTF-8 without control characters; "" unknown */
} gvc_exr_facts;

/** Appends the file for an image of 3 planes of size * size codes. GVC_ERROR_ARGUMENT if the facts
 * are not as said above. */
gvc_result gvc_exr_encode(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts,
                          gvc_buffer *bytes, gvc_error *error);

/** An attribute of text that the caller adds. */
typedef struct gvc_exr_text {
    const char *name, *value;
} gvc_exr_text;

typedef struct gvc_exr_options {
    bool piz; /**< PIZ instead of ZIP: to compare with, gvc_exr_decode refuses it */
    const gvc_exr_text *text;
    size_t text_count;
} gvc_exr_options;

/** The same, with more attributes or compressed otherwise. */
gvc_result gvc_exr_encode_with(uint32_t size, const uint16_t *codes, const gvc_exr_facts *facts,
                               const gvc_exr_options *options, gvc_buffer *bytes, gvc_error *error);

/** Appends the value of an attribute of text of untrusted bytes that must be such a file, without a
 * NUL. GVC_ERROR_CORRUPT if there is none. */
gvc_result gvc_exr_read_text(const uint8_t *data, size_t data_size, const char *name,
                             gvc_buffer *text, gvc_error *error);

/** Reads untrusted bytes that must be such a file of an image of `size`. Compression may be NONE,
 * RLE, ZIPS or ZIP, and there may be further attributes. `codes` gets 3 * size * size codes; its
 * content is undefined on failure. `facts` may be NULL. GVC_ERROR_CORRUPT if it is no OpenEXR file
 * or damaged; GVC_ERROR_UNSUPPORTED if it is tiled, deep, of several parts, of another version, or
 * in another compression. Memory besides `codes`: a few times the bytes of one chunk of lines, and
 * `data_size`. */
gvc_result gvc_exr_decode(const uint8_t *data, size_t data_size, uint32_t size, uint16_t *codes,
                          gvc_exr_facts *facts, gvc_error *error);

/** A header of more bytes is refused (GVC_ERROR_LIMIT): those written here have less than 500, and
 * 130,000 with a whole shape record in it. The library keeps up to eight times as much. */
#define GVC_EXR_MAX_HEADER (UINT32_C(1) << 18)
#define GVC_EXR_HEADER_MEMORY (8 * (uint64_t)GVC_EXR_MAX_HEADER)

#endif
