/* SPDX-License-Identifier: MIT */
/** @file match.c  Matches the extrema of two frames. */
#include "descriptor/match.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

/* Work space of the Hungarian algorithm; index 0 stands for "none", as in its usual description. */
typedef struct assignment {
    double *row_potential, *column_potential, *slack;
    size_t *row_at, *came_from; /* per column */
    unsigned char *used;
} assignment;

static void assignment_free(assignment *a) {
    free(a->row_potential);
    free(a->column_potential);
    free(a->slack);
    free(a->row_at);
    free(a->came_from);
    free(a->used);
}

static bool assignment_allocate(assignment *a, size_t rows, size_t columns) {
    a->row_potential = gvc_alloc(rows + 1, sizeof(double));
    a->column_potential = gvc_alloc(columns + 1, sizeof(double));
    a->slack = gvc_alloc(columns + 1, sizeof(double));
    a->row_at = gvc_alloc(columns + 1, sizeof(size_t));
    a->came_from = gvc_alloc(columns + 1, sizeof(size_t));
    a->used = gvc_alloc(columns + 1, 1);
    return a->row_potential && a->column_potential && a->slack && a->row_at && a->came_from &&
           a->used;
}

/* Adds one row to the assignment along a shortest augmenting path. */
static void assign_row(assignment *a, const double *cost, size_t row, size_t columns) {
    size_t column = 0;
    a->row_at[0] = row;
    for (size_t j = 0; j <= columns; j++) {
        a->slack[j] = INFINITY;
        a->used[j] = 0;
    }
    do {
        size_t i = a->row_at[column], next = 0;
        double least = INFINITY;
        a->used[column] = 1;
        for (size_t j = 1; j <= columns; j++) {
            if (a->used[j]) continue;
            double reduced =
                cost[(i - 1) * columns + j - 1] - a->row_potential[i] - a->column_potential[j];
            if (reduced < a->slack[j]) {
                a->slack[j] = reduced;
                a->came_from[j] = column;
            }
            if (a->slack[j] < least || next == 0) {
                least = a->slack[j];
                next = j;
            }
        }
        for (size_t j = 0; j <= columns; j++) {
            if (a->used[j]) {
                a->row_potential[a->row_at[j]] += least;
                a->column_potential[j] -= least;
            } else {
                a->slack[j] -= least;
            }
        }
        column = next;
    } while (a->row_at[column] != 0);
    while (column != 0) {
        size_t from = a->came_from[column];
        a->row_at[column] = a->row_at[from];
        column = from;
    }
}

gvc_result gvc_assign(const double *cost, size_t rows, size_t columns, uint32_t *column_of,
                      gvc_error *error) {
    assignment a = {0};
    if (!assignment_allocate(&a, rows, columns)) {
        assignment_free(&a);
        return gvc_fail_memory(error);
    }
    for (size_t row = 1; row <= rows; row++) assign_row(&a, cost, row, columns);
    for (size_t j = 1; j <= columns; j++)
        if (a.row_at[j] != 0) column_of[a.row_at[j] - 1] = (uint32_t)(j - 1);
    assignment_free(&a);
    return GVC_OK;
}

/* Position decides; the node attributes of Sect. 3.1.3 settle what is close, and a tip that stands
 * out is preferred to a wrinkle beside it. */
static double difference(const gvc_extremum *a, const gvc_extremum *b, double distance) {
    return distance + 0.25 * fabs(a->mu - b->mu) + 0.25 * fabs(sqrt(a->area) - sqrt(b->area)) -
           0.05 * fmin(b->persistence, 0.3);
}

gvc_result gvc_match_extrema(const gvc_extremum *previous, size_t count,
                             const gvc_features *features, double gate, uint32_t *match,
                             bool *found, gvc_error *error) {
    size_t columns = features->extremum_count;
    *found = count <= columns;
    if (!*found || count == 0) return GVC_OK;
    double *cost = gvc_alloc(count * columns, sizeof *cost);
    double *distance = gvc_alloc(count * columns, sizeof *distance);
    gvc_result result = cost && distance ? GVC_OK : gvc_fail_memory(error);
    for (size_t i = 0; result == GVC_OK && i < count; i++)
        for (size_t j = 0; j < columns; j++) {
            const double *p = previous[i].position, *q = features->extremum[j].position;
            double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
            double d = sqrt(x * x + y * y + z * z) / features->diagonal;
            distance[i * columns + j] = d;
            /* Beyond the gate only if there is no other assignment: that is then refused. */
            cost[i * columns + j] =
                difference(&previous[i], &features->extremum[j], d) + (d > gate ? 1000 : 0);
        }
    if (result == GVC_OK) result = gvc_assign(cost, count, columns, match, error);
    for (size_t i = 0; result == GVC_OK && i < count; i++)
        if (distance[i * columns + match[i]] > gate) *found = false;
    free(cost);
    free(distance);
    return result;
}
