/* SPDX-License-Identifier: MIT */
/** @file seed_torus.h  The least chart with a handle: one node, two loops. */
#ifndef GVC_FUZZ_SEED_TORUS_H
#define GVC_FUZZ_SEED_TORUS_H

#include "container/shape_record.h"

/** What the chart is made of. */
typedef struct torus_parts {
    uint32_t steps[2];
    gvc_side side[4];
    gvc_shape_node node[1];
    gvc_shape_edge edge[2];
    gvc_chart_shape chart;
} torus_parts;

/** A shape that lives as long as `parts`; its chart has size * size samples. */
static inline gvc_shape make_torus(torus_parts *parts, uint32_t size) {
    *parts = (torus_parts){.steps = {size - 1, size - 1},
                           .side = {{0, false}, {1, false}, {0, true}, {1, true}}};
    parts->chart = (gvc_chart_shape){.genus = 1,
                                     .step = 0.5,
                                     .node_count = 1,
                                     .edge_count = 2,
                                     .node = parts->node,
                                     .edge = parts->edge,
                                     .sides = {size, 5, 2, parts->steps, 4, parts->side}};
    return (gvc_shape){.chart_count = 1, .chart = &parts->chart};
}

#endif
