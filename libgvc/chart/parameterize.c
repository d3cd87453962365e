/* SPDX-License-Identifier: MIT */
/**
 * @file parameterize.c
 * Interior of the parameterization. Every inner vertex is put at a weighted mean of its neighbours,
 *     sum over j of w_ij (u_j - u_i) = 0,  w_ij > 0,
 * which is a sparse linear system with one row per inner vertex. Its rows are diagonally dominant,
 * so the transpose can be factored without exchanging pivots, whatever the weights: the symbolic
 * analysis is done once for all solves.
 */
#include "chart/parameterize.h"

#include "base/memory.h"
#include "chart/curvature.h"
#include "chart/delaunay.h"
#include "mesh/vector.h"

#include <klu.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_WEIGHT 1e-4
#define MOST_REPAIRS 8
#define STEEPEST 4.0 /* ratio of the stretch of neighbours; 2 is seen on slender limbs */
#define MOST_LIMIT_PASSES 50

typedef struct solver {
    const gvc_disk *disk;
    double square; /* area of the parameter domain */
    gvc_intrinsic delaunay;
    double *harmonic;   /* per halfedge from i to j of `delaunay`: w_ij */
    double *mean_value; /* the same of the mesh itself, */
    uint8_t *plain;     /* for the vertices marked here */
    double *scale;      /* per vertex j: factor of all w_ij in the next solve */
    double *uv;         /* solution of the last solve; border as given */
    uint32_t *row;      /* per vertex: its row, GVC_NONE on the border */
    size_t row_count;   /* number of inner vertices */
    /* The system's matrix by rows, which KLU takes as the transposed matrix by columns. */
    int *start, *column;
    double *value, *right; /* right: 2 * row_count, first all u, then all v */
    klu_common common;
    klu_symbolic *symbolic;
    klu_numeric *numeric;
} solver;

/** The next system has entries elsewhere. */
static void solver_forget_pattern(solver *s) {
    klu_free_numeric(&s->numeric, &s->common);
    klu_free_symbolic(&s->symbolic, &s->common);
}

static void solver_free(solver *s) {
    gvc_intrinsic_free(&s->delaunay);
    free(s->harmonic);
    free(s->mean_value);
    free(s->plain);
    free(s->scale);
    free(s->uv);
    free(s->row);
    free(s->start);
    free(s->column);
    free(s->value);
    free(s->right);
    solver_forget_pattern(s);
}

/* ------------------------------------------------------------------------------------- weights */

/** Tangent of half the angle at the start of `h` in its face, kept off 0 and infinity so that
 * degenerate faces do not stop the solver. */
static double half_tangent(const gvc_halfedges *m, uint32_t h) {
    const double *p = m->position + 3 * m->vertex[h];
    const double *q = m->position + 3 * m->vertex[gvc_next(h)];
    const double *r = m->position + 3 * m->vertex[gvc_prev(h)];
    double a[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    double b[3] = {r[0] - p[0], r[1] - p[1], r[2] - p[2]};
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double sine = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    double lengths =
        sqrt((a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
    double below = lengths + cosine;
    if (below <= 0 && sine <= 0) return 1e-5;
    return sine >= 1e5 * below ? 1e5 : fmax(sine / below, 1e-5);
}

/** Mean value coordinates (Floater 2003, Eq. 2.1) of inner vertices. */
static void mean_value_weights(solver *s) {
    const gvc_halfedges *m = &s->disk->mesh;
    size_t count = 3 * m->face_count;
    double mean = 0;
    for (uint32_t h = 0; h < count; h++) mean += gvc_halfedge_length(m, h) / (double)count;
    for (uint32_t h = 0; h < count; h++) {
        if (s->row[m->vertex[h]] == GVC_NONE) continue;
        double tangents = half_tangent(m, h) + half_tangent(m, gvc_next(m->twin[h]));
        s->mean_value[h] = tangents / fmax(gvc_halfedge_length(m, h), 1e-9 * mean);
    }
}

/** Harmonic weights (Pinkall & Polthier 1993) on the intrinsic Delaunay triangulation, where they
 * are not negative. A little is added for the sake of edges across right angles. */
static gvc_result harmonic_weights(solver *s, gvc_error *error) {
    GVC_TRY(gvc_delaunay(&s->disk->mesh, &s->delaunay, error));
    const gvc_intrinsic *t = &s->delaunay;
    for (uint32_t h = 0; h < 3 * t->face_count; h++)
        if (t->twin[h] != GVC_NONE)
            s->harmonic[h] =
                fmax(gvc_intrinsic_cotangent(t, h) + gvc_intrinsic_cotangent(t, t->twin[h]),
                     LEAST_WEIGHT);
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- system */

static gvc_result klu_failure(const solver *s, const char *step, gvc_error *error) {
    switch (s->common.status) {
    case KLU_OUT_OF_MEMORY:
        return gvc_fail_memory(error);
    case KLU_TOO_LARGE:
        return gvc_fail(error, GVC_ERROR_MESH, "mesh with %zu inner vertices is too large to %s",
                        s->row_count, step);
    default:
        return gvc_fail(error, GVC_ERROR_INTERNAL, "KLU failed to %s with status %d", step,
                        s->common.status);
    }
}

static gvc_result solver_allocate(solver *s, const gvc_disk *disk, const double *uv,
                                  gvc_error *error) {
    size_t n = disk->mesh.vertex_count, halfedges = 3 * disk->mesh.face_count;
    if (halfedges > INT_MAX / 4)
        return gvc_fail(error, GVC_ERROR_MESH, "mesh with %zu faces is too large to parameterize",
                        disk->mesh.face_count);
    s->disk = disk;
    s->row = gvc_alloc(n, sizeof *s->row);
    s->scale = gvc_alloc(n, sizeof *s->scale);
    s->uv = gvc_alloc(2 * n, sizeof *s->uv);
    s->harmonic = gvc_alloc(halfedges, sizeof *s->harmonic);
    s->mean_value = gvc_alloc(halfedges, sizeof *s->mean_value);
    s->plain = gvc_alloc(n, 1);
    if (!s->row || !s->scale || !s->uv || !s->harmonic || !s->mean_value || !s->plain)
        return gvc_fail_memory(error);
    memcpy(s->uv, uv, 2 * n * sizeof *uv);
    for (size_t i = 0; i < disk->border_count; i++) s->row[disk->border[i]] = GVC_NONE;
    for (size_t v = 0; v < n; v++)
        if (s->row[v] != GVC_NONE) s->row[v] = (uint32_t)s->row_count++;
    s->start = gvc_alloc(s->row_count + 1, sizeof *s->start);
    s->column = gvc_alloc(s->row_count + halfedges, sizeof *s->column);
    s->value = gvc_alloc(s->row_count + halfedges, sizeof *s->value);
    s->right = gvc_alloc(2 * s->row_count, sizeof *s->right);
    if (!s->start || !s->column || !s->value || !s->right) return gvc_fail_memory(error);
    return GVC_OK;
}

/** Adds `value` to the entry for `column` of a row that began at `first`; the triangulation may
 * join two vertices by several edges. Returns the number of entries then. */
static int add_entry(solver *s, int first, int end, int column, double value) {
    int e = first;
    while (e < end && s->column[e] != column) e++;
    if (e == end) s->value[end++] = 0;
    s->column[e] = column;
    s->value[e] += value;
    return end;
}

/** Row of inner vertex v: u_v - sum of normalised w_vj u_j over inner j = the same over border j.
 * Returns the number of entries written behind `entry`. */
static int fill_row(solver *s, bool uniform, uint32_t v, int entry) {
    const gvc_halfedges *m = &s->disk->mesh;
    bool plain = uniform || s->plain[v];
    const uint32_t *vertex = plain ? m->vertex : s->delaunay.vertex;
    const uint32_t *twin = plain ? m->twin : s->delaunay.twin;
    const double *weight = plain ? s->mean_value : s->harmonic;
    uint32_t row = s->row[v], first = plain ? m->outgoing[v] : s->delaunay.outgoing[v], h = first;
    double sum = 0, u[2] = {0, 0};
    int begin = entry + 1;
    s->column[entry] = (int)row;
    s->value[entry++] = 1;
    do {
        uint32_t j = vertex[gvc_next(h)];
        double w = (uniform ? 1 : weight[h]) * s->scale[j];
        sum += j == v ? 0 : w;
        if (s->row[j] == GVC_NONE) {
            u[0] += w * s->uv[2 * j];
            u[1] += w * s->uv[2 * j + 1];
        } else if (j != v) {
            entry = add_entry(s, begin, entry, (int)s->row[j], -w);
        }
        h = twin[gvc_prev(h)];
    } while (h != first);
    for (int e = begin; e < entry; e++) s->value[e] /= sum;
    s->right[row] = u[0] / sum;
    s->right[s->row_count + row] = u[1] / sum;
    return entry;
}

/** Factors the transposed matrix; the symbolic analysis and the pivots of the first time serve all
 * later ones. `*singular` tells that there is no solution in floating point. */
static gvc_result factor(solver *s, bool *singular, gvc_error *error) {
    if (!s->symbolic) {
        s->symbolic = klu_analyze((int)s->row_count, s->start, s->column, &s->common);
        if (!s->symbolic) return klu_failure(s, "order", error);
    }
    bool done = true;
    if (s->numeric)
        done = klu_refactor(s->start, s->column, s->value, s->symbolic, s->numeric, &s->common);
    else
        s->numeric = klu_factor(s->start, s->column, s->value, s->symbolic, &s->common);
    *singular = s->common.status == KLU_SINGULAR;
    if (*singular || (done && s->numeric)) return GVC_OK;
    return klu_failure(s, "factor", error);
}

/** Solves for the inner vertices with their weights (or all 1) times scale. Weights beyond floating
 * point give NaN, which counts as flipped. */
static gvc_result solve(solver *s, bool uniform, gvc_error *error) {
    size_t n = s->disk->mesh.vertex_count;
    int entry = 0;
    bool singular = false;
    if (s->row_count == 0) return GVC_OK;
    for (uint32_t v = 0; v < n; v++) {
        if (s->row[v] == GVC_NONE) continue;
        s->start[s->row[v]] = entry;
        entry = fill_row(s, uniform, v, entry);
    }
    s->start[s->row_count] = entry;
    GVC_TRY(factor(s, &singular, error));
    if (!singular &&
        !klu_tsolve(s->symbolic, s->numeric, (int)s->row_count, 2, s->right, &s->common))
        return klu_failure(s, "solve", error);
    for (size_t v = 0; v < n; v++) {
        if (s->row[v] == GVC_NONE) continue;
        for (int c = 0; c < 2; c++)
            s->uv[2 * v + c] = singular ? NAN : s->right[(size_t)c * s->row_count + s->row[v]];
    }
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------- stretch */

typedef struct face_stretch {
    double area;    /* on the surface */
    double plane;   /* in the parameter domain, signed */
    double squared; /* L2 stretch squared: mean squared length of a unit step in the domain */
} face_stretch;

/** Sander et al. 2001, for a face with the sides a and b from its first corner. A face that has
 * collapsed or turned over counts by its size. */
static face_stretch measure_triangle(const double a[3], const double b[3], const double *uv,
                                     const uint32_t *v) {
    double s1 = uv[2 * v[1]] - uv[2 * v[0]], t1 = uv[2 * v[1] + 1] - uv[2 * v[0] + 1];
    double s2 = uv[2 * v[2]] - uv[2 * v[0]], t2 = uv[2 * v[2] + 1] - uv[2 * v[0] + 1];
    double squared = 0, n[3];
    double twice = s1 * t2 - s2 * t1;
    for (int c = 0; c < 3; c++) {
        double s = t2 * a[c] - t1 * b[c], t = s1 * b[c] - s2 * a[c];
        squared += s * s + t * t;
    }
    gvc_cross(a, b, n);
    double least = fmax(fabs(twice), 1e-24); /* square pixels; rounding is below */
    return (face_stretch){.area = sqrt(gvc_dot(n, n)) / 2,
                          .plane = twice / 2,
                          .squared = squared / (2 * least * least)};
}

static face_stretch measure_face(const gvc_halfedges *m, const double *uv, size_t f) {
    const uint32_t *v = m->vertex + 3 * f;
    double a[3], b[3];
    gvc_subtract(m->position + 3 * (size_t)v[1], m->position + 3 * (size_t)v[0], a);
    gvc_subtract(m->position + 3 * (size_t)v[2], m->position + 3 * (size_t)v[0], b);
    return measure_triangle(a, b, uv, v);
}

static face_stretch measure_intrinsic_face(const gvc_intrinsic *t, const double *uv, size_t f) {
    double a[3] = {0}, b[3] = {0};
    gvc_intrinsic_lay(t, (uint32_t)(3 * f), a, b);
    return measure_triangle(a, b, uv, t->vertex + 3 * f);
}

static size_t count_flips(const gvc_halfedges *m, const double *uv) {
    size_t flips = 0;
    for (size_t f = 0; f < m->face_count; f++) flips += !(measure_face(m, uv, f).plane > 0);
    return flips;
}

/** L2 stretch of the whole map, 1 for an isometry up to size. */
static double total_stretch(const gvc_halfedges *m, const double *uv, double square) {
    double sum = 0, area = 0;
    for (size_t f = 0; f < m->face_count; f++) {
        face_stretch face = measure_face(m, uv, f);
        sum += face.area * face.squared;
        area += face.area;
    }
    return area > 0 ? sqrt(sum / area * square / area) : 1;
}

/** Yoshizawa et al. 2004, Eq. 6: neighbours in stretched places pull less, so their places grow.
 * Writes s->scale from the stretch per vertex; `curvature` may be NULL. */
static void stretch_scale(solver *s, const double *sigma, double eta, const double *curvature,
                          double kp) {
    for (size_t v = 0; v < s->disk->mesh.vertex_count; v++) {
        s->scale[v] = pow(sigma[v], -eta);
        if (curvature) s->scale[v] *= pow(curvature[v], -kp);
    }
}

/** Stretch per vertex: root of the area-weighted mean of the squared stretch around. `sigma` has
 * been zeroed; `area` is scratch for as many doubles. The intrinsic triangles are measured, among
 * which there are no slivers to spoil the mean. */
static void vertex_stretch(const solver *s, const double *uv, double *area, double *sigma) {
    const gvc_intrinsic *t = &s->delaunay;
    double total = 0;
    size_t n = s->disk->mesh.vertex_count;
    memset(area, 0, n * sizeof *area);
    for (size_t f = 0; f < t->face_count; f++) {
        face_stretch face = measure_intrinsic_face(t, uv, f);
        total += face.area;
        for (int k = 0; k < 3; k++) {
            sigma[t->vertex[3 * f + k]] += face.area * face.squared;
            area[t->vertex[3 * f + k]] += face.area;
        }
    }
    double scale = total > 0 ? s->square / total : 1;
    for (size_t v = 0; v < n; v++) {
        double squared = area[v] > 0 ? sigma[v] / area[v] * scale : 1;
        sigma[v] = fmin(fmax(sqrt(squared), 1e-6), 1e30);
    }
}

/** Faces that have collapsed by chance must not silence their corners: no vertex is taken to be
 * stretched much more than a neighbour. */
static void limit_stretch(const gvc_intrinsic *t, double *sigma) {
    bool changed = true;
    for (int i = 0; i < MOST_LIMIT_PASSES && changed; i++) {
        changed = false;
        for (uint32_t h = 0; h < 3 * t->face_count; h++) {
            double *a = &sigma[t->vertex[h]], *b = &sigma[t->vertex[gvc_next(h)]];
            if (*a > STEEPEST * *b) *a = STEEPEST * *b, changed = true;
            if (*b > STEEPEST * *a) *b = STEEPEST * *a, changed = true;
        }
    }
}

/* -------------------------------------------------------------------------------------- repair */

/** Marks a vertex, if it is an inner one, and tells whether it was not marked yet. */
static bool mark(solver *s, uint32_t v) {
    if (s->row[v] == GVC_NONE || s->plain[v]) return false;
    s->plain[v] = 1;
    return true;
}

/** Marks the corners of faces that have turned over, and their neighbours if that is not enough;
 * false if all are marked already. */
static bool mark_flipped(solver *s, bool neighbours) {
    const gvc_halfedges *m = &s->disk->mesh;
    bool marked = false;
    for (size_t f = 0; f < m->face_count; f++) {
        if (measure_face(m, s->uv, f).plane > 0) continue;
        for (int k = 0; k < 3; k++) {
            uint32_t first = m->outgoing[m->vertex[3 * f + k]], h = first;
            marked = mark(s, m->vertex[h]) || marked;
            do {
                if (neighbours) {
                    marked = mark(s, m->vertex[gvc_next(h)]) || marked;
                    marked = mark(s, m->vertex[gvc_prev(h)]) || marked;
                }
                h = gvc_turn(m, h);
            } while (h != GVC_NONE && h != first);
        }
    }
    return marked;
}

/** Solves, and where faces of the mesh turn over, which the edges of the other triangulation do not
 * hold in place, solves again with mean value coordinates of the mesh at their corners: on captures
 * at some twenty vertices. In the end everywhere. */
static gvc_result solve_unfolded(solver *s, gvc_error *error) {
    GVC_TRY(solve(s, false, error));
    for (int i = 0; i <= MOST_REPAIRS && count_flips(&s->disk->mesh, s->uv) > 0; i++) {
        bool marked = i < MOST_REPAIRS && (mark_flipped(s, false) || mark_flipped(s, true));
        if (!marked) memset(s->plain, 1, s->disk->mesh.vertex_count);
        solver_forget_pattern(s);
        GVC_TRY(solve(s, false, error));
        if (!marked) break;
    }
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------ attempts */

/** Maps in the order of gvc_parameterize_report.fallback. */
enum { ASKED_FOR = 0, NO_CURVATURE = 1, HARMONIC = 2, UNIFORM = 3 };

/** Tries the maps from the best on; leaves the first without a flip, or the last, in s->uv. */
static gvc_result attempt(solver *s, const gvc_parameterize_options *options,
                          gvc_parameterize_report *report, double *harmonic, double *sigma,
                          double *curvature, gvc_error *error) {
    const gvc_halfedges *m = &s->disk->mesh;
    size_t n = m->vertex_count;
    bool bends = options->curvature_exponent != 0, stretches = options->stretch_exponent != 0;
    mean_value_weights(s);
    GVC_TRY(harmonic_weights(s, error));
    for (size_t v = 0; v < n; v++) s->scale[v] = 1;
    GVC_TRY(solve_unfolded(s, error));
    memcpy(harmonic, s->uv, 2 * n * sizeof *harmonic);
    vertex_stretch(s, harmonic, s->scale, sigma);
    limit_stretch(&s->delaunay, sigma);
    if (bends) GVC_TRY(gvc_curvature(s->disk, curvature, error));

    for (report->fallback = ASKED_FOR;; report->fallback++) {
        if (report->fallback == NO_CURVATURE && !bends) continue; /* has just been tried */
        switch (report->fallback) {
        case ASKED_FOR:
            if (!bends && !stretches) break; /* harmonic it is, solved above */
            stretch_scale(s, sigma, options->stretch_exponent, bends ? curvature : NULL,
                          options->curvature_exponent);
            GVC_TRY(solve_unfolded(s, error));
            break;
        case NO_CURVATURE:
            stretch_scale(s, sigma, options->stretch_exponent, NULL, 0);
            GVC_TRY(solve_unfolded(s, error));
            break;
        case HARMONIC:
            memcpy(s->uv, harmonic, 2 * n * sizeof *harmonic);
            break;
        default:
            for (size_t v = 0; v < n; v++) s->scale[v] = 1;
            solver_forget_pattern(s);
            GVC_TRY(solve(s, true, error));
        }
        report->flipped = count_flips(m, s->uv);
        if (report->flipped == 0 || report->fallback == UNIFORM) return GVC_OK;
    }
}

gvc_result gvc_parameterize(const gvc_disk *disk, uint32_t size,
                            const gvc_parameterize_options *options, double *uv,
                            gvc_parameterize_report *report, gvc_error *error) {
    size_t n = disk->mesh.vertex_count;
    solver s = {.square = (size - 1.0) * (size - 1.0)};
    gvc_parameterize_report made = {0};
    gvc_result result = GVC_OK;
    double *harmonic = gvc_alloc(2 * n, sizeof *harmonic);
    double *sigma = gvc_alloc(n, sizeof *sigma), *curvature = gvc_alloc(n, sizeof *curvature);
    klu_defaults(&s.common);
    s.common.btf = 0;      /* the inner vertices are one block but for a few loose ones */
    s.common.ordering = 0; /* AMD */
    s.common.scale = 0;    /* rows already have the diagonal 1 */
    s.common.tol = 0;      /* keep the diagonal pivots */
    if (!harmonic || !sigma || !curvature) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(solver_allocate(&s, disk, uv, error));
    GVC_CHECK(attempt(&s, options, &made, harmonic, sigma, curvature, error));
    if (made.flipped > 0) {
        result = gvc_fail(error, GVC_ERROR_MESH,
                          "%zu of %zu triangles are flipped in every parameterization tried",
                          made.flipped, disk->mesh.face_count);
        goto cleanup;
    }
    memcpy(uv, s.uv, 2 * n * sizeof *uv);
    made.stretch = total_stretch(&disk->mesh, uv, s.square);
    if (report) *report = made;
cleanup:
    solver_free(&s);
    free(harmonic);
    free(sigma);
    free(curvature);
    return result;
}
