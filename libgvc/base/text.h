/* SPDX-License-Identifier: MIT */
/** @file text.h  Numbers as text, independent of the locale, exact in both directions. */
#ifndef GVC_BASE_TEXT_H
#define GVC_BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Parses a decimal floating-point number ("nan" and "inf" included, hex not) at [text, end): skips
 * no blanks, returns the first byte after it, or NULL if there is none. Correctly rounded. */
const char *gvc_parse_double(const char *text, const char *end, double *value);
/** Parses an optional sign and decimal digits; NULL if there are none or the value overflows. */
const char *gvc_parse_int(const char *text, const char *end, int64_t *value);

/** Writes the shortest of %.6g...%.17g that reads back to the same double or, if `value` is exactly
 * a float32, to the same float32. At most 32 bytes with the final NUL. Returns the length. */
size_t gvc_format_double(char *text, double value);
size_t gvc_format_uint(char *text, uint64_t value);

#endif
