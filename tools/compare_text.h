/* SPDX-License-Identifier: MIT */
/** @file compare_text.h  Pieces of tables, JSON and CSV. They do not depend on the locale; out of
 * memory shows in `text->failed`. */
#ifndef GVC_TOOLS_COMPARE_TEXT_H
#define GVC_TOOLS_COMPARE_TEXT_H

#include "base/bytes.h"

#define TEXT_CELL 64

void text_append(gvc_buffer *text, const char *added);
/** At most TEXT_CELL - 1 bytes. */
void text_format(gvc_buffer *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
void text_padding(gvc_buffer *text, size_t width, size_t used);
/** Two blanks and the cell flush right. */
void text_right(gvc_buffer *text, const char *cell, size_t width);

/** A number with so many decimals; "-" for NaN. */
void text_fixed(char cell[TEXT_CELL], double value, int decimals);

/** The exact number, or `absent` if it is NaN or infinite, which JSON has not. */
void text_number(gvc_buffer *text, double value, const char *absent);
/** Quoted and escaped. */
void text_json_string(gvc_buffer *text, const char *string);
/** Quoted where RFC 4180 asks for it. */
void text_csv_string(gvc_buffer *text, const char *string);

#endif
