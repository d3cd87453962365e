/* SPDX-License-Identifier: MIT */
/** @file coordinates.c  Geodesic coordinates, carried as attributes of the mesh. */
#include "descriptor/coordinates.h"

#include "base/memory.h"
#include "descriptor/geodesic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Distances are good to a hundredth of the greatest one; a position that has followed the surface
 * (warp.h), to a thousandth of the diagonal. */
static const double position_weight = 10;

gvc_result gvc_coordinates_attach(gvc_halfedges *mesh, const gvc_features *features, size_t count,
                                  gvc_coordinates *coordinates, gvc_error *error) {
    size_t first = mesh->attribute_count, channels = first + count, values;
    double *wider = gvc_multiply(mesh->vertex_capacity, channels, &values)
                        ? gvc_alloc(values, sizeof *wider)
                        : NULL;
    if (!wider) return gvc_fail_memory(error);
    for (size_t v = 0; first && v < mesh->vertex_count; v++)
        memcpy(wider + v * channels, mesh->attribute + v * first, first * sizeof *wider);
    free(mesh->attribute);
    mesh->attribute = wider;
    mesh->attribute_count = channels;
    *coordinates =
        (gvc_coordinates){.first = first,
                          .count = count,
                          .dimension = count + 3,
                          .scale = features->geodesic_scale > 0 ? features->geodesic_scale : 1,
                          .diagonal = features->diagonal > 0 ? features->diagonal : 1};
    return GVC_OK;
}

void gvc_coordinates_detach(gvc_halfedges *mesh, gvc_coordinates *coordinates) {
    if (coordinates->count == 0) return;
    size_t first = coordinates->first, channels = mesh->attribute_count;
    for (size_t v = 0; v < mesh->vertex_count; v++)
        memmove(mesh->attribute + v * first, mesh->attribute + v * channels,
                first * sizeof *mesh->attribute);
    if (first == 0) {
        free(mesh->attribute);
        mesh->attribute = NULL;
    }
    mesh->attribute_count = first;
    coordinates->count = 0;
}

gvc_result gvc_coordinates_measure(gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                                   size_t channel, const uint32_t *vertex, size_t count,
                                   gvc_error *error) {
    gvc_marcher *marcher = NULL;
    double *distance = gvc_alloc(mesh->vertex_count, sizeof *distance);
    gvc_result result = distance ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_marcher_create(mesh, &marcher, error);
    for (size_t i = 0; result == GVC_OK && i < count; i++) {
        result = gvc_march(marcher, &vertex[i], 1, distance, error);
        size_t place = coordinates->first + channel + i;
        for (size_t v = 0; result == GVC_OK && v < mesh->vertex_count; v++) {
            /* Another component: just far away. */
            double d = isfinite(distance[v]) ? distance[v] / coordinates->scale : 2;
            mesh->attribute[v * mesh->attribute_count + place] = d;
        }
    }
    gvc_marcher_destroy(&marcher);
    free(distance);
    return result;
}

void gvc_coordinates_get(const gvc_coordinates *coordinates, const double position[3],
                         const double *attribute, double *point) {
    memcpy(point, attribute + coordinates->first, coordinates->count * sizeof *point);
    gvc_coordinates_place(coordinates, position, point);
}

void gvc_coordinates_place(const gvc_coordinates *coordinates, const double position[3],
                           double *point) {
    for (size_t k = 0; k < 3; k++)
        point[coordinates->count + k] = position_weight * position[k] / coordinates->diagonal;
}

void gvc_coordinates_position(const gvc_coordinates *coordinates, const double *point,
                              double position[3]) {
    for (size_t k = 0; k < 3; k++)
        position[k] = point[coordinates->count + k] * coordinates->diagonal / position_weight;
}

void gvc_coordinates_of_vertex(const gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                               uint32_t vertex, double *point) {
    gvc_coordinates_get(coordinates, mesh->position + 3 * (size_t)vertex,
                        mesh->attribute + mesh->attribute_count * vertex, point);
}
