/* SPDX-License-Identifier: MIT */
/** @file render.c  Camera, canvas, and how samples become pixels. */
#include "render.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "render_canvas.h"

#include <stdlib.h>

#define RADIANS 0.017453292519943295
#define MARGIN 1.06

/* -------------------------------------------------------------------------------------- camera */

void render_view_init(render_view *view) {
    *view = (render_view){.up = RENDER_UP_Y, .yaw = 25, .pitch = 8, .zoom = 1};
}

/* The object's own axes: up, and the front it shows at yaw 0. Cyclic, so right-handed. */
static frame3 object_axes(unsigned up) {
    static const frame3 axes[3] = {{{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                   {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
    return axes[up];
}

static void union_of_bounds(const gvc_mesh *const *mesh, size_t count, double low[3],
                            double high[3]) {
    for (int a = 0; a < 3; a++) low[a] = INFINITY, high[a] = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        for (size_t v = 0; v < mesh[i]->vertex_count; v++) {
            for (int a = 0; a < 3; a++) {
                low[a] = fmin(low[a], mesh[i]->position[3 * v + a]);
                high[a] = fmax(high[a], mesh[i]->position[3 * v + a]);
            }
        }
    }
}

/* The box around the vertices in the view's axes: its centre and half its size. */
typedef struct view_box {
    frame3 axes;
    vec3 centre, half;
} view_box;

static gvc_result find_box(const gvc_mesh *const *mesh, size_t count, const render_view *view,
                           view_box *box, gvc_error *error) {
    double least[3], most[3];
    union_of_bounds(mesh, count, least, most);
    if (!(least[0] <= most[0])) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is nothing to show");
    }
    unsigned up = (unsigned)view->up;
    if (up > 2) {
        up = 0;
        for (unsigned a = 1; a < 3; a++) {
            if (most[a] - least[a] > most[up] - least[up]) up = a;
        }
    }
    frame3 axes = frame3_turn_y(object_axes(up), -view->yaw * RADIANS);
    box->axes = axes = frame3_turn_x(axes, -view->pitch * RADIANS);
    vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        for (size_t v = 0; v < mesh[i]->vertex_count; v++) {
            vec3 p = frame3_coordinates(&axes, vec3_load(&mesh[i]->position[3 * v]));
            low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
    }
    box->centre = frame3_apply(&axes, vec3_scale(vec3_add(low, high), 0.5));
    box->half = vec3_scale(vec3_sub(high, low), 0.5);
    return GVC_OK;
}

gvc_result render_view_extent(const gvc_mesh *const *mesh, size_t count, const render_view *view,
                              double half[2], gvc_error *error) {
    view_box box;
    GVC_TRY(find_box(mesh, count, view, &box, error));
    half[0] = box.half.x;
    half[1] = box.half.y;
    return GVC_OK;
}

gvc_result render_camera_fit(const gvc_mesh *const *mesh, size_t count, const render_view *view,
                             size_t width, size_t height, render_camera *camera, gvc_error *error) {
    view_box box;
    if (!width || !height || !(view->zoom > 0)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is nothing to show");
    }
    GVC_TRY(find_box(mesh, count, view, &box, error));
    camera->axes = box.axes;
    camera->centre = box.centre;
    camera->half_height = fmax(box.half.y, box.half.x * (double)height / (double)width);
    if (!(camera->half_height > 0)) camera->half_height = box.half.z > 0 ? box.half.z : 1;
    camera->distance = 8 * fmax(camera->half_height, box.half.z);
    /* What is nearer than the centre looks larger. */
    camera->half_height *= MARGIN * camera->distance / (camera->distance - box.half.z);
    camera->half_height /= view->zoom;
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- canvas */

gvc_result render_canvas_create(size_t width, size_t height, const render_camera *camera,
                                render_canvas **canvas, gvc_error *error) {
    *canvas = NULL;
    if (!width || !height || width > 16384 || height > 16384) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a picture of %zu x %zu pixels is not possible",
                        width, height);
    }
    render_canvas *c = gvc_alloc(1, sizeof *c);
    if (!c) return gvc_fail_memory(error);
    c->width = width;
    c->height = height;
    c->columns = RENDER_SAMPLES * width;
    c->rows = RENDER_SAMPLES * height;
    c->camera = *camera;
    c->depth = gvc_alloc(c->columns * c->rows, sizeof *c->depth);
    c->color = gvc_alloc(c->columns * c->rows, sizeof *c->color);
    if (!c->depth || !c->color) {
        render_canvas_destroy(&c);
        return gvc_fail_memory(error);
    }
    const vec3 top = render_linear((render_color){246, 247, 249});
    const vec3 bottom = render_linear((render_color){214, 218, 224});
    for (size_t y = 0; y < c->rows; y++) {
        double t = (double)y / (double)c->rows;
        vec3 shade = vec3_add(vec3_scale(top, 1 - t), vec3_scale(bottom, t));
        for (size_t i = y * c->columns; i < (y + 1) * c->columns; i++) {
            c->depth[i] = -INFINITY;
            c->color[i][0] = (float)shade.x;
            c->color[i][1] = (float)shade.y;
            c->color[i][2] = (float)shade.z;
        }
    }
    *canvas = c;
    return GVC_OK;
}

void render_canvas_destroy(render_canvas **canvas) {
    if (!canvas || !*canvas) return;
    free((*canvas)->depth);
    free((*canvas)->color);
    free(*canvas);
    *canvas = NULL;
}

render_point render_project(const render_canvas *canvas, vec3 position) {
    const render_camera *camera = &canvas->camera;
    vec3 p = frame3_coordinates(&camera->axes, vec3_sub(position, camera->centre));
    double away = camera->distance - p.z;
    if (away < camera->distance * 1e-3) away = camera->distance * 1e-3; /* behind the eye */
    double scale = (double)canvas->rows / (2 * camera->half_height) * camera->distance / away;
    return (render_point){(double)canvas->columns / 2 + scale * p.x,
                          (double)canvas->rows / 2 - scale * p.y, p.z};
}

static double linear_channel(uint8_t value) {
    double v = value / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

vec3 render_linear(render_color color) {
    return vec3_make(linear_channel(color.r), linear_channel(color.g), linear_channel(color.b));
}

static uint8_t srgb_channel(double v) {
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
    return (uint8_t)(255 * v + 0.5);
}

gvc_result render_canvas_finish(const render_canvas *canvas, render_image **image,
                                gvc_error *error) {
    GVC_TRY(
        render_image_create(canvas->width, canvas->height, (render_color){0, 0, 0}, image, error));
    for (size_t y = 0; y < canvas->height; y++) {
        for (size_t x = 0; x < canvas->width; x++) {
            double sum[3] = {0, 0, 0};
            for (size_t s = 0; s < RENDER_SAMPLES * RENDER_SAMPLES; s++) {
                size_t row = y * RENDER_SAMPLES + s / RENDER_SAMPLES;
                size_t column = x * RENDER_SAMPLES + s % RENDER_SAMPLES;
                for (int a = 0; a < 3; a++)
                    sum[a] += (double)canvas->color[row * canvas->columns + column][a];
            }
            const double share = 1.0 / (RENDER_SAMPLES * RENDER_SAMPLES);
            (*image)->pixel[y * canvas->width + x] =
                (render_color){srgb_channel(sum[0] * share), srgb_channel(sum[1] * share),
                               srgb_channel(sum[2] * share)};
        }
    }
    return GVC_OK;
}
