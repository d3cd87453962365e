/* SPDX-License-Identifier: MIT */
/** @file compare_clock.h  CPU seconds, for the costs that `gvc compare` reports. */
#ifndef GVC_TOOLS_COMPARE_CLOCK_H
#define GVC_TOOLS_COMPARE_CLOCK_H

#include <time.h>

static inline double compare_clock_seconds(clockid_t clock) {
    struct timespec now = {0, 0};
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/** Of the calling thread: right for work that one thread does beside others. */
static inline double compare_thread_seconds(void) {
    return compare_clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

/** Of all threads together: right for work that makes threads of its own. */
static inline double compare_process_seconds(void) {
    return compare_clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
}

#endif
