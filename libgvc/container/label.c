/* SPDX-License-Identifier: MIT */
/** @file label.c  Short texts in the file. */
#include "container/label.h"

#include "base/utf8.h"

#include <string.h>

void gvc_write_label(gvc_buffer *buffer, const char *text, size_t capacity) {
    const uint8_t *bytes = (const uint8_t *)text;
    size_t length = strnlen(text, capacity - 1);
    if (length > UINT8_MAX) length = UINT8_MAX;
    gvc_write_u8(buffer, (uint8_t)length);
    for (size_t i = 0; i < length;) {
        size_t size = gvc_utf8_plain_size(bytes + i, length - i);
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
    if (!bytes || length >= capacity || !gvc_utf8_is_plain(bytes, length)) return false;
    memcpy(text, bytes, length);
    text[length] = '\0';
    return true;
}
