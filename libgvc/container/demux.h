/* SPDX-License-Identifier: MIT */
/**
 * @file demux.h
 * Parses an untrusted `.gvc` file through bounded reads into an immutable index of samples. Knows
 * boxes and checksums only; no codec is needed to build or fuzz it.
 */
#ifndef GVC_CONTAINER_DEMUX_H
#define GVC_CONTAINER_DEMUX_H

#include "container/config.h"

typedef enum gvc_track_kind {
    GVC_TRACK_GEOMETRY = 0,
    GVC_TRACK_SHAPE = 1,
    GVC_TRACK_KINDS = 2
} gvc_track_kind;

typedef struct gvc_sample_entry {
    uint64_t offset;
    uint32_t size;
    uint32_t crc;          /**< CRC-32 of the sample's bytes as the file says */
    uint64_t presentation; /**< frame number */
    bool sync;
} gvc_sample_entry;

typedef struct gvc_fragment_entry {
    uint64_t offset, size; /**< of moof and mdat together */
    uint64_t first_frame;  /**< smallest presentation number in it */
    uint32_t frame_count;
    size_t first_sample[GVC_TRACK_KINDS]; /**< index into sample[kind] */
} gvc_fragment_entry;

/** A damaged stretch of the file, found with keep_going. */
typedef struct gvc_damage {
    uint64_t offset, size;
    gvc_error error;
} gvc_damage;

typedef struct gvc_demux {
    gvc_config config;
    uint8_t *avc_config;
    size_t avc_config_size;
    size_t fragment_count;
    gvc_fragment_entry *fragment;
    size_t sample_count[GVC_TRACK_KINDS]; /**< geometry in decoding order, shape in presentation
                                             order */
    gvc_sample_entry *sample[GVC_TRACK_KINDS];
    size_t damage_count;
    gvc_damage *damage;
    bool complete; /**< the closing index was there and matched */
} gvc_demux;

/** Parses the whole structure (not the sample data). Without options->keep_going the first defect
 * is an error with offset and box path; with it, damage is listed, and parsing goes on at the next
 * moof found by its type and checksum. A file without shape track gets an error that says that a
 * remuxer dropped it. */
gvc_result gvc_demux_open(const gvc_io *io, const gvc_read_options *options, gvc_demux *demux,
                          gvc_error *error);
void gvc_demux_free(gvc_demux *demux);

/** Reads a sample and verifies its checksum. `buffer` is cleared first. */
gvc_result gvc_demux_read(const gvc_demux *demux, const gvc_io *io, gvc_track_kind kind,
                          size_t index, gvc_buffer *buffer, gvc_error *error);

#endif
