/* SPDX-License-Identifier: MIT */
/** @file render_job.c  Which frames a picture shows, and from where. */
#include "render_job.h"

#include "base/result.h"
#include "mesh/mesh.h"
#include "render_figure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------- choice of frames */

static int too_many(void) {
    return cli_usage("render", "a picture shows %d frames at most", RENDER_MOST_FRAMES);
}

static bool add_frame(render_job *job, uint64_t frame) {
    size_t place = job->frame_count;
    while (place > 0 && job->frame[place - 1] >= frame) place--;
    if (place < job->frame_count && job->frame[place] == frame) return true;
    if (job->frame_count == RENDER_MOST_FRAMES) return false;
    memmove(&job->frame[place + 1], &job->frame[place],
            (job->frame_count - place) * sizeof *job->frame);
    job->frame[place] = frame;
    job->frame_count++;
    return true;
}

/* "7", "3-9", "3-", each with "/10" for every tenth. */
static int add_range(render_job *job, const char *text, size_t length, uint64_t count) {
    char range[64];
    uint64_t first, last, step = 1;
    bool good = length < sizeof range;
    if (good) {
        memcpy(range, text, length);
        range[length] = '\0';
        char *slash = strchr(range, '/');
        if (slash) {
            *slash = '\0';
            good = cli_uint(slash + 1, 1, INT64_MAX, &step);
        }
    }
    if (!good || !cli_range(range, count, &first, &last)) {
        return cli_usage("render", "'%.*s' is not a range of frames 0-%llu", (int)length, text,
                         (unsigned long long)(count - 1));
    }
    for (uint64_t frame = first;; frame += step) {
        if (!add_frame(job, frame)) return too_many();
        if (last - frame < step) return EXIT_DONE;
    }
}

int render_job_choose(render_job *job, uint64_t count, size_t usual) {
    job->frame_count = 0;
    if (!job->frames) {
        size_t shown = count < usual ? (size_t)count : usual;
        for (size_t i = 0; i < shown; i++) {
            job->frame[job->frame_count++] = shown > 1 ? (count - 1) * i / (shown - 1) : 0;
        }
        return EXIT_DONE;
    }
    const char *text = job->frames;
    for (;;) {
        size_t length = strcspn(text, ",");
        int status = add_range(job, text, length, count);
        if (status != EXIT_DONE) return status;
        if (text[length] == '\0') return EXIT_DONE;
        text += length + 1;
    }
}

/* -------------------------------------------------------------------------------------- meshes */

void render_meshes_free(gvc_mesh **mesh, size_t count) {
    for (size_t i = 0; i < count; i++) gvc_mesh_destroy(&mesh[i]);
}

gvc_result render_meshes_read(const render_job *job, const gvc_source *source, gvc_mesh **mesh,
                              gvc_error *error) {
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < job->frame_count; i++) mesh[i] = NULL;
    for (size_t i = 0; i < job->frame_count && result == GVC_OK; i++) {
        gvc_mesh *given = NULL;
        size_t welded;
        result = source->read(source->user, job->frame[i], &given, error);
        if (result == GVC_OK) result = gvc_mesh_clean(given, job->weld, &mesh[i], &welded, error);
        gvc_mesh_destroy(&given);
        result = gvc_at_frame(error, result, (int64_t)job->frame[i]);
    }
    return result;
}

/* --------------------------------------------------------------------------------------- sight */

/* A panel as wide and high as the widest and highest of the meshes ask for, but not too slim. */
static gvc_result fit_panel(const render_job *job, gvc_mesh *const *mesh, render_sight *sight,
                            gvc_error *error) {
    const double least = 0.6;
    double wide = 0, high = 0;
    for (size_t i = 0; i < job->frame_count; i++) {
        double half[2];
        const gvc_mesh *one = mesh[i];
        GVC_TRY(render_view_extent(&one, 1, &job->view, half, error));
        wide = fmax(wide, half[0]);
        high = fmax(high, half[1]);
    }
    double shape = high > 0 ? wide / high : 1 / least;
    shape = fmin(fmax(shape, least), 1 / least);
    double size = (double)job->size;
    sight->width = (size_t)lround(shape < 1 ? size * shape : size);
    sight->height = (size_t)lround(shape < 1 ? size : size / shape);
    return GVC_OK;
}

gvc_result render_sight_fit(const render_job *job, gvc_mesh *const *mesh, render_sight *sight,
                            gvc_error *error) {
    double half_height = 0, distance = 0;
    GVC_TRY(fit_panel(job, mesh, sight, error));
    for (size_t side = 0; side < 2; side++) {
        render_view view = job->view;
        view.yaw += side ? 180 : 0;
        for (size_t i = 0; i < job->frame_count; i++) {
            const gvc_mesh *one = mesh[i];
            render_camera *camera = &sight->camera[side][i];
            GVC_TRY(render_camera_fit(&one, 1, &view, sight->width, sight->height, camera, error));
            half_height = fmax(half_height, camera->half_height);
            distance = fmax(distance, camera->distance);
        }
    }
    for (size_t side = 0; side < 2; side++) {
        for (size_t i = 0; i < job->frame_count; i++) {
            sight->camera[side][i].half_height = half_height;
            sight->camera[side][i].distance = distance;
        }
    }
    return GVC_OK;
}

gvc_result render_job_legend(const char *low, const char *high, size_t width, render_parts *page,
                             gvc_error *error) {
    const render_color white = {255, 255, 255};
    render_image *image;
    GVC_TRY(render_image_create(width, 48, white, &image, error));
    render_heat_legend(image, low, high);
    return render_parts_add(page, image, error);
}
