/* SPDX-License-Identifier: MIT */
/** @file memory.c  Allocation with overflow checks. */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>

bool gvc_multiply(size_t a, size_t b, size_t *product) {
    if (b != 0 && a > SIZE_MAX / b) return false;
    *product = a * b;
    return true;
}

bool gvc_add(size_t a, size_t b, size_t *sum) {
    if (a > SIZE_MAX - b) return false;
    *sum = a + b;
    return true;
}

void *gvc_alloc(size_t count, size_t size) {
    size_t bytes;
    if (!gvc_multiply(count, size, &bytes)) return NULL;
    return calloc(bytes ? bytes : 1, 1);
}

bool gvc_grow(void **data, size_t *capacity, size_t needed, size_t size) {
    if (needed <= *capacity && *data) return true;
    size_t wanted = needed, half, bytes;
    if (gvc_add(*capacity, *capacity / 2, &half) && half > wanted) wanted = half;
    if (wanted < 16) wanted = 16;
    if (!gvc_multiply(wanted, size, &bytes)) return false;
    void *grown = realloc(*data, bytes);
    if (!grown) return false;
    *data = grown;
    *capacity = wanted;
    return true;
}
