/* SPDX-License-Identifier: MIT */
/** @file label.h  Short texts in the file: a length byte, then that many bytes of UTF-8 (RFC 3629)
 * without control characters (U+0000..001F, U+007F..009F), which could command a terminal. */
#ifndef GVC_CONTAINER_LABEL_H
#define GVC_CONTAINER_LABEL_H

#include "base/bytes.h"

/** Appends the text in `text` (at most `capacity` - 1 bytes, at most 255). Bytes that may not be in
 * a label (a file name can hold anything) become '?'. */
void gvc_write_label(gvc_buffer *buffer, const char *text, size_t capacity);

/** Reads a label into `text` of `capacity` bytes, NUL-terminated. False if the bytes end, it does
 * not fit, or it holds what a label may not. */
bool gvc_read_label(gvc_cursor *cursor, char *text, size_t capacity);

#endif
