/* SPDX-License-Identifier: MIT */
/** @file prior.c  Distance to a path in the space of geodesic coordinates. */
#include "descriptor/prior.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

void gvc_prior_free(gvc_prior *prior) {
    free(prior->sample);
    free(prior->box);
    *prior = (gvc_prior){0};
}

static void resample(gvc_prior *prior, const double *point, const double *length, size_t count) {
    size_t n = prior->dimensions, at = 0;
    for (size_t s = 0; s <= GVC_PRIOR_SEGMENTS; s++) {
        double wanted = length[count - 1] * (double)s / GVC_PRIOR_SEGMENTS;
        while (at + 2 < count && length[at + 1] < wanted) at++;
        size_t next = at + 1 < count ? at + 1 : at;
        double span = length[next] - length[at];
        double t = span > 0 ? fmin(1, (wanted - length[at]) / span) : 0;
        for (size_t k = 0; k < n; k++)
            prior->sample[s * n + k] =
                point[at * n + k] + t * (point[next * n + k] - point[at * n + k]);
    }
}

/* Leaf i of the tree is node GVC_PRIOR_SEGMENTS + i and holds segment i. */
static void build_boxes(gvc_prior *prior) {
    size_t n = prior->dimensions;
    for (size_t node = 2 * GVC_PRIOR_SEGMENTS - 1; node >= 1; node--) {
        double *low = prior->box + 2 * n * node, *high = low + n;
        const double *a, *b;
        if (node >= GVC_PRIOR_SEGMENTS) {
            a = prior->sample + n * (node - GVC_PRIOR_SEGMENTS);
            b = a + n;
            for (size_t k = 0; k < n; k++) {
                low[k] = fmin(a[k], b[k]);
                high[k] = fmax(a[k], b[k]);
            }
        } else {
            a = prior->box + 2 * n * (2 * node);
            b = prior->box + 2 * n * (2 * node + 1);
            for (size_t k = 0; k < n; k++) {
                low[k] = fmin(a[k], b[k]);
                high[k] = fmax(a[n + k], b[n + k]);
            }
        }
    }
}

gvc_result gvc_prior_set(gvc_prior *prior, size_t dimensions, const double *point,
                         const double *length, size_t count, gvc_error *error) {
    gvc_prior fresh = {.dimensions = dimensions};
    fresh.sample = gvc_alloc(dimensions * (GVC_PRIOR_SEGMENTS + 1), sizeof *fresh.sample);
    fresh.box = gvc_alloc(dimensions * 4 * GVC_PRIOR_SEGMENTS, sizeof *fresh.box);
    if (!fresh.sample || !fresh.box) {
        gvc_prior_free(&fresh);
        return gvc_fail_memory(error);
    }
    resample(&fresh, point, length, count);
    build_boxes(&fresh);
    gvc_prior_free(prior);
    *prior = fresh;
    return GVC_OK;
}

void gvc_prior_move(gvc_prior *prior, void (*move)(const void *context, double *point),
                    const void *context) {
    for (size_t s = 0; s <= GVC_PRIOR_SEGMENTS; s++)
        move(context, prior->sample + s * prior->dimensions);
    build_boxes(prior);
}

static double box_distance(const gvc_prior *prior, size_t node, const double *point) {
    const double *low = prior->box + 2 * prior->dimensions * node, *high = low + prior->dimensions;
    double sum = 0;
    for (size_t k = 0; k < prior->dimensions; k++) {
        double d = point[k] < low[k]    ? low[k] - point[k]
                   : point[k] > high[k] ? point[k] - high[k]
                                        : 0;
        sum += d * d;
    }
    return sum;
}

static double segment_distance(const gvc_prior *prior, size_t segment, const double *point) {
    size_t n = prior->dimensions;
    const double *a = prior->sample + n * segment, *b = a + n;
    double along = 0, square = 0, sum = 0;
    for (size_t k = 0; k < n; k++) {
        along += (point[k] - a[k]) * (b[k] - a[k]);
        square += (b[k] - a[k]) * (b[k] - a[k]);
    }
    double t = square > 0 ? fmax(0, fmin(1, along / square)) : 0;
    for (size_t k = 0; k < n; k++) {
        double d = point[k] - a[k] - t * (b[k] - a[k]);
        sum += d * d;
    }
    return sum;
}

double gvc_prior_distance(const gvc_prior *prior, const double *point, double limit) {
    struct {
        size_t node;
        double distance;
    } stack[16];
    size_t depth = 0;
    stack[depth].node = 1;
    stack[depth++].distance = box_distance(prior, 1, point);
    while (depth > 0) {
        depth--;
        size_t node = stack[depth].node;
        if (stack[depth].distance >= limit) continue;
        if (node >= GVC_PRIOR_SEGMENTS) {
            limit = fmin(limit, segment_distance(prior, node - GVC_PRIOR_SEGMENTS, point));
            continue;
        }
        double left = box_distance(prior, 2 * node, point);
        double right = box_distance(prior, 2 * node + 1, point);
        size_t near = left <= right ? 0 : 1;
        stack[depth].node = 2 * node + 1 - near; /* the nearer one is looked at first */
        stack[depth++].distance = near ? left : right;
        stack[depth].node = 2 * node + near;
        stack[depth++].distance = near ? right : left;
    }
    return limit;
}
