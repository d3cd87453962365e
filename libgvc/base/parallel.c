/* SPDX-License-Identifier: MIT */
/** @file parallel.c  A parallel for loop whose outcome does not depend on timing. */
#include "base/parallel.h"

#include "base/memory.h"

#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#define MAX_THREADS 256

unsigned gvc_processor_count(void) {
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    if (count < 1) return 1;
    return count > MAX_THREADS ? MAX_THREADS : (unsigned)count;
}

typedef struct loop {
    pthread_mutex_t lock;
    size_t next, count;
    gvc_task task;
    void *context;
    size_t failed_index; /* smallest so far; count if none */
    gvc_result failed_result;
    gvc_error failed_error;
} loop;

static bool take_index(loop *work, size_t *index) {
    pthread_mutex_lock(&work->lock);
    bool any = work->next < work->count && work->failed_result == GVC_OK;
    if (any) *index = work->next++;
    pthread_mutex_unlock(&work->lock);
    return any;
}

/* Indices are handed out in order and every one handed out is finished, so the smallest index that
 * fails at all is always among those that ran: the reported failure is the same on any number of
 * threads. */
static void record_failure(loop *work, size_t index, gvc_result result, const gvc_error *error) {
    pthread_mutex_lock(&work->lock);
    if (index < work->failed_index) {
        work->failed_index = index;
        work->failed_result = result;
        work->failed_error = *error;
    }
    pthread_mutex_unlock(&work->lock);
}

static void *run(void *argument) {
    loop *work = argument;
    size_t index;
    while (take_index(work, &index)) {
        gvc_error error;
        gvc_error_init(&error);
        gvc_result result = work->task(work->context, index, &error);
        if (result != GVC_OK) record_failure(work, index, result, &error);
    }
    return NULL;
}

gvc_result gvc_parallel_for(unsigned threads, size_t count, gvc_task task, void *context,
                            gvc_error *error) {
    loop work = {.count = count, .task = task, .context = context, .failed_index = count};
    if (threads == 0) threads = gvc_processor_count();
    if (threads > MAX_THREADS) threads = MAX_THREADS;
    if (threads > count) threads = count ? (unsigned)count : 1;
    if (pthread_mutex_init(&work.lock, NULL) != 0) return gvc_fail_memory(error);

    pthread_t helper[MAX_THREADS];
    unsigned started = 0;
    while (started + 1 < threads && pthread_create(&helper[started], NULL, run, &work) == 0) {
        started++;
    }
    run(&work);
    for (unsigned i = 0; i < started; i++) pthread_join(helper[i], NULL);
    pthread_mutex_destroy(&work.lock);

    if (work.failed_result != GVC_OK && error) *error = work.failed_error;
    return work.failed_result;
}
