/* SPDX-License-Identifier: MIT */
/** @file read_at.c  Reads a whole stretch of a file. */
#include "read_at.h"

#include <errno.h>
#include <unistd.h>

int gvc_read_at(int descriptor, uint64_t offset, void *data, size_t size) {
    uint8_t *next = data;
    while (size > 0) {
        ssize_t got = pread(descriptor, next, size, (off_t)offset);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno;
        if (got == 0) return GVC_READ_ENDS;
        next += got;
        offset += (uint64_t)got;
        size -= (size_t)got;
    }
    return 0;
}
