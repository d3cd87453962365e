/* SPDX-License-Identifier: MIT */
/** @file demux_scan.c  Finds the next whole fragment, or the index, after a damaged stretch. */
#include "container/parser.h"

#include <string.h>

#define CHUNK_SIZE 4096u
#define TYPE_END 8u /**< bytes of a box header up to and including its type */

/** Whether a box that claims to be a moof or an mfra at `offset` has a right checksum at its end.
 */
static gvc_result is_whole(gvc_parser *parser, uint64_t offset, bool *whole, gvc_error *error) {
    gvc_box box;
    uint8_t tail[GVC_GCRC_SIZE];
    uint32_t crc;
    *whole = false;
    gvc_result result = gvc_parser_header(parser, offset, &box, error);
    if (result == GVC_ERROR_CORRUPT || result == GVC_ERROR_TRUNCATED) return GVC_OK;
    GVC_TRY(result);
    uint64_t behind = GVC_GCRC_SIZE + (box.type == GVC_BOX_MFRA ? GVC_MFRO_SIZE : 0);
    bool wanted = box.type == GVC_BOX_MOOF ||
                  (box.type == GVC_BOX_MFRA && offset + box.size == parser->io->size);
    if (!wanted || box.size < box.header_size + behind) return GVC_OK;
    uint64_t before = box.size - behind;
    GVC_TRY(gvc_parser_read(parser, offset + before, tail, sizeof tail, error));
    if (gvc_box_check_crc(0, tail) == GVC_CRC_ABSENT) return GVC_OK;
    if (box.size > parser->scan_budget) {
        parser->scan_budget = 0;
        return GVC_OK;
    }
    parser->scan_budget -= box.size;
    GVC_TRY(gvc_parser_crc(parser, offset, before, &crc, error));
    *whole = gvc_box_check_crc(crc, tail) == GVC_CRC_RIGHT;
    return GVC_OK;
}

gvc_result gvc_scan_for_box(gvc_parser *parser, uint64_t from, uint64_t *found, gvc_error *error) {
    static const char type[2][4] = {{'m', 'o', 'o', 'f'}, {'m', 'f', 'r', 'a'}};
    uint64_t size = parser->io->size;
    uint8_t chunk[CHUNK_SIZE];
    *found = size;
    gvc_error ignored; /* a false moof is no news */
    gvc_error_init(&ignored);
    while (from < size && size - from >= TYPE_END) {
        size_t count = size - from < sizeof chunk ? (size_t)(size - from) : sizeof chunk;
        GVC_TRY(gvc_parser_read(parser, from, chunk, count, error));
        for (size_t i = 0; i + TYPE_END <= count; i++) {
            const uint8_t *bytes = chunk + i + 4;
            if (memcmp(bytes, type[0], 4) != 0 && memcmp(bytes, type[1], 4) != 0) continue;
            bool whole;
            gvc_result result = is_whole(parser, from + i, &whole, &ignored);
            GVC_TRY(gvc_hand_on(error, result, &ignored));
            /* Decoys could make every candidate cost the whole file: give up instead. */
            if (parser->scan_budget == 0) return GVC_OK;
            if (whole) {
                *found = from + i;
                return GVC_OK;
            }
        }
        from += count - TYPE_END + 1;
    }
    return GVC_OK;
}
