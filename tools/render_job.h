/* SPDX-License-Identifier: MIT */
/** @file render_job.h  What `gvc render` was asked for, and what its three kinds of picture share.
 */
#ifndef GVC_TOOLS_RENDER_JOB_H
#define GVC_TOOLS_RENDER_JOB_H

#include "cli.h"
#include "frames.h"
#include "render.h"
#include "render_page.h"

#define RENDER_MOST_FRAMES 100 /**< of one picture */
#define RENDER_GAP 14u         /**< between panels, in pixels */

typedef struct render_job {
    const char *output, *frames; /**< `frames` as typed, or NULL */
    char *const *input;          /**< frames, or a .gvc file and what follows --against */
    int input_count;
    size_t size; /**< longer side of a panel, in pixels */
    render_view view;
    unsigned threads;
    bool against, no_graph, ambiguity, weld, any_order, force, quiet;
    uint64_t frame[RENDER_MOST_FRAMES]; /**< to be shown, ascending; see render_job_choose */
    size_t frame_count;
} render_job;

/** Fills job->frame from --frames or, without, with up to `usual` frames spread over all `count`.
 * EXIT_DONE, or EXIT_USAGE with a message. */
int render_job_choose(render_job *job, uint64_t count, size_t usual);

/** How surfaces are seen: every one in the middle of its panel, all at one scale. */
typedef struct render_sight {
    size_t width, height;                        /**< of a panel */
    render_camera camera[2][RENDER_MOST_FRAMES]; /**< front and back, one per frame of the job */
} render_sight;

/** Fits panels and cameras to job->frame_count meshes. */
gvc_result render_sight_fit(const render_job *job, gvc_mesh *const *mesh, render_sight *sight,
                            gvc_error *error);

/** Reads the frames of the job, cleaned for drawing; `mesh` has room for all and is freed with
 * render_meshes_free, also after a failure. */
gvc_result render_meshes_read(const render_job *job, const gvc_source *source, gvc_mesh **mesh,
                              gvc_error *error);
void render_meshes_free(gvc_mesh **mesh, size_t count);

/** Appends a line with the scale of render_heat_color between two texts. */
gvc_result render_job_legend(const char *low, const char *high, size_t width, render_parts *page,
                             gvc_error *error);

/* The three kinds of picture. GVC_OK and a picture, or an error; `status` is EXIT_USAGE after
 * a message about --frames. */
int render_surfaces(render_job *job, render_image **image);
int render_images(render_job *job, render_image **image);
int render_against(render_job *job, render_image **image);

#endif
