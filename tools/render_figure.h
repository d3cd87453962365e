/* SPDX-License-Identifier: MIT */
/** @file render_figure.h  Pictures of the coder's own objects: cut graph, error, geometry images.
 */
#ifndef GVC_TOOLS_RENDER_FIGURE_H
#define GVC_TOOLS_RENDER_FIGURE_H

#include "descriptor/cut_graph.h"
#include "render.h"

/** Colour that stands for cut edge number `edge` in every picture. */
render_color render_edge_color(size_t edge);

/** Colour of nodes of a kind: tips red, the root blue, junctions dark. */
render_color render_node_color(gvc_node_kind kind);

/** Draws the cut graph on the surface it belongs to: every edge in its colour, tips red, the root
 * blue, junctions dark. */
gvc_result render_cut_graph(render_canvas *canvas, const gvc_halfedges *mesh,
                            const gvc_cut_graph *graph, gvc_error *error);

/** 0 .. 1 to dark blue, violet, red, yellow; outside values are clamped. */
render_color render_heat_color(double value);

/** Distance of every vertex of `mesh` to the surface of `other`, in the unit of the meshes;
 * `distance` has room for mesh->vertex_count. `*greatest` may be NULL. */
gvc_result render_vertex_distance(const gvc_mesh *mesh, const gvc_mesh *other, double *distance,
                                  double *greatest, gvc_error *error);

/** Draws `mesh` coloured by a value per vertex; `full_scale` is that of the last colour. */
gvc_result render_heat_map(render_canvas *canvas, const gvc_mesh *mesh, const double *value,
                           double full_scale, gvc_error *error);

/** Draws `mesh` coloured by render_vertex_distance to `other`; `full_scale` is the distance of the
 * last colour. */
gvc_result render_distance_map(render_canvas *canvas, const gvc_mesh *mesh, const gvc_mesh *other,
                               double full_scale, gvc_error *error);

/** Draws the scale of render_heat_color along the lower edge of a finished picture, with the text
 * of its two ends. */
void render_heat_legend(render_image *image, const char *low, const char *high);

/** A geometry image as colours: `plane` points at 3 * size * size codes, x plane first, which
 * become red, green, blue (`greatest` is the code of full brightness). Each sample is zoom x zoom
 * pixels. */
gvc_result render_geometry_image(const uint16_t *plane, size_t size, uint16_t greatest, size_t zoom,
                                 render_image **image, gvc_error *error);

/** `count` pictures of one size in rows of `columns`, `gap` apart. */
gvc_result render_contact_sheet(const render_image *const *part, size_t count, size_t columns,
                                size_t gap, render_color background, render_image **sheet,
                                gvc_error *error);

#endif
