/* SPDX-License-Identifier: MIT */
/**
 * @file fit.c
 * Least-squares fit of a geometry image. Minimises over the change d of the welded vertices
 *     sum over quadrature points k of w_k |B_k (x + d) - p_k|^2 + lambda |d|^2,
 * where x are the point samples, B_k x the bilinear interpolation at the parameter of point k of
 * the surface and p_k that point. The weight of a point is the share of surface area it stands for,
 * and a little of the parameter area so that every sample is determined where the chart is dense.
 */
#include "chart/sample.h"

#include "base/conjugate_gradient.h"
#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

#define SPACING 0.5         /* greatest distance of quadrature points in a face, in pixels */
#define PARAMETER_SHARE .05 /* weight of the parameter domain's area beside the surface's area */
#define TOLERANCE 1e-6
#define MOST_ITERATIONS 200

/** Neighbours of a pixel in the half of its 3 x 3 block that comes later in raster order. */
enum { SELF, EAST, SOUTH_WEST, SOUTH, SOUTH_EAST, STENCIL };

typedef struct fit {
    const gvc_weld *weld;
    size_t size, plane, pad; /* pad: zeros before and after a plane that neighbours may fall into */
    double lambda;
    double *stencil[STENCIL]; /* normal equations before welding: coupling with each neighbour */
    double *grid, *product;   /* a plane before and after the stencil; padded as the stencils */
    double *image;            /* point samples */
    double *diagonal, *right, *change; /* per welded vertex, three planes */
} fit;

static double *padded_plane(const fit *f) {
    return gvc_alloc(f->plane + 2 * f->pad, sizeof(double));
}

static gvc_result fit_allocate(fit *f, gvc_error *error) {
    bool complete = true;
    for (int k = 0; k < STENCIL; k++) {
        f->stencil[k] = padded_plane(f);
        complete = complete && f->stencil[k];
    }
    f->grid = padded_plane(f);
    f->product = padded_plane(f);
    f->diagonal = gvc_alloc(f->weld->vertex_count, 3 * sizeof *f->diagonal);
    f->right = gvc_alloc(f->weld->vertex_count, 3 * sizeof *f->right);
    f->change = gvc_alloc(f->weld->vertex_count, 3 * sizeof *f->change);
    complete = complete && f->grid && f->product && f->diagonal && f->right && f->change;
    return complete ? GVC_OK : gvc_fail_memory(error);
}

static void fit_free(fit *f) {
    for (int k = 0; k < STENCIL; k++) free(f->stencil[k]);
    free(f->grid);
    free(f->product);
    free(f->diagonal);
    free(f->right);
    free(f->change);
}

/** Adds a surface point `p` with parameter `uv` and weight `w` to the normal equations. */
static void add_point(fit *f, const double uv[2], const double p[3], double w) {
    double last = (double)f->size - 1;
    double u = fmin(fmax(uv[0], 0), last), v = fmin(fmax(uv[1], 0), last);
    size_t x = (size_t)fmin(floor(u), last - 1), y = (size_t)fmin(floor(v), last - 1);
    double s = u - (double)x, t = v - (double)y;
    const double b[4] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    size_t q = y * f->size + x, at[4] = {q, q + 1, q + f->size, q + f->size + 1};
    for (size_t c = 0; c < 3; c++) {
        const double *plane = f->image + c * f->plane;
        double residual = p[c];
        for (int k = 0; k < 4; k++) residual -= b[k] * plane[at[k]];
        for (int k = 0; k < 4; k++)
            f->right[c * f->weld->vertex_count + f->weld->vertex[at[k]]] += w * b[k] * residual;
    }
    for (int k = 0; k < 4; k++) f->stencil[SELF][f->pad + at[k]] += w * b[k] * b[k];
    f->stencil[EAST][f->pad + at[0]] += w * b[0] * b[1];
    f->stencil[SOUTH][f->pad + at[0]] += w * b[0] * b[2];
    f->stencil[SOUTH_EAST][f->pad + at[0]] += w * b[0] * b[3];
    f->stencil[SOUTH_WEST][f->pad + at[1]] += w * b[1] * b[2];
    f->stencil[SOUTH][f->pad + at[1]] += w * b[1] * b[3];
    f->stencil[EAST][f->pad + at[2]] += w * b[2] * b[3];
}

/** Adds the face's point at barycentric coordinates (1 - i - j, i, j). */
static void add_face_point(fit *f, const double *corner_uv[3], const double *corner[3], double i,
                           double j, double w) {
    const double b[3] = {1 - i - j, i, j};
    double uv[2] = {0, 0}, p[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < 2; c++) uv[c] += b[k] * corner_uv[k][c];
        for (int c = 0; c < 3; c++) p[c] += b[k] * corner[k][c];
    }
    add_point(f, uv, p, w);
}

/** Adds the centroids of n * n equal parts of a face, n by its size in the parameter domain. */
static void add_face(fit *f, const double *corner_uv[3], const double *corner[3], double weight) {
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = corner_uv[k], *b = corner_uv[(k + 1) % 3];
        longest = fmax(longest, hypot(b[0] - a[0], b[1] - a[1]));
    }
    int n = (int)fmax(ceil(longest / SPACING), 1);
    double part = 1.0 / n, w = weight * part * part;
    for (int i = 0; i < n; i++)
        for (int j = 0; i + j < n; j++) {
            add_face_point(f, corner_uv, corner, (i + 1.0 / 3) * part, (j + 1.0 / 3) * part, w);
            if (i + j + 1 < n)
                add_face_point(f, corner_uv, corner, (i + 2.0 / 3) * part, (j + 2.0 / 3) * part, w);
        }
}

static double face_area(const double *corner[3]) {
    double a[3], b[3];
    for (int c = 0; c < 3; c++) {
        a[c] = corner[1][c] - corner[0][c];
        b[c] = corner[2][c] - corner[0][c];
    }
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

static double parameter_area(const double *uv[3]) {
    return fabs((uv[1][0] - uv[0][0]) * (uv[2][1] - uv[0][1]) -
                (uv[2][0] - uv[0][0]) * (uv[1][1] - uv[0][1])) /
           2;
}

/** Normal equations of all faces; the area of the whole surface counts 1. */
static void assemble(fit *f, const gvc_halfedges *m, const double *uv) {
    const double *corner[3], *corner_uv[3];
    double total = 0, square = ((double)f->size - 1) * ((double)f->size - 1);
    for (int pass = 0; pass < 2; pass++)
        for (size_t face = 0; face < m->face_count; face++) {
            for (int k = 0; k < 3; k++) {
                corner[k] = m->position + 3 * (size_t)m->vertex[3 * face + (size_t)k];
                corner_uv[k] = uv + 2 * (size_t)m->vertex[3 * face + (size_t)k];
            }
            double area = face_area(corner);
            if (pass == 0)
                total += area;
            else
                add_face(f, corner_uv, corner,
                         (total > 0 ? area / total : 0) +
                             PARAMETER_SHARE * parameter_area(corner_uv) / square);
        }
    size_t n = f->weld->vertex_count;
    for (size_t i = 0; i < 3 * n; i++) f->diagonal[i] = f->lambda;
    for (size_t i = 0; i < f->plane; i++)
        for (size_t c = 0; c < 3; c++)
            f->diagonal[c * n + f->weld->vertex[i]] += f->stencil[SELF][f->pad + i];
}

/** product = stencil * grid, one plane. Couplings over the rim of the image are zero. */
static void apply_stencil(const fit *f) {
    const size_t s = f->size;
    for (size_t i = f->pad; i < f->pad + f->plane; i++) {
        const double *x = f->grid + i;
        f->product[i] = f->stencil[SELF][i] * x[0] + f->stencil[EAST][i] * x[1] +
                        f->stencil[SOUTH_WEST][i] * x[s - 1] + f->stencil[SOUTH][i] * x[s] +
                        f->stencil[SOUTH_EAST][i] * x[s + 1] +
                        f->stencil[EAST][i - 1] * f->grid[i - 1] +
                        f->stencil[SOUTH_WEST][i - s + 1] * f->grid[i - s + 1] +
                        f->stencil[SOUTH][i - s] * f->grid[i - s] +
                        f->stencil[SOUTH_EAST][i - s - 1] * f->grid[i - s - 1];
    }
}

/** Normal equations of the welded vertices: spread to samples, stencil, gather. */
static void normal_equations(void *context, const double *x, double *y) {
    const fit *f = context;
    size_t n = f->weld->vertex_count;
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < f->plane; i++) f->grid[f->pad + i] = x[c * n + f->weld->vertex[i]];
        apply_stencil(f);
        for (size_t i = c * n; i < (c + 1) * n; i++) y[i] = f->lambda * x[i];
        for (size_t i = 0; i < f->plane; i++)
            y[c * n + f->weld->vertex[i]] += f->product[f->pad + i];
    }
}

gvc_result gvc_sample_fit(const gvc_disk *disk, const double *uv, const gvc_weld *weld,
                          double regularization, double *image, gvc_error *error) {
    gvc_result result = GVC_OK;
    fit f = {.weld = weld, .size = weld->size, .image = image};
    f.plane = f.size * f.size;
    f.pad = f.size + 1;
    f.lambda = fmax(regularization, 1e-12) / (double)f.plane;
    GVC_CHECK(fit_allocate(&f, error));
    assemble(&f, &disk->mesh, uv);
    GVC_CHECK(gvc_conjugate_gradient(3 * (size_t)weld->vertex_count, normal_equations, &f,
                                     f.diagonal, f.right, TOLERANCE, MOST_ITERATIONS, f.change,
                                     NULL, error));
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < f.plane; i++)
            image[c * f.plane + i] += f.change[c * weld->vertex_count + weld->vertex[i]];
cleanup:
    fit_free(&f);
    return result;
}
