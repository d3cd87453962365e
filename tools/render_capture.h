/* SPDX-License-Identifier: MIT */
/** @file render_capture.h  Geometry images of an opened .gvc file as panels. */
#ifndef GVC_TOOLS_RENDER_CAPTURE_H
#define GVC_TOOLS_RENDER_CAPTURE_H

#include "render_job.h"

typedef struct render_capture {
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_info info;
    uint16_t low[3], high[3]; /**< codes shown as dark and as bright, one scale for all frames */
} render_capture;

/** Opens the file; EXIT_DONE, or a status after a message. Free with render_capture_close. */
int render_capture_open(const char *path, render_capture *capture);
void render_capture_close(render_capture *capture);

/** Finds the range of codes of the frames of a job, for the colours. */
gvc_result render_capture_scale(render_capture *capture, const render_job *job, gvc_error *error);

/** The geometry image of a frame's first chart, x, y, z as red, green, blue, `side` pixels wide
 * with a thin frame in the colours of the cut edges whose sides lie there; dots mark root, tips and
 * junctions. `*size` is the number of samples a side. */
gvc_result render_capture_image(render_capture *capture, uint64_t frame, size_t side,
                                render_image **image, uint32_t *size, gvc_error *error);

/** "capture.gvc: 30 frames, 38,205 bytes, 1,273 a frame", appended as a line of text. */
gvc_result render_capture_headline(const render_capture *capture, const char *path,
                                   render_parts *page, gvc_error *error);

/** What the dots and strokes around geometry images stand for, appended. */
gvc_result render_capture_keys(size_t width, render_parts *page, gvc_error *error);

#endif
