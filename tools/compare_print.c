/* SPDX-License-Identifier: MIT */
/** @file compare_print.c  The comparison as a table, as JSON and as CSV. */
#include "compare.h"
#include "compare_text.h"

#include <string.h>

typedef struct column {
    const char *title; /* of the table */
    const char *key;   /* of JSON and CSV */
    double scale;      /* from the value to the table's unit */
    int decimals;      /* in the table */
} column;

/* The numbers of a row, in print order; value_of knows the same order. */
static const column columns[] = {
    {"frames", "frames", 1, 0},
    {"bytes/frame", "bytes_per_frame", 1, 0},
    {"mean e-4", "mean", 1e4, 3},
    {"RMS e-4", "rms", 1e4, 3},
    {"Hausd. max e-4", "hausdorff_max", 1e4, 2},
    {"Hausd. mean e-4", "hausdorff_mean", 1e4, 2},
    {"enc ms", "encode_seconds", 1e3, 1},
    {"dec ms", "decode_seconds", 1e3, 1},
};
#define COLUMNS (sizeof columns / sizeof columns[0])

static double value_of(const compare_row *row, size_t column_index) {
    const double values[COLUMNS] = {
        (double)row->frames, row->bytes,          row->mean,           row->rms,
        row->hausdorff_max,  row->hausdorff_mean, row->encode_seconds, row->decode_seconds};
    return values[column_index];
}

/* ------------------------------------------------------------------------------------ table */

static void table_cell(const compare_row *row, size_t c, char cell[TEXT_CELL]) {
    text_fixed(cell, value_of(row, c) * columns[c].scale, columns[c].decimals);
}

static size_t widest(size_t width, const char *cell) {
    size_t length = strlen(cell);
    return length > width ? length : width;
}

void compare_print_table(const compare_row *rows, size_t count, gvc_buffer *text) {
    char cell[TEXT_CELL];
    size_t method_width = strlen("method"), width[COLUMNS];
    for (size_t r = 0; r < count; r++) method_width = widest(method_width, rows[r].method);
    text_append(text, "method");
    text_padding(text, method_width, strlen("method"));
    for (size_t c = 0; c < COLUMNS; c++) {
        width[c] = strlen(columns[c].title);
        for (size_t r = 0; r < count; r++) {
            table_cell(&rows[r], c, cell);
            width[c] = widest(width[c], cell);
        }
        text_right(text, columns[c].title, width[c]);
    }
    text_append(text, "\n");
    for (size_t r = 0; r < count; r++) {
        text_append(text, rows[r].method);
        text_padding(text, method_width, strlen(rows[r].method));
        for (size_t c = 0; c < COLUMNS; c++) {
            table_cell(&rows[r], c, cell);
            text_right(text, cell, width[c]);
        }
        text_append(text, "\n");
    }
}

/* ----------------------------------------------------------------------------- JSON and CSV */

void compare_print_json(const compare_row *rows, size_t count, gvc_buffer *text) {
    text_append(text, "{\"rows\": [");
    for (size_t r = 0; r < count; r++) {
        text_append(text, r ? ",\n  {\"method\": " : "\n  {\"method\": ");
        text_json_string(text, rows[r].method);
        for (size_t c = 0; c < COLUMNS; c++) {
            text_append(text, ", \"");
            text_append(text, columns[c].key);
            text_append(text, "\": ");
            text_number(text, value_of(&rows[r], c), "null");
        }
        text_append(text, "}");
    }
    text_append(text, count ? "\n]}\n" : "]}\n");
}

void compare_print_csv(const compare_row *rows, size_t count, gvc_buffer *text) {
    text_append(text, "method");
    for (size_t c = 0; c < COLUMNS; c++) {
        text_append(text, ",");
        text_append(text, columns[c].key);
    }
    text_append(text, "\n");
    for (size_t r = 0; r < count; r++) {
        text_csv_string(text, rows[r].method);
        for (size_t c = 0; c < COLUMNS; c++) {
            text_append(text, ",");
            text_number(text, value_of(&rows[r], c), "");
        }
        text_append(text, "\n");
    }
}
