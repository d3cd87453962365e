/* SPDX-License-Identifier: MIT */
/** @file memory.h  Allocation with overflow checks. Zero elements give a valid, freeable pointer.
 */
#ifndef GVC_BASE_MEMORY_H
#define GVC_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/** `count * size` zeroed bytes, or NULL (also when the product overflows). Free with free(). */
void *gvc_alloc(size_t count, size_t size) __attribute__((warn_unused_result));

/** Grows `*data` (elements of `size` bytes) so that it holds at least `needed`, at least by half.
 *  New bytes are not zeroed. Returns false, and changes nothing, when memory ran out. */
bool gvc_grow(void **data, size_t *capacity, size_t needed, size_t size)
    __attribute__((warn_unused_result));

/** a * b in *product; false on overflow. */
bool gvc_multiply(size_t a, size_t b, size_t *product);
/** a + b in *sum; false on overflow. */
bool gvc_add(size_t a, size_t b, size_t *sum);

#endif
