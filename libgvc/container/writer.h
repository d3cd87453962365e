/* SPDX-License-Identifier: MIT */
/**
 * @file writer.h
 * Writes a `.gvc` file front to back: ftyp, moov, one moof + mdat per group of frames, mfra. Never
 * seeks. demux.h describes what it writes. Parts of another file can be taken over bit for bit.
 */
#ifndef GVC_CONTAINER_WRITER_H
#define GVC_CONTAINER_WRITER_H

#include "container/demux.h"

typedef struct gvc_writer gvc_writer;

/** One sample in decoding order. */
typedef struct gvc_sample {
    const uint8_t *data;
    size_t size;
    int32_t composition_offset; /**< presentation minus decoding time, in frames (version 1 trun,
                                   signed) */
    bool sync;                  /**< true for the first of a fragment, and only for it */
} gvc_sample;

/** One fragment: a group of frames. Each track has one sample per frame. */
typedef struct gvc_fragment {
    uint64_t first_frame; /**< decoding time of the first sample, in frames; fragments follow each
                             other without gap from 0 */
    size_t frame_count;
    const gvc_sample *geometry; /**< in decoding order; NULL if there is no such track */
    const gvc_sample *shape; /**< in presentation order; the first record is whole, the others say
                                "same" */
    const gvc_sample *exact; /**< in presentation order; NULL if there is no such track */
} gvc_fragment;

/** Writes ftyp and moov at once. `avc_config` is the content of avcC; NULL: there is no geometry
 * track. There is an exact track if config->features say so. GVC_ERROR_ARGUMENT for a configuration
 * that gvc_config_read would refuse, or if there is neither track. */
gvc_result gvc_writer_create(const gvc_sink *sink, const gvc_config *config,
                             const uint8_t *avc_config, size_t avc_config_size, gvc_writer **writer,
                             gvc_error *error);
/** Begins a file with the head of another one as it stands there; `config` is what it says.
 * GVC_ERROR_UNSUPPORTED if its tracks are not numbered and shifted as this writer does it. */
gvc_result gvc_writer_create_from(const gvc_sink *sink, const gvc_demux *demux, const gvc_io *io,
                                  gvc_writer **writer, gvc_error *error);
/** Takes fragment `index` of another file of the same configuration over, bit for bit (but the
 * header of mdat as it should be). Its first frame must be the next one, and all its samples be
 * right. */
gvc_result gvc_writer_copy(gvc_writer *writer, const gvc_demux *demux, const gvc_io *io,
                           size_t index, gvc_error *error);
/** States that the next `count` frames are lost: writes ggap, after which the frames go on behind
 * them. */
gvc_result gvc_writer_gap(gvc_writer *writer, uint64_t count, gvc_error *error);
/** Writes moof and mdat. GVC_ERROR_ARGUMENT, before anything is written, if other than the first
 * samples are sync samples, other than the first shape record is whole, a sample is empty, or the
 * composition offsets do not permute the frames. After the sink failed nothing more can be written.
 */
gvc_result gvc_writer_fragment(gvc_writer *writer, const gvc_fragment *fragment, gvc_error *error);
/** Writes the index, a copy of the head, and the digest of the file (mfra). GVC_ERROR_ARGUMENT if
 * frames declared are missing. */
gvc_result gvc_writer_finish(gvc_writer *writer, gvc_error *error);
uint64_t gvc_writer_byte_count(const gvc_writer *writer);
void gvc_writer_destroy(gvc_writer **writer);

#endif
