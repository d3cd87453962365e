/* SPDX-License-Identifier: MIT */
/** @file render_image.h  A picture of 8-bit sRGB pixels: put together, labelled, written as PNG. */
#ifndef GVC_TOOLS_RENDER_IMAGE_H
#define GVC_TOOLS_RENDER_IMAGE_H

#include "base/output.h"

typedef struct render_color {
    uint8_t r, g, b;
} render_color;

typedef struct render_image {
    size_t width, height;
    render_color *pixel; /**< row-major, top row first */
} render_image;

/** A picture of one colour; at most 65535 pixels a side. */
gvc_result render_image_create(size_t width, size_t height, render_color color,
                               render_image **image, gvc_error *error);
void render_image_destroy(render_image **image);

/** Copies `from` with its top left corner at (x, y); what sticks out is left off. */
void render_image_paste(render_image *image, const render_image *from, size_t x, size_t y);
void render_image_box(render_image *image, size_t x, size_t y, size_t width, size_t height,
                      render_color color);

/** Puts pictures side by side, `gap` apart and with a strip for a label above each if `label` is
 * not NULL (`label[i]` may be NULL). All strips are `background`. */
gvc_result render_image_row(const render_image *const *part, const char *const *label, size_t count,
                            size_t gap, render_color background, render_image **row,
                            gvc_error *error);

#define RENDER_GLYPH_WIDTH 6u /**< of a letter with its space, at scale 1 */
#define RENDER_GLYPH_HEIGHT 9u

/** Writes ASCII text (others become '?') with its top left at (x, y), enlarged `scale` times.
 * Returns the width in pixels. */
size_t render_image_text(render_image *image, size_t x, size_t y, size_t scale, const char *text,
                         render_color color);
size_t render_text_width(const char *text, size_t scale);

/** Writes all of a PNG file to `output`. */
gvc_result render_image_write(const render_image *image, gvc_output *output, gvc_error *error);

#endif
