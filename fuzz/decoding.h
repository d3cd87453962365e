/* SPDX-License-Identifier: MIT */
/** @file decoding.h  Decodes a file in memory through the public interface and keeps what came out.
 */
#ifndef GVC_FUZZ_DECODING_H
#define GVC_FUZZ_DECODING_H

#include "file.h"

#define DECODED_FRAMES 12u /**< of a file, so that a run stays short */

typedef struct decoded_frame {
    uint64_t frame;
    gvc_result result;
    uint32_t crc; /**< of the mesh; 0 if there is none */
} decoded_frame;

typedef struct decoded {
    size_t count;
    decoded_frame frame[DECODED_FRAMES];
} decoded;

/** Limits under which every run takes milliseconds: 64 MiB, images of 129 samples a side. */
gvc_read_options decoding_options(bool keep_going, bool preview);
/** CRC-32 of positions and faces. */
uint32_t mesh_crc(const gvc_mesh *mesh);
/** Decodes frames in order; then each again, backwards, which must give the same. */
decoded decode_frames(const gvc_reader *reader);
/** Frames that decode in `before` must be the same in `after` (and may not be missing there, if
 * `all`). */
void require_kept(const decoded *before, const decoded *after, bool all);

#endif
