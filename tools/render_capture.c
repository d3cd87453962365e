/* SPDX-License-Identifier: MIT */
/** @file render_capture.c  Geometry images of an opened .gvc file as panels. */
#include "render_capture.h"

#include "base/memory.h"
#include "base/result.h"
#include "file.h"
#include "render_figure.h"

#include <stdlib.h>
#include <string.h>

#define RIM 7u /* width of the frame around an image, in pixels */
#define DOT 5.0

int render_capture_open(const char *path, render_capture *capture) {
    gvc_error error;
    gvc_error_init(&error);
    *capture = (render_capture){0};
    if (gvc_reader_open_file(path, NULL, &capture->reader, &error) != GVC_OK ||
        gvc_decoder_create(capture->reader, &capture->decoder, &error) != GVC_OK) {
        render_capture_close(capture);
        return cli_fail("render", path, &error);
    }
    gvc_reader_info(capture->reader, &capture->info);
    if (capture->info.frame_count > 0) return EXIT_DONE;
    render_capture_close(capture);
    fprintf(stderr, "gvc render: %s: the file holds no frames\n", path);
    return EXIT_DATA;
}

void render_capture_close(render_capture *capture) {
    gvc_decoder_destroy(&capture->decoder);
    gvc_reader_close(&capture->reader);
}

gvc_result render_capture_headline(const render_capture *capture, const char *path,
                                   render_parts *page, gvc_error *error) {
    const gvc_info *info = &capture->info;
    const char *slash = strrchr(path, '/');
    char text[200], frames[32], bytes[32], each[32];
    snprintf(text, sizeof text, "%.60s: %s frames, %s bytes, %s a frame", slash ? slash + 1 : path,
             render_count(frames, info->frame_count), render_count(bytes, info->byte_count),
             render_count(each, info->byte_count / info->frame_count));
    return render_parts_text(page, 2, text, error);
}

/* -------------------------------------------------------------------------------------- colours
 */

gvc_result render_capture_scale(render_capture *capture, const render_job *job, gvc_error *error) {
    for (size_t p = 0; p < 3; p++) capture->low[p] = UINT16_MAX, capture->high[p] = 0;
    for (size_t f = 0; f < job->frame_count; f++) {
        const uint16_t *plane;
        uint32_t size;
        if (cli_interrupted()) return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        GVC_TRY(gvc_decoder_codes(capture->decoder, job->frame[f], 0, &plane, &size, error));
        size_t count = (size_t)size * size;
        for (size_t i = 0; i < 3 * count; i++) {
            size_t p = i / count;
            if (plane[i] < capture->low[p]) capture->low[p] = plane[i];
            if (plane[i] > capture->high[p]) capture->high[p] = plane[i];
        }
    }
    return GVC_OK;
}

/* The codes' range stretched to all of 16 bits. */
static gvc_result stretched_image(const render_capture *capture, const uint16_t *plane,
                                  uint32_t size, render_image **image, gvc_error *error) {
    size_t count = (size_t)size * size;
    uint16_t *code = gvc_alloc(3 * count, sizeof *code);
    if (!code) return gvc_fail_memory(error);
    for (size_t i = 0; i < 3 * count; i++) {
        unsigned low = capture->low[i / count], high = capture->high[i / count];
        unsigned above = plane[i] > low ? plane[i] - low : 0;
        if (above > high - low) above = high - low;
        code[i] = (uint16_t)(high > low ? (uint64_t)above * UINT16_MAX / (high - low) : 0);
    }
    gvc_result result = render_geometry_image(code, size, UINT16_MAX, 1, image, error);
    free(code);
    return result;
}

/* ------------------------------------------------------------------------------------ the border
 */

/* The square that the samples' centres of a border span, in pixels of the panel. */
typedef struct border_square {
    double low, step; /* pixel of sample 0, and pixels from sample to sample */
    uint32_t size;
} border_square;

/* Fills the rim beside `steps` border steps from `position` on. */
static void draw_side(render_image *image, const border_square *square, uint32_t position,
                      uint32_t steps, render_color color) {
    for (uint32_t i = 0; i < steps; i++) {
        uint32_t x0, y0, x1, y1;
        gvc_border_pixel(square->size, position + i, &x0, &y0);
        gvc_border_pixel(square->size, position + i + 1, &x1, &y1);
        uint32_t left = x0 < x1 ? x0 : x1, top = y0 < y1 ? y0 : y1;
        size_t from_x = (size_t)(square->low + square->step * left);
        size_t from_y = (size_t)(square->low + square->step * top);
        size_t length = (size_t)square->step + 2;
        if (y0 == y1) {
            render_image_box(image, from_x, y0 == 0 ? 0 : image->height - RIM, length, RIM, color);
        } else {
            render_image_box(image, x0 == 0 ? 0 : image->width - RIM, from_y, RIM, length, color);
        }
    }
}

static void draw_node(render_image *image, const border_square *square, uint32_t position,
                      render_color color) {
    uint32_t x, y;
    gvc_border_pixel(square->size, position, &x, &y);
    uint32_t last = square->size - 1;
    double middle = RIM / 2.0, end = (double)image->width - middle;
    double px = x == 0 ? middle : x == last ? end : square->low + square->step * x;
    double py = y == 0 ? middle : y == last ? end : square->low + square->step * y;
    render_image_disc(image, px, py, DOT + 1, (render_color){255, 255, 255});
    render_image_disc(image, px, py, DOT, color);
}

static void draw_border(render_image *image, const gvc_chart_shape *chart) {
    const gvc_side_table *sides = &chart->sides;
    double step = (double)(image->width - 2 * RIM) / sides->size;
    border_square square = {.low = RIM + step / 2, .step = step, .size = sides->size};
    for (int nodes = 0; nodes < 2; nodes++) { /* on top of all sides */
        uint32_t position = sides->start;
        for (size_t i = 0; i < sides->side_count; i++) {
            gvc_side side = sides->side[i];
            uint32_t node = chart->edge[side.edge].node[side.reversed ? 1 : 0];
            if (nodes) {
                draw_node(image, &square, position,
                          render_node_color((gvc_node_kind)chart->node[node].kind));
            } else {
                draw_side(image, &square, position, sides->steps[side.edge],
                          render_edge_color(side.edge));
            }
            position += sides->steps[side.edge];
        }
    }
}

static gvc_result frame_shape(const render_capture *capture, uint64_t frame, gvc_shape *shape,
                              gvc_error *error) {
    gvc_shape_frame facts;
    size_t fragment;
    uint64_t owner;
    GVC_TRY(gvc_reader_find(capture->reader, frame, &fragment, error));
    return gvc_reader_shape(capture->reader, fragment, frame, shape, &facts, &owner, error);
}

gvc_result render_capture_image(render_capture *capture, uint64_t frame, size_t side,
                                render_image **image, uint32_t *size, gvc_error *error) {
    const uint16_t *plane;
    gvc_shape shape = {0};
    render_image *samples = NULL, *inner = NULL;
    *image = NULL;
    gvc_result result = frame_shape(capture, frame, &shape, error);
    if (result == GVC_OK) {
        result = gvc_decoder_codes(capture->decoder, frame, 0, &plane, size, error);
    }
    if (result == GVC_OK) result = stretched_image(capture, plane, *size, &samples, error);
    if (result == GVC_OK) {
        result = render_image_resize(samples, side - 2 * RIM, side - 2 * RIM, &inner, error);
    }
    if (result == GVC_OK) {
        result = render_image_create(side, side, (render_color){255, 255, 255}, image, error);
    }
    if (result == GVC_OK) {
        render_image_paste(*image, inner, RIM, RIM);
        draw_border(*image, &shape.chart[0]);
    }
    render_image_destroy(&samples);
    render_image_destroy(&inner);
    gvc_shape_free(&shape);
    return result;
}
