/* SPDX-License-Identifier: MIT */
/** @file allocation.c  What the linker puts in place of malloc and the others. */
#include "allocation.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

static _Atomic uint64_t count, fails_at = NEVER_FAIL;
static _Atomic int64_t blocks, held, base, peak;

void *__real_malloc(size_t size);
void *__real_calloc(size_t number, size_t size);
void *__real_realloc(void *block, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t number, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __wrap_free(void *block);

void allocation_begin(uint64_t failing) {
    count = 0;
    fails_at = failing;
    base = peak = (int64_t)held;
}

uint64_t allocation_count(void) { return count; }
int64_t allocation_blocks(void) { return blocks; }
int64_t allocation_bytes(void) { return held; }
int64_t allocation_peak(void) { return peak - base; }

static bool fails(void) { return atomic_fetch_add(&count, 1) == fails_at; }

static void add(void *block, int sign) {
    if (!block) return;
    int64_t size = (int64_t)malloc_usable_size(block);
    blocks += sign;
    int64_t now = atomic_fetch_add(&held, sign * size) + sign * size, most = peak;
    while (now > most && !atomic_compare_exchange_weak(&peak, &most, now)) {
    }
}

void *__wrap_malloc(size_t size) {
    void *block = fails() ? NULL : __real_malloc(size);
    add(block, 1);
    return block;
}

void *__wrap_calloc(size_t number, size_t size) {
    void *block = fails() ? NULL : __real_calloc(number, size);
    add(block, 1);
    return block;
}

/* Both blocks are there for a while. */
void *__wrap_realloc(void *block, size_t size) {
    if (fails()) return NULL;
    int64_t before = block ? (int64_t)malloc_usable_size(block) : 0;
    void *grown = __real_realloc(block, size);
    if (!grown) return NULL;
    add(grown, 1);
    held -= before;
    blocks -= block != NULL;
    return grown;
}

void __wrap_free(void *block) {
    add(block, -1);
    __real_free(block);
}
