/* SPDX-License-Identifier: MIT */
/** @file compare_paper_plot.c  The paper's Fig. 9: change of geometry images over time. */
#include "compare_paper.h"
#include "plot.h"

#include "base/memory.h"

#include <stdlib.h>

/* Told apart by those who see colours in other ways, too (Okabe and Ito). */
static const char *const color[PAPER_METHODS] = {"#d55e00", "#0072b2", "#009e73"};

void paper_print_plot(const paper_capture *captures, size_t count, gvc_buffer *text) {
    plot_panel *panel = gvc_alloc(count, sizeof *panel);
    if (!panel) {
        text->failed = true;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        panel[i] = (plot_panel){.title = captures[i].name,
                                .x_label = "frame",
                                .y_label = "MSE to the frame before (summed)"};
        for (int m = 0; m < PAPER_METHODS; m++) {
            const paper_result *r = &captures[i].result[m];
            if (!r->measured || r->frame_count < 2) continue;
            panel[i].curve[panel[i].curve_count++] =
                (plot_curve){.label = paper_method_name((paper_method)m),
                             .color = color[m],
                             .value = r->mse,
                             .count = (size_t)r->frame_count - 1};
        }
    }
    plot_svg(panel, count, text);
    free(panel);
}
