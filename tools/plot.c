/* SPDX-License-Identifier: MIT */
/** @file plot.c  Curves over time with a logarithmic scale, as SVG. */
#include "plot.h"

#include "compare_text.h"

#include <math.h>
#include <stdio.h>

/* Pixels. */
#define WIDTH 820
#define HEIGHT 360 /* of a panel */
#define LEFT 84.0
#define RIGHT 804.0
#define TOP 46.0
#define BOTTOM 306.0
#define TICK 5.0
#define LEGEND_STEP 86.0
#define MOST_TICKS 10

typedef struct scales {
    size_t last;      /* x */
    double low, high; /* powers of ten */
    double offset;    /* of the panel, down */
} scales;

static scales find_scales(const plot_panel *panel, size_t index) {
    scales s = {.low = INFINITY, .high = -INFINITY, .offset = (double)index * HEIGHT};
    for (size_t c = 0; c < panel->curve_count; c++) {
        const plot_curve *curve = &panel->curve[c];
        if (curve->count > s.last) s.last = curve->count;
        for (size_t i = 0; i < curve->count; i++) {
            if (!(curve->value[i] > 0) || !isfinite(curve->value[i])) continue;
            s.low = fmin(s.low, log10(curve->value[i]));
            s.high = fmax(s.high, log10(curve->value[i]));
        }
    }
    if (s.low > s.high) s.low = s.high = 0;
    s.low = floor(s.low);
    s.high = fmax(ceil(s.high), s.low + 1);
    return s;
}

static double place_x(const scales *s, size_t x) {
    double span = s->last > 1 ? (double)(s->last - 1) : 1;
    return LEFT + (RIGHT - LEFT) * (double)(x - 1) / span;
}

static double place_y(const scales *s, double value) {
    double exponent = value > 0 ? fmin(fmax(log10(value), s->low), s->high) : s->low;
    return s->offset + BOTTOM - (BOTTOM - TOP) * (exponent - s->low) / (s->high - s->low);
}

/* ----------------------------------------------------------------------------------------- marks
 */

static void number(gvc_buffer *text, double value) {
    char cell[TEXT_CELL];
    text_fixed(cell, value, 2);
    text_append(text, cell);
}

static void line(gvc_buffer *text, double x1, double y1, double x2, double y2, const char *style) {
    text_append(text, "<path class=\"");
    text_append(text, style);
    text_append(text, "\" d=\"M");
    number(text, x1);
    text_append(text, " ");
    number(text, y1);
    text_append(text, "L");
    number(text, x2);
    text_append(text, " ");
    number(text, y2);
    text_append(text, "\"/>\n");
}

static void escape(gvc_buffer *text, const char *words) {
    for (; *words; words++) {
        switch (*words) {
        case '&':
            text_append(text, "&amp;");
            break;
        case '<':
            text_append(text, "&lt;");
            break;
        default:
            if ((unsigned char)*words >= 0x20) gvc_write_bytes(text, words, 1);
        }
    }
}

static void words_at(gvc_buffer *text, double x, double y, const char *style, const char *words) {
    text_append(text, "<text class=\"");
    text_append(text, style);
    text_append(text, "\" x=\"");
    number(text, x);
    text_append(text, "\" y=\"");
    number(text, y);
    text_append(text, "\">");
    escape(text, words);
    text_append(text, "</text>\n");
}

/* ------------------------------------------------------------------------------------------ axes
 */

/* 1, 2 or 5 times a power of ten, so that there are not too many ticks. */
static size_t tick_step(size_t last) {
    for (size_t power = 1;; power *= 10) {
        if (last / power <= MOST_TICKS) return power;
        if (last / (2 * power) <= MOST_TICKS) return 2 * power;
        if (last / (5 * power) <= MOST_TICKS) return 5 * power;
    }
}

static void x_axis(const plot_panel *panel, const scales *s, gvc_buffer *text) {
    double bottom = s->offset + BOTTOM;
    size_t step = tick_step(s->last);
    char cell[TEXT_CELL];
    line(text, LEFT, bottom, RIGHT, bottom, "axis");
    for (size_t x = step; x <= s->last; x += step) {
        line(text, place_x(s, x), bottom, place_x(s, x), bottom + TICK, "axis");
        text_fixed(cell, (double)x, 0);
        words_at(text, place_x(s, x), bottom + 20, "middle", cell);
    }
    words_at(text, (LEFT + RIGHT) / 2, bottom + 40, "middle", panel->x_label);
}

/* Powers of ten are written out as long as they are short. */
static void power_of_ten(int exponent, char cell[TEXT_CELL]) {
    if (exponent >= 0 && exponent <= 6) {
        text_fixed(cell, pow(10, exponent), 0);
    } else if (exponent < 0 && exponent >= -4) {
        text_fixed(cell, pow(10, exponent), -exponent);
    } else {
        snprintf(cell, TEXT_CELL, "1e%d", exponent);
    }
}

static void y_axis(const plot_panel *panel, const scales *s, gvc_buffer *text) {
    char cell[TEXT_CELL];
    line(text, LEFT, s->offset + TOP, LEFT, s->offset + BOTTOM, "axis");
    for (int e = (int)s->low; e <= (int)s->high; e++) {
        double y = place_y(s, pow(10, e));
        if (e > (int)s->low) line(text, LEFT, y, RIGHT, y, "grid");
        line(text, LEFT - TICK, y, LEFT, y, "axis");
        power_of_ten(e, cell);
        words_at(text, LEFT - TICK - 4, y + 4, "end", cell);
        for (int k = 2; k < 10 && e < (int)s->high; k++) {
            double minor = place_y(s, k * pow(10, e));
            line(text, LEFT - TICK / 2, minor, LEFT, minor, "axis");
        }
    }
    text_append(text, "<text class=\"middle\" transform=\"translate(20 ");
    number(text, s->offset + (TOP + BOTTOM) / 2);
    text_append(text, ") rotate(-90)\">");
    escape(text, panel->y_label);
    text_append(text, "</text>\n");
}

/* ---------------------------------------------------------------------------------------- curves
 */

static void draw_curve(const plot_curve *curve, const scales *s, gvc_buffer *text) {
    text_append(text, "<path class=\"curve\" stroke=\"");
    escape(text, curve->color);
    text_append(text, "\" d=\"");
    for (size_t i = 0; i < curve->count; i++) {
        text_append(text, i ? "L" : "M");
        number(text, place_x(s, i + 1));
        text_append(text, " ");
        number(text, place_y(s, curve->value[i]));
    }
    /* a single point shows as a dot, by its round ends */
    text_append(text, curve->count == 1 ? "h0\"/>\n" : "\"/>\n");
}

static void legend(const plot_panel *panel, const scales *s, gvc_buffer *text) {
    double x = RIGHT - LEGEND_STEP * (double)panel->curve_count + 14, y = s->offset + 24;
    for (size_t c = 0; c < panel->curve_count; c++, x += LEGEND_STEP) {
        text_append(text, "<path class=\"curve\" stroke=\"");
        escape(text, panel->curve[c].color);
        text_append(text, "\" d=\"M");
        number(text, x);
        text_append(text, " ");
        number(text, y - 4);
        text_append(text, "h22\"/>\n");
        words_at(text, x + 28, y, "start", panel->curve[c].label);
    }
}

void plot_svg(const plot_panel *panels, size_t count, gvc_buffer *text) {
    size_t height = HEIGHT * (count ? count : 1);
    text_format(text, "<svg xmlns=\"http://www.w3.org/2000/svg\"");
    text_format(text, " width=\"%d\" height=\"%zu\"", WIDTH, height);
    text_format(text, " viewBox=\"0 0 %d %zu\">\n", WIDTH, height);
    text_append(text, "<style>"
                      "text{font:13px sans-serif;fill:#222}.title{font-weight:bold;font-size:15px}"
                      ".middle{text-anchor:middle}.end{text-anchor:end}"
                      "path{fill:none}.axis{stroke:#222}.grid{stroke:#ddd}"
                      ".curve{stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round}"
                      "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
    for (size_t p = 0; p < count; p++) {
        scales s = find_scales(&panels[p], p);
        words_at(text, LEFT, s.offset + 24, "title", panels[p].title);
        y_axis(&panels[p], &s, text);
        x_axis(&panels[p], &s, text);
        for (size_t c = 0; c < panels[p].curve_count; c++) {
            draw_curve(&panels[p].curve[c], &s, text);
        }
        legend(&panels[p], &s, text);
    }
    text_append(text, "</svg>\n");
}
