/* SPDX-License-Identifier: MIT */
/** @file utf8.h  What is well-formed UTF-8 (RFC 3629). */
#ifndef GVC_BASE_UTF8_H
#define GVC_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Bytes (1 to 4) of the character that begins at `text`, of which `left` > 0 bytes are there; 0 if
 * none does: a stray or missing continuation byte, an overlong form, a surrogate, a number past
 * U+10FFFF. */
size_t gvc_utf8_size(const uint8_t *text, size_t left);

/** The same, and 0 for a control character (U+0000 to U+001F, U+007F to U+009F), which could
 * command a terminal. */
size_t gvc_utf8_plain_size(const uint8_t *text, size_t left);

/** Whether all `size` bytes are well-formed and no control characters. */
bool gvc_utf8_is_plain(const uint8_t *text, size_t size);

#endif
