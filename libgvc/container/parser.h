/* SPDX-License-Identifier: MIT */
/**
 * @file parser.h
 * State of gvc_demux_open while it walks over a file, and the steps of the walk. One top-level box
 * is in memory at a time, in `scratch`; everything kept counts against options->max_memory.
 */
#ifndef GVC_CONTAINER_PARSER_H
#define GVC_CONTAINER_PARSER_H

#include "container/box.h"
#include "container/demux.h"

typedef struct gvc_parser {
    const gvc_io *io;
    const gvc_read_options *options;
    gvc_demux *demux;
    uint64_t held; /**< bytes of memory in use */
    uint8_t *scratch;
    size_t scratch_capacity;
    uint8_t *met; /**< per frame of a fragment: whether a sample shows it */
    size_t met_capacity;
    size_t fragment_capacity, sample_capacity[GVC_TRACK_KINDS], damage_capacity, gap_capacity;
    uint64_t unknown; /**< where boxes not known begin that end at this place; 0: there are none */
    uint64_t data_begin;  /**< where the data of the last fragment begin */
    uint64_t next_frame;  /**< presentation number that the next fragment should begin with */
    uint64_t scan_budget; /**< bytes that may still be checksummed while looking for a moof */
    bool closed;          /**< mfra has been read */
    bool index_matched;   /**< and agrees with the fragments */
} gvc_parser;

/** gvc_grow within options->max_memory (GVC_ERROR_LIMIT), old and new block counted together. */
gvc_result gvc_parser_grow(gvc_parser *parser, void **data, size_t *capacity, size_t needed,
                           size_t size, gvc_error *error);
/** Reads bytes of the file; GVC_ERROR_TRUNCATED if it ends before. */
gvc_result gvc_parser_read(const gvc_parser *parser, uint64_t offset, void *data, size_t size,
                           gvc_error *error);
/** Header of the top-level box at `offset`, which must end within the file
 * (GVC_ERROR_TRUNCATED). */
gvc_result gvc_parser_header(const gvc_parser *parser, uint64_t offset, gvc_box *box,
                             gvc_error *error);
/** Reads a whole top-level box into scratch and sets box->content, valid until the next load. */
gvc_result gvc_parser_load(gvc_parser *parser, gvc_box *box, gvc_error *error);
/** CRC-32 of `size` bytes of the file at `offset`. */
gvc_result gvc_parser_crc(const gvc_parser *parser, uint64_t offset, uint64_t size, uint32_t *crc,
                          gvc_error *error);
/** Lists a damaged stretch. */
gvc_result gvc_parser_damage(gvc_parser *parser, uint64_t offset, uint64_t size,
                             const gvc_error *defect, gvc_error *error);

/** Which of our tracks has this number; GVC_TRACK_KINDS if none. */
gvc_track_kind gvc_parser_kind(const gvc_parser *parser, uint32_t track_id);

#define GVC_NO_BRAND_MESSAGE                                                                       \
    "a media file without the brand gvc1: not a .gvc file, or one that a tool copied without its " \
    "shape track"

/* The steps, each given the header of its box. */

/** The moov box; also checks its gcrc, which covers the file from its first byte. */
gvc_result gvc_parse_moov(gvc_parser *parser, gvc_box *moov, bool has_brand, gvc_error *error);
/** A moof and the mdat behind it; `*end` is where they end. */
gvc_result gvc_parse_fragment(gvc_parser *parser, gvc_box *moof, uint64_t *end, gvc_error *error);
/** The mfra box, which must end the file. */
gvc_result gvc_parse_index(gvc_parser *parser, gvc_box *mfra, gvc_error *error);
/** A ggap box. */
gvc_result gvc_parse_gap(gvc_parser *parser, gvc_box *ggap, gvc_error *error);
/** Expands the copy of the head in the index at the end of the file, whatever else is damaged, to
 * demux->head. GVC_ERROR_CORRUPT if there is none to be had. */
gvc_result gvc_restore_head(gvc_parser *parser, gvc_error *error);
/** Looks from `from` on for a moof, or an index, whose checksum is right; `*found` is its offset or
 * the end of the file. */
gvc_result gvc_scan_for_box(gvc_parser *parser, uint64_t from, uint64_t *found, gvc_error *error);

#endif
