/* SPDX-License-Identifier: MIT */
/** @file consistent.c  Finds the point of a surface that is geodesically consistent to another. */
#include "descriptor/consistent.h"

#include "base/memory.h"
#include "descriptor/path.h"

#include <math.h>
#include <stdlib.h>

typedef struct comparison {
    const gvc_halfedges *mesh;
    const gvc_coordinates *coordinates;
    size_t features;
    const double *wanted;
    double *attribute, *point; /* room for one of each */
} comparison;

/* Coordinates hold position at a high weight, meant for points whose motion is known; this share of
 * it is what it weighs here. */
static const double position_weight = 0.15;

static double misfit(comparison *c, const gvc_surface_point *at) {
    double position[3], sum = 0, square = 0;
    gvc_surface_point_get(c->mesh, at, position, c->attribute);
    gvc_coordinates_get(c->coordinates, position, c->attribute, c->point);
    for (size_t k = 0; k < c->features; k++) sum += fabs(c->point[k] - c->wanted[k]);
    for (size_t k = c->coordinates->count; k < c->coordinates->dimension; k++)
        square += (c->point[k] - c->wanted[k]) * (c->point[k] - c->wanted[k]);
    return sum + position_weight * sqrt(square);
}

static bool contains(const uint32_t *list, size_t count, uint32_t vertex) {
    for (size_t i = 0; i < count; i++)
        if (list[i] == vertex) return true;
    return false;
}

static uint32_t best_vertex(comparison *c, const uint32_t *taken, size_t taken_count,
                            double *least) {
    uint32_t best = GVC_NONE;
    *least = INFINITY;
    for (uint32_t v = 0; v < c->mesh->vertex_count; v++) {
        gvc_surface_point at = {v, GVC_NONE, 0};
        double cost = misfit(c, &at);
        if (!(cost < *least) || contains(taken, taken_count, v)) continue;
        *least = cost;
        best = v;
    }
    return best;
}

/* Looks for a better point inside the edges of the faces round a vertex. */
static gvc_surface_point refine(comparison *c, uint32_t vertex, double least) {
    const gvc_halfedges *m = c->mesh;
    gvc_surface_point best = {vertex, GVC_NONE, 0};
    uint32_t h = m->outgoing[vertex];
    do {
        uint32_t edge[2] = {h, gvc_next(h)};
        for (int i = 0; i < 2; i++)
            for (int j = 1; j <= GVC_STEINER_POINTS; j++) {
                gvc_surface_point at = {m->vertex[edge[i]], m->vertex[gvc_next(edge[i])],
                                        j / (GVC_STEINER_POINTS + 1.0)};
                double cost = misfit(c, &at);
                if (cost >= least) continue;
                least = cost;
                best = at;
            }
        h = gvc_turn(m, h);
    } while (h != GVC_NONE && h != m->outgoing[vertex]);
    return best;
}

gvc_result gvc_consistent_vertex(gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                                 size_t features, const double *wanted, const uint32_t *taken,
                                 size_t taken_count, uint32_t *vertex, gvc_error *error) {
    comparison c = {mesh, coordinates, features, wanted, NULL, NULL};
    double least = INFINITY;
    *vertex = GVC_NONE;
    c.attribute = gvc_alloc(mesh->attribute_count, sizeof *c.attribute);
    c.point = gvc_alloc(coordinates->dimension, sizeof *c.point);
    gvc_result result = c.attribute && c.point ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) *vertex = best_vertex(&c, taken, taken_count, &least);
    if (*vertex != GVC_NONE) {
        gvc_surface_point best = refine(&c, *vertex, least);
        if (best.b != GVC_NONE) {
            uint32_t h = gvc_halfedge_between(mesh, best.a, best.b);
            result = gvc_halfedges_split(mesh, h, best.t, vertex, error);
        }
    }
    free(c.attribute);
    free(c.point);
    return result;
}

uint32_t gvc_nearest_vertex(const gvc_halfedges *mesh, const gvc_coordinates *coordinates,
                            const double *point) {
    double p[3], least = INFINITY;
    uint32_t nearest = GVC_NONE;
    gvc_coordinates_position(coordinates, point, p);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *q = mesh->position + 3 * (size_t)v;
        double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2], square = x * x + y * y + z * z;
        if (!(square < least)) continue;
        least = square;
        nearest = v;
    }
    return nearest;
}
