/* SPDX-License-Identifier: MIT */
/** @file demux.c  Walks over the top-level boxes of a file; reads samples. */
#include "container/demux.h"

#include "base/digest.h"
#include "base/memory.h"
#include "container/parser.h"

#include <stdlib.h>
#include <string.h>

/* Checksumming candidates while scanning may cost this many times the file. */
#define SCAN_BUDGET_FILES 4u

void gvc_demux_free(gvc_demux *demux) {
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) free(demux->sample[kind]);
    free(demux->fragment);
    free(demux->damage);
    free(demux->gap);
    free(demux->head);
    free(demux->avc_config);
    *demux = (gvc_demux){0};
}

/** ftyp must come first; `*has_brand` tells whether it names gvc1. */
static gvc_result parse_ftyp(gvc_parser *parser, uint64_t *end, bool *has_brand, gvc_error *error) {
    uint8_t bytes[8];
    gvc_box ftyp;
    *has_brand = false;
    GVC_TRY(gvc_parser_read(parser, 0, bytes, sizeof bytes, error));
    gvc_cursor cursor = gvc_cursor_make(bytes + 4, 4);
    if (gvc_read_u32(&cursor) != GVC_BOX_FTYP) {
        gvc_fail(error, GVC_ERROR_CORRUPT, "not a .gvc file: it does not begin with ftyp");
        if (error) error->offset = 0;
        return GVC_ERROR_CORRUPT;
    }
    GVC_TRY(gvc_parser_header(parser, 0, &ftyp, error));
    GVC_TRY(gvc_parser_load(parser, &ftyp, error));
    uint32_t major = gvc_read_u32(&ftyp.content);
    gvc_skip(&ftyp.content, 4); /* minor version */
    GVC_TRY(gvc_box_check(&ftyp, error));
    *has_brand = major == GVC_BRAND;
    while (gvc_cursor_left(&ftyp.content) >= 4) {
        if (gvc_read_u32(&ftyp.content) == GVC_BRAND) *has_brand = true;
    }
    *end = ftyp.size;
    return GVC_OK;
}

/** ftyp, boxes not known, moov. */
static gvc_result parse_head(gvc_parser *parser, uint64_t *end, gvc_error *error) {
    bool has_brand;
    GVC_TRY(parse_ftyp(parser, end, &has_brand, error));
    for (;;) {
        gvc_box box;
        GVC_TRY(gvc_parser_header(parser, *end, &box, error));
        *end += box.size;
        switch (box.type) {
        case GVC_BOX_MOOV:
            return gvc_parse_moov(parser, &box, has_brand, error);
        case GVC_BOX_FTYP:
        case GVC_BOX_MOOF:
        case GVC_BOX_MDAT:
        case GVC_BOX_MFRA:
            if (!has_brand) {
                return gvc_box_fail(&box, error, GVC_ERROR_UNSUPPORTED, GVC_NO_BRAND_MESSAGE);
            }
            return gvc_box_fail(&box, error, GVC_ERROR_CORRUPT, "moov must come before this box");
        default:
            break;
        }
    }
}

/** One top-level box after moov, or a moof with its mdat. */
static gvc_result parse_unit(gvc_parser *parser, uint64_t *end, gvc_error *error) {
    gvc_box box;
    GVC_TRY(gvc_parser_header(parser, *end, &box, error));
    if (parser->closed) {
        return gvc_box_fail(&box, error, GVC_ERROR_CORRUPT,
                            "the index (mfra) must be the end of the file");
    }
    uint64_t box_end = box.offset + box.size;
    switch (box.type) {
    case GVC_BOX_MOOF:
        GVC_TRY(gvc_parse_fragment(parser, &box, &box_end, error));
        break;
    case GVC_BOX_MFRA:
        GVC_TRY(gvc_parse_index(parser, &box, error));
        break;
    case GVC_BOX_GGAP:
        GVC_TRY(gvc_parse_gap(parser, &box, error));
        break;
    case GVC_BOX_MDAT:
        return gvc_box_fail(&box, error, GVC_ERROR_CORRUPT, "data that no moof describes");
    case GVC_BOX_FTYP:
    case GVC_BOX_MOOV:
        return gvc_box_fail(&box, error, GVC_ERROR_CORRUPT, "a second box of this kind");
    default: /* what is not known is not needed */
        if (!parser->unknown) parser->unknown = box.offset;
        *end = box_end;
        return GVC_OK;
    }
    parser->unknown = 0;
    *end = box_end;
    return GVC_OK;
}

/** Whether a failure says something of the bytes at hand, so that reading may go on after them. */
static bool is_damage(gvc_result result) {
    return result == GVC_ERROR_CORRUPT || result == GVC_ERROR_TRUNCATED ||
           result == GVC_ERROR_UNSUPPORTED;
}

static gvc_result read_head_copy(void *user, uint64_t offset, void *data, size_t size,
                                 gvc_error *error) {
    const gvc_demux *demux = user;
    (void)error;
    memcpy(data, demux->head + offset, size);
    return GVC_OK;
}

/** Parses the copy of the head in the index. If there is none that is good, `defect`, that of the
 * head, stays what is to be told; but not where no byte of the file is to blame. */
static gvc_result parse_head_copy(gvc_parser *parser, uint64_t *end, gvc_error *defect) {
    gvc_demux *demux = parser->demux;
    gvc_error trouble;
    gvc_error_init(&trouble);
    gvc_result result = gvc_restore_head(parser, &trouble);
    if (result == GVC_OK) {
        const gvc_io *file = parser->io, copy = {demux, demux->head_size, read_head_copy};
        parser->io = &copy;
        *end = 0;
        result = parse_head(parser, end, &trouble);
        parser->io = file;
        if (result == GVC_OK && *end == demux->head_size) {
            return gvc_parser_damage(parser, 0, *end, defect, defect);
        }
    }
    if (result == GVC_OK || is_damage(result)) return defect->code;
    *defect = trouble;
    return result;
}

/** The head from its place or, with keep_going, from its copy in the index. */
static gvc_result parse_some_head(gvc_parser *parser, uint64_t *end, gvc_error *error) {
    gvc_error defect;
    gvc_error_init(&defect);
    gvc_demux *demux = parser->demux;
    gvc_result result = parse_head(parser, end, &defect);
    if (is_damage(result) && parser->options->keep_going) {
        result = parse_head_copy(parser, end, &defect);
    }
    demux->head_size = *end;
    return gvc_hand_on(error, result, &defect);
}

/** Lists a defect at `offset` and finds where to go on. If bytes were lost from the fragment
 * before, the next one begins where its data should be. */
static gvc_result pass_over(gvc_parser *parser, uint64_t offset, const gvc_error *defect,
                            uint64_t *next, gvc_error *error) {
    uint64_t from = parser->data_begin ? parser->data_begin : offset;
    GVC_TRY(gvc_scan_for_box(parser, from, next, error));
    uint64_t begin = parser->unknown ? parser->unknown : offset; /* a moof with another type? */
    parser->unknown = 0;
    parser->data_begin = 0;
    if (*next == offset) GVC_TRY(gvc_scan_for_box(parser, offset + 1, next, error));
    if (*next < begin) return gvc_parser_damage(parser, *next, 0, defect, error);
    return gvc_parser_damage(parser, begin, *next - begin, defect, error);
}

static gvc_result parse_body(gvc_parser *parser, uint64_t offset, gvc_error *error) {
    while (offset < parser->io->size) {
        gvc_error defect;
        gvc_error_init(&defect);
        uint64_t next = offset;
        gvc_result result = parse_unit(parser, &next, &defect);
        if (result != GVC_OK) {
            if (!parser->options->keep_going || !is_damage(result)) {
                return gvc_hand_on(error, result, &defect);
            }
            GVC_TRY(pass_over(parser, offset, &defect, &next, error));
        }
        offset = next;
    }
    return GVC_OK;
}

/** The file has been read to its end: is it whole? */
static gvc_result check_end(gvc_parser *parser, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    uint64_t declared = demux->config.declared_frames, size = parser->io->size;
    gvc_error defect;
    gvc_error_init(&defect);
    gvc_result result = GVC_OK;
    if (!parser->closed) {
        result = gvc_fail(&defect, GVC_ERROR_TRUNCATED,
                          "the file ends after frame %llu without its index (mfra)",
                          (unsigned long long)parser->next_frame);
    } else if (declared && declared != parser->next_frame) {
        result = gvc_fail(&defect, GVC_ERROR_CORRUPT, "the file holds %llu frames of %llu",
                          (unsigned long long)parser->next_frame, (unsigned long long)declared);
    }
    defect.offset = size;
    if (!parser->options->keep_going) GVC_TRY(gvc_hand_on(error, result, &defect));
    bool listed = false; /* a stretch that reaches the end tells already */
    if (demux->damage_count) {
        const gvc_damage *last = &demux->damage[demux->damage_count - 1];
        listed = last->offset + last->size == demux->index_offset;
    }
    if (result != GVC_OK && !listed) {
        uint64_t begin = parser->unknown ? parser->unknown : size; /* an index of another type? */
        GVC_TRY(gvc_parser_damage(parser, begin, size - begin, &defect, error));
    }
    demux->complete = parser->closed && parser->index_matched && demux->damage_count == 0;
    return GVC_OK;
}

gvc_result gvc_demux_open(const gvc_io *io, const gvc_read_options *options, gvc_demux *demux,
                          gvc_error *error) {
    *demux = (gvc_demux){0};
    gvc_parser parser = {.io = io, .options = options, .demux = demux};
    parser.scan_budget =
        io->size > UINT64_MAX / SCAN_BUDGET_FILES ? UINT64_MAX : SCAN_BUDGET_FILES * io->size;
    uint64_t end = 0;
    gvc_result result;
    demux->index_offset = io->size;
    GVC_CHECK(parse_some_head(&parser, &end, error));
    GVC_CHECK(parse_body(&parser, end, error));
    GVC_CHECK(check_end(&parser, error));
cleanup:
    free(parser.scratch);
    free(parser.met);
    demux->held = parser.held - parser.scratch_capacity - parser.met_capacity;
    if (result != GVC_OK) gvc_demux_free(demux);
    return result;
}

gvc_result gvc_demux_head(const gvc_demux *demux, const gvc_io *io, gvc_buffer *head,
                          gvc_error *error) {
    size_t size = (size_t)demux->head_size;
    if (demux->head) {
        gvc_write_bytes(head, demux->head, size);
        return head->failed ? gvc_fail_memory(error) : GVC_OK;
    }
    if (!gvc_grow((void **)&head->data, &head->capacity, size, 1)) return gvc_fail_memory(error);
    head->size = size;
    return io->read(io->user, 0, head->data, size, error);
}

gvc_result gvc_demux_check_digest(const gvc_demux *demux, const gvc_io *io, gvc_error *error) {
    uint8_t chunk[1 << 14], digest[GVC_FILE_DIGEST_SIZE];
    if (demux->digest_offset == 0) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the digest of the file is lost");
    }
    gvc_sha256 *state = gvc_sha256_begin();
    if (!state) return gvc_fail_memory(error);
    gvc_result result = GVC_OK;
    for (uint64_t at = 0; at < demux->digest_offset && result == GVC_OK;) {
        uint64_t left = demux->digest_offset - at;
        size_t count = left < sizeof chunk ? (size_t)left : sizeof chunk;
        result = io->read(io->user, at, chunk, count, error);
        if (result == GVC_OK) gvc_sha256_update(state, chunk, count);
        at += count;
    }
    gvc_sha256_end(state, digest);
    if (result != GVC_OK || memcmp(digest, demux->digest, sizeof digest) == 0) return result;
    return gvc_fail(error, GVC_ERROR_CORRUPT,
                    "the file's bytes do not match the digest at its end");
}

static const char *const sample_name[GVC_TRACK_KINDS] = {"a picture", "a shape record",
                                                         "an exact image"};

static gvc_result read_sample(const gvc_sample_entry *sample, const gvc_io *io, const char *name,
                              uint64_t most, gvc_buffer *buffer, gvc_error *error) {
    const gvc_box mdat = {.offset = sample->offset, .path = "mdat"};
    if (sample->offset > io->size || sample->size > io->size - sample->offset) {
        return gvc_box_fail(&mdat, error, GVC_ERROR_CORRUPT, "the file ends within %s", name);
    }
    if (sample->size > most) {
        return gvc_box_fail(&mdat, error, GVC_ERROR_LIMIT, "%s of %u bytes; the limit is %llu",
                            name, sample->size, (unsigned long long)most);
    }
    if (buffer->capacity < sample->size) gvc_buffer_free(buffer); /* never two at a time */
    if (!gvc_grow((void **)&buffer->data, &buffer->capacity, sample->size, 1)) {
        return gvc_fail_memory(error);
    }
    GVC_TRY(io->read(io->user, sample->offset, buffer->data, sample->size, error));
    if (gvc_crc32(0, buffer->data, sample->size) != sample->crc) {
        return gvc_box_fail(&mdat, error, GVC_ERROR_CORRUPT, "the checksum of %s is wrong", name);
    }
    buffer->size = sample->size;
    return GVC_OK;
}

gvc_result gvc_demux_read(const gvc_demux *demux, const gvc_io *io, gvc_track_kind kind,
                          size_t index, uint64_t most, gvc_buffer *buffer, gvc_error *error) {
    gvc_buffer_clear(buffer);
    if (kind >= GVC_TRACK_KINDS || index >= demux->sample_count[kind]) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is no sample %zu", index);
    }
    const gvc_sample_entry *sample = &demux->sample[kind][index];
    return gvc_at_frame(error, read_sample(sample, io, sample_name[kind], most, buffer, error),
                        (int64_t)sample->presentation);
}
