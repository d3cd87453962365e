/* SPDX-License-Identifier: MIT */
/** @file utf8.c  What is well-formed UTF-8 (RFC 3629). */
#include "base/utf8.h"

static bool is_within(uint8_t byte, uint8_t least, uint8_t greatest) {
    return byte >= least && byte <= greatest;
}

size_t gvc_utf8_size(const uint8_t *text, size_t left) {
    uint8_t lead = text[0];
    if (lead < 0x80) return 1;
    size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || size > left) return 0;
    /* The second byte excludes overlong forms, surrogates and numbers past U+10FFFF. */
    uint8_t least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    uint8_t greatest = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (!is_within(text[1], least, greatest)) return 0;
    for (size_t i = 2; i < size; i++) {
        if (!is_within(text[i], 0x80, 0xbf)) return 0;
    }
    return size;
}

size_t gvc_utf8_plain_size(const uint8_t *text, size_t left) {
    size_t size = gvc_utf8_size(text, left);
    bool control = text[0] < 0x20 || text[0] == 0x7f || (text[0] == 0xc2 && size && text[1] < 0xa0);
    return control ? 0 : size;
}

bool gvc_utf8_is_plain(const uint8_t *text, size_t size) {
    for (size_t i = 0; i < size;) {
        size_t step = gvc_utf8_plain_size(text + i, size - i);
        if (step == 0) return false;
        i += step;
    }
    return true;
}
