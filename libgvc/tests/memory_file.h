/* SPDX-License-Identifier: MIT */
/** @file memory_file.h  Files in memory: a sink that fills a gvc_buffer, and reading from bytes.
 */
#ifndef GVC_TESTS_MEMORY_FILE_H
#define GVC_TESTS_MEMORY_FILE_H

#include <string.h>

#include "base/bytes.h"
#include "gvc/gvc.h"

/** gvc_sink.write: `user` is a gvc_buffer. */
static inline gvc_result sink_write(void *user, const void *data, size_t size, gvc_error *error) {
    (void)error;
    gvc_write_bytes(user, data, size);
    return GVC_OK;
}

/** gvc_io.read: `user` are the bytes. Reads beyond them are for the sanitizers to find. */
static inline gvc_result memory_read(void *user, uint64_t offset, void *data, size_t size,
                                     gvc_error *error) {
    (void)error;
    memcpy(data, (const uint8_t *)user + offset, size);
    return GVC_OK;
}

static inline gvc_io io_of(const uint8_t *data, size_t size) {
    return (gvc_io){.user = (void *)(uintptr_t)data, .size = size, .read = memory_read};
}

#endif
