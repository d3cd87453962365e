/* SPDX-License-Identifier: MIT */
/** @file curvature.c  How strongly the surface bends, for spending more samples where it does. */
#include "chart/curvature.h"

#include "base/conjugate_gradient.h"
#include "base/memory.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>

#define SMOOTHING 0.016 /* standard deviation of the diffusion, of the diagonal */
#define CLIP 4.0
#define MOST_COTANGENT 100.0 /* a sliver must not spoil the condition of the diffusion */

/** Discrete surface: twins of the cut are one point again, otherwise the cut would show. */
typedef struct surface {
    const gvc_halfedges *mesh;
    uint32_t *point;   /* per disk vertex: the first disk vertex at the same surface point */
    double *area;      /* per point: a third of the area around */
    double *cotangent; /* per halfedge: of the angle opposite, not negative, times time / 2 */
    double *diagonal;  /* of the diffusion operator area + time * Laplacian */
} surface;

static double squared_diagonal(const gvc_halfedges *mesh) {
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t v = 0; v < mesh->vertex_count; v++) {
            low = fmin(low, mesh->position[3 * v + c]);
            high = fmax(high, mesh->position[3 * v + c]);
        }
        sum += (high - low) * (high - low);
    }
    return sum;
}

/** Vertices of the uncut mesh are numbered below the disk's vertex count, as cutting only adds. */
static gvc_result find_points(const gvc_disk *disk, uint32_t *point, gvc_error *error) {
    size_t n = disk->mesh.vertex_count;
    uint32_t *first = gvc_alloc(n, sizeof *first);
    if (!first) return gvc_fail_memory(error);
    for (size_t v = 0; v < n; v++) first[v] = GVC_NONE;
    for (size_t v = 0; v < n; v++) {
        uint32_t original = disk->original[v];
        point[v] = (uint32_t)v;
        if (original >= n) continue; /* inserted on the border: its twin is not known */
        if (first[original] == GVC_NONE) first[original] = (uint32_t)v;
        point[v] = first[original];
    }
    free(first);
    return GVC_OK;
}

/** Area, face normals summed per point (`normal`, then made unit), and the diffusion operator. */
static void measure(surface *s, double time, double *normal) {
    const gvc_halfedges *m = s->mesh;
    for (size_t f = 0; f < m->face_count; f++) {
        double edge[3][3], n[3];
        for (int k = 0; k < 3; k++) /* edge k is opposite to corner k */
            gvc_subtract(m->position + 3 * m->vertex[3 * f + (k + 2) % 3],
                         m->position + 3 * m->vertex[3 * f + (k + 1) % 3], edge[k]);
        gvc_cross(edge[0], edge[1], n);
        double twice = sqrt(gvc_dot(n, n));
        for (int k = 0; k < 3; k++) {
            uint32_t p = s->point[m->vertex[3 * f + k]];
            for (int c = 0; c < 3; c++) normal[3 * p + c] += n[c];
            s->area[p] += twice / 6;
            s->diagonal[p] += twice / 6;
            double cosine = -gvc_dot(edge[(k + 1) % 3], edge[(k + 2) % 3]);
            double cotangent = cosine <= 0                       ? 0
                               : cosine > MOST_COTANGENT * twice ? MOST_COTANGENT
                                                                 : cosine / twice;
            s->cotangent[3 * f + (k + 1) % 3] = time / 2 * cotangent;
        }
        for (int k = 0; k < 3; k++)
            for (int end = 0; end < 2; end++)
                s->diagonal[s->point[m->vertex[3 * f + (k + end) % 3]]] += s->cotangent[3 * f + k];
    }
    for (size_t v = 0; v < m->vertex_count; v++) {
        double length = sqrt(gvc_dot(normal + 3 * v, normal + 3 * v));
        for (int c = 0; c < 3; c++)
            if (length > 0) normal[3 * v + c] /= length;
        if (s->point[v] != v || !(s->area[v] > 0)) s->diagonal[v] += 1; /* as in diffuse */
    }
}

/** Integral of the normal's gradient over each face, a third of it to each of its points. The
 * integral stays finite on slivers and, being of the first power, on creases. */
static void integrate_bending(const surface *s, const double *normal, double *bending) {
    const gvc_halfedges *m = s->mesh;
    for (size_t f = 0; f < m->face_count; f++) {
        const uint32_t *v = m->vertex + 3 * f;
        uint32_t p[3] = {s->point[v[0]], s->point[v[1]], s->point[v[2]]};
        double e1[3], e2[3], d1[3], d2[3];
        gvc_subtract(m->position + 3 * v[1], m->position + 3 * v[0], e1);
        gvc_subtract(m->position + 3 * v[2], m->position + 3 * v[0], e2);
        gvc_subtract(normal + 3 * p[1], normal + 3 * p[0], d1);
        gvc_subtract(normal + 3 * p[2], normal + 3 * p[0], d2);
        double squared = gvc_dot(d1, d1) * gvc_dot(e2, e2) - 2 * gvc_dot(d1, d2) * gvc_dot(e1, e2) +
                         gvc_dot(d2, d2) * gvc_dot(e1, e1);
        for (int k = 0; k < 3; k++) bending[p[k]] += sqrt(fmax(squared, 0)) / 6;
    }
}

/** y = (area + time * Laplacian) x; rows of points that are not used stay the identity. */
static void diffuse(void *context, const double *x, double *y) {
    const surface *s = context;
    const gvc_halfedges *m = s->mesh;
    for (size_t v = 0; v < m->vertex_count; v++)
        y[v] = (s->point[v] == v && s->area[v] > 0 ? s->area[v] : 1) * x[v];
    for (uint32_t h = 0; h < 3 * m->face_count; h++) {
        uint32_t a = s->point[m->vertex[h]], b = s->point[m->vertex[gvc_next(h)]];
        double flow = s->cotangent[h] * (x[a] - x[b]);
        y[a] += flow;
        y[b] -= flow;
    }
}

/** Divides by the area-weighted mean, which is rounding noise if not above `flat`, and clips; every
 * twin gets its point's value. */
static void normalise(const surface *s, double flat, double *curvature) {
    size_t n = s->mesh->vertex_count;
    double sum = 0, area = 0;
    for (size_t v = 0; v < n; v++) {
        sum += s->area[v] * fmax(curvature[v], 0);
        area += s->area[v];
    }
    double mean = area > 0 ? sum / area : 0;
    for (size_t v = 0; v < n; v++) {
        uint32_t p = s->point[v];
        if (p == v) /* p <= v: it has been clipped before its twins look at it */
            curvature[v] = mean > flat ? fmin(fmax(curvature[v] / mean, 1 / CLIP), CLIP) : 1;
        curvature[v] = curvature[p];
    }
}

gvc_result gvc_curvature(const gvc_disk *disk, double *curvature, gvc_error *error) {
    const gvc_halfedges *mesh = &disk->mesh;
    size_t n = mesh->vertex_count;
    surface s = {.mesh = mesh};
    gvc_result result = GVC_OK;
    s.point = gvc_alloc(n, sizeof *s.point);
    s.area = gvc_alloc(n, sizeof *s.area);
    s.diagonal = gvc_alloc(n, sizeof *s.diagonal);
    s.cotangent = gvc_alloc(3 * mesh->face_count, sizeof *s.cotangent);
    double *normal = gvc_alloc(3 * n, sizeof *normal), *bending = gvc_alloc(n, sizeof *bending);
    if (!s.point || !s.area || !s.diagonal || !s.cotangent || !normal || !bending) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(find_points(disk, s.point, error));
    double squared = squared_diagonal(mesh);
    /* One implicit step of the heat equation: after time t the variance along each axis is 2 t. */
    measure(&s, SMOOTHING * SMOOTHING / 2 * squared, normal);
    integrate_bending(&s, normal, bending);
    for (size_t v = 0; v < n; v++) curvature[v] = s.area[v] > 0 ? bending[v] / s.area[v] : 0;
    GVC_CHECK(gvc_conjugate_gradient(n, diffuse, &s, s.diagonal, bending, 1e-4, 200, curvature,
                                     NULL, error));
    normalise(&s, 1e-6 / sqrt(squared), curvature);
cleanup:
    free(s.point);
    free(s.area);
    free(s.diagonal);
    free(s.cotangent);
    free(normal);
    free(bending);
    return result;
}
