/* SPDX-License-Identifier: MIT */
/** @file live_memory.h  How much memory is held, dependencies included. Counts under
 * AddressSanitizer and with glibc; elsewhere the peak is always 0. */
#ifndef GVC_TESTS_LIVE_MEMORY_H
#define GVC_TESTS_LIVE_MEMORY_H

#include <stdint.h>

/** From here on, what is allocated counts. */
void memory_begin(void);
/** The most bytes held at a time since memory_begin, besides those held then. */
uint64_t memory_peak(void);

/** What may be held besides a limit. (Contexts of codecs count towards it.) */
#define MEMORY_ALLOWANCE (UINT64_C(1) << 16)

#endif
