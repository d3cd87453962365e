/* SPDX-License-Identifier: MIT */
/** @file parallel.h  Deterministic data parallelism on POSIX threads. */
#ifndef GVC_BASE_PARALLEL_H
#define GVC_BASE_PARALLEL_H

#include "base/result.h"

/** One unit of work; must only write to what belongs to `index`. */
typedef gvc_result (*gvc_task)(void *context, size_t index, gvc_error *error);

/** Runs task(context, 0..count-1, ...) on up to `threads` threads (the caller's is one; 0: one per
 *  processor) and waits. After a failure no further index is begun. Returns the result, and fills
 * the error, of the smallest failed index, so that messages do not depend on timing. Falls back to
 * fewer threads if some cannot be made. */
gvc_result gvc_parallel_for(unsigned threads, size_t count, gvc_task task, void *context,
                            gvc_error *error);

/** Number of processors online, at least 1. */
unsigned gvc_processor_count(void);

#endif
