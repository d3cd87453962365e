/* SPDX-License-Identifier: MIT */
/** @file file.c  Loading a whole file. */
#include "mesh/file.h"

#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/** Reads to the end. `expected` is the size if known; the file may have changed since. */
static gvc_result read_all(int descriptor, size_t expected, const char *name, char **data,
                           size_t *size, gvc_error *error) {
    void *bytes = NULL;
    size_t capacity = 0, used = 0;
    for (;;) {
        /* One byte more than expected, so that the end is seen without growing. */
        size_t needed = used <= expected && expected < SIZE_MAX ? expected + 1 : used + 1;
        if (needed < 65536) needed = 65536;
        if (used == capacity && !gvc_grow(&bytes, &capacity, needed, 1)) {
            free(bytes);
            return gvc_fail_in(error, gvc_fail_memory(error), name);
        }
        ssize_t count = read(descriptor, (char *)bytes + used, capacity - used);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            int number = errno;
            free(bytes);
            return gvc_fail_errno(error, "read", number, name);
        }
        if (count == 0) break;
        used += (size_t)count;
    }
    *data = bytes;
    *size = used;
    return GVC_OK;
}

gvc_result gvc_file_load(const char *path, char **data, size_t *size, gvc_error *error) {
    *data = NULL;
    *size = 0;
    if (strcmp(path, "-") == 0)
        return read_all(STDIN_FILENO, 0, "standard input", data, size, error);
    int descriptor;
    do {
        descriptor = open(path, O_RDONLY | O_CLOEXEC);
    } while (descriptor < 0 && errno == EINTR);
    if (descriptor < 0) return gvc_fail_errno(error, "open", errno, path);
    struct stat status;
    gvc_result result = GVC_OK;
    if (fstat(descriptor, &status) != 0)
        result = gvc_fail_errno(error, "read", errno, path);
    else if (S_ISDIR(status.st_mode))
        result = gvc_fail_errno(error, "read", EISDIR, path);
    else
        result = read_all(descriptor, S_ISREG(status.st_mode) ? (size_t)status.st_size : 0, path,
                          data, size, error);
    close(descriptor);
    return result;
}
