/* SPDX-License-Identifier: MIT */
/** @file compare_paper_print.c  The paper's tables as text. */
#include "compare_paper.h"
#include "compare_text.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS 6 /* at most, beside the first */
#define LABEL 100

/* ------------------------------------------------------------------------------------ a table */

typedef struct table_row {
    char label[LABEL];
    char cell[COLUMNS][TEXT_CELL];
} table_row;

/* A label and numbers in columns as wide as they need be. The first row is the head. */
typedef struct table {
    table_row *row;
    size_t row_count, capacity, columns;
    bool failed;
} table;

static table_row *add_row(table *t, const char *label) {
    if (!gvc_grow((void **)&t->row, &t->capacity, t->row_count + 1, sizeof *t->row)) {
        t->failed = true;
        return NULL;
    }
    table_row *row = &t->row[t->row_count++];
    *row = (table_row){.cell = {""}};
    snprintf(row->label, sizeof row->label, "%s", label);
    return row;
}

static void add_head(table *t, const char *const *title, size_t columns) {
    table_row *row = add_row(t, "capture");
    t->columns = columns;
    for (size_t c = 0; row && c < columns; c++) {
        snprintf(row->cell[c], sizeof row->cell[c], "%s", title[c]);
    }
}

static void add_numbers(table *t, const char *label, const double *value, const int *decimals) {
    table_row *row = add_row(t, label);
    for (size_t c = 0; row && c < t->columns; c++) text_fixed(row->cell[c], value[c], decimals[c]);
}

/* Prints and empties the table. */
static void print_table(table *t, gvc_buffer *text) {
    size_t width[COLUMNS] = {0}, label = 0;
    for (size_t r = 0; r < t->row_count; r++) {
        if (strlen(t->row[r].label) > label) label = strlen(t->row[r].label);
        for (size_t c = 0; c < t->columns; c++) {
            size_t length = strlen(t->row[r].cell[c]);
            if (length > width[c]) width[c] = length;
        }
    }
    for (size_t r = 0; r < t->row_count; r++) {
        text_append(text, t->row[r].label);
        text_padding(text, label, strlen(t->row[r].label));
        for (size_t c = 0; c < t->columns; c++) text_right(text, t->row[r].cell[c], width[c]);
        text_append(text, "\n");
    }
    text->failed |= t->failed;
    free(t->row);
    *t = (table){0};
}

/* ----------------------------------------------------------------------------------- the tables */

static double ratio(double a, double b) { return b > 0 ? a / b : NAN; }

static double mse_of(const paper_capture *capture, paper_method method) {
    const paper_result *result = &capture->result[method];
    return result->measured ? result->mse_mean : NAN;
}

static const paper_result *coded(const paper_capture *capture, paper_method method) {
    static const paper_result none = {.hausdorff = NAN, .rms = NAN, .bytes = NAN};
    const paper_result *result = &capture->result[method];
    return result->measured ? result : &none;
}

static void paper_label(const paper_row *row, char label[LABEL]) {
    snprintf(label, LABEL, "  in the paper: %s", row->name);
}

static void print_mse(const paper_capture *captures, size_t count, gvc_buffer *text) {
    static const char *const title[] = {"frames", "gis",       "fixed",
                                        "mixed",  "gis/fixed", "mixed/fixed"};
    static const int decimals[] = {0, 2, 2, 2, 2, 3};
    char label[LABEL];
    table t = {0};
    text_append(text,
                "\nTable 1. Mean squared difference of consecutive 8-bit geometry images before "
                "coding. 0..255 is the side of the smallest\ncube round all frames of the capture "
                "(mixed: of that capture). The paper does not say whether it sums components.\n");
    add_head(&t, title, 6);
    for (size_t i = 0; i < count; i++) {
        const paper_capture *c = &captures[i];
        for (int parts = 1; parts <= PAPER_COMPONENTS; parts += PAPER_COMPONENTS - 1) {
            double gis = mse_of(c, PAPER_GIS) / parts, fixed = mse_of(c, PAPER_FIXED) / parts;
            double mixed = mse_of(c, PAPER_MIXED) / parts;
            const double value[] = {(double)c->frame_count, gis, fixed, mixed, ratio(gis, fixed),
                                    ratio(mixed, fixed)};
            snprintf(label, sizeof label, "%s, %s", c->name,
                     parts == 1 ? "summed over x, y, z" : "mean per component");
            add_numbers(&t, label, value, decimals);
        }
        if (!c->row) continue;
        const double *m = c->row->mse;
        const double value[] = {c->row->frame_count,
                                m[PAPER_GIS],
                                m[PAPER_FIXED],
                                m[PAPER_MIXED],
                                ratio(m[PAPER_GIS], m[PAPER_FIXED]),
                                ratio(m[PAPER_MIXED], m[PAPER_FIXED])};
        paper_label(c->row, label);
        add_numbers(&t, label, value, decimals);
    }
    print_table(&t, text);
}

static void print_hausdorff(const paper_capture *captures, size_t count, gvc_buffer *text) {
    static const char *const title[] = {"frames", "gis", "ours", "125 vertices"};
    static const int decimals[] = {0, 4, 4, 4};
    char label[LABEL];
    table t = {0};
    text_append(text,
                "\nTable 2. Mean Hausdorff distance of the decoded frames to the originals, the "
                "worse direction, as a fraction of the\nbounding box's diagonal. (The paper does "
                "not say that its images were coded for this.)\n");
    add_head(&t, title, 4);
    for (size_t i = 0; i < count; i++) {
        const paper_capture *c = &captures[i];
        const double value[] = {(double)c->frame_count, coded(c, PAPER_GIS)->hausdorff,
                                coded(c, PAPER_FIXED)->hausdorff, c->hausdorff_reference};
        add_numbers(&t, c->name, value, decimals);
        if (!c->row) continue;
        const double paper[] = {c->row->frame_count, c->row->hausdorff_gis, c->row->hausdorff_ours,
                                c->row->hausdorff_reference};
        paper_label(c->row, label);
        add_numbers(&t, label, paper, decimals);
    }
    print_table(&t, text);
}

static void print_bytes(const paper_capture *captures, size_t count, gvc_buffer *text) {
    static const char *const title[] = {"frames", "OFF (zip)", "gis",
                                        "ours",   "ours/gis",  "zip/ours"};
    static const int decimals[] = {0, 1, 1, 1, 3, 1};
    char label[LABEL];
    table t = {0};
    text_append(text, "\nTable 3. Bytes of the whole capture, in KB of 1,000. ours: the whole .gvc "
                      "file. gis: the same video settings, and the shape\nrecord each of its "
                      "layouts needs; no file around it.\n");
    add_head(&t, title, 6);
    for (size_t i = 0; i < count; i++) {
        const paper_capture *c = &captures[i];
        double gis = coded(c, PAPER_GIS)->bytes, ours = coded(c, PAPER_FIXED)->bytes;
        const double value[] = {(double)c->frame_count, c->zip_bytes / PAPER_KB,
                                gis / PAPER_KB,         ours / PAPER_KB,
                                ratio(ours, gis),       ratio(c->zip_bytes, ours)};
        add_numbers(&t, c->name, value, decimals);
        if (!c->row) continue;
        const paper_row *r = c->row;
        const double paper[] = {r->frame_count,
                                r->kb_zip,
                                r->kb_gis,
                                r->kb_ours,
                                ratio(r->kb_ours, r->kb_gis),
                                ratio(r->kb_zip, r->kb_ours)};
        paper_label(r, label);
        add_numbers(&t, label, paper, decimals);
    }
    print_table(&t, text);
}

void paper_print_tables(const paper_capture *captures, size_t count, const paper_options *options,
                        gvc_buffer *text) {
    char crf[TEXT_CELL];
    text_fixed(crf, options->crf, 1);
    text_format(text, "Geometry images of %u x %u samples", options->size, options->size);
    if (paper_codes(options)) text_format(text, "; H.264 at crf %s", crf);
    if (paper_codes(options)) text_format(text, ", groups of %u frames", options->gop);
    text_append(text, ".\n");
    if (options->table[0]) print_mse(captures, count, text);
    if (options->table[1]) print_hausdorff(captures, count, text);
    if (options->table[2]) print_bytes(captures, count, text);
}
