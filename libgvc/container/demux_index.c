/* SPDX-License-Identifier: MIT */
/** @file demux_index.c  Reads the closing index (mfra) and compares it with the fragments. */
#include "base/digest.h"
#include "container/parser.h"

/** mfra ends with gcrc and mfro. */
static gvc_result check_tail(const gvc_parser *parser, const gvc_box *mfra, gvc_error *error) {
    size_t least = mfra->header_size + GVC_GCRC_SIZE + GVC_MFRO_SIZE, size = (size_t)mfra->size;
    gvc_crc_state state = GVC_CRC_ABSENT;
    bool has_mfro = false;
    if (size >= least) {
        const uint8_t *gcrc = parser->scratch + size - GVC_MFRO_SIZE - GVC_GCRC_SIZE;
        uint32_t crc = gvc_crc32(0, parser->scratch, (size_t)(gcrc - parser->scratch));
        state = gvc_box_check_crc(crc, gcrc);
        gvc_cursor mfro = gvc_cursor_make(gcrc + GVC_GCRC_SIZE, GVC_MFRO_SIZE);
        bool is_mfro = gvc_read_u32(&mfro) == GVC_MFRO_SIZE && gvc_read_u32(&mfro) == GVC_BOX_MFRO;
        has_mfro = is_mfro && gvc_read_u32(&mfro) == 0 && gvc_read_u32(&mfro) == mfra->size;
    }
    if (state == GVC_CRC_RIGHT && has_mfro) return GVC_OK;
    return gvc_box_fail(mfra, error, GVC_ERROR_CORRUPT,
                        "the index does not end with its right checksum (gcrc) and size (mfro)");
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
    uint64_t shown = first->presentation + parser->track[main].shown_later;
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
    while (gvc_cursor_left(&rest.content)) {
        uint8_t version;
        uint32_t flags;
        GVC_TRY(gvc_box_next(&rest, &tfra, error));
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
    return GVC_OK;
}
