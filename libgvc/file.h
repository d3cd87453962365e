/* SPDX-License-Identifier: MIT */
/** @file file.h  What an opened file is to the decoder: the parsed index and its input. */
#ifndef GVC_FILE_H
#define GVC_FILE_H

#include "container/demux.h"
#include "container/shape_record.h"

struct gvc_reader {
    gvc_io io;
    gvc_read_options options;
    gvc_demux demux;
    int descriptor;       /**< of a file opened here, else -1 */
    const uint8_t *bytes; /**< borrowed memory, or NULL */
};

/** Whether frames can be decoded both exactly and from H.264. */
static inline bool gvc_reader_has_preview(const gvc_reader *reader) {
    return reader->demux.has_track[GVC_TRACK_GEOMETRY] && reader->demux.has_track[GVC_TRACK_EXACT];
}

/** Bytes of max_memory that the index of the file leaves. */
static inline uint64_t gvc_reader_room(const gvc_reader *reader) {
    uint64_t held = reader->demux.held, most = reader->options.max_memory;
    return held < most ? most - held : 0;
}

/** The digest of what the reader's options ask to be decoded. */
const uint8_t *gvc_reader_digest(const gvc_reader *reader, const gvc_shape_frame *facts);

/** Fragment that holds a frame. GVC_ERROR_ARGUMENT for a frame number past the end,
 * GVC_ERROR_CORRUPT for one that lies in a damaged part, GVC_ERROR_TRUNCATED for one that the file
 * declares but does not reach. */
gvc_result gvc_reader_find(const gvc_reader *reader, uint64_t frame, size_t *fragment,
                           gvc_error *error);

/** Per-frame facts of a frame of a fragment, and, if it is the fragment's first, the shape that all
 * frames of the fragment have; else `shape` stays empty (freed by the caller in either case).
 * Refuses a record that is whole where it should say "same", or the reverse. */
gvc_result gvc_reader_record(const gvc_reader *reader, size_t fragment, uint64_t frame,
                             gvc_shape *shape, gvc_shape_frame *facts, gvc_error *error);

/** Shape of all frames of a fragment, from its first record; freed by the caller. */
gvc_result gvc_reader_shape(const gvc_reader *reader, size_t fragment, gvc_shape *shape,
                            gvc_error *error);

/** The geometry image of a chart as it comes out of its track, before twins are welded: `*plane`
 * points at 3 * size * size 16-bit codes, x plane first, which the decoder owns and keeps until the
 * next call; NULL on failure. Checksums are verified; the digest, which covers the welded surface,
 * is not. GVC_ERROR_ARGUMENT for a chart number past the end. */
gvc_result gvc_decoder_codes(gvc_decoder *decoder, uint64_t frame, size_t chart,
                             const uint16_t **plane, uint32_t *size, gvc_error *error);

#endif
