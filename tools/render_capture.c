/* SPDX-License-Identifier: MIT */
/** @file render_capture.c  Geometry images of an opened .gvc file as panels. */
#include "render_capture.h"

#include "base/memory.h"
#include "base/result.h"
#include "file.h"
#include "render_figure.h"

#include <math.h>
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

gvc_result render_capture_keys(size_t width, render_parts *page, gvc_error *error) {
    const render_key key[] = {
        {render_node_color(GVC_NODE_ROOT), false, "root"},
        {render_node_color(GVC_NODE_EXTREMUM), false, "tip"},
        {render_node_color(GVC_NODE_JUNCTION), false, "junction"},
        {render_edge_color(0), true, "cut edge, on both sides"},
    };
    return render_parts_keys(page, key, sizeof key / sizeof *key, width, error);
}

/* -------------------------------------------------------------------------------------- colours */

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

/* ----------------------------------------------------------------------------------- the border */

/* Pixel of sample number `index` along a border of `size` samples: its centre, but the outer edge
 * of the rim for the first and the last. */
static double border_place(const render_image *image, uint32_t size, uint32_t index) {
    if (index == 0) return 0;
    if (index == size - 1) return (double)image->width;
    return RIM + ((double)index + 0.5) * (double)(image->width - 2 * RIM) / size;
}

/* Fills the rim beside `steps` border steps from `position` on. */
static void draw_side(render_image *image, uint32_t size, uint32_t position, uint32_t steps,
                      render_color color) {
    for (uint32_t i = 0; i < steps; i++) {
        uint32_t x[2], y[2];
        gvc_border_pixel(size, position + i, &x[0], &y[0]);
        gvc_border_pixel(size, position + i + 1, &x[1], &y[1]);
        bool level = y[0] == y[1];
        uint32_t a = level ? x[0] : y[0], b = level ? x[1] : y[1];
        size_t from = (size_t)border_place(image, size, a < b ? a : b);
        size_t length = (size_t)border_place(image, size, a < b ? b : a) - from;
        size_t far = image->width - RIM;
        if (level) {
            render_image_box(image, from, y[0] == 0 ? 0 : far, length, RIM, color);
        } else {
            render_image_box(image, x[0] == 0 ? 0 : far, from, RIM, length, color);
        }
    }
}

static void draw_node(render_image *image, uint32_t size, uint32_t position, render_color color) {
    const double middle = RIM / 2.0;
    uint32_t x, y;
    gvc_border_pixel(size, position, &x, &y);
    double px = fmax(border_place(image, size, x), middle);
    double py = fmax(border_place(image, size, y), middle);
    px = fmin(px, (double)image->width - middle);
    py = fmin(py, (double)image->width - middle);
    render_image_disc(image, px, py, DOT + 1, (render_color){255, 255, 255});
    render_image_disc(image, px, py, DOT, color);
}

static void draw_border(render_image *image, const gvc_chart_shape *chart) {
    const gvc_side_table *sides = &chart->sides;
    for (int nodes = 0; nodes < 2; nodes++) { /* on top of all sides */
        uint32_t position = sides->start;
        for (size_t i = 0; i < sides->side_count; i++) {
            gvc_side side = sides->side[i];
            uint32_t node = chart->edge[side.edge].node[side.reversed ? 1 : 0];
            if (nodes) {
                draw_node(image, sides->size, position,
                          render_node_color((gvc_node_kind)chart->node[node].kind));
            } else {
                draw_side(image, sides->size, position, sides->steps[side.edge],
                          render_edge_color(side.edge));
            }
            position += sides->steps[side.edge];
        }
    }
}

static gvc_result frame_shape(const render_capture *capture, uint64_t frame, gvc_shape *shape,
                              gvc_error *error) {
    size_t fragment;
    GVC_TRY(gvc_reader_find(capture->reader, frame, &fragment, error));
    return gvc_reader_shape(capture->reader, fragment, shape, error);
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
