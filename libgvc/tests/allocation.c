/* SPDX-License-Identifier: MIT */
/** @file allocation.c  What the linker puts in place of malloc and the others. */
#include "allocation.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

static _Atomic uint64_t count, fails_at = NEVER_FAIL;
static _Atomic int64_t blocks;

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
}

uint64_t allocation_count(void) { return count; }
int64_t allocation_blocks(void) { return blocks; }

static bool fails(void) { return atomic_fetch_add(&count, 1) == fails_at; }

static void *counted(void *block) {
    if (block) blocks++;
    return block;
}

void *__wrap_malloc(size_t size) { return fails() ? NULL : counted(__real_malloc(size)); }

void *__wrap_calloc(size_t number, size_t size) {
    return fails() ? NULL : counted(__real_calloc(number, size));
}

void *__wrap_realloc(void *block, size_t size) {
    if (fails()) return NULL;
    void *grown = __real_realloc(block, size);
    return grown && !block ? counted(grown) : grown;
}

void __wrap_free(void *block) {
    if (block) blocks--;
    __real_free(block);
}
