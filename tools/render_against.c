/* SPDX-License-Identifier: MIT */
/** @file render_against.c  gvc render capture.gvc --against FRAMES: captured and decoded frames
 * side by side. */
#include "render_capture.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "render_figure.h"

#include <math.h>
#include <stdlib.h>

#define ROWS 3u
/* The heat map's last colour stands for about so many times the greatest RMS distance. */
#define SCALE_OF_RMS 3.0

typedef struct versus {
    render_job *job;
    gvc_source source;
    render_capture capture;
    gvc_mesh *original[RENDER_MOST_FRAMES], *decoded[RENDER_MOST_FRAMES];
    double rms[RENDER_MOST_FRAMES]; /* share of the frame's diagonal */
    double full_scale;              /* of the heat map, share of the diagonal */
    render_sight sight;
} versus;

/* ------------------------------------------------------------------------------------ measuring */

/* 1, 2 or 5 times a power of ten, not below `value`. */
static double round_scale(double value) {
    if (!(value > 0)) return 1e-6;
    double unit = pow(10, floor(log10(value)));
    double digits = value / unit;
    return unit * (digits <= 1 ? 1 : digits <= 2 ? 2 : digits <= 5 ? 5 : 10);
}

static gvc_result measure(versus *v, size_t i, gvc_error *error) {
    gvc_distance distance;
    GVC_TRY(gvc_decoder_frame(v->capture.decoder, v->job->frame[i], &v->decoded[i], error));
    gvc_result result = gvc_mesh_distance(v->original[i], v->decoded[i], 0, &distance, error);
    if (result == GVC_OK) {
        v->rms[i] = fmax(distance.rms[0], distance.rms[1]) / distance.diagonal;
        v->full_scale = fmax(v->full_scale, SCALE_OF_RMS * v->rms[i]);
    }
    return gvc_at_frame(error, result, (int64_t)v->job->frame[i]);
}

static gvc_result prepare(versus *v, gvc_error *error) {
    GVC_TRY(render_meshes_read(v->job, &v->source, v->original, error));
    for (size_t i = 0; i < v->job->frame_count; i++) {
        if (cli_interrupted()) return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        GVC_TRY(measure(v, i, error));
    }
    v->full_scale = round_scale(v->full_scale);
    GVC_TRY(render_capture_scale(&v->capture, v->job, error));
    return render_sight_fit(v->job, v->original, &v->sight, error);
}

/* -------------------------------------------------------------------------------------- panels */

typedef enum panel_kind { PANEL_ORIGINAL, PANEL_DECODED, PANEL_DISTANCE, PANEL_IMAGE } panel_kind;

static gvc_result draw_surface(const versus *v, size_t i, panel_kind kind, render_image **image,
                               gvc_error *error) {
    render_canvas *canvas;
    render_style style;
    render_style_init(&style);
    *image = NULL;
    GVC_TRY(render_canvas_create(v->sight.width, v->sight.height, &v->sight.camera[0][i], &canvas,
                                 error));
    gvc_result result =
        kind == PANEL_DISTANCE
            ? render_distance_map(canvas, v->decoded[i], v->original[i],
                                  v->full_scale * gvc_mesh_diagonal(v->original[i]), error)
            : render_canvas_mesh(canvas, kind == PANEL_ORIGINAL ? v->original[i] : v->decoded[i],
                                 &style, error);
    if (result == GVC_OK) result = render_canvas_finish(canvas, image, error);
    render_canvas_destroy(&canvas);
    return result;
}

/* What stands above a panel; `size` is that of the geometry image. */
static gvc_result describe(const versus *v, size_t i, panel_kind kind, uint32_t size,
                           char title[64], char facts[64], gvc_error *error) {
    gvc_frame_info info;
    char number[32];
    switch (kind) {
    case PANEL_ORIGINAL:
        snprintf(title, 64, "frame %llu, captured", (unsigned long long)v->job->frame[i]);
        snprintf(facts, 64, "%s triangles", render_count(number, v->original[i]->face_count));
        break;
    case PANEL_DECODED:
        GVC_TRY(gvc_reader_frame_info(v->capture.reader, v->job->frame[i], &info, error));
        snprintf(title, 64, info.keyframe ? "decoded keyframe" : "decoded");
        snprintf(facts, 64, "from %s bytes", render_count(number, info.byte_count));
        break;
    case PANEL_DISTANCE:
        snprintf(title, 64, "distance to the capture");
        snprintf(facts, 64, "RMS %.3g%% of diagonal", 100 * v->rms[i]);
        break;
    case PANEL_IMAGE:
        snprintf(title, 64, "geometry image");
        snprintf(facts, 64, "%u x %u points as colours", size, size);
        break;
    }
    return GVC_OK;
}

static gvc_result add_panel(versus *v, size_t i, panel_kind kind, render_parts *row,
                            gvc_error *error) {
    render_image *panel;
    uint32_t size = 0;
    char title[64], facts[64];
    GVC_TRY(kind == PANEL_IMAGE ? render_capture_image(&v->capture, v->job->frame[i],
                                                       v->sight.height, &panel, &size, error)
                                : draw_surface(v, i, kind, &panel, error));
    gvc_result result = describe(v, i, kind, size, title, facts, error);
    if (result == GVC_OK) result = render_caption(&panel, title, facts, error);
    if (result != GVC_OK) {
        render_image_destroy(&panel);
        return result;
    }
    return render_parts_add(row, panel, error);
}

static gvc_result add_row(versus *v, size_t i, render_parts *page, gvc_error *error) {
    render_parts row = {0};
    gvc_result result = GVC_OK;
    for (panel_kind kind = PANEL_ORIGINAL; kind <= PANEL_IMAGE && result == GVC_OK; kind++) {
        result = add_panel(v, i, kind, &row, error);
    }
    if (result == GVC_OK) result = render_parts_move_row(&row, RENDER_GAP, page, error);
    render_parts_free(&row);
    return result;
}

/* ---------------------------------------------------------------------------------------- page */

static gvc_result add_legend(const versus *v, size_t width, render_parts *page, gvc_error *error) {
    char most[64];
    snprintf(most, sizeof most, " %.3g%% of the bounding box's diagonal, or more",
             100 * v->full_scale);
    return render_job_legend("distance: 0 ", most, width, page, error);
}

static gvc_result draw(versus *v, render_image **image, gvc_error *error) {
    render_parts page = {0};
    gvc_result result = prepare(v, error);
    if (result == GVC_OK) {
        result = render_capture_headline(&v->capture, v->job->input[0], &page, error);
    }
    for (size_t i = 0; i < v->job->frame_count && result == GVC_OK; i++) {
        result = add_row(v, i, &page, error);
        if (result == GVC_OK && cli_interrupted()) {
            result = gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        }
    }
    if (result == GVC_OK) result = add_legend(v, page.image[1]->width, &page, error);
    if (result == GVC_OK) result = render_capture_keys(page.image[1]->width, &page, error);
    if (result == GVC_OK) result = render_parts_page(&page, RENDER_GAP, image, error);
    render_parts_free(&page);
    return result;
}

/* With the file open. */
static int run(versus *v, render_image **image) {
    frame_list list;
    gvc_error error;
    gvc_error_init(&error);
    render_job *job = v->job;
    if (frame_list_make(job->input + 1, job->input_count - 1, job->any_order, &list, &error) !=
        GVC_OK) {
        return cli_fail("render", NULL, &error);
    }
    v->source = frame_list_source(&list);
    int status = EXIT_DATA;
    if (v->source.frame_count != v->capture.info.frame_count) {
        fprintf(stderr, "gvc render: %s: the file has %llu frames, the capture %llu\n",
                job->input[0], (unsigned long long)v->capture.info.frame_count,
                (unsigned long long)v->source.frame_count);
    } else {
        status = render_job_choose(job, v->source.frame_count, ROWS);
        if (status == EXIT_DONE && draw(v, image, &error) != GVC_OK) {
            status = cli_fail("render", job->input[0], &error);
        }
    }
    frame_list_free(&list);
    return status;
}

int render_against(render_job *job, render_image **image) {
    gvc_error error;
    gvc_error_init(&error);
    versus *v = gvc_alloc(1, sizeof *v);
    if (!v) {
        (void)gvc_fail_memory(&error);
        return cli_fail("render", NULL, &error);
    }
    v->job = job;
    int status = render_capture_open(job->input[0], &v->capture);
    if (status == EXIT_DONE) status = run(v, image);
    render_capture_close(&v->capture);
    render_meshes_free(v->original, RENDER_MOST_FRAMES);
    render_meshes_free(v->decoded, RENDER_MOST_FRAMES);
    free(v);
    return status;
}
