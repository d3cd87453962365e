/* SPDX-License-Identifier: MIT */
/**
 * @file demux.h
 * Parses an untrusted `.gvc` file through bounded reads into an immutable index of samples. Knows
 * boxes and checksums only; no codec is needed to build or fuzz it.
 */
#ifndef GVC_CONTAINER_DEMUX_H
#define GVC_CONTAINER_DEMUX_H

#include "container/config.h"

/* Structure of a file (ISO/IEC 14496-12; * marks what this format adds). Boxes not named here are
 * skipped at every level, but nothing may stand behind mfra, and mdat follows its moof at once. A
 * box of size 0 ("to the end of the file") is refused: a cut would not be noticed.
 *
 *   ftyp                     brand gvc1, as major or compatible one
 *   moov
 *     mvhd
 *     trak  geometry         tkhd, edts/elst, mdia/minf/stbl/stsd/avc1 { avcC, colr, gvcC* }
 *     trak  shape            tkhd, tref/cdsc -> main, .../stsd/urim { uri  "urn:gvc:shape:0" }
 *     trak  exact            tkhd, .../stsd/urim { uri  "urn:gvc:exact:0" }
 *     mvex                   mehd if the number of frames is known, trex for each track
 *     gcrc*                  last child: CRC-32 from the file's first byte up to its own CRC field
 *   per group of frames:
 *   moof
 *     mfhd
 *     traf  for each of these tracks: tfhd (default-base-is-moof), tfdt, one trun,
 *           gcks*            CRC-32 (u32) of each sample, in the order of trun
 *     gcrc*                  last child: CRC-32 from moof's first byte up to its own CRC field
 *   mdat                     samples of shape, geometry, exact, in trun's order, no other byte
 *   ggap*                    where frames are lost that the file had before it was repaired: which;
 *                            ends with a gcrc as moof does
 *   mfra
 *     tfra                   of the main track: one entry per fragment
 *     ghed*                  ftyp ... moov once more, as a Zstandard frame
 *     gdig*                  SHA-256 from the file's first byte up to its own digest field
 *     gcrc*                  CRC-32 from mfra's first byte up to its own CRC field
 *     mfro                   last
 *
 * Of geometry and exact track one may be missing. The main track is the geometry track if there is
 * one, else the exact track, whose urim then holds gvcC. There is an exact track if, and only if,
 * gvcC says so.
 *
 * gcrc, gcks, ggap, ghed and gdig are FullBoxes of version 0. The CRC-32 is that of gvc_crc32.
 * Every byte of these boxes is thus covered by a checksum or compared exactly; boxes not named here
 * that stand at the top level behind moov are not.
 *
 * All tracks have timescale frame_rate_num, and every sample lasts frame_rate_den. The number of
 * the frame that a sample belongs to is
 *   (decoding time + composition offset - media_time of the track's edit list, or 0) /
 *   frame_rate_den,
 * a whole number. In a fragment of n frames whose tfdt is the time of frame f, the numbers of each
 * track are f .. f + n - 1 in some order, and only the first sample is a sync sample. Fragments
 * (and ggap boxes) follow each other without gap from frame 0. A fragment of other tracks only
 * (sound) is ignored; one that mixes them with these is refused. */

typedef enum gvc_track_kind {
    GVC_TRACK_GEOMETRY = 0,
    GVC_TRACK_SHAPE = 1,
    GVC_TRACK_EXACT = 2,
    GVC_TRACK_KINDS = 3
} gvc_track_kind;

typedef struct gvc_sample_entry {
    uint64_t offset;
    uint32_t size;
    uint32_t crc;          /**< CRC-32 of the sample's bytes as the file says */
    uint64_t presentation; /**< frame number */
    uint32_t nth; /**< in entry n of a fragment: which of its entries holds the frame shown n-th
                     (the inverse of `presentation`, for gvc_demux_sample_of) */
} gvc_sample_entry;

typedef struct gvc_fragment_entry {
    uint64_t offset, size; /**< of moof and mdat together; may reach behind the end of a cut file */
    uint64_t moof_size;
    uint64_t first_frame; /**< smallest presentation number in it */
    uint32_t frame_count;
    uint32_t sequence; /**< number of the fragment as mfhd says, from 1; names it in messages */
    size_t first_sample[GVC_TRACK_KINDS]; /**< index into sample[kind] */
} gvc_fragment_entry;

/** Frames that the file says are lost. */
typedef struct gvc_gap {
    uint64_t offset; /**< of its ggap box */
    uint64_t first_frame, frame_count;
} gvc_gap;

#define GVC_FILE_DIGEST_SIZE 32

/** A damaged stretch of the file, found with keep_going. */
typedef struct gvc_damage {
    uint64_t offset, size;
    gvc_error error;
} gvc_damage;

/** What the head says of a track. */
typedef struct gvc_track_defaults {
    uint32_t track_id;
    uint32_t duration, size, flags; /**< from trex: of samples whose fragment does not say them */
    uint32_t shown_later; /**< from the edit list: frames that composition offsets are too great */
} gvc_track_defaults;

typedef struct gvc_demux {
    gvc_config config;
    uint8_t *avc_config;
    size_t avc_config_size;
    bool has_track[GVC_TRACK_KINDS];
    size_t fragment_count;
    gvc_fragment_entry *fragment;
    size_t sample_count[GVC_TRACK_KINDS]; /**< geometry in decoding order, others in presentation
                                             order; 0 of a track that is missing */
    gvc_sample_entry *sample[GVC_TRACK_KINDS];
    size_t gap_count;
    gvc_gap *gap;
    size_t damage_count;
    gvc_damage *damage;
    bool complete; /**< the closing index was there and matched */

    gvc_track_defaults track[GVC_TRACK_KINDS];
    uint64_t held;      /**< bytes of memory that all this takes */
    uint64_t head_size; /**< bytes from the first of ftyp to the last of moov */
    uint8_t *head;      /**< ftyp ... moov where they are damaged in place, from their copy in mfra;
                             else NULL */
    uint64_t index_offset;  /**< of mfra; the end of the file if there is none */
    uint64_t digest_offset; /**< bytes that `digest` covers; 0 if the file has none */
    uint8_t digest[GVC_FILE_DIGEST_SIZE];
} gvc_demux;

/** Parses the whole structure (not the sample data). Without options->keep_going the first defect
 * is an error with offset and box path; with it, damage is listed, and parsing goes on at the next
 * moof found by its type and checksum; a damaged head is taken from its copy; of a fragment whose
 * moof is right, all samples that the file is long enough for are kept. A file without shape track
 * gets an error that says that a remuxer dropped it. `options` must not be NULL. GVC_ERROR_LIMIT if
 * index and boxes, or one picture, take more than options->max_memory. On failure `demux` is empty.
 */
gvc_result gvc_demux_open(const gvc_io *io, const gvc_read_options *options, gvc_demux *demux,
                          gvc_error *error);
void gvc_demux_free(gvc_demux *demux);

/** Order of the tracks in mdat; those that are missing are left out. */
extern const gvc_track_kind gvc_data_order[GVC_TRACK_KINDS];

/** The track that shape records describe and the index points at. */
static inline gvc_track_kind gvc_demux_main(const gvc_demux *demux) {
    return demux->has_track[GVC_TRACK_GEOMETRY] ? GVC_TRACK_GEOMETRY : GVC_TRACK_EXACT;
}

/** Index of the sample of a frame, which must be one of those of `fragment`; the track must not
 * be missing. */
static inline size_t gvc_demux_sample_of(const gvc_demux *demux, const gvc_fragment_entry *fragment,
                                         gvc_track_kind kind, uint64_t frame) {
    size_t first = fragment->first_sample[kind];
    return first + demux->sample[kind][first + (size_t)(frame - fragment->first_frame)].nth;
}

/** Appends ftyp ... moov as they were written, to an empty buffer. */
gvc_result gvc_demux_head(const gvc_demux *demux, const gvc_io *io, gvc_buffer *head,
                          gvc_error *error);

/** Reads the whole file and compares its digest. GVC_ERROR_CORRUPT if it differs or the file has
 * none. */
gvc_result gvc_demux_check_digest(const gvc_demux *demux, const gvc_io *io, gvc_error *error);

/** Reads a sample and verifies its checksum. `buffer` is cleared first. GVC_ERROR_LIMIT, before
 * memory is taken, for one of more than `most` bytes. */
gvc_result gvc_demux_read(const gvc_demux *demux, const gvc_io *io, gvc_track_kind kind,
                          size_t index, uint64_t most, gvc_buffer *buffer, gvc_error *error);

#endif
