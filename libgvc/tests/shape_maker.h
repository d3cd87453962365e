/* SPDX-License-Identifier: MIT */
/** @file shape_maker.h  Shapes for tests: charts whose graphs fit their side tables. */
#ifndef GVC_TESTS_SHAPE_MAKER_H
#define GVC_TESTS_SHAPE_MAKER_H

#include "container/shape_record.h"
#include "table_maker.h"

/** A chart at (x, y) around `table`, which it takes over. Its nodes are the welded vertices at the
 * ends of the sides, numbered as met. */
static inline gvc_chart_shape chart_make(gvc_side_table table, uint32_t x, uint32_t y) {
    gvc_weld weld;
    assert_int_equal(gvc_weld_build(&table, &weld, NULL), GVC_OK);
    gvc_chart_shape chart = {.x = x,
                             .y = y,
                             .genus = weld.genus,
                             .origin = {-1.5, 0.25, 1e3},
                             .step = 1.0 / 4096,
                             .edge_count = table.edge_count,
                             .sides = table};
    chart.node = calloc(table.edge_count + 1, sizeof *chart.node);
    chart.edge = calloc(table.edge_count, sizeof *chart.edge);
    uint32_t *met = calloc(table.edge_count + 1, sizeof *met);
    assert_true(chart.node && chart.edge && met);
    uint32_t position = table.start;
    for (size_t i = 0; i < table.side_count; i++) {
        uint32_t px, py, node = 0, edge = table.side[i].edge;
        gvc_border_pixel(table.size, position, &px, &py);
        uint32_t vertex = weld.vertex[py * table.size + px];
        while (node < chart.node_count && met[node] != vertex) node++;
        if (node == chart.node_count) met[chart.node_count++] = vertex;
        chart.edge[edge].node[table.side[i].reversed ? 1 : 0] = node;
        position += table.steps[edge];
    }
    for (uint32_t i = 1; i < chart.node_count; i++) {
        chart.node[i].kind = i % 3 == 0 ? 2 : 1;
        if (chart.node[i].kind == 1) chart.node[i].feature = i * 1000;
    }
    free(met);
    gvc_weld_free(&weld);
    return chart;
}

static inline gvc_side_table table_of_torus(uint32_t size) {
    gvc_side_table table = table_allocate(size, 2);
    table.side[0] = (gvc_side){0, false};
    table.side[1] = (gvc_side){1, false};
    table.side[2] = (gvc_side){0, true};
    table.side[3] = (gvc_side){1, true};
    table.start = 9;
    table.steps[0] = 5;
    table.steps[1] = 2 * (size - 1) - 5;
    return table;
}

/** A star on 33 x 33 at (0, 0) and a torus on 20 x 20 at (33, 7): fits a plane of 64 x 48. */
static inline gvc_shape shape_of_two(void) {
    gvc_shape shape = {.segment = 300, .chart_count = 2};
    shape.chart = calloc(2, sizeof *shape.chart);
    assert_non_null(shape.chart);
    gvc_side_table star = table_star(33, 4);
    star.start = 8;
    shape.chart[0] = chart_make(star, 0, 0);
    shape.chart[1] = chart_make(table_of_torus(20), 33, 7);
    return shape;
}

#endif
