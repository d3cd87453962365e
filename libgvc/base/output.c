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

bool gvc_output_is_stream(const char *path) { return strcmp(path, "-") == 0 || is_stream(path); }

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

/* Locks a file that has been opened. False if its name is not its own any more: the run that wrote
 * it came to its end meanwhile. */
static gvc_result lock(const gvc_output *o, bool *ours, gvc_error *error) {
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    struct stat opened, named;
    if (fcntl(o->descriptor, F_SETLK, &whole) != 0) {
        if (errno != EACCES && errno != EAGAIN) {
            return gvc_fail_errno(error, "lock", errno, o->temporary);
        }
        gvc_fail(error, GVC_ERROR_IO, "another run is writing it");
        return gvc_fail_in(error, GVC_ERROR_IO, o->temporary);
    }
    *ours = fstat(o->descriptor, &opened) == 0 && stat(o->temporary, &named) == 0 &&
            opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
    return GVC_OK;
}

static gvc_result open_known(gvc_output *o, gvc_leftover leftover, gvc_error *error) {
    struct stat status;
    bool ours = false;
    while (!ours) {
        if (o->descriptor >= 0) (void)close(o->descriptor);
        o->descriptor = open(o->temporary, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (o->descriptor < 0 && errno == EINTR) continue;
        if (o->descriptor < 0) return gvc_fail_errno(error, "write", errno, o->temporary);
        GVC_TRY(lock(o, &ours, error));
    }
    if (fstat(o->descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        return gvc_fail_errno(error, "write", EINVAL, o->temporary);
    }
    if (status.st_size > 0 && leftover == GVC_LEFTOVER_REFUSE) {
        gvc_fail(error, GVC_ERROR_IO, "left by a run that did not come to its end");
        return gvc_fail_in(error, GVC_ERROR_IO, o->temporary);
    }
    if (leftover == GVC_LEFTOVER_KEEP) {
        o->there = (uint64_t)status.st_size;
    } else if (ftruncate(o->descriptor, 0) != 0) {
        return gvc_fail_errno(error, "write", errno, o->temporary);
    }
    return GVC_OK;
}

gvc_result gvc_output_begin_known(const char *path, const char *suffix, bool overwrite,
                                  gvc_leftover leftover, gvc_output *output, gvc_error *error) {
    struct stat status;
    *output = (gvc_output){.path = path, .descriptor = -1, .overwrite = overwrite, .known = true};
    if (!overwrite && gvc_output_in_the_way(path)) return fail_exists(output, error);
    if (lstat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        return gvc_fail_errno(error, "write", EISDIR, path);
    }
    size_t room = strlen(path) + strlen(suffix) + 1;
    output->buffer = gvc_alloc(BUFFER_SIZE, 1);
    output->temporary = gvc_alloc(room, 1);
    gvc_result result = output->buffer && output->temporary ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        snprintf(output->temporary, room, "%s%s", path, suffix);
        result = open_known(output, leftover, error);
    }
    if (result != GVC_OK) gvc_output_leave(output); /* it is not ours to remove */
    return result;
}

gvc_result gvc_output_begin(const char *path, bool overwrite, gvc_output *output,
                            gvc_error *error) {
    *output = (gvc_output){.path = path, .descriptor = -1, .overwrite = overwrite};
    output->buffer = gvc_alloc(BUFFER_SIZE, 1);
    gvc_result result = output->buffer ? open_target(output, error) : gvc_fail_memory(error);
    if (result != GVC_OK) gvc_output_discard(output);
    return result;
}

/* How many of the next bytes are in the file already, from an earlier run. The first that differs
 * ends what is kept of that. */
static size_t skip_kept(gvc_output *o, const char *data, size_t size) {
    char chunk[4096];
    size_t same = 0;
    while (same < size && o->written < o->there && !o->failure) {
        size_t count = size - same < sizeof chunk ? size - same : sizeof chunk;
        ssize_t got = pread(o->descriptor, chunk, count, (off_t)o->written);
        if (got < 0 && errno == EINTR) continue;
        size_t equal = 0;
        while (got > 0 && equal < (size_t)got && chunk[equal] == data[same + equal]) equal++;
        same += equal;
        o->written += equal;
        if (got <= 0 || equal < (size_t)got) o->there = o->written;
    }
    if (same < size && o->written == o->there && o->there > 0) {
        o->there = 0;
        if (ftruncate(o->descriptor, (off_t)o->written) != 0 ||
            lseek(o->descriptor, (off_t)o->written, SEEK_SET) < 0) {
            o->failure = errno;
        }
    }
    return same;
}

static void put(gvc_output *o, const char *data, size_t size) {
    if (o->there > 0) {
        size_t same = skip_kept(o, data, size);
        data += same;
        size -= same;
    }
    while (size > 0 && !o->failure) {
        ssize_t count = write(o->descriptor, data, size);
        if (count >= 0) {
            data += count;
            size -= (size_t)count;
            o->written += (size_t)count;
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

/* Drops what is left of an earlier run behind the end of this one. */
static void cut_rest(gvc_output *o) {
    if (o->there == 0 || o->failure) return;
    if (ftruncate(o->descriptor, (off_t)o->written) != 0) o->failure = errno;
    o->there = 0;
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
    cut_rest(o);
    /* A file system may tell of a full disk only here. */
    if (close_target(o) != 0 && !o->failure && errno != EINTR) o->failure = errno;
    gvc_result result = GVC_OK;
    if (o->failure) result = gvc_fail_errno(error, "write", o->failure, o->path);
    if (result == GVC_OK && o->temporary) result = publish(o, error);
    if (result != GVC_OK && o->temporary && !o->known) unlink(o->temporary);
    forget(o);
    return result;
}

void gvc_output_leave(gvc_output *o) {
    flush(o);
    (void)close_target(o);
    forget(o);
}

void gvc_output_discard(gvc_output *o) {
    (void)close_target(o);
    if (o->temporary) unlink(o->temporary);
    forget(o);
}
