/* SPDX-License-Identifier: MIT */
/** @file render_page.h  Puts panels, captions and lines of text together to one picture. */
#ifndef GVC_TOOLS_RENDER_PAGE_H
#define GVC_TOOLS_RENDER_PAGE_H

#include "render_image.h"

/** Pictures that will stand side by side or one above another. Zero-initialise; free with
 * render_parts_free. */
typedef struct render_parts {
    render_image **image;
    size_t count, capacity;
} render_parts;

/** Takes `image` over, also when it fails. */
gvc_result render_parts_add(render_parts *parts, render_image *image, gvc_error *error);
void render_parts_free(render_parts *parts);

/** Joins the parts, `gap` apart, on a white ground: in a row, aligned at their lower edges.
 * GVC_ERROR_ARGUMENT if there are none. */
gvc_result render_parts_row(const render_parts *parts, size_t gap, render_image **image,
                            gvc_error *error);
/** The same in a column, aligned at the left, with a margin of `gap` around: the whole page. */
gvc_result render_parts_page(const render_parts *parts, size_t gap, render_image **image,
                             gvc_error *error);
/** A row, appended to `into`; `parts` is emptied. */
gvc_result render_parts_move_row(render_parts *parts, size_t gap, render_parts *into,
                                 gvc_error *error);

/** Gives a panel a caption above it: what it is, and in a lighter ink the facts. Replaces `*image`;
 * `title` and `facts` may be NULL. */
gvc_result render_caption(render_image **image, const char *title, const char *facts,
                          gvc_error *error);

/** Appends a line of text. */
gvc_result render_parts_text(render_parts *parts, size_t scale, const char *text, gvc_error *error);

/** What a coloured dot or stroke stands for. */
typedef struct render_key {
    render_color color;
    bool stroke; /**< else a dot */
    char text[40];
} render_key;

/** Appends a line of keys, in as many rows as `width` asks for. */
gvc_result render_parts_keys(render_parts *parts, const render_key *key, size_t count, size_t width,
                             gvc_error *error);

/** `image` at another size: every pixel the mean of what it covers. */
gvc_result render_image_resize(const render_image *image, size_t width, size_t height,
                               render_image **resized, gvc_error *error);

/** A filled circle with soft edges. */
void render_image_disc(render_image *image, double x, double y, double radius, render_color color);

/** Digits in groups of three: "12,345". `text` has room for 32 bytes. */
const char *render_count(char text[32], uint64_t count);

#endif
