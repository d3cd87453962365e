/* SPDX-License-Identifier: MIT */
/** @file compare_text.c  Pieces of tables, JSON and CSV. */
#include "compare_text.h"

#include "base/text.h"
#include "json.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void text_append(gvc_buffer *text, const char *added) {
    gvc_write_bytes(text, added, strlen(added));
}

void text_format(gvc_buffer *text, const char *format, ...) {
    char piece[TEXT_CELL];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(piece, sizeof piece, format, arguments);
    va_end(arguments);
    text_append(text, piece);
}

void text_padding(gvc_buffer *text, size_t width, size_t used) {
    for (size_t i = used; i < width; i++) text_append(text, " ");
}

void text_right(gvc_buffer *text, const char *cell, size_t width) {
    text_append(text, "  ");
    text_padding(text, width, strlen(cell));
    text_append(text, cell);
}

/* Fixed decimals through integers: printf would take the decimal point from the locale. */
void text_fixed(char cell[TEXT_CELL], double value, int decimals) {
    uint64_t unit = 1;
    for (int i = 0; i < decimals; i++) unit *= 10;
    if (isnan(value)) {
        snprintf(cell, TEXT_CELL, "-");
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
        snprintf(cell, TEXT_CELL, "%s%llu", sign, (unsigned long long)whole);
    } else {
        snprintf(cell, TEXT_CELL, "%s%llu.%0*llu", sign, (unsigned long long)(whole / unit),
                 decimals, (unsigned long long)(whole % unit));
    }
}

/* The exact number, or `absent` if there is none (JSON has no NaN and no infinity). */
void text_number(gvc_buffer *text, double value, const char *absent) {
    char cell[TEXT_CELL];
    if (!isfinite(value)) {
        text_append(text, absent);
        return;
    }
    gvc_format_double(cell, value);
    text_append(text, cell);
}

void text_json_string(gvc_buffer *text, const char *string) {
    char escaped[JSON_ESCAPED];
    text_append(text, "\"");
    while (*string) gvc_write_bytes(text, escaped, json_escape(&string, escaped));
    text_append(text, "\"");
}

void text_csv_string(gvc_buffer *text, const char *string) {
    if (!strpbrk(string, ",\"\r\n")) {
        text_append(text, string);
        return;
    }
    text_append(text, "\"");
    for (const char *c = string; *c; c++) {
        if (*c == '"') text_append(text, "\"");
        gvc_write_bytes(text, c, 1);
    }
    text_append(text, "\"");
}
