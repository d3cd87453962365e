/* SPDX-License-Identifier: MIT */
/** @file render_canvas.h  What the drawing functions share. */
#ifndef GVC_TOOLS_RENDER_CANVAS_H
#define GVC_TOOLS_RENDER_CANVAS_H

#include "render.h"

#define RENDER_SAMPLES 3 /* per pixel and direction */

struct render_canvas {
    size_t width, height; /* in pixels */
    size_t columns, rows; /* in samples */
    render_camera camera;
    float *depth;      /* per sample: distance towards the eye; -INFINITY if empty */
    float (*color)[3]; /* per sample: linear light */
};

/* A point in the picture: sample coordinates, and how far it is towards the eye. */
typedef struct render_point {
    double x, y, depth;
} render_point;

render_point render_project(const render_canvas *canvas, vec3 position);
/* sRGB to linear light. */
vec3 render_linear(render_color color);

#endif
