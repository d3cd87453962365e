/* SPDX-License-Identifier: MIT */
/** @file render_figure.c  Pictures of the coder's own objects: cut graph, error, geometry images.
 */
#include "render_figure.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/distance.h"

#include <stdlib.h>

#define CURVE_WIDTH 2.6
#define DOT_RADIUS 4.5

/* ----------------------------------------------------------------------------------- cut graph */

render_color render_edge_color(size_t edge) {
    /* Well apart from each other and from the clay of the surface. */
    static const render_color palette[] = {
        {31, 119, 180}, {214, 60, 50}, {44, 150, 60}, {148, 80, 190}, {240, 130, 20}, {0, 160, 170},
        {200, 60, 150}, {120, 110, 0}, {80, 90, 220}, {130, 60, 30},  {100, 180, 20}, {60, 70, 80}};
    return palette[edge % (sizeof palette / sizeof *palette)];
}

render_color render_node_color(gvc_node_kind kind) {
    switch (kind) {
    case GVC_NODE_ROOT:
        return (render_color){30, 70, 220};
    case GVC_NODE_EXTREMUM:
        return (render_color){225, 35, 35};
    case GVC_NODE_JUNCTION:
        break;
    }
    return (render_color){50, 54, 60};
}

gvc_result render_cut_graph(render_canvas *canvas, const gvc_halfedges *mesh,
                            const gvc_cut_graph *graph, gvc_error *error) {
    for (size_t e = 0; e < graph->edge_count; e++) {
        const gvc_cut_edge *edge = &graph->edge[e];
        double *points = gvc_alloc(edge->vertex_count, 3 * sizeof *points);
        if (!points) return gvc_fail_memory(error);
        for (size_t i = 0; i < edge->vertex_count; i++) {
            for (size_t a = 0; a < 3; a++)
                points[3 * i + a] = mesh->position[3 * (size_t)edge->vertex[i] + a];
        }
        render_canvas_curve(canvas, points, edge->vertex_count, render_edge_color(e), CURVE_WIDTH);
        free(points);
    }
    for (size_t n = 0; n < graph->node_count; n++) {
        const gvc_cut_node *node = &graph->node[n];
        double radius = node->kind == GVC_NODE_JUNCTION ? 0.75 * DOT_RADIUS : DOT_RADIUS;
        render_canvas_dot(canvas, &mesh->position[3 * (size_t)node->vertex],
                          render_node_color(node->kind), radius);
    }
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------- error maps */

render_color render_heat_color(double value) {
    static const render_color stop[] = {{28, 30, 90},   {70, 60, 170},  {150, 50, 160},
                                        {215, 60, 90},  {245, 130, 40}, {252, 210, 70},
                                        {255, 250, 200}};
    const int last = (int)(sizeof stop / sizeof *stop) - 1;
    double t = value > 0 ? value < 1 ? value * last : last : 0;
    int i = t < last ? (int)t : last - 1;
    t -= i;
    return (render_color){(uint8_t)(stop[i].r + t * (stop[i + 1].r - stop[i].r) + 0.5),
                          (uint8_t)(stop[i].g + t * (stop[i + 1].g - stop[i].g) + 0.5),
                          (uint8_t)(stop[i].b + t * (stop[i + 1].b - stop[i].b) + 0.5)};
}

gvc_result render_vertex_distance(const gvc_mesh *mesh, const gvc_mesh *other, double *distance,
                                  double *greatest, gvc_error *error) {
    gvc_bvh *bvh = NULL;
    GVC_TRY(gvc_bvh_create(other, &bvh, error));
    double most = 0;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        gvc_closest closest;
        bool found = gvc_bvh_closest(bvh, &mesh->position[3 * v], NULL, INFINITY, &closest);
        distance[v] = found ? closest.distance : INFINITY;
        most = fmax(most, distance[v]);
    }
    gvc_bvh_destroy(&bvh);
    if (greatest) *greatest = most;
    return GVC_OK;
}

gvc_result render_heat_map(render_canvas *canvas, const gvc_mesh *mesh, const double *value,
                           double full_scale, gvc_error *error) {
    render_style style;
    render_color *colors = gvc_alloc(mesh->vertex_count, sizeof *colors);
    if (!colors) return gvc_fail_memory(error);
    for (size_t v = 0; v < mesh->vertex_count; v++)
        colors[v] = render_heat_color(full_scale > 0 ? value[v] / full_scale : 0);
    render_style_init(&style);
    style.colors = colors;
    gvc_result result = render_canvas_mesh(canvas, mesh, &style, error);
    free(colors);
    return result;
}

gvc_result render_distance_map(render_canvas *canvas, const gvc_mesh *mesh, const gvc_mesh *other,
                               double full_scale, gvc_error *error) {
    double *distance = gvc_alloc(mesh->vertex_count, sizeof *distance);
    gvc_result result = distance ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = render_vertex_distance(mesh, other, distance, NULL, error);
    if (result == GVC_OK) result = render_heat_map(canvas, mesh, distance, full_scale, error);
    free(distance);
    return result;
}

void render_heat_legend(render_image *image, const char *low, const char *high) {
    enum { MARGIN = 10, HEIGHT = 14, SCALE = 2 };
    const render_color ink = {50, 52, 58};
    size_t left = MARGIN + render_text_width(low, SCALE) + 4;
    size_t right = render_text_width(high, SCALE) + 4 + MARGIN;
    if (image->height < 2 * (MARGIN + HEIGHT) || image->width < left + right + 16) return;
    size_t width = image->width - left - right, y = image->height - HEIGHT - MARGIN;
    render_image_text(image, MARGIN, y, SCALE, low, ink);
    for (size_t x = 0; x < width; x++) {
        render_color color = render_heat_color((double)x / (double)(width - 1));
        render_image_box(image, left + x, y, 1, HEIGHT, color);
    }
    render_image_text(image, left + width + 8, y, SCALE, high, ink);
}

/* ----------------------------------------------------------------------------- geometry images */

static uint8_t brightness(uint16_t code, uint16_t greatest) {
    unsigned limited = code < greatest ? code : greatest;
    return greatest ? (uint8_t)((limited * 255u + greatest / 2u) / greatest) : 0;
}

gvc_result render_geometry_image(const uint16_t *plane, size_t size, uint16_t greatest, size_t zoom,
                                 render_image **image, gvc_error *error) {
    GVC_TRY(render_image_create(size * zoom, size * zoom, (render_color){0, 0, 0}, image, error));
    for (size_t y = 0; y < size; y++) {
        for (size_t x = 0; x < size; x++) {
            size_t i = y * size + x;
            render_color color = {brightness(plane[i], greatest),
                                  brightness(plane[i + size * size], greatest),
                                  brightness(plane[i + 2 * size * size], greatest)};
            render_image_box(*image, x * zoom, y * zoom, zoom, zoom, color);
        }
    }
    return GVC_OK;
}

gvc_result render_contact_sheet(const render_image *const *part, size_t count, size_t columns,
                                size_t gap, render_color background, render_image **sheet,
                                gvc_error *error) {
    *sheet = NULL;
    if (!count || !columns) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is nothing to show");
    }
    if (columns > count) columns = count;
    size_t rows = (count + columns - 1) / columns;
    size_t width = part[0]->width + gap, height = part[0]->height + gap;
    GVC_TRY(
        render_image_create(columns * width + gap, rows * height + gap, background, sheet, error));
    for (size_t i = 0; i < count; i++) {
        render_image_paste(*sheet, part[i], gap + i % columns * width, gap + i / columns * height);
    }
    return GVC_OK;
}
