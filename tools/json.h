/* SPDX-License-Identifier: MIT */
/** @file json.h  Strings in JSON (RFC 8259). */
#ifndef GVC_TOOLS_JSON_H
#define GVC_TOOLS_JSON_H

#include <stddef.h>

enum { JSON_ESCAPED = 8 };

/** Takes one character of `*text`, which must not be at its end, and moves `*text` behind it.
 * Writes what stands for it inside the quotes to `escaped` (no final NUL) and returns how many
 * bytes that are: quotes, backslashes and control characters are escaped, a byte that is not UTF-8
 * becomes U+FFFD, since a file name can hold any bytes and JSON cannot. */
size_t json_escape(const char **text, char escaped[JSON_ESCAPED]);

#endif
