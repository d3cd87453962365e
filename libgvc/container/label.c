/* SPDX-License-Identifier: MIT */
/** @file label.c  Short texts in the file. */
#include "container/label.h"

#include <string.h>

static bool is_continuation(uint8_t byte, uint8_t least, uint8_t greatest) {
    return byte >= least && byte <= greatest;
}

/** Bytes of the character at `text`, or 0 if it is not one that a label may hold. */
static size_t character_size(const uint8_t *text, size_t left) {
    uint8_t lead = text[0];
    if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
    size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || size > left) return 0;
    /* The second byte excludes C1 controls, overlong forms, surrogates and numbers past U+10FFFF.
     */
    uint8_t least = lead == 0xc2 || lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    uint8_t greatest = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (!is_continuation(text[1], least, greatest)) return 0;
    for (size_t i = 2; i < size; i++) {
        if (!is_continuation(text[i], 0x80, 0xbf)) return 0;
    }
    return size;
}

void gvc_write_label(gvc_buffer *buffer, const char *text, size_t capacity) {
    const uint8_t *bytes = (const uint8_t *)text;
    size_t length = strnlen(text, capacity - 1);
    if (length > UINT8_MAX) length = UINT8_MAX;
    gvc_write_u8(buffer, (uint8_t)length);
    for (size_t i = 0; i < length;) {
        size_t size = character_size(bytes + i, length - i);
        if (size) {
            gvc_write_bytes(buffer, bytes + i, size);
        } else {
            gvc_write_u8(buffer, '?');
        }
        i += size ? size : 1;
    }
}

bool gvc_read_label(gvc_cursor *cursor, char *text, size_t capacity) {
    size_t length = gvc_read_u8(cursor);
    const uint8_t *bytes = gvc_read_bytes(cursor, length);
    if (!bytes || length >= capacity) return false;
    for (size_t i = 0; i < length;) {
        size_t size = character_size(bytes + i, length - i);
        if (!size) return false;
        i += size;
    }
    memcpy(text, bytes, length);
    text[length] = '\0';
    return true;
}
