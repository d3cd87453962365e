/* SPDX-License-Identifier: MIT */
/** @file render_mesh.c  Rasterises and shades triangles. */
#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "render_canvas.h"

#include <stdlib.h>

#define EDGE_WIDTH 0.55 /* of drawn triangle edges, in pixels */

void render_style_init(render_style *style) { *style = (render_style){.color = {226, 206, 182}}; }

/* One vertex of a triangle on its way to the samples. */
typedef struct corner {
    render_point at;
    vec3 normal, color;
} corner;

/* Light that leaves a surface of this colour towards the eye (along the camera's z axis); all in
 * camera coordinates. A warm key light from the upper left, a cool fill light from the right, light
 * from the sky, a small highlight. */
static vec3 shade(vec3 normal, vec3 color) {
    static const vec3 key_color = {0.98, 0.95, 0.90}, fill_color = {0.26, 0.29, 0.34};
    const vec3 key = vec3_unit(vec3_make(-0.5, 0.75, 0.75));
    const vec3 fill = vec3_unit(vec3_make(0.9, 0.1, 0.45));
    normal = vec3_unit(normal);
    if (normal.z < 0) normal = vec3_scale(normal, -1); /* the inside, through a hole */
    double diffuse = fmax(0, vec3_dot(normal, key)), second = fmax(0, vec3_dot(normal, fill));
    double sky = 0.13 + 0.11 * (0.5 + 0.5 * normal.y);
    vec3 half = vec3_unit(vec3_add(key, vec3_make(0, 0, 1)));
    double shine = 0.10 * pow(fmax(0, vec3_dot(normal, half)), 28);
    vec3 light = vec3_add(vec3_make(sky, sky, sky * 1.05), vec3_scale(key_color, 0.95 * diffuse));
    light = vec3_add(light, vec3_scale(fill_color, 0.9 * second));
    return vec3_make(color.x * light.x + shine, color.y * light.y + shine,
                     color.z * light.z + shine);
}

static double edge_function(render_point a, render_point b, double x, double y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

static size_t clamp_index(double value, size_t count) {
    if (!(value > 0)) return 0;
    return value >= (double)count ? count : (size_t)value;
}

/* How dark a drawn edge makes the sample: distances to the three sides, in samples. */
static double edge_cover(const double weight[3], const double height[3]) {
    double nearest = INFINITY;
    for (int i = 0; i < 3; i++) nearest = fmin(nearest, weight[i] * height[i]);
    return nearest < EDGE_WIDTH * RENDER_SAMPLES / 2 ? 0.5 : 0;
}

static void put_sample(render_canvas *canvas, size_t index, const corner c[3],
                       const double weight[3], const double *height) {
    double depth = 0;
    vec3 normal = {0, 0, 0}, color = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        depth += weight[i] * c[i].at.depth;
        normal = vec3_add(normal, vec3_scale(c[i].normal, weight[i]));
        color = vec3_add(color, vec3_scale(c[i].color, weight[i]));
    }
    if ((float)depth <= canvas->depth[index]) return;
    canvas->depth[index] = (float)depth;
    vec3 light = shade(normal, color);
    if (height) light = vec3_scale(light, 1 - edge_cover(weight, height));
    canvas->color[index][0] = (float)light.x;
    canvas->color[index][1] = (float)light.y;
    canvas->color[index][2] = (float)light.z;
}

static void draw_triangle(render_canvas *canvas, const corner c[3], bool edges) {
    double area = edge_function(c[0].at, c[1].at, c[2].at.x, c[2].at.y);
    if (!(fabs(area) > 1e-9)) return;
    double low_x = fmin(c[0].at.x, fmin(c[1].at.x, c[2].at.x));
    double high_x = fmax(c[0].at.x, fmax(c[1].at.x, c[2].at.x));
    double low_y = fmin(c[0].at.y, fmin(c[1].at.y, c[2].at.y));
    double high_y = fmax(c[0].at.y, fmax(c[1].at.y, c[2].at.y));
    double height[3]; /* of the triangle over each side */
    for (int i = 0; i < 3; i++) {
        render_point a = c[(i + 1) % 3].at, b = c[(i + 2) % 3].at;
        height[i] = fabs(area) / hypot(b.x - a.x, b.y - a.y);
    }
    size_t end_x = clamp_index(high_x + 1, canvas->columns);
    size_t end_y = clamp_index(high_y + 1, canvas->rows);
    for (size_t y = clamp_index(low_y, canvas->rows); y < end_y; y++) {
        for (size_t x = clamp_index(low_x, canvas->columns); x < end_x; x++) {
            double weight[3], px = (double)x + 0.5, py = (double)y + 0.5;
            bool inside = true;
            for (int i = 0; i < 3; i++) {
                weight[i] = edge_function(c[(i + 1) % 3].at, c[(i + 2) % 3].at, px, py) / area;
                inside = inside && weight[i] >= 0;
            }
            if (inside)
                put_sample(canvas, y * canvas->columns + x, c, weight, edges ? height : NULL);
        }
    }
}

static vec3 face_normal(const gvc_mesh *mesh, size_t face) {
    const uint32_t *v = &mesh->face[3 * face];
    vec3 a = vec3_load(&mesh->position[3 * (size_t)v[0]]);
    vec3 b = vec3_load(&mesh->position[3 * (size_t)v[1]]);
    vec3 c = vec3_load(&mesh->position[3 * (size_t)v[2]]);
    return vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
}

gvc_result render_canvas_mesh(render_canvas *canvas, const gvc_mesh *mesh,
                              const render_style *style, gvc_error *error) {
    /* Vertex normals: of the faces around, weighted by area. */
    vec3 *normal = gvc_alloc(mesh->vertex_count, sizeof *normal);
    if (!normal) return gvc_fail_memory(error);
    for (size_t f = 0; f < mesh->face_count; f++) {
        vec3 n = face_normal(mesh, f);
        for (int i = 0; i < 3; i++) {
            vec3 *sum = &normal[mesh->face[3 * f + (size_t)i]];
            *sum = vec3_add(*sum, n);
        }
    }
    for (size_t f = 0; f < mesh->face_count; f++) {
        corner c[3];
        for (int i = 0; i < 3; i++) {
            size_t v = mesh->face[3 * f + (size_t)i];
            vec3 n = style->flat ? face_normal(mesh, f) : normal[v];
            c[i].at = render_project(canvas, vec3_load(&mesh->position[3 * v]));
            c[i].normal = vec3_unit(frame3_coordinates(&canvas->camera.axes, n));
            c[i].color = render_linear(style->colors ? style->colors[v] : style->color);
        }
        draw_triangle(canvas, c, style->edges);
    }
    free(normal);
    return GVC_OK;
}
