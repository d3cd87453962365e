/* SPDX-License-Identifier: MIT */
/** @file render_font.h  Five by nine dots per letter. */
#ifndef GVC_TOOLS_RENDER_FONT_H
#define GVC_TOOLS_RENDER_FONT_H

#include <stdint.h>

/** The nine rows of a letter, top first (two of them below the line), the leftmost dot in bit 4.
 * Anything but printable ASCII gives '?'. */
const uint8_t *render_glyph(char letter);

#endif
