/* SPDX-License-Identifier: MIT */
/** @file encoder_exr.h  From OpenEXR files of frames (exr_frame.h) back to a lossless file. */
#ifndef GVC_ENCODER_EXR_H
#define GVC_ENCODER_EXR_H

#include "base/bytes.h"
#include "gvc/gvc.h"

typedef struct gvc_exr_source {
    void *user;
    uint64_t frame_count;
    /** Appends the bytes of a frame's file to an empty buffer. */
    gvc_result (*read)(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error);
} gvc_exr_source;

/** Writes a lossless file of the frames, in this order. Frames that were a group are one again if
 * they follow each other and still have the same charts; everything else is as the frames say. So
 * the frames of a lossless file without preview, all and in order, give the same bytes again. Of
 * `options`, threads, progress and warn are used. A warning names frames whose codes were changed.
 * GVC_ERROR_MESH for frames of files that differ in their configuration. One group is held in
 * memory at a time. */
gvc_result gvc_encode_exr(const gvc_exr_source *source, const gvc_sink *sink,
                          const gvc_encode_options *options, gvc_encode_report *report,
                          gvc_error *error);

#endif
