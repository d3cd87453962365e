/* SPDX-License-Identifier: MIT */
/** @file decoder_exact.h  Decodes the exact track: the codes of a frame, from the last keyframe on.
 */
#ifndef GVC_DECODER_EXACT_H
#define GVC_DECODER_EXACT_H

#include "file.h"

/** Zero-initialise; free with gvc_exact_decoder_free. */
typedef struct gvc_exact_decoder {
    uint64_t most_bytes; /**< that a sample may have */
    gvc_buffer sample;
    uint16_t *codes, *before; /**< of the last frame decoded and of the one before it: for each
                                 chart 3 planes of size * size codes, one chart after the other */
    size_t code_count;        /**< of all charts */
    size_t next;              /**< place in the fragment of the next frame to be decoded */
    size_t end;               /**< place of the first frame that cannot be decoded */
    gvc_error defect;         /**< why not */
} gvc_exact_decoder;

/** Prepares for the frames of another fragment, whose charts are `shape`. A sample of more than
 * `most_bytes` is refused (GVC_ERROR_LIMIT). */
gvc_result gvc_exact_decoder_begin(gvc_exact_decoder *decoder, const gvc_shape *shape,
                                   uint64_t most_bytes, gvc_error *error);
/** Leaves the codes of `frame`, one of `fragment`, in decoder->codes. A frame behind one that is
 * damaged gets that one's error at once. */
gvc_result gvc_exact_decoder_seek(gvc_exact_decoder *decoder, const gvc_reader *reader,
                                  size_t fragment, uint64_t frame, const gvc_shape *shape,
                                  gvc_error *error);
/** 3 planes of codes of a chart, valid until the next call of another function here. */
const uint16_t *gvc_exact_decoder_chart(const gvc_exact_decoder *decoder, const gvc_shape *shape,
                                        size_t chart);
void gvc_exact_decoder_free(gvc_exact_decoder *decoder);

/** Bytes that decoding holds at most: codes, and what the codecs need for one chart. */
uint64_t gvc_exact_decoder_memory(const gvc_config *config);

#endif
