/* SPDX-License-Identifier: MIT */
/** @file demux_index.c  Reads the closing index (mfra) and compares it with the fragments; gaps. */
#include "base/digest.h"
#include "base/memory.h"
#include "container/parser.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

/* More than any head takes; a copy that claims to be longer is not expanded. */
#define MAX_HEAD_SIZE (UINT64_C(1) << 24)

/** mfra ends with gdig, gcrc and mfro. */
static gvc_result check_tail(const gvc_parser *parser, const gvc_box *mfra, gvc_error *error) {
    size_t least = mfra->header_size + GVC_GDIG_SIZE + GVC_GCRC_SIZE + GVC_MFRO_SIZE;
    size_t size = (size_t)mfra->size;
    gvc_crc_state state = GVC_CRC_ABSENT;
    bool has_mfro = false, has_digest = false;
    if (size >= least) {
        const uint8_t *gcrc = parser->scratch + size - GVC_MFRO_SIZE - GVC_GCRC_SIZE;
        uint32_t crc = gvc_crc32(0, parser->scratch, (size_t)(gcrc - parser->scratch));
        state = gvc_box_check_crc(crc, gcrc);
        gvc_cursor mfro = gvc_cursor_make(gcrc + GVC_GCRC_SIZE, GVC_MFRO_SIZE);
        bool is_mfro = gvc_read_u32(&mfro) == GVC_MFRO_SIZE && gvc_read_u32(&mfro) == GVC_BOX_MFRO;
        has_mfro = is_mfro && gvc_read_u32(&mfro) == 0 && gvc_read_u32(&mfro) == mfra->size;
        gvc_cursor gdig = gvc_cursor_make(gcrc - GVC_GDIG_SIZE, GVC_GDIG_SIZE);
        has_digest = gvc_read_u32(&gdig) == GVC_GDIG_SIZE && gvc_read_u32(&gdig) == GVC_BOX_GDIG &&
                     gvc_read_u32(&gdig) == 0;
        const uint8_t *digest = gcrc - GVC_FILE_DIGEST_SIZE;
        if (state == GVC_CRC_RIGHT && has_digest) {
            memcpy(parser->demux->digest, digest, GVC_FILE_DIGEST_SIZE);
            parser->demux->digest_offset = mfra->offset + (uint64_t)(digest - parser->scratch);
        }
    }
    if (state == GVC_CRC_RIGHT && has_mfro && has_digest) return GVC_OK;
    return gvc_box_fail(mfra, error, GVC_ERROR_CORRUPT,
                        "the index does not end with the digest of the file (gdig), its right "
                        "checksum (gcrc) and its size (mfro)");
}

/** Reads a number of 1 to 4 bytes. */
static uint32_t read_number(gvc_cursor *cursor, unsigned size) {
    uint32_t value = 0;
    for (unsigned i = 0; i < size; i++) value = value << 8 | gvc_read_u8(cursor);
    return value;
}

/** Whether the next entry points at the first sample of a fragment's main track. */
static bool entry_matches(const gvc_parser *parser, const gvc_fragment_entry *fragment,
                          gvc_cursor *cursor, uint8_t version, uint32_t sizes) {
    const gvc_demux *demux = parser->demux;
    gvc_track_kind main = gvc_demux_main(demux);
    const gvc_sample_entry *first = &demux->sample[main][fragment->first_sample[main]];
    uint64_t shown = first->presentation + parser->demux->track[main].shown_later;
    uint64_t time = version == 1 ? gvc_read_u64(cursor) : gvc_read_u32(cursor);
    uint64_t offset = version == 1 ? gvc_read_u64(cursor) : gvc_read_u32(cursor);
    read_number(cursor, (sizes >> 4 & 3) + 1); /* number of traf: they may stand in any order */
    uint32_t trun = read_number(cursor, (sizes >> 2 & 3) + 1);
    uint32_t sample = read_number(cursor, (sizes & 3) + 1);
    return !cursor->failed && time == shown * demux->config.frame_rate_den &&
           offset == fragment->offset && trun == 1 && sample == 1;
}

static gvc_result compare_entries(const gvc_parser *parser, gvc_box *tfra, uint8_t version,
                                  gvc_error *error) {
    const gvc_demux *demux = parser->demux;
    gvc_cursor *cursor = &tfra->content;
    uint32_t sizes = gvc_read_u32(cursor);
    uint32_t count = gvc_read_u32(cursor);
    GVC_TRY(gvc_box_check(tfra, error));
    if (count != demux->fragment_count) {
        return gvc_box_fail(tfra, error, GVC_ERROR_CORRUPT,
                            "the index lists %u fragments, the file holds %zu", count,
                            demux->fragment_count);
    }
    for (size_t i = 0; i < count; i++) {
        if (!entry_matches(parser, &demux->fragment[i], cursor, version, sizes)) {
            return gvc_box_fail(tfra, error, GVC_ERROR_CORRUPT,
                                "entry %zu of the index does not match its fragment", i);
        }
    }
    if (gvc_cursor_left(cursor) == 0) return GVC_OK;
    return gvc_box_fail(tfra, error, GVC_ERROR_CORRUPT, "%zu bytes are left after the last entry",
                        gvc_cursor_left(cursor));
}

gvc_result gvc_parse_index(gvc_parser *parser, gvc_box *mfra, gvc_error *error) {
    GVC_TRY(gvc_parser_load(parser, mfra, error));
    GVC_TRY(check_tail(parser, mfra, error));
    gvc_box rest = *mfra, tfra;
    bool found = false;
    unsigned digests = 0, ends = 0;
    while (gvc_cursor_left(&rest.content)) {
        uint8_t version;
        uint32_t flags;
        GVC_TRY(gvc_box_next(&rest, &tfra, error));
        digests += tfra.type == GVC_BOX_GDIG;
        ends += tfra.type == GVC_BOX_MFRO;
        if (digests > 1 || ends > 1) {
            return gvc_box_fail(&tfra, error, GVC_ERROR_CORRUPT,
                                "a second box of a kind that may stand once");
        }
        if (tfra.type != GVC_BOX_TFRA) continue;
        GVC_TRY(gvc_box_version(&tfra, 1, &version, &flags, error));
        uint32_t track_id = gvc_read_u32(&tfra.content);
        GVC_TRY(gvc_box_check(&tfra, error));
        if (gvc_parser_kind(parser, track_id) != gvc_demux_main(parser->demux)) continue;
        if (found) return gvc_box_fail(&tfra, error, GVC_ERROR_CORRUPT, "a second tfra");
        found = true;
        /* After damage the index must name fragments that are lost: nothing to learn. */
        if (parser->demux->damage_count == 0) {
            GVC_TRY(compare_entries(parser, &tfra, version, error));
            parser->index_matched = true;
        }
    }
    if (!found) {
        return gvc_box_fail(mfra, error, GVC_ERROR_CORRUPT, "the %s track has no tfra",
                            parser->demux->has_track[GVC_TRACK_GEOMETRY] ? "geometry" : "exact");
    }
    parser->closed = true;
    parser->demux->index_offset = mfra->offset;
    return GVC_OK;
}

/* ------------------------------------------------------------------------------ copy of the head
 */

static gvc_result expand_head(gvc_parser *parser, gvc_box *ghed, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_version(ghed, 0, &version, &flags, error));
    size_t size = gvc_cursor_left(&ghed->content), capacity = 0;
    const uint8_t *packed = gvc_read_bytes(&ghed->content, size);
    unsigned long long expanded = ZSTD_getFrameContentSize(packed, size);
    if (expanded == ZSTD_CONTENTSIZE_UNKNOWN || expanded == ZSTD_CONTENTSIZE_ERROR ||
        expanded > MAX_HEAD_SIZE) {
        return gvc_box_fail(ghed, error, GVC_ERROR_CORRUPT, "no copy of the head");
    }
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->head, &capacity, (size_t)expanded, 1, error));
    demux->head_size = expanded;
    if (ZSTD_decompress(demux->head, (size_t)expanded, packed, size) == expanded) return GVC_OK;
    return gvc_box_fail(ghed, error, GVC_ERROR_CORRUPT, "the copy of the head does not expand");
}

gvc_result gvc_restore_head(gvc_parser *parser, gvc_error *error) {
    uint8_t bytes[GVC_MFRO_SIZE];
    uint64_t size = parser->io->size;
    gvc_box mfra, ghed;
    if (size < sizeof bytes) return gvc_fail(error, GVC_ERROR_CORRUPT, "no room for an index");
    GVC_TRY(gvc_parser_read(parser, size - sizeof bytes, bytes, sizeof bytes, error));
    gvc_cursor mfro = gvc_cursor_make(bytes, sizeof bytes);
    gvc_skip(&mfro, sizeof bytes - 4);
    uint32_t length = gvc_read_u32(&mfro);
    if (length > size) return gvc_fail(error, GVC_ERROR_CORRUPT, "the file does not end with mfro");
    GVC_TRY(gvc_parser_header(parser, size - length, &mfra, error));
    if (mfra.type != GVC_BOX_MFRA || mfra.size != length) {
        return gvc_box_fail(&mfra, error, GVC_ERROR_CORRUPT, "the file does not end with mfra");
    }
    GVC_TRY(gvc_parser_load(parser, &mfra, error));
    GVC_TRY(check_tail(parser, &mfra, error));
    GVC_TRY(gvc_box_find(&mfra, GVC_BOX_GHED, true, &ghed, error));
    return expand_head(parser, &ghed, error);
}

/* ------------------------------------------------------------------------------------------ gaps
 */

gvc_result gvc_parse_gap(gvc_parser *parser, gvc_box *ggap, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_parser_load(parser, ggap, error));
    if (ggap->size != GVC_GGAP_SIZE || ggap->header_size != 8) {
        return gvc_box_fail(ggap, error, GVC_ERROR_CORRUPT, "a box of %llu bytes instead of %u",
                            (unsigned long long)ggap->size, GVC_GGAP_SIZE);
    }
    size_t tail = GVC_GGAP_SIZE - GVC_GCRC_SIZE;
    uint32_t crc = gvc_crc32(0, parser->scratch, tail);
    if (gvc_box_check_crc(crc, parser->scratch + tail) != GVC_CRC_RIGHT) {
        return gvc_box_fail(ggap, error, GVC_ERROR_CORRUPT, "the checksum of ggap is wrong");
    }
    GVC_TRY(gvc_box_version(ggap, 0, &version, &flags, error));
    uint64_t first = gvc_read_u64(&ggap->content), count = gvc_read_u64(&ggap->content);
    uint64_t declared = demux->config.declared_frames, limit = parser->options->max_frames;
    uint64_t end = declared && declared < limit ? declared : limit;
    bool after_damage = parser->options->keep_going && first > parser->next_frame;
    if ((first != parser->next_frame && !after_damage) || count == 0 || first > end ||
        count > end - first) {
        return gvc_box_fail(ggap, error, GVC_ERROR_CORRUPT,
                            "a gap of %llu frames from %llu on, expected at %llu",
                            (unsigned long long)count, (unsigned long long)first,
                            (unsigned long long)parser->next_frame);
    }
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->gap, &parser->gap_capacity,
                            demux->gap_count + 1, sizeof *demux->gap, error));
    demux->gap[demux->gap_count++] = (gvc_gap){ggap->offset, first, count};
    parser->next_frame = first + count;
    return GVC_OK;
}
