/* SPDX-License-Identifier: MIT */
/** @file plot.h  Curves over time with a logarithmic scale, as SVG. */
#ifndef GVC_TOOLS_PLOT_H
#define GVC_TOOLS_PLOT_H

#include "base/bytes.h"

#define PLOT_MOST_CURVES 4

typedef struct plot_curve {
    const char *label;
    const char *color; /**< as in SVG */
    const double
        *value; /**< at x = 1, 2, ..., count; those that are not positive lie on the axis */
    size_t count;
} plot_curve;

/** One diagram. */
typedef struct plot_panel {
    const char *title, *x_label, *y_label;
    plot_curve curve[PLOT_MOST_CURVES];
    size_t curve_count;
} plot_panel;

/** Appends an SVG document with the panels one below the other, each with its own scales. Numbers
 * do not depend on the locale. Out of memory shows in `text->failed`. */
void plot_svg(const plot_panel *panels, size_t count, gvc_buffer *text);

#endif
