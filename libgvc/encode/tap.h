/* SPDX-License-Identifier: MIT */
/** @file tap.h  Looking at the geometry images that the encoder makes, before they are coded. */
#ifndef GVC_ENCODE_TAP_H
#define GVC_ENCODE_TAP_H

#include "gvc/gvc.h"

typedef struct gvc_image_tap {
    void *user;
    /** Gets the image of a frame: 3 planes of size * size coordinates, x first, valid during the
     * call. Called from several threads, for different frames at a time. A frame whose cut is made
     * anew, because one just before it began a segment, comes again: the last image is the one that
     * is coded. A failure ends the encode. */
    gvc_result (*image)(void *user, uint64_t frame, const double *image, uint32_t size,
                        gvc_error *error);
} gvc_image_tap;

/** gvc_encode, with a tap (which may be NULL). */
gvc_result gvc_encode_tapped(const gvc_source *source, const gvc_sink *sink,
                             const gvc_encode_options *options, const gvc_image_tap *tap,
                             gvc_encode_report *report, gvc_error *error);

#endif
