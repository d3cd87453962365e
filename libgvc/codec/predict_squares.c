/* SPDX-License-Identifier: MIT */
/** @file predict_squares.c  Prediction by least squares over what is known so far. */
#include "codec/predict_squares.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if FLT_EVAL_METHOD != 0
#error "Predictions are defined in binary64; this target computes in another precision"
#endif

#define TERMS GVC_SQUARES_TERMS
#define CURRENT_TERMS 7
/* Rows 0 .. TERMS - 1 of the lower triangle of the normal equations, then the right side as one
 * more row: row i begins at i (i + 1) / 2, the last one has TERMS entries. */
#define SUMS (TERMS * (TERMS + 1) / 2 + TERMS)
/* Sums are kept in units of 2^-16, so that far samples count although they are halved away.
 * Greatest sum: 3 components of at most 2^32 each, times 4 for all samples, times 2^16: below 2^53.
 */
#define SUM_UNIT (1 << 16)
/* Pull of the weights to 0: 2^-16 of each diagonal entry and 1. It is far above all errors of
 * rounding, so that every pivot is positive. */
#define PULL_SHIFT 16
#define PULL SUM_UNIT

typedef struct offset {
    int8_t x, y;
} offset;

/* The first CURRENT_TERMS are of this image and known before (x, y). */
static const offset neighbour[TERMS] = {{-1, 0}, {0, -1}, {-1, -1}, {1, -1},  {-2, 0}, {0, -2},
                                        {2, -1}, {-1, 0}, {0, -1},  {-1, -1}, {1, -1}, {1, 0},
                                        {0, 1},  {1, 1},  {-1, 1},  {-2, 0},  {0, -2}, {2, -1}};

typedef int64_t sums[SUMS];

struct gvc_squares {
    uint32_t size;
    const uint16_t *codes, *previous;
    int32_t term[3][TERMS]; /* of the sample just predicted */
    sums left;              /* of the samples before in this row */
    sums *above;            /* per column: of all rows above, then also what `left` was there */
    sums *own;              /* per column: of the sample itself */
};

gvc_squares *gvc_squares_create(uint32_t size, const uint16_t *codes, const uint16_t *previous) {
    gvc_squares *s = gvc_alloc(1, sizeof *s);
    if (!s) return NULL;
    s->size = size;
    s->codes = codes;
    s->previous = previous;
    s->above = gvc_alloc(size, sizeof *s->above);
    s->own = gvc_alloc(size, sizeof *s->own);
    if (s->above && s->own) return s;
    gvc_squares_destroy(s);
    return NULL;
}

void gvc_squares_destroy(gvc_squares *s) {
    if (!s) return;
    free(s->above);
    free(s->own);
    free(s);
}

/* ------------------------------------------------------------------------------------------ terms
 */

static uint32_t clamped(int64_t value, uint32_t size) {
    return value < 0 ? 0 : value >= size ? size - 1 : (uint32_t)value;
}

/* Where the neighbour is, in a plane. Beyond the border of the image the nearest sample stands for
 * it; where that is not known yet, the one to the left, or above in the first column. */
static size_t place_of(const gvc_squares *s, unsigned i, uint32_t x, uint32_t y) {
    uint32_t u = clamped((int64_t)x + neighbour[i].x, s->size);
    uint32_t v = clamped((int64_t)y + neighbour[i].y, s->size);
    if (i < CURRENT_TERMS && v == y && u >= x) {
        if (x > 0) {
            u = x - 1;
        } else {
            u = 0;
            v = y - 1;
        }
    }
    return (size_t)v * s->size + u;
}

static void read_terms(gvc_squares *s, uint32_t x, uint32_t y) {
    size_t plane = (size_t)s->size * s->size, at = (size_t)y * s->size + x;
    bool first = x == 0 && y == 0; /* nothing of this image is known */
    for (unsigned i = first ? CURRENT_TERMS : 0; i < TERMS; i++) {
        const uint16_t *image = i < CURRENT_TERMS ? s->codes : s->previous;
        size_t place = place_of(s, i, x, y);
        for (unsigned k = 0; k < 3; k++) {
            s->term[k][i] = (int32_t)image[k * plane + place] - s->previous[k * plane + at];
        }
    }
    if (first) {
        for (unsigned k = 0; k < 3; k++) memset(s->term[k], 0, CURRENT_TERMS * sizeof(int32_t));
    }
}

/* ---------------------------------------------------------------------------------------- weights
 */

/* Sums with the pull added, as a matrix of TERMS + 1 rows. */
static void gather(const gvc_squares *s, uint32_t x, double a[TERMS + 1][TERMS]) {
    const int64_t *above = s->above[x], *left = s->left;
    for (unsigned i = 0, at = 0; i <= TERMS; i++) {
        for (unsigned j = 0; j <= i && j < TERMS; j++, at++)
            a[i][j] = (double)(above[at] + left[at]);
    }
    for (unsigned i = 0; i < TERMS; i++) a[i][i] += a[i][i] / (1 << PULL_SHIFT) + PULL;
}

/* L D L^T without square roots; the right side is carried along as the last row, which so becomes
 * the solution but for the substitution back. */
static void solve(double a[TERMS + 1][TERMS], double weight[TERMS]) {
    double column[TERMS + 1];
    for (unsigned j = 0; j < TERMS; j++) {
        double inverse = 1 / a[j][j];
        for (unsigned i = j + 1; i <= TERMS; i++) {
            column[i] = a[i][j];
            a[i][j] = column[i] * inverse;
        }
        for (unsigned i = j + 1; i <= TERMS; i++) {
            for (unsigned k = j + 1; k <= i && k < TERMS; k++) a[i][k] -= column[i] * a[k][j];
        }
    }
    memcpy(weight, a[TERMS], TERMS * sizeof *weight);
    for (unsigned i = TERMS - 1; i > 0; i--) {
        for (unsigned k = 0; k < i; k++) weight[k] -= a[i][k] * weight[i];
    }
}

void gvc_squares_predict(gvc_squares *s, uint32_t x, uint32_t y, int32_t expected[3]) {
    double a[TERMS + 1][TERMS], weight[TERMS];
    size_t plane = (size_t)s->size * s->size, at = (size_t)y * s->size + x;
    read_terms(s, x, y);
    gather(s, x, a);
    solve(a, weight);
    for (unsigned k = 0; k < 3; k++, at += plane) {
        double sum = 0;
        for (unsigned i = 0; i < TERMS; i++) sum += weight[i] * s->term[k][i];
        double code = floor(s->previous[at] + sum + 0.5);
        expected[k] = code < 0 ? 0 : code > UINT16_MAX ? UINT16_MAX : (int32_t)code;
    }
}

/* ------------------------------------------------------------------------------------------ learn
 */

/* Products of the sample's terms with each other, and with what was sought. */
static void add_products(const int32_t term[TERMS], int32_t sought, int64_t *sum) {
    for (unsigned i = 0; i < TERMS; i++) {
        for (unsigned j = 0; j <= i; j++) *sum++ += (int64_t)term[i] * term[j] * SUM_UNIT;
    }
    for (unsigned j = 0; j < TERMS; j++) *sum++ += (int64_t)sought * term[j] * SUM_UNIT;
}

/* At the end of a row: adds to each column what lies to the right of it, and moves down a row. */
static void end_row(gvc_squares *s) {
    sums right = {0};
    for (uint32_t x = s->size; x-- > 0;) {
        for (unsigned i = 0; i < SUMS; i++) {
            s->above[x][i] = (s->above[x][i] + right[i]) / 2;
            right[i] = (right[i] + s->own[x][i]) / 2;
        }
    }
    memset(s->left, 0, sizeof s->left);
}

void gvc_squares_learn(gvc_squares *s, uint32_t x, uint32_t y) {
    size_t plane = (size_t)s->size * s->size, at = (size_t)y * s->size + x;
    int64_t *own = s->own[x], *above = s->above[x], *left = s->left;
    memset(own, 0, sizeof(sums));
    for (unsigned k = 0; k < 3; k++, at += plane) {
        add_products(s->term[k], (int32_t)s->codes[at] - s->previous[at], own);
    }
    for (unsigned i = 0; i < SUMS; i++) {
        int64_t both = left[i] + own[i];
        above[i] += both;
        left[i] = both / 2;
    }
    if (x == s->size - 1) end_row(s);
}
