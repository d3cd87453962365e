/* SPDX-License-Identifier: MIT */
/** @file compare_print.c  The comparison as a table, as JSON and as CSV. */
#include "base/text.h"
#include "compare.h"
#include "json.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CELL 64

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

static void append(gvc_buffer *text, const char *added) {
    gvc_write_bytes(text, added, strlen(added));
}

/* ------------------------------------------------------------------------------------ table */

/* Fixed decimals through integers: printf would take the decimal point from the locale. */
static void format_fixed(char cell[CELL], double value, int decimals) {
    uint64_t unit = 1;
    for (int i = 0; i < decimals; i++) unit *= 10;
    if (isnan(value)) {
        snprintf(cell, CELL, "-");
        return;
    }
    double scaled = round(fabs(value) * (double)unit);
    if (!(scaled < 1e18)) {
        gvc_format_double(cell, value);
        return;
    }
    uint64_t whole = (uint64_t)scaled;
    const char *sign = value < 0 && whole > 0 ? "-" : "";
    if (decimals == 0) {
        snprintf(cell, CELL, "%s%llu", sign, (unsigned long long)whole);
    } else {
        snprintf(cell, CELL, "%s%llu.%0*llu", sign, (unsigned long long)(whole / unit), decimals,
                 (unsigned long long)(whole % unit));
    }
}

static void table_cell(const compare_row *row, size_t c, char cell[CELL]) {
    format_fixed(cell, value_of(row, c) * columns[c].scale, columns[c].decimals);
}

static void append_padding(gvc_buffer *text, size_t width, size_t used) {
    for (size_t i = used; i < width; i++) append(text, " ");
}

static void append_right(gvc_buffer *text, const char *cell, size_t width) {
    append(text, "  ");
    append_padding(text, width, strlen(cell));
    append(text, cell);
}

static size_t widest(size_t width, const char *cell) {
    size_t length = strlen(cell);
    return length > width ? length : width;
}

void compare_print_table(const compare_row *rows, size_t count, gvc_buffer *text) {
    char cell[CELL];
    size_t method_width = strlen("method"), width[COLUMNS];
    for (size_t r = 0; r < count; r++) method_width = widest(method_width, rows[r].method);
    append(text, "method");
    append_padding(text, method_width, strlen("method"));
    for (size_t c = 0; c < COLUMNS; c++) {
        width[c] = strlen(columns[c].title);
        for (size_t r = 0; r < count; r++) {
            table_cell(&rows[r], c, cell);
            width[c] = widest(width[c], cell);
        }
        append_right(text, columns[c].title, width[c]);
    }
    append(text, "\n");
    for (size_t r = 0; r < count; r++) {
        append(text, rows[r].method);
        append_padding(text, method_width, strlen(rows[r].method));
        for (size_t c = 0; c < COLUMNS; c++) {
            table_cell(&rows[r], c, cell);
            append_right(text, cell, width[c]);
        }
        append(text, "\n");
    }
}

/* ----------------------------------------------------------------------------- JSON and CSV */

/* The exact number, or `absent` if there is none (JSON has no NaN and no infinity). */
static void append_number(gvc_buffer *text, double value, const char *absent) {
    char cell[CELL];
    if (!isfinite(value)) {
        append(text, absent);
        return;
    }
    gvc_format_double(cell, value);
    append(text, cell);
}

static void append_json_string(gvc_buffer *text, const char *string) {
    char escaped[JSON_ESCAPED];
    append(text, "\"");
    while (*string) gvc_write_bytes(text, escaped, json_escape(&string, escaped));
    append(text, "\"");
}

void compare_print_json(const compare_row *rows, size_t count, gvc_buffer *text) {
    append(text, "{\"rows\": [");
    for (size_t r = 0; r < count; r++) {
        append(text, r ? ",\n  {\"method\": " : "\n  {\"method\": ");
        append_json_string(text, rows[r].method);
        for (size_t c = 0; c < COLUMNS; c++) {
            append(text, ", \"");
            append(text, columns[c].key);
            append(text, "\": ");
            append_number(text, value_of(&rows[r], c), "null");
        }
        append(text, "}");
    }
    append(text, count ? "\n]}\n" : "]}\n");
}

static void append_csv_string(gvc_buffer *text, const char *string) {
    if (!strpbrk(string, ",\"\r\n")) {
        append(text, string);
        return;
    }
    append(text, "\"");
    for (const char *c = string; *c; c++) {
        if (*c == '"') append(text, "\"");
        gvc_write_bytes(text, c, 1);
    }
    append(text, "\"");
}

void compare_print_csv(const compare_row *rows, size_t count, gvc_buffer *text) {
    append(text, "method");
    for (size_t c = 0; c < COLUMNS; c++) {
        append(text, ",");
        append(text, columns[c].key);
    }
    append(text, "\n");
    for (size_t r = 0; r < count; r++) {
        append_csv_string(text, rows[r].method);
        for (size_t c = 0; c < COLUMNS; c++) {
            append(text, ",");
            append_number(text, value_of(&rows[r], c), "");
        }
        append(text, "\n");
    }
}
