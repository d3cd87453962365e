/* SPDX-License-Identifier: MIT */
/** @file render_images.c  gvc render capture.gvc: a contact sheet of geometry images. */
#include "render_capture.h"

#include "base/result.h"

#define COLUMNS 5 /* images side by side */

static gvc_result add_image(const render_job *job, render_capture *capture, uint64_t frame,
                            render_parts *row, gvc_error *error) {
    gvc_frame_info facts;
    render_image *panel;
    uint32_t size;
    char title[48], text[48], bytes[32];
    GVC_TRY(gvc_reader_frame_info(capture->reader, frame, &facts, error));
    GVC_TRY(render_capture_image(capture, frame, job->size, &panel, &size, error));
    snprintf(title, sizeof title, "frame %llu", (unsigned long long)frame);
    snprintf(text, sizeof text, "%u x %u, %s bytes", size, size,
             render_count(bytes, facts.byte_count));
    gvc_result result = render_caption(&panel, title, text, error);
    if (result != GVC_OK) {
        render_image_destroy(&panel);
        return result;
    }
    return render_parts_add(row, panel, error);
}

static gvc_result add_images(const render_job *job, render_capture *capture, render_parts *page,
                             gvc_error *error) {
    render_parts row = {0};
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < job->frame_count && result == GVC_OK; i++) {
        if (cli_interrupted()) {
            result = gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
            break;
        }
        result = add_image(job, capture, job->frame[i], &row, error);
        bool full = row.count == COLUMNS || i + 1 == job->frame_count;
        if (result == GVC_OK && full) {
            result = render_parts_move_row(&row, RENDER_GAP, page, error);
        }
    }
    render_parts_free(&row);
    return result;
}

static gvc_result draw(const render_job *job, render_capture *capture, render_image **image,
                       gvc_error *error) {
    render_parts page = {0};
    gvc_result result = render_capture_headline(capture, job->input[0], &page, error);
    if (result == GVC_OK) {
        result = render_parts_text(&page, 2, "geometry images: x, y, z as red, green, blue", error);
    }
    if (result == GVC_OK) result = render_capture_scale(capture, job, error);
    if (result == GVC_OK) result = add_images(job, capture, &page, error);
    if (result == GVC_OK) {
        result = render_capture_keys(page.image[page.count - 1]->width, &page, error);
    }
    if (result == GVC_OK) result = render_parts_page(&page, RENDER_GAP, image, error);
    render_parts_free(&page);
    return result;
}

int render_images(render_job *job, render_image **image) {
    render_capture capture;
    gvc_error error;
    gvc_error_init(&error);
    int status = render_capture_open(job->input[0], &capture);
    if (status != EXIT_DONE) return status;
    status = render_job_choose(job, capture.info.frame_count, COLUMNS);
    if (status == EXIT_DONE && draw(job, &capture, image, &error) != GVC_OK) {
        status = cli_fail("render", job->input[0], &error);
    }
    render_capture_close(&capture);
    return status;
}
