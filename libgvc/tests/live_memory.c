/* SPDX-License-Identifier: MIT */
/** @file live_memory.c  Counts live bytes: with the hooks of the sanitizers' allocator, or in place
 * of malloc and its kind, which come before those of the C library in every library of the program.
 */
#include "live_memory.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#if defined(__SANITIZE_ADDRESS__)
#define HAVE_HOOKS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAVE_HOOKS 1
#endif
#endif

static _Atomic int64_t held, peak;

static void add(int64_t size) {
    int64_t now = atomic_fetch_add(&held, size) + size, most = peak;
    while (now > most && !atomic_compare_exchange_weak(&peak, &most, now)) {
    }
}

uint64_t memory_peak(void) { return (uint64_t)peak; }

#ifdef HAVE_HOOKS
#include <sanitizer/allocator_interface.h>

static void on_malloc(const volatile void *block, size_t size) {
    (void)block;
    add((int64_t)size);
}

static void on_free(const volatile void *block) {
    if (block) add(-(int64_t)__sanitizer_get_allocated_size(block));
}

void memory_begin(void) {
    static bool installed;
    if (!installed) __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
    installed = true;
    held = peak = 0;
}

#else
void memory_begin(void) { held = peak = 0; }

#ifdef __GLIBC__
#include <errno.h>
#include <malloc.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t number, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *block);

static void *count(void *block) {
    if (block) add((int64_t)malloc_usable_size(block));
    return block;
}

__attribute__((visibility("default"))) void *malloc(size_t size) {
    return count(__libc_malloc(size));
}

__attribute__((visibility("default"))) void *calloc(size_t number, size_t size) {
    return count(__libc_calloc(number, size));
}

__attribute__((visibility("default"))) void *memalign(size_t alignment, size_t size) {
    return count(__libc_memalign(alignment, size));
}

__attribute__((visibility("default"))) void *aligned_alloc(size_t alignment, size_t size) {
    return count(__libc_memalign(alignment, size));
}

__attribute__((visibility("default"))) int posix_memalign(void **block, size_t alignment,
                                                          size_t size) {
    *block = count(__libc_memalign(alignment, size));
    return *block ? 0 : ENOMEM;
}

/* Both blocks are there for a while. */
__attribute__((visibility("default"))) void *realloc(void *block, size_t size) {
    int64_t before = block ? (int64_t)malloc_usable_size(block) : 0;
    void *grown = __libc_realloc(block, size);
    if (!grown && size > 0) return NULL;
    count(grown);
    add(-before);
    return grown;
}

__attribute__((visibility("default"))) void free(void *block) {
    if (block) add(-(int64_t)malloc_usable_size(block));
    __libc_free(block);
}
#endif
#endif
