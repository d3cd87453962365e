/* SPDX-License-Identifier: MIT */
/**
 * @file render.h
 * A small software renderer for pictures of meshes: z-buffer, 3 x 3 samples per pixel, smooth
 * shading with two lights, curves and dots that lie on the surface.
 *
 * Usage: render_camera_fit, render_canvas_create, draw..., render_canvas_finish.
 */
#ifndef GVC_TOOLS_RENDER_H
#define GVC_TOOLS_RENDER_H

#include "gvc/gvc.h"
#include "render_image.h"
#include "vec3.h"

/** Looks along -axes.z at `centre`; axes.y is up in the picture. */
typedef struct render_camera {
    vec3 centre;
    frame3 axes;
    double half_height; /**< half of what the picture's height shows at the centre's depth */
    double distance;    /**< from the eye to the centre: perspective */
} render_camera;

typedef enum render_up {
    RENDER_UP_X = 0,
    RENDER_UP_Y = 1,
    RENDER_UP_Z = 2,
    RENDER_UP_LONGEST = 3 /**< the longest axis of the bounding box */
} render_up;

typedef struct render_view {
    render_up up;      /**< default RENDER_UP_Y */
    double yaw, pitch; /**< degrees: turned to the left about the up axis, seen from above */
    double zoom;       /**< 1: everything just fits */
} render_view;

/** Three-quarter front from slightly above. */
void render_view_init(render_view *view);

/** A camera that shows all of `count` meshes in a picture of this shape. Use one camera for
 * pictures to be compared. GVC_ERROR_ARGUMENT if there is nothing to show. */
gvc_result render_camera_fit(const gvc_mesh *const *mesh, size_t count, const render_view *view,
                             size_t width, size_t height, render_camera *camera, gvc_error *error);

/** Half the width and half the height of what the view shows of the meshes, in their unit, without
 * perspective. GVC_ERROR_ARGUMENT if there is nothing to show. */
gvc_result render_view_extent(const gvc_mesh *const *mesh, size_t count, const render_view *view,
                              double half[2], gvc_error *error);

/** The picture being drawn. */
typedef struct render_canvas render_canvas;

gvc_result render_canvas_create(size_t width, size_t height, const render_camera *camera,
                                render_canvas **canvas, gvc_error *error);
void render_canvas_destroy(render_canvas **canvas);
/** The finished picture; the canvas may be drawn on further. */
gvc_result render_canvas_finish(const render_canvas *canvas, render_image **image,
                                gvc_error *error);

typedef struct render_style {
    render_color color;         /**< of the surface */
    const render_color *colors; /**< instead, one per vertex; may be NULL */
    bool flat;                  /**< every triangle in its own plane instead of smooth */
    bool edges;                 /**< draw the triangles' edges */
} render_style;

/** Smooth clay colour without edges. */
void render_style_init(render_style *style);

gvc_result render_canvas_mesh(render_canvas *canvas, const gvc_mesh *mesh,
                              const render_style *style, gvc_error *error);

/** A curve through `count` points (3 coordinates each), `width` pixels wide, hidden behind surfaces
 * but not by the one it lies on. */
void render_canvas_curve(render_canvas *canvas, const double *points, size_t count,
                         render_color color, double width);
/** A round dot, `radius` in pixels, with a white rim. */
void render_canvas_dot(render_canvas *canvas, const double point[3], render_color color,
                       double radius);

#endif
