/* SPDX-License-Identifier: MIT */
/** @file render_image.c  A picture of 8-bit sRGB pixels: put together and labelled. */
#include "render_image.h"

#include "base/memory.h"
#include "base/result.h"
#include "render_font.h"

#include <stdlib.h>
#include <string.h>

#define MAX_SIDE 65535u
#define LABEL_SCALE 2u
#define LABEL_HEIGHT 34u

gvc_result render_image_create(size_t width, size_t height, render_color color,
                               render_image **image, gvc_error *error) {
    *image = NULL;
    if (!width || !height || width > MAX_SIDE || height > MAX_SIDE) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a picture of %zu x %zu pixels is not possible",
                        width, height);
    }
    render_image *made = gvc_alloc(1, sizeof *made);
    if (!made) return gvc_fail_memory(error);
    made->width = width;
    made->height = height;
    made->pixel = gvc_alloc(width * height, sizeof *made->pixel);
    if (!made->pixel) {
        free(made);
        return gvc_fail_memory(error);
    }
    render_image_box(made, 0, 0, width, height, color);
    *image = made;
    return GVC_OK;
}

void render_image_destroy(render_image **image) {
    if (!image || !*image) return;
    free((*image)->pixel);
    free(*image);
    *image = NULL;
}

void render_image_paste(render_image *image, const render_image *from, size_t x, size_t y) {
    if (x >= image->width) return;
    size_t width = from->width < image->width - x ? from->width : image->width - x;
    for (size_t row = 0; row < from->height && row + y < image->height; row++) {
        memcpy(&image->pixel[(row + y) * image->width + x], &from->pixel[row * from->width],
               width * sizeof *image->pixel);
    }
}

void render_image_box(render_image *image, size_t x, size_t y, size_t width, size_t height,
                      render_color color) {
    for (size_t row = y; row < image->height && row - y < height; row++) {
        for (size_t column = x; column < image->width && column - x < width; column++) {
            image->pixel[row * image->width + column] = color;
        }
    }
}

size_t render_text_width(const char *text, size_t scale) {
    return strlen(text) * RENDER_GLYPH_WIDTH * scale;
}

size_t render_image_text(render_image *image, size_t x, size_t y, size_t scale, const char *text,
                         render_color color) {
    size_t left = x;
    for (; *text; text++, x += RENDER_GLYPH_WIDTH * scale) {
        const uint8_t *glyph = render_glyph(*text);
        for (size_t row = 0; row < RENDER_GLYPH_HEIGHT; row++) {
            for (size_t column = 0; column < 5; column++) {
                if (!(glyph[row] >> (4 - column) & 1)) continue;
                render_image_box(image, x + column * scale, y + row * scale, scale, scale, color);
            }
        }
    }
    return x - left;
}

gvc_result render_image_row(const render_image *const *part, const char *const *label, size_t count,
                            size_t gap, render_color background, render_image **row,
                            gvc_error *error) {
    const render_color ink = {50, 52, 58};
    size_t width = gap, height = 0, strip = label ? LABEL_HEIGHT : gap;
    for (size_t i = 0; i < count; i++) {
        width += part[i]->width + gap;
        if (part[i]->height > height) height = part[i]->height;
    }
    GVC_TRY(render_image_create(width, height + strip + gap, background, row, error));
    size_t x = gap;
    for (size_t i = 0; i < count; i++) {
        render_image_paste(*row, part[i], x, strip);
        if (label && label[i]) render_image_text(*row, x + 4, 9, LABEL_SCALE, label[i], ink);
        x += part[i]->width + gap;
    }
    return GVC_OK;
}
