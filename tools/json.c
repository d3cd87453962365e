/* SPDX-License-Identifier: MIT */
/** @file json.c  Strings in JSON (RFC 8259). */
#include "json.h"

#include "base/utf8.h"

#include <stdio.h>
#include <string.h>

size_t json_escape(const char **text, char escaped[JSON_ESCAPED]) {
    static const char replacement[] = "\xef\xbf\xbd"; /* U+FFFD */
    const char *c = *text;
    size_t size = gvc_utf8_size((const uint8_t *)c, strlen(c));
    *text += size ? size : 1;
    if (size == 0) {
        memcpy(escaped, replacement, 3);
        return 3;
    }
    if (*c == '"' || *c == '\\') return (size_t)snprintf(escaped, JSON_ESCAPED, "\\%c", *c);
    if ((unsigned char)*c < 0x20) {
        return (size_t)snprintf(escaped, JSON_ESCAPED, "\\u%04x", (unsigned)*c);
    }
    memcpy(escaped, c, size);
    return size;
}
