/* SPDX-License-Identifier: MIT */
/** @file box.c  Boxes of ISO/IEC 14496-12 in memory. */
#include "container/box.h"

#include "base/digest.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

gvc_result gvc_box_fail(const gvc_box *box, gvc_error *error, gvc_result code, const char *format,
                        ...) {
    if (!error) return code;
    char message[sizeof error->message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    gvc_fail(error, code, "%s", message);
    error->offset = box->offset;
    snprintf(error->where, sizeof error->where, "%s", box->path);
    return code;
}

/** Appends "/type" to the parent's path; bytes that are no printable ASCII become '?'. */
static void name_box(const gvc_box *parent, gvc_box *box) {
    char name[5] = {0};
    for (unsigned i = 0; i < 4; i++) {
        uint8_t letter = (uint8_t)(box->type >> (24 - 8 * i));
        name[i] = letter >= 0x20 && letter < 0x7f ? (char)letter : '?';
    }
    const char *above = parent ? parent->path : "";
    /* The precision only tells the compiler what fixed nesting guarantees. */
    snprintf(box->path, sizeof box->path, "%.58s%s%s", above, above[0] ? "/" : "", name);
}

gvc_result gvc_box_header(gvc_cursor *header, uint64_t offset, const gvc_box *parent, gvc_box *box,
                          gvc_error *error) {
    *box = (gvc_box){.offset = offset};
    if (parent) memcpy(box->path, parent->path, sizeof box->path);
    size_t begin = header->position;
    uint32_t size = gvc_read_u32(header);
    uint32_t type = gvc_read_u32(header);
    uint64_t large_size = size == 1 ? gvc_read_u64(header) : size;
    if (header->failed) {
        return gvc_box_fail(box, error, GVC_ERROR_TRUNCATED, "a box header does not fit");
    }
    box->type = type;
    name_box(parent, box);
    box->header_size = (uint32_t)(header->position - begin);
    box->size = large_size;
    /* "To the end of the file" (size 0) is refused: a cut would not be noticed. */
    if (box->size < box->header_size) {
        return gvc_box_fail(box, error, GVC_ERROR_CORRUPT, "a box of %llu bytes cannot be",
                            (unsigned long long)box->size);
    }
    return GVC_OK;
}

gvc_result gvc_box_next(gvc_box *parent, gvc_box *child, gvc_error *error) {
    gvc_cursor *cursor = &parent->content;
    uint64_t content_offset = parent->offset + (parent->size - cursor->size);
    gvc_result result =
        gvc_box_header(cursor, content_offset + cursor->position, parent, child, error);
    if (result == GVC_ERROR_TRUNCATED) {
        return gvc_box_fail(child, error, GVC_ERROR_CORRUPT, "a box header leaves its parent");
    }
    GVC_TRY(result);
    uint64_t content_size = child->size - child->header_size;
    if (content_size > gvc_cursor_left(cursor)) {
        return gvc_box_fail(child, error, GVC_ERROR_CORRUPT,
                            "a box of %llu bytes leaves its parent",
                            (unsigned long long)child->size);
    }
    child->content = gvc_read_sub(cursor, (size_t)content_size);
    return GVC_OK;
}

gvc_result gvc_box_find(const gvc_box *parent, uint32_t type, bool mandatory, gvc_box *child,
                        gvc_error *error) {
    gvc_box rest = *parent, candidate;
    *child = (gvc_box){.type = type};
    name_box(parent, child);
    child->type = 0;
    while (gvc_cursor_left(&rest.content)) {
        GVC_TRY(gvc_box_next(&rest, &candidate, error));
        if (candidate.type != type) continue;
        if (child->type) {
            return gvc_box_fail(&candidate, error, GVC_ERROR_CORRUPT,
                                "a second box of a kind that may stand once");
        }
        *child = candidate;
    }
    if (mandatory && !child->type) {
        child->offset = parent->offset;
        return gvc_box_fail(child, error, GVC_ERROR_CORRUPT, "a mandatory box is missing");
    }
    return GVC_OK;
}

gvc_result gvc_box_version(gvc_box *box, uint8_t greatest, uint8_t *version, uint32_t *flags,
                           gvc_error *error) {
    *version = gvc_read_u8(&box->content);
    *flags = gvc_read_u24(&box->content);
    GVC_TRY(gvc_box_check(box, error));
    if (*version > greatest) {
        return gvc_box_fail(box, error, GVC_ERROR_UNSUPPORTED,
                            "version %u of a box known up to version %u", *version, greatest);
    }
    return GVC_OK;
}

gvc_result gvc_box_check(const gvc_box *box, gvc_error *error) {
    if (!box->content.failed) return GVC_OK;
    return gvc_box_fail(box, error, GVC_ERROR_CORRUPT, "%llu bytes are too few for this box",
                        (unsigned long long)box->size);
}

gvc_crc_state gvc_box_check_crc(uint32_t crc, const uint8_t tail[GVC_GCRC_SIZE]) {
    gvc_cursor cursor = gvc_cursor_make(tail, GVC_GCRC_SIZE);
    uint32_t size = gvc_read_u32(&cursor);
    uint32_t type = gvc_read_u32(&cursor);
    if (size != GVC_GCRC_SIZE || type != GVC_BOX_GCRC) return GVC_CRC_ABSENT;
    uint32_t version_and_flags = gvc_read_u32(&cursor);
    bool right = gvc_read_u32(&cursor) == gvc_crc32(crc, tail, GVC_GCRC_SIZE - 4);
    return right && version_and_flags == 0 ? GVC_CRC_RIGHT : GVC_CRC_WRONG;
}

size_t gvc_box_begin(gvc_buffer *buffer, uint32_t type) {
    size_t begin = buffer->size;
    gvc_write_u32(buffer, 0);
    gvc_write_u32(buffer, type);
    return begin;
}

size_t gvc_box_begin_full(gvc_buffer *buffer, uint32_t type, uint8_t version, uint32_t flags) {
    size_t begin = gvc_box_begin(buffer, type);
    gvc_write_u8(buffer, version);
    gvc_write_u24(buffer, flags);
    return begin;
}

void gvc_box_end(gvc_buffer *buffer, size_t begin) {
    if (buffer->failed) return;
    if (buffer->size - begin > UINT32_MAX) {
        buffer->failed = true; /* not a size that memory for tables reaches */
        return;
    }
    gvc_patch_u32(buffer, begin, (uint32_t)(buffer->size - begin));
}

void gvc_box_write_crc(gvc_buffer *buffer, size_t begin, uint32_t crc) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_GCRC, 0, 0);
    size_t crc_position = buffer->size;
    gvc_write_u32(buffer, 0);
    gvc_box_end(buffer, box);
    if (buffer->failed) return;
    gvc_patch_u32(buffer, crc_position, gvc_crc32(crc, buffer->data + begin, crc_position - begin));
}
