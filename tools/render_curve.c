/* SPDX-License-Identifier: MIT */
/** @file render_curve.c  Curves and dots on surfaces. */
#include "render_canvas.h"

/* How far a curve may lie below the surface and is still seen, as a part of half the picture's
 * height: it runs along facets, the surface is drawn through them, and its width covers the slope.
 */
#define DEPTH_SLACK 0.012

/* Colours the samples within `radius` of the segment a b that nothing hides. */
static void draw_capsule(render_canvas *canvas, render_point a, render_point b, double radius,
                         vec3 color, double slack) {
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double low_x = fmin(a.x, b.x) - radius, high_x = fmax(a.x, b.x) + radius;
    double low_y = fmin(a.y, b.y) - radius, high_y = fmax(a.y, b.y) + radius;
    for (double y = floor(fmax(low_y, 0)); y <= high_y && y < (double)canvas->rows; y++) {
        for (double x = floor(fmax(low_x, 0)); x <= high_x && x < (double)canvas->columns; x++) {
            double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
            double t = square > 0 ? (px * dx + py * dy) / square : 0;
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            double ex = px - t * dx, ey = py - t * dy;
            if (ex * ex + ey * ey > radius * radius) continue;
            size_t index = (size_t)y * canvas->columns + (size_t)x;
            double depth = a.depth + t * (b.depth - a.depth) + slack;
            if (depth < (double)canvas->depth[index]) continue;
            canvas->color[index][0] = (float)color.x;
            canvas->color[index][1] = (float)color.y;
            canvas->color[index][2] = (float)color.z;
        }
    }
}

void render_canvas_curve(render_canvas *canvas, const double *points, size_t count,
                         render_color color, double width) {
    vec3 linear = render_linear(color);
    double slack = DEPTH_SLACK * canvas->camera.half_height;
    for (size_t i = 0; i + 1 < count; i++) {
        render_point a = render_project(canvas, vec3_load(&points[3 * i]));
        render_point b = render_project(canvas, vec3_load(&points[3 * i + 3]));
        draw_capsule(canvas, a, b, width / 2 * RENDER_SAMPLES, linear, slack);
    }
}

void render_canvas_dot(render_canvas *canvas, const double point[3], render_color color,
                       double radius) {
    render_point p = render_project(canvas, vec3_load(point));
    double slack = 3 * DEPTH_SLACK * canvas->camera.half_height;
    draw_capsule(canvas, p, p, (radius + 1.2) * RENDER_SAMPLES, vec3_make(1, 1, 1), slack);
    draw_capsule(canvas, p, p, radius * RENDER_SAMPLES, render_linear(color), slack);
}
