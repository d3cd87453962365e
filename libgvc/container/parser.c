/* SPDX-License-Identifier: MIT */
/** @file parser.c  Bounded reading of a file and bounded memory. */
#include "container/parser.h"

#include "base/digest.h"
#include "base/memory.h"

#include <stdlib.h>

#define CHUNK_SIZE 4096u
#define MAX_HEADER_SIZE 16u

gvc_result gvc_parser_grow(gvc_parser *parser, void **data, size_t *capacity, size_t needed,
                           size_t size, gvc_error *error) {
    if (needed <= *capacity && *data) return GVC_OK;
    /* As gvc_grow will choose: by half, at least sixteen elements. */
    uint64_t wanted = (uint64_t)*capacity + *capacity / 2;
    if (wanted < needed) wanted = needed;
    if (wanted < 16) wanted = 16;
    uint64_t limit = parser->options->max_memory;
    if (parser->held > limit || wanted > (limit - parser->held) / size) {
        return gvc_fail(error, GVC_ERROR_LIMIT,
                        "the structure of the file takes more than the %llu bytes allowed",
                        (unsigned long long)limit);
    }
    size_t before = *capacity;
    if (!gvc_grow(data, capacity, needed, size)) return gvc_fail_memory(error);
    parser->held += (uint64_t)(*capacity - before) * size;
    return GVC_OK;
}

gvc_result gvc_parser_read(const gvc_parser *parser, uint64_t offset, void *data, size_t size,
                           gvc_error *error) {
    const gvc_io *io = parser->io;
    if (offset > io->size || size > io->size - offset) {
        gvc_result result = gvc_fail(error, GVC_ERROR_TRUNCATED, "the file ends at byte %llu",
                                     (unsigned long long)io->size);
        if (error) error->offset = offset;
        return result;
    }
    return io->read(io->user, offset, data, size, error);
}

gvc_result gvc_parser_header(const gvc_parser *parser, uint64_t offset, gvc_box *box,
                             gvc_error *error) {
    uint8_t bytes[MAX_HEADER_SIZE];
    uint64_t left = parser->io->size - offset;
    size_t size = left < sizeof bytes ? (size_t)left : sizeof bytes;
    GVC_TRY(gvc_parser_read(parser, offset, bytes, size, error));
    gvc_cursor cursor = gvc_cursor_make(bytes, size);
    GVC_TRY(gvc_box_header(&cursor, offset, NULL, box, error));
    if (box->size > left) {
        return gvc_box_fail(box, error, GVC_ERROR_TRUNCATED,
                            "a box of %llu bytes, but the file ends after %llu of them",
                            (unsigned long long)box->size, (unsigned long long)left);
    }
    return GVC_OK;
}

gvc_result gvc_parser_load(gvc_parser *parser, gvc_box *box, gvc_error *error) {
    if (box->size > SIZE_MAX) {
        return gvc_box_fail(box, error, GVC_ERROR_LIMIT, "a box of %llu bytes",
                            (unsigned long long)box->size);
    }
    size_t size = (size_t)box->size;
    GVC_TRY(gvc_parser_grow(parser, (void **)&parser->scratch, &parser->scratch_capacity, size, 1,
                            error));
    GVC_TRY(gvc_parser_read(parser, box->offset, parser->scratch, size, error));
    box->content = gvc_cursor_make(parser->scratch + box->header_size, size - box->header_size);
    return GVC_OK;
}

gvc_result gvc_parser_crc(const gvc_parser *parser, uint64_t offset, uint64_t size, uint32_t *crc,
                          gvc_error *error) {
    uint8_t chunk[CHUNK_SIZE];
    *crc = 0;
    while (size) {
        size_t count = size < sizeof chunk ? (size_t)size : sizeof chunk;
        GVC_TRY(gvc_parser_read(parser, offset, chunk, count, error));
        *crc = gvc_crc32(*crc, chunk, count);
        offset += count;
        size -= count;
    }
    return GVC_OK;
}

gvc_result gvc_parser_damage(gvc_parser *parser, uint64_t offset, uint64_t size,
                             const gvc_error *defect, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->damage, &parser->damage_capacity,
                            demux->damage_count + 1, sizeof *demux->damage, error));
    demux->damage[demux->damage_count++] =
        (gvc_damage){.offset = offset, .size = size, .error = *defect};
    return GVC_OK;
}

gvc_track_kind gvc_parser_kind(const gvc_parser *parser, uint32_t track_id) {
    unsigned kind = track_id ? 0 : GVC_TRACK_KINDS; /* 0: that of a track that is missing */
    while (kind < GVC_TRACK_KINDS && parser->demux->track[kind].track_id != track_id) kind++;
    return (gvc_track_kind)kind;
}
