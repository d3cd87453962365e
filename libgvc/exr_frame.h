/* SPDX-License-Identifier: MIT */
/**
 * @file exr_frame.h
 * A frame as an OpenEXR file that needs nothing else: besides what exr.h says it has four
 * attributes of text (spec 6.5.8), from which the `.gvc` file can be made again.
 */
#ifndef GVC_EXR_FRAME_H
#define GVC_EXR_FRAME_H

#include "container/config.h"
#include "container/shape_record.h"
#include "gvc/gvc.h"

/** Free with gvc_exr_frame_free. */
typedef struct gvc_exr_frame {
    gvc_config config;     /**< of the file that the frame is from */
    uint64_t number;       /**< of the frame in it, */
    uint64_t group;        /**< and of the first frame of its group */
    gvc_shape shape;       /**< one chart */
    gvc_shape_frame facts; /**< never "same" */
    uint16_t *codes;       /**< 3 planes of size * size */
} gvc_exr_frame;

void gvc_exr_frame_free(gvc_exr_frame *frame);

/** Decodes frame `number` and verifies its digest. GVC_ERROR_UNSUPPORTED for a frame of several
 * charts. */
gvc_result gvc_exr_frame_take(const gvc_reader *reader, gvc_decoder *decoder, uint64_t number,
                              gvc_exr_frame *frame, gvc_error *error);

/** Appends the OpenEXR file. */
gvc_result gvc_exr_frame_write(const gvc_exr_frame *frame, gvc_buffer *bytes, gvc_error *error);

/** Reads untrusted bytes of such a file. GVC_ERROR_CORRUPT, naming what is missing, for any other
 * OpenEXR file. */
gvc_result gvc_exr_frame_read(const uint8_t *data, size_t data_size, gvc_exr_frame *frame,
                              gvc_error *error);

/** Digest of the frame's codes, which facts.digest is unless they were changed. */
gvc_result gvc_exr_frame_digest(const gvc_exr_frame *frame, uint8_t digest[8], gvc_error *error);

#endif
