/* SPDX-License-Identifier: MIT */
/** @file shape.c  Plain handling of shapes: free, compare. */
#include "container/shape_record.h"

#include <stdlib.h>
#include <string.h>

void gvc_shape_free(gvc_shape *shape) {
    for (size_t i = 0; i < shape->chart_count; i++) {
        free(shape->chart[i].node);
        free(shape->chart[i].edge);
        gvc_side_table_free(&shape->chart[i].sides);
    }
    free(shape->chart);
    *shape = (gvc_shape){0};
}

static bool nodes_equal(const gvc_chart_shape *a, const gvc_chart_shape *b) {
    if (a->node_count != b->node_count) return false;
    for (size_t i = 0; i < a->node_count; i++) {
        if (a->node[i].kind != b->node[i].kind) return false;
        if (a->node[i].feature != b->node[i].feature) return false;
    }
    return true;
}

static bool edges_equal(const gvc_chart_shape *a, const gvc_chart_shape *b) {
    if (a->edge_count != b->edge_count) return false;
    for (size_t i = 0; i < a->edge_count; i++) {
        if (a->edge[i].node[0] != b->edge[i].node[0]) return false;
        if (a->edge[i].node[1] != b->edge[i].node[1]) return false;
    }
    return true;
}

static bool sides_equal(const gvc_side_table *a, const gvc_side_table *b) {
    if (a->size != b->size || a->start != b->start) return false;
    if (a->edge_count != b->edge_count || a->side_count != b->side_count) return false;
    for (size_t i = 0; i < a->edge_count; i++) {
        if (a->steps[i] != b->steps[i]) return false;
    }
    for (size_t i = 0; i < a->side_count; i++) {
        if (a->side[i].edge != b->side[i].edge) return false;
        if (a->side[i].reversed != b->side[i].reversed) return false;
    }
    return true;
}

static bool charts_equal(const gvc_chart_shape *a, const gvc_chart_shape *b) {
    return a->x == b->x && a->y == b->y && a->genus == b->genus &&
           memcmp(a->origin, b->origin, sizeof a->origin) == 0 &&
           memcmp(&a->step, &b->step, sizeof a->step) == 0 && nodes_equal(a, b) &&
           edges_equal(a, b) && sides_equal(&a->sides, &b->sides);
}

bool gvc_shape_equal(const gvc_shape *a, const gvc_shape *b) {
    if (a->segment != b->segment || a->chart_count != b->chart_count) return false;
    for (size_t i = 0; i < a->chart_count; i++) {
        if (!charts_equal(&a->chart[i], &b->chart[i])) return false;
    }
    return true;
}
