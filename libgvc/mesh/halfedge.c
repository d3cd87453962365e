/* SPDX-License-Identifier: MIT */
/** @file halfedge.c  Halfedges of a triangle mesh: building and splitting. */
#include "mesh/halfedge.h"

#include "base/memory.h"
#include "mesh/order.h"
#include "mesh/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void gvc_halfedges_free(gvc_halfedges *halfedges) {
    free(halfedges->position);
    free(halfedges->attribute);
    free(halfedges->outgoing);
    free(halfedges->vertex);
    free(halfedges->twin);
    *halfedges = (gvc_halfedges){0};
}

/** Fresh arrays of exactly the counts. */
static gvc_result allocate(size_t vertex_count, size_t face_count, size_t attribute_count,
                           gvc_halfedges *m, gvc_error *error) {
    *m = (gvc_halfedges){.vertex_count = vertex_count,
                         .face_count = face_count,
                         .vertex_capacity = vertex_count,
                         .face_capacity = face_count,
                         .attribute_count = attribute_count};
    size_t attributes;
    bool fits = gvc_multiply(vertex_count, attribute_count, &attributes);
    m->position = gvc_alloc(vertex_count, 3 * sizeof *m->position);
    if (fits && attribute_count) m->attribute = gvc_alloc(attributes, sizeof *m->attribute);
    m->outgoing = gvc_alloc(vertex_count, sizeof *m->outgoing);
    m->vertex = gvc_alloc(face_count, 3 * sizeof *m->vertex);
    m->twin = gvc_alloc(face_count, 3 * sizeof *m->twin);
    if (m->position && (m->attribute || !attribute_count) && m->outgoing && m->vertex && m->twin)
        return GVC_OK;
    gvc_halfedges_free(m);
    return gvc_fail_memory(error);
}

/* ------------------------------------------------------------------------------------- building */

static gvc_result check_faces(const gvc_mesh *mesh, gvc_error *error) {
    for (size_t h = 0; h < 3 * mesh->face_count; h++) {
        if (mesh->face[h] >= mesh->vertex_count)
            return gvc_fail(error, GVC_ERROR_MESH, "face %zu uses vertex %lu of %zu", h / 3,
                            (unsigned long)mesh->face[h], mesh->vertex_count);
        if (h % 3 == 0 && gvc_is_degenerate(mesh, (uint32_t)(h / 3)))
            return gvc_fail(error, GVC_ERROR_MESH, "face %zu repeats a vertex", h / 3);
    }
    return GVC_OK;
}

/** Pairs the halfedges of each edge; `order` has them side by side. */
static gvc_result pair_twins(const gvc_mesh *mesh, const uint32_t *order, gvc_halfedges *m,
                             gvc_error *error) {
    size_t count = 3 * mesh->face_count;
    for (size_t i = 0, next; i < count; i = next) {
        uint32_t h = order[i];
        unsigned long a = gvc_start_of(mesh, h), b = gvc_end_of(mesh, h);
        for (next = i + 1; next < count && gvc_same_edge(mesh, h, order[next]);) next++;
        m->twin[h] = GVC_NONE;
        if (next - i == 1) continue;
        uint32_t g = order[i + 1];
        if (next - i > 2)
            return gvc_fail(error, GVC_ERROR_MESH,
                            "the edge between vertices %lu and %lu has %zu faces", a, b, next - i);
        if (gvc_start_of(mesh, g) == a)
            return gvc_fail(error, GVC_ERROR_MESH,
                            "faces %lu and %lu run the same way along the edge between vertices "
                            "%lu and %lu",
                            (unsigned long)h / 3, (unsigned long)g / 3, a, b);
        m->twin[h] = g;
        m->twin[g] = h;
    }
    return GVC_OK;
}

/** Picks the outgoing halfedges and checks that the faces of every vertex form a single fan. */
static gvc_result check_fans(gvc_halfedges *m, gvc_error *error) {
    uint32_t *corners = gvc_alloc(m->vertex_count, sizeof *corners);
    if (!corners) return gvc_fail_memory(error);
    for (size_t v = 0; v < m->vertex_count; v++) m->outgoing[v] = GVC_NONE;
    for (size_t h = 0; h < 3 * m->face_count; h++) {
        uint32_t v = m->vertex[h];
        corners[v]++;
        if (m->outgoing[v] == GVC_NONE || m->twin[h] == GVC_NONE) m->outgoing[v] = (uint32_t)h;
    }
    gvc_result result = GVC_OK;
    for (size_t v = 0; v < m->vertex_count && result == GVC_OK; v++) {
        uint32_t h = m->outgoing[v], met = 0;
        if (h == GVC_NONE) {
            result = gvc_fail(error, GVC_ERROR_MESH, "vertex %zu has no face", v);
            break;
        }
        do {
            met++;
            h = gvc_turn(m, h);
        } while (h != GVC_NONE && h != m->outgoing[v]);
        if (met != corners[v])
            result = gvc_fail(error, GVC_ERROR_MESH,
                              "the faces around vertex %zu form more than one fan", v);
    }
    free(corners);
    return result;
}

gvc_result gvc_halfedges_build(const gvc_mesh *mesh, size_t attribute_count,
                               gvc_halfedges *halfedges, gvc_error *error) {
    *halfedges = (gvc_halfedges){0};
    uint32_t *order = NULL;
    GVC_TRY(check_faces(mesh, error));
    GVC_TRY(gvc_order_halfedges(mesh, &order, error));
    gvc_result result =
        allocate(mesh->vertex_count, mesh->face_count, attribute_count, halfedges, error);
    if (result == GVC_OK) {
        memcpy(halfedges->position, mesh->position, 3 * mesh->vertex_count * sizeof(double));
        memcpy(halfedges->vertex, mesh->face, 3 * mesh->face_count * sizeof(uint32_t));
        result = pair_twins(mesh, order, halfedges, error);
    }
    if (result == GVC_OK) result = check_fans(halfedges, error);
    if (result != GVC_OK) gvc_halfedges_free(halfedges);
    free(order);
    return result;
}

gvc_result gvc_halfedges_copy(const gvc_halfedges *from, gvc_halfedges *to, gvc_error *error) {
    GVC_TRY(allocate(from->vertex_count, from->face_count, from->attribute_count, to, error));
    size_t vertices = from->vertex_count, halfedges = 3 * from->face_count;
    if (vertices) {
        memcpy(to->position, from->position, 3 * vertices * sizeof *to->position);
        memcpy(to->outgoing, from->outgoing, vertices * sizeof *to->outgoing);
        if (to->attribute)
            memcpy(to->attribute, from->attribute,
                   vertices * from->attribute_count * sizeof *to->attribute);
    }
    if (halfedges) {
        memcpy(to->vertex, from->vertex, halfedges * sizeof *to->vertex);
        memcpy(to->twin, from->twin, halfedges * sizeof *to->twin);
    }
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ splitting */

/** Makes room in one array without telling; `capacity` is what all arrays of its kind surely have.
 */
static bool reserve(void **data, size_t capacity, size_t needed, size_t size) {
    return gvc_grow(data, &capacity, needed, size);
}

static bool reserve_vertices(gvc_halfedges *m, size_t needed) {
    if (needed <= m->vertex_capacity) return true;
    size_t wanted = needed + m->vertex_capacity / 2;
    void *position = m->position, *attribute = m->attribute, *outgoing = m->outgoing;
    bool done = reserve(&position, m->vertex_capacity, wanted, 3 * sizeof *m->position);
    m->position = position;
    size_t stride;
    done = done && gvc_multiply(m->attribute_count, sizeof *m->attribute, &stride) &&
           (!stride || reserve(&attribute, m->vertex_capacity, wanted, stride));
    m->attribute = attribute;
    done = done && reserve(&outgoing, m->vertex_capacity, wanted, sizeof *m->outgoing);
    m->outgoing = outgoing;
    if (done) m->vertex_capacity = wanted;
    return done;
}

static bool reserve_faces(gvc_halfedges *m, size_t needed) {
    if (needed <= m->face_capacity) return true;
    size_t wanted = needed + m->face_capacity / 2;
    void *vertex = m->vertex, *twin = m->twin;
    bool done = reserve(&vertex, m->face_capacity, wanted, 3 * sizeof *m->vertex);
    m->vertex = vertex;
    done = done && reserve(&twin, m->face_capacity, wanted, 3 * sizeof *m->twin);
    m->twin = twin;
    if (done) m->face_capacity = wanted;
    return done;
}

static void join(gvc_halfedges *m, uint32_t g, uint32_t h) {
    m->twin[g] = h;
    if (h != GVC_NONE) m->twin[h] = g;
}

/** Puts vertex `middle` on halfedge h = (a b) of face (a b c): the face becomes (a middle c), and
 *  (middle b c) is appended. Returns the new halfedge (middle b), still without its twin. */
static uint32_t split_face(gvc_halfedges *m, uint32_t h, uint32_t middle) {
    uint32_t next = gvc_next(h), prev = gvc_prev(h);
    uint32_t b = m->vertex[next], c = m->vertex[prev];
    uint32_t added = (uint32_t)(3 * m->face_count++);
    m->vertex[added] = middle;
    m->vertex[added + 1] = b;
    m->vertex[added + 2] = c;
    m->twin[added] = GVC_NONE;
    join(m, added + 1, m->twin[next]);
    join(m, added + 2, next);
    m->vertex[next] = middle;
    if (m->outgoing[b] == next) m->outgoing[b] = added + 1;
    return added;
}

static void interpolate(double *values, size_t count, size_t a, size_t b, size_t to, double t) {
    for (size_t k = 0; k < count; k++) {
        double first = values[a * count + k], second = values[b * count + k];
        values[to * count + k] = first + t * (second - first);
    }
}

gvc_result gvc_halfedges_split(gvc_halfedges *m, uint32_t h, double t, uint32_t *vertex,
                               gvc_error *error) {
    if (h >= 3 * m->face_count || !(t > 0 && t < 1))
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "cannot split halfedge %lu at %g",
                        (unsigned long)h, t);
    uint32_t twin = m->twin[h];
    size_t face_count = m->face_count + (twin == GVC_NONE ? 1 : 2);
    if (m->vertex_count >= UINT32_MAX - 1 || face_count > (UINT32_MAX - 1) / 3)
        return gvc_fail(error, GVC_ERROR_LIMIT, "too many faces to split an edge");
    if (!reserve_vertices(m, m->vertex_count + 1) || !reserve_faces(m, face_count))
        return gvc_fail_memory(error);

    uint32_t a = m->vertex[h], b = m->vertex[gvc_next(h)];
    uint32_t middle = (uint32_t)m->vertex_count++;
    interpolate(m->position, 3, a, b, middle, t);
    if (m->attribute) interpolate(m->attribute, m->attribute_count, a, b, middle, t);

    uint32_t beyond = split_face(m, h, middle); /* (middle b) */
    m->outgoing[middle] = beyond;
    if (twin != GVC_NONE) {
        uint32_t back = split_face(m, twin, middle); /* (middle a); twin is now (b middle) */
        join(m, h, back);
        join(m, beyond, twin);
    }
    *vertex = middle;
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ questions */

uint32_t gvc_halfedge_between(const gvc_halfedges *m, uint32_t from, uint32_t to) {
    uint32_t h = m->outgoing[from];
    do {
        if (m->vertex[gvc_next(h)] == to) return h;
        h = gvc_turn(m, h);
    } while (h != GVC_NONE && h != m->outgoing[from]);
    return GVC_NONE;
}

void gvc_face_area_normal(const gvc_halfedges *m, size_t face, double normal[3]) {
    const uint32_t *v = m->vertex + 3 * face;
    const double *a = m->position + 3 * (size_t)v[0];
    double ab[3], ac[3];
    gvc_subtract(m->position + 3 * (size_t)v[1], a, ab);
    gvc_subtract(m->position + 3 * (size_t)v[2], a, ac);
    gvc_cross(ab, ac, normal);
}

void gvc_face_normal(const gvc_halfedges *m, size_t face, double normal[3]) {
    gvc_face_area_normal(m, face, normal);
    double length = sqrt(gvc_dot(normal, normal));
    for (int k = 0; k < 3; k++) normal[k] = length > 0 ? normal[k] / length : 0;
}

double gvc_halfedge_length(const gvc_halfedges *m, uint32_t h) {
    const double *a = m->position + 3 * (size_t)m->vertex[h];
    const double *b = m->position + 3 * (size_t)m->vertex[gvc_next(h)];
    double x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    return sqrt(x * x + y * y + z * z);
}
