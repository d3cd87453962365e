/* SPDX-License-Identifier: MIT */
/** @file encoding.h  Encodes a few small meshes and demands a good file or a fair error. */
#ifndef GVC_FUZZ_ENCODING_H
#define GVC_FUZZ_ENCODING_H

#include "base/bytes.h"
#include "gvc/gvc.h"

#define ENCODED_FRAMES 3u

typedef struct small_capture {
    size_t count;
    gvc_mesh *mesh[ENCODED_FRAMES];
} small_capture;

void small_capture_free(small_capture *capture);
/** Encodes to memory. False if the meshes cannot be coded, or not as well as asked for; then `file`
 * is empty. A good file opens strictly, has as many frames, and all of them decode, twice alike, to
 * closed manifolds. */
bool encode_and_check(const small_capture *capture, const gvc_encode_options *options,
                      gvc_buffer *file);

#endif
