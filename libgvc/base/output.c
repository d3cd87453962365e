/* SPDX-License-Identifier: MIT */
/** @file output.c  An output file that appears under its name only when whole. */
#include "base/output.h"

#include "base/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_SIZE = 1 << 18, ATTEMPTS = 100 };

static gvc_result fail_exists(const gvc_output *o, gvc_error *error) {
    gvc_fail(error, GVC_ERROR_IO, "the file exists");
    return gvc_fail_in(error, GVC_ERROR_IO, o->path);
}

/** Makes a new file "<path>.tmp-<pid>", or with a number after it while that name is taken (another
 *  thread may be writing the same file). Permissions follow the umask, which mkstemp would not. */
static gvc_result open_temporary(gvc_output *o, gvc_error *error) {
    size_t room = strlen(o->path) + 64;
    char *name = gvc_alloc(room, 1);
    if (!name) return gvc_fail_memory(error);
    int number = EEXIST;
    for (int attempt = 0; attempt < ATTEMPTS && number == EEXIST; attempt++) {
        int length = snprintf(name, room, "%s.tmp-%ld", o->path, (long)getpid());
        if (attempt) snprintf(name + length, room - (size_t)length, "-%d", attempt);
        o->descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (o->descriptor >= 0) {
            o->temporary = name;
            return GVC_OK;
        }
        number = errno;
        if (number == EINTR) number = EEXIST; /* the next name will do as well */
    }
    free(name);
    return gvc_fail_errno(error, "write", number, o->path);
}

static bool is_stream(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool gvc_output_in_the_way(const char *path) {
    struct stat status; /* of a link itself: one that leads nowhere is there, too */
    return strcmp(path, "-") != 0 && lstat(path, &status) == 0 && !is_stream(path);
}

static gvc_result open_target(gvc_output *o, gvc_error *error) {
    struct stat status;
    if (strcmp(o->path, "-") == 0) {
        o->path = "standard output";
        o->standard = true;
        o->descriptor = STDOUT_FILENO;
        return GVC_OK;
    }
    if (is_stream(o->path)) {
        do {
            o->descriptor = open(o->path, O_WRONLY | O_CLOEXEC);
        } while (o->descriptor < 0 && errno == EINTR);
        return o->descriptor < 0 ? gvc_fail_errno(error, "write", errno, o->path) : GVC_OK;
    }
    if (!o->overwrite && gvc_output_in_the_way(o->path)) return fail_exists(o, error);
    if (lstat(o->path, &status) == 0 && S_ISDIR(status.st_mode)) {
        return gvc_fail_errno(error, "write", EISDIR, o->path);
    }
    return open_temporary(o, error);
}

gvc_result gvc_output_begin(const char *path, bool overwrite, gvc_output *output,
                            gvc_error *error) {
    *output = (gvc_output){.path = path, .descriptor = -1, .overwrite = overwrite};
    output->buffer = gvc_alloc(BUFFER_SIZE, 1);
    gvc_result result = output->buffer ? open_target(output, error) : gvc_fail_memory(error);
    if (result != GVC_OK) gvc_output_discard(output);
    return result;
}

static void put(gvc_output *o, const char *data, size_t size) {
    while (size > 0 && !o->failure) {
        ssize_t count = write(o->descriptor, data, size);
        if (count >= 0) {
            data += count;
            size -= (size_t)count;
        } else if (errno != EINTR) {
            o->failure = errno;
        }
    }
}

static void flush(gvc_output *o) {
    put(o, o->buffer, o->used);
    o->used = 0;
}

char *gvc_output_room(gvc_output *output, size_t size) {
    if (BUFFER_SIZE - output->used < size) flush(output);
    return output->buffer + output->used;
}

gvc_result gvc_output_write(void *output, const void *data, size_t size, gvc_error *error) {
    gvc_output *o = output;
    if (size > BUFFER_SIZE - o->used) flush(o);
    if (size > BUFFER_SIZE) {
        put(o, data, size);
    } else if (size > 0) {
        memcpy(o->buffer + o->used, data, size);
        o->used += size;
    }
    if (!o->temporary) flush(o);
    return o->failure ? gvc_fail_errno(error, "write", o->failure, o->path) : GVC_OK;
}

void gvc_output_sync(gvc_output *output) {
    flush(output);
    if (!output->temporary || output->failure) return;
    if (fsync(output->descriptor) != 0) output->failure = errno;
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
        if (errno == EEXIST || lstat(o->path, &status) == 0) return fail_exists(o, error);
    }
    if (rename(o->temporary, o->path) == 0) return GVC_OK;
    return gvc_fail_errno(error, "write", errno, o->path);
}

static void forget(gvc_output *o) {
    free(o->buffer);
    free(o->temporary);
    *o = (gvc_output){.descriptor = -1};
}

static int close_target(const gvc_output *o) {
    return o->descriptor < 0 || o->standard ? 0 : close(o->descriptor);
}

gvc_result gvc_output_end(gvc_output *o, gvc_error *error) {
    flush(o);
    /* A file system may tell of a full disk only here. */
    if (close_target(o) != 0 && !o->failure && errno != EINTR) o->failure = errno;
    gvc_result result = GVC_OK;
    if (o->failure) result = gvc_fail_errno(error, "write", o->failure, o->path);
    if (result == GVC_OK && o->temporary) result = publish(o, error);
    if (result != GVC_OK && o->temporary) unlink(o->temporary);
    forget(o);
    return result;
}

void gvc_output_discard(gvc_output *o) {
    (void)close_target(o);
    if (o->temporary) unlink(o->temporary);
    forget(o);
}
