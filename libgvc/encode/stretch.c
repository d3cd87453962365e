/* SPDX-License-Identifier: MIT */
/** @file stretch.c  Where a parameterization stretches most. */
#include "encode/stretch.h"

/* Squared L2 stretch of a face: mean squared length on the surface of a unit step in the domain. */
static double face_stretch(const gvc_halfedges *m, const double *uv, size_t f) {
    const uint32_t *v = m->vertex + 3 * f;
    double s1 = uv[2 * v[1]] - uv[2 * v[0]], t1 = uv[2 * v[1] + 1] - uv[2 * v[0] + 1];
    double s2 = uv[2 * v[2]] - uv[2 * v[0]], t2 = uv[2 * v[2] + 1] - uv[2 * v[0] + 1];
    double twice = s1 * t2 - s2 * t1, squared = 0;
    for (int c = 0; c < 3; c++) {
        double a = m->position[3 * v[1] + c] - m->position[3 * v[0] + c];
        double b = m->position[3 * v[2] + c] - m->position[3 * v[0] + c];
        double s = (t2 * a - t1 * b) / twice, t = (s1 * b - s2 * a) / twice;
        squared += s * s + t * t;
    }
    return squared / 2;
}

static bool is_inner(const gvc_halfedges *m, uint32_t vertex) {
    return m->twin[m->outgoing[vertex]] != GVC_NONE; /* of a border vertex it has none */
}

/* What tells the vertices of one face apart. */
static double stretch_around(const gvc_halfedges *m, const double *uv, uint32_t vertex) {
    double sum = 0;
    uint32_t h = m->outgoing[vertex];
    do {
        sum += face_stretch(m, uv, h / 3);
        h = gvc_turn(m, h);
    } while (h != m->outgoing[vertex]);
    return sum;
}

uint32_t gvc_stretch_extremum(const gvc_disk *disk, const double *uv) {
    const gvc_halfedges *m = &disk->mesh;
    double greatest = -1, around = -1;
    uint32_t extremum = GVC_NONE;
    for (size_t f = 0; f < m->face_count; f++) {
        double stretch = face_stretch(m, uv, f);
        if (!(stretch >= greatest)) continue;
        for (int k = 0; k < 3; k++) {
            uint32_t v = m->vertex[3 * f + k];
            if (!is_inner(m, v) || disk->original[v] == GVC_NONE) continue;
            double here = stretch_around(m, uv, v);
            if (stretch == greatest && here <= around) continue;
            greatest = stretch;
            around = here;
            extremum = disk->original[v];
        }
    }
    return extremum;
}
