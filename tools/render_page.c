/* SPDX-License-Identifier: MIT */
/** @file render_page.c  Puts panels, captions and lines of text together to one picture. */
#include "render_page.h"

#include "base/memory.h"
#include "base/result.h"
#include "base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LINE 26u      /* height of a line of text at scale 2 */
#define SMALL 284u    /* panels narrower than this have small letters */
#define KEY_WIDTH 30u /* of a dot or a stroke */
#define KEY_SPACE 22u /* after a key */

static const render_color white = {255, 255, 255}, ink = {36, 38, 44}, pale = {112, 116, 126};

/* --------------------------------------------------------------------------------------- parts */

gvc_result render_parts_add(render_parts *parts, render_image *image, gvc_error *error) {
    if (!gvc_grow((void **)&parts->image, &parts->capacity, parts->count + 1,
                  sizeof(render_image *))) {
        render_image_destroy(&image);
        return gvc_fail_memory(error);
    }
    parts->image[parts->count++] = image;
    return GVC_OK;
}

void render_parts_free(render_parts *parts) {
    for (size_t i = 0; i < parts->count; i++) render_image_destroy(&parts->image[i]);
    free(parts->image);
    *parts = (render_parts){0};
}

static gvc_result join(const render_parts *parts, bool column, size_t gap, render_image **image,
                       gvc_error *error) {
    size_t along = 0, across = 0, place = 0;
    *image = NULL;
    if (parts->count == 0) return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is nothing to show");
    for (size_t i = 0; i < parts->count; i++) {
        size_t width = parts->image[i]->width, height = parts->image[i]->height;
        along += (column ? height : width) + (i > 0 ? gap : 0);
        size_t breadth = column ? width : height;
        if (breadth > across) across = breadth;
    }
    GVC_TRY(
        render_image_create(column ? across : along, column ? along : across, white, image, error));
    for (size_t i = 0; i < parts->count; i++) {
        const render_image *part = parts->image[i];
        if (column) {
            render_image_paste(*image, part, 0, place);
        } else {
            render_image_paste(*image, part, place, across - part->height);
        }
        place += (column ? part->height : part->width) + gap;
    }
    return GVC_OK;
}

gvc_result render_parts_row(const render_parts *parts, size_t gap, render_image **image,
                            gvc_error *error) {
    return join(parts, false, gap, image, error);
}

/* Replaces `*image` by one with a margin around. */
static gvc_result add_margin(render_image **image, size_t margin, gvc_error *error) {
    render_image *whole;
    GVC_TRY(render_image_create((*image)->width + 2 * margin, (*image)->height + 2 * margin, white,
                                &whole, error));
    render_image_paste(whole, *image, margin, margin);
    render_image_destroy(image);
    *image = whole;
    return GVC_OK;
}

gvc_result render_parts_page(const render_parts *parts, size_t gap, render_image **image,
                             gvc_error *error) {
    GVC_TRY(join(parts, true, gap, image, error));
    gvc_result result = add_margin(image, gap, error);
    if (result != GVC_OK) render_image_destroy(image);
    return result;
}

gvc_result render_parts_move_row(render_parts *parts, size_t gap, render_parts *into,
                                 gvc_error *error) {
    render_image *row;
    gvc_result result = render_parts_row(parts, gap, &row, error);
    if (result == GVC_OK) result = render_parts_add(into, row, error);
    render_parts_free(parts);
    return result;
}

/* ---------------------------------------------------------------------------------------- text */

gvc_result render_caption(render_image **image, const char *title, const char *facts,
                          gvc_error *error) {
    const render_image *panel = *image;
    size_t scale = panel->width < SMALL ? 1 : 2, line = LINE * scale / 2, height = 4;
    if (title) height += line;
    if (facts) height += line;
    render_image *whole;
    GVC_TRY(render_image_create(panel->width, panel->height + height, white, &whole, error));
    if (title) render_image_text(whole, 2, 2, scale, title, ink);
    if (facts) render_image_text(whole, 2, title ? 2 + line : 2, scale, facts, pale);
    render_image_paste(whole, panel, 0, height);
    render_image_destroy(image);
    *image = whole;
    return GVC_OK;
}

gvc_result render_parts_text(render_parts *parts, size_t scale, const char *text,
                             gvc_error *error) {
    render_image *line;
    GVC_TRY(render_image_create(render_text_width(text, scale) + 4, LINE * scale / 2, white, &line,
                                error));
    render_image_text(line, 2, 2, scale, text, ink);
    return render_parts_add(parts, line, error);
}

static size_t key_width(const render_key *key) {
    return KEY_WIDTH + render_text_width(key->text, 2) + KEY_SPACE;
}

static void draw_key(render_image *image, size_t x, size_t y, const render_key *key) {
    if (key->stroke) {
        render_image_box(image, x + 2, y + 7, KEY_WIDTH - 8, 5, key->color);
    } else {
        render_image_disc(image, (double)x + 14, (double)y + 9.5, 8, key->color);
    }
    render_image_text(image, x + KEY_WIDTH, y + 1, 2, key->text, pale);
}

gvc_result render_parts_keys(render_parts *parts, const render_key *key, size_t count, size_t width,
                             gvc_error *error) {
    size_t rows = 1, x = 0;
    for (size_t i = 0; i < count; i++) {
        if (x > 0 && x + key_width(&key[i]) > width) rows++, x = 0;
        x += key_width(&key[i]);
    }
    render_image *image;
    if (rows == 1 && x > 0 && x < width) width = x;
    GVC_TRY(render_image_create(width, rows * LINE, white, &image, error));
    size_t y = 0;
    x = 0;
    for (size_t i = 0; i < count; i++) {
        if (x > 0 && x + key_width(&key[i]) > width) y += LINE, x = 0;
        draw_key(image, x, y, &key[i]);
        x += key_width(&key[i]);
    }
    return render_parts_add(parts, image, error);
}

const char *render_count(char text[32], uint64_t count) {
    char digits[32];
    size_t length = gvc_format_uint(digits, count), out = 0;
    for (size_t i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0) text[out++] = ',';
        text[out++] = digits[i];
    }
    text[out] = '\0';
    return text;
}

/* -------------------------------------------------------------------------------------- pixels */

/* Mean of the pixels that the rectangle from (left, top) to (right, bottom) covers. */
static render_color mean_color(const render_image *image, double left, double top, double right,
                               double bottom) {
    double sum[3] = {0, 0, 0}, area = 0;
    for (size_t y = (size_t)top; y < image->height && (double)y < bottom; y++) {
        double high = fmin((double)y + 1, bottom) - fmax((double)y, top);
        for (size_t x = (size_t)left; x < image->width && (double)x < right; x++) {
            double part = high * (fmin((double)x + 1, right) - fmax((double)x, left));
            render_color c = image->pixel[y * image->width + x];
            area += part;
            sum[0] += part * c.r;
            sum[1] += part * c.g;
            sum[2] += part * c.b;
        }
    }
    if (!(area > 0)) return white;
    return (render_color){(uint8_t)(sum[0] / area + 0.5), (uint8_t)(sum[1] / area + 0.5),
                          (uint8_t)(sum[2] / area + 0.5)};
}

gvc_result render_image_resize(const render_image *image, size_t width, size_t height,
                               render_image **resized, gvc_error *error) {
    GVC_TRY(render_image_create(width, height, white, resized, error));
    double wide = (double)image->width / (double)width;
    double high = (double)image->height / (double)height;
    for (size_t y = 0; y < height; y++) {
        for (size_t x = 0; x < width; x++) {
            (*resized)->pixel[y * width + x] =
                mean_color(image, wide * (double)x, high * (double)y, wide * (double)(x + 1),
                           high * (double)(y + 1));
        }
    }
    return GVC_OK;
}

static uint8_t mix(uint8_t below, uint8_t above, double cover) {
    return (uint8_t)(below + (above - below) * cover + 0.5);
}

void render_image_disc(render_image *image, double x, double y, double radius, render_color color) {
    for (double row = fmax(0, floor(y - radius - 1)); row <= y + radius + 1; row++) {
        for (double column = fmax(0, floor(x - radius - 1)); column <= x + radius + 1; column++) {
            if (row >= (double)image->height || column >= (double)image->width) continue;
            double cover = radius + 0.5 - hypot(column + 0.5 - x, row + 0.5 - y);
            if (cover <= 0) continue;
            if (cover > 1) cover = 1;
            render_color *pixel = &image->pixel[(size_t)row * image->width + (size_t)column];
            *pixel = (render_color){mix(pixel->r, color.r, cover), mix(pixel->g, color.g, cover),
                                    mix(pixel->b, color.b, cover)};
        }
    }
}
