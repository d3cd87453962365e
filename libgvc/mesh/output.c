/* SPDX-License-Identifier: MIT */
/** @file output.c  Writing a file that appears only when whole. */
#include "mesh/file.h"

#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 18, ATTEMPTS = 100 };

static gvc_result fail_exists(const char *path, gvc_error *error) {
    gvc_fail(error, GVC_ERROR_IO, "the file exists");
    return gvc_fail_in(error, GVC_ERROR_IO, path);
}

/** Makes a new file "<path>.tmp-<pid>", or with a number after it while that name is taken (another
 *  thread may be writing the same file). Permissions follow the umask, which mkstemp would not. */
static gvc_result open_temporary(gvc_output *o, gvc_error *error) {
    size_t room = strlen(o->path) + 64;
    o->temporary = gvc_alloc(room, 1);
    if (!o->temporary) return gvc_fail_memory(error);
    int number = EEXIST;
    for (int attempt = 0; attempt < ATTEMPTS && number == EEXIST; attempt++) {
        int length = snprintf(o->temporary, room, "%s.tmp-%ld", o->path, (long)getpid());
        if (attempt) snprintf(o->temporary + length, room - (size_t)length, "-%d", attempt);
        o->descriptor = open(o->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (o->descriptor >= 0) return GVC_OK;
        number = errno;
        if (number == EINTR) number = EEXIST; /* the next name will do as well */
    }
    return gvc_fail_errno(error, "create", number, o->path);
}

static gvc_result open_target(gvc_output *o, gvc_error *error) {
    if (strcmp(o->path, "-") == 0) {
        o->path = "standard output";
        o->descriptor = STDOUT_FILENO;
        return GVC_OK;
    }
    struct stat status;
    bool exists = lstat(o->path, &status) == 0;
    if (exists && !o->overwrite) return fail_exists(o->path, error);
    if (exists && S_ISDIR(status.st_mode)) return gvc_fail_errno(error, "write", EISDIR, o->path);
    /* A device or pipe is written to, not replaced. */
    if (exists && stat(o->path, &status) == 0 && !S_ISREG(status.st_mode)) {
        o->descriptor = open(o->path, O_WRONLY | O_CLOEXEC);
        return o->descriptor < 0 ? gvc_fail_errno(error, "write", errno, o->path) : GVC_OK;
    }
    return open_temporary(o, error);
}

gvc_result gvc_output_begin(const char *path, bool overwrite, gvc_output *output,
                            gvc_error *error) {
    *output = (gvc_output){.path = path, .descriptor = -1, .overwrite = overwrite};
    output->buffer = gvc_alloc(BUFFER_SIZE, 1);
    gvc_result result = output->buffer ? open_target(output, error) : gvc_fail_memory(error);
    if (result != GVC_OK) {
        free(output->buffer);
        free(output->temporary);
    }
    return result;
}

static void flush(gvc_output *o) {
    for (size_t done = 0; done < o->used && !o->failure;) {
        ssize_t count = write(o->descriptor, o->buffer + done, o->used - done);
        if (count >= 0)
            done += (size_t)count;
        else if (errno != EINTR)
            o->failure = errno;
    }
    o->used = 0;
}

char *gvc_output_room(gvc_output *output, size_t size) {
    if (BUFFER_SIZE - output->used < size) flush(output);
    return output->buffer + output->used;
}

/** Gives the finished temporary file its name. Without `overwrite`, link(2) is what fails for a
 *  name that has come into being meanwhile; file systems without links get the weaker check. */
static gvc_result publish(const gvc_output *o, gvc_error *error) {
    if (!o->overwrite) {
        if (link(o->temporary, o->path) == 0) {
            unlink(o->temporary);
            return GVC_OK;
        }
        struct stat status;
        if (errno == EEXIST || lstat(o->path, &status) == 0) return fail_exists(o->path, error);
    }
    if (rename(o->temporary, o->path) == 0) return GVC_OK;
    return gvc_fail_errno(error, "write", errno, o->path);
}

gvc_result gvc_output_end(gvc_output *o, gvc_error *error) {
    flush(o);
    /* A file system may tell of a full disk only here. */
    if (o->descriptor != STDOUT_FILENO && close(o->descriptor) != 0 && !o->failure &&
        errno != EINTR)
        o->failure = errno;
    gvc_result result = GVC_OK;
    if (o->failure) result = gvc_fail_errno(error, "write", o->failure, o->path);
    if (result == GVC_OK && o->temporary) result = publish(o, error);
    if (result != GVC_OK && o->temporary) unlink(o->temporary);
    free(o->buffer);
    free(o->temporary);
    *o = (gvc_output){.descriptor = -1};
    return result;
}
