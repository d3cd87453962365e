/* SPDX-License-Identifier: MIT */
/** @file allocation.h  Allocations of the library, counted and made to fail: its own calls of
 * malloc, calloc, realloc and free are redirected by the linker (--wrap), those of its dependencies
 * are not. Thread-safe. */
#ifndef GVC_TESTS_ALLOCATION_H
#define GVC_TESTS_ALLOCATION_H

#include <stddef.h>
#include <stdint.h>

#define NEVER_FAIL UINT64_MAX

/** Counts from 0 and lets allocation number `failing`, and no other, fail. */
void allocation_begin(uint64_t failing);
/** Allocations since then, the one that failed among them. */
uint64_t allocation_count(void);
/** Blocks that are held, of all time. */
int64_t allocation_blocks(void);

#endif
