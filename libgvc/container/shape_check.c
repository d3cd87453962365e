/* SPDX-License-Identifier: MIT */
/** @file shape_check.c  The rules for whole shapes. */
#include "container/shape_layout.h"

#include "base/memory.h"

#include <stdlib.h>

static int compare_tops(const void *a, const void *b) {
    const gvc_chart_shape *first = *(const gvc_chart_shape *const *)a;
    const gvc_chart_shape *second = *(const gvc_chart_shape *const *)b;
    if (first->y != second->y) return first->y < second->y ? -1 : 1;
    return first < second ? -1 : first > second; /* both in one array: order of the charts */
}

/** Lays the charts down from top to bottom. bottom[x] is the first row of column x that no chart so
 * far reaches, so a later chart overlaps an earlier one exactly if it begins above it somewhere. */
static gvc_result lay_down(const gvc_chart_shape *const *by_top, size_t chart_count,
                           uint32_t *bottom, gvc_error *error) {
    for (size_t i = 0; i < chart_count; i++) {
        const gvc_chart_shape *chart = by_top[i];
        uint32_t size = chart->sides.size;
        for (uint32_t x = chart->x; x < chart->x + size; x++) {
            if (bottom[x] > chart->y) {
                return gvc_fail(error, GVC_ERROR_CORRUPT,
                                "the chart at (%u, %u) overlaps another one", chart->x, chart->y);
            }
            bottom[x] = chart->y + size;
        }
    }
    return GVC_OK;
}

static gvc_result check_rectangles(const gvc_shape *shape, uint32_t plane_width,
                                   uint32_t plane_height, gvc_error *error) {
    for (size_t i = 0; i < shape->chart_count; i++) {
        const gvc_chart_shape *chart = &shape->chart[i];
        uint32_t size = chart->sides.size;
        if (size > plane_width || chart->x > plane_width - size || size > plane_height ||
            chart->y > plane_height - size) {
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "chart %zu at (%u, %u) leaves the plane of %u x %u samples", i,
                            chart->x, chart->y, plane_width, plane_height);
        }
    }
    gvc_result result = GVC_OK;
    uint32_t *bottom = gvc_alloc(plane_width, sizeof *bottom);
    const gvc_chart_shape **by_top = gvc_alloc(shape->chart_count, sizeof *by_top);
    if (!bottom || !by_top) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    for (size_t i = 0; i < shape->chart_count; i++) by_top[i] = &shape->chart[i];
    qsort(by_top, shape->chart_count, sizeof *by_top, compare_tops);
    result = lay_down(by_top, shape->chart_count, bottom, error);
cleanup:
    free(by_top);
    free(bottom);
    return result;
}

/** Node where a side ends: its edge's second one, or the first if walked in reverse. */
static uint32_t end_node(const gvc_chart_shape *chart, const gvc_side *side) {
    return chart->edge[side->edge].node[side->reversed ? 0 : 1];
}

static uint32_t begin_node(const gvc_chart_shape *chart, const gvc_side *side) {
    return chart->edge[side->edge].node[side->reversed ? 1 : 0];
}

/** Walks around the border: each side must begin at the node where the one before it ends, a node
 * must always be the same vertex of the surface, and every node must be met. Then nodes and welded
 * corners of the sides correspond one to one, because Euler's formula gives both the same number.
 */
static gvc_result walk_sides(const gvc_chart_shape *chart, const gvc_weld *weld, uint32_t *vertex,
                             size_t index, gvc_error *error) {
    const gvc_side_table *sides = &chart->sides;
    size_t met = 0;
    uint32_t position = sides->start;
    uint32_t node_before = end_node(chart, &sides->side[sides->side_count - 1]);
    for (size_t i = 0; i < sides->side_count; i++) {
        const gvc_side *side = &sides->side[i];
        uint32_t node = begin_node(chart, side), x, y;
        if (node != node_before) {
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "chart %zu: side %zu begins at node %u, the one before ends at %u",
                            index, i, node, node_before);
        }
        gvc_border_pixel(sides->size, position, &x, &y);
        uint32_t here = weld->vertex[(size_t)y * sides->size + x];
        if (vertex[node] == UINT32_MAX) {
            vertex[node] = here;
            met++;
        } else if (vertex[node] != here) {
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "chart %zu: node %u is two points of the surface", index, node);
        }
        position += sides->steps[side->edge];
        node_before = end_node(chart, side);
    }
    if (met != chart->node_count) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "chart %zu: %zu of %zu nodes have an edge", index,
                        met, chart->node_count);
    }
    return GVC_OK;
}

static gvc_result check_chart(const gvc_chart_shape *chart, size_t index, gvc_error *error) {
    gvc_weld weld;
    GVC_TRY(gvc_weld_build(&chart->sides, &weld, error));
    gvc_result result = GVC_OK;
    uint32_t *vertex = NULL;
    if (weld.genus != chart->genus) {
        result =
            gvc_fail(error, GVC_ERROR_CORRUPT, "chart %zu says genus %u, its sides give genus %u",
                     index, chart->genus, weld.genus);
        goto cleanup;
    }
    vertex = gvc_alloc(chart->node_count, sizeof *vertex);
    if (!vertex) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    for (size_t i = 0; i < chart->node_count; i++) vertex[i] = UINT32_MAX;
    result = walk_sides(chart, &weld, vertex, index, error);
cleanup:
    free(vertex);
    gvc_weld_free(&weld);
    return result;
}

gvc_result gvc_shape_check(const gvc_shape *shape, uint32_t plane_width, uint32_t plane_height,
                           gvc_error *error) {
    /* First, because disjoint charts bound the work of welding them all. */
    GVC_TRY(check_rectangles(shape, plane_width, plane_height, error));
    for (size_t i = 0; i < shape->chart_count; i++) {
        GVC_TRY(check_chart(&shape->chart[i], i, error));
    }
    return GVC_OK;
}
