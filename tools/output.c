/* SPDX-License-Identifier: MIT */
/** @file output.c  Output files that appear under their name only when whole. */
#include "base/result.h"
#include "cli.h"
#include "mesh/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool fail(const cli_output *output, const char *what, gvc_error *error) {
    int reason = errno;
    (void)gvc_fail(error, GVC_ERROR_IO, "%s: %s", what, strerror(reason));
    (void)gvc_fail_in(error, GVC_ERROR_IO, output->path);
    return false;
}

static bool exists(const cli_output *output, gvc_error *error) {
    struct stat status;
    if (output->overwrite || lstat(output->path, &status) != 0) return false;
    errno = EEXIST;
    fail(output, "not overwritten without -f", error);
    return true;
}

/* A device or pipe is written to, not replaced by a file. */
static bool is_stream(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool cli_output_open(cli_output *output, const char *path, bool overwrite, gvc_error *error) {
    *output = (cli_output){.overwrite = overwrite};
    if (strcmp(path, "-") == 0) {
        output->standard = true;
        output->file = stdout;
        return true;
    }
    size_t room = strlen(path) + 32;
    output->path = strdup(path);
    output->temporary = malloc(room);
    if (!output->path || !output->temporary) {
        cli_output_discard(output);
        (void)gvc_fail_memory(error);
        return false;
    }
    if (is_stream(path)) {
        free(output->temporary);
        output->temporary = NULL;
        output->file = fopen(path, "wb");
        if (output->file) return true;
        fail(output, "cannot write", error);
        cli_output_discard(output);
        return false;
    }
    if (exists(output, error)) {
        cli_output_discard(output);
        return false;
    }
    snprintf(output->temporary, room, "%s.part-XXXXXX", path);
    mode_t mask = umask(0);
    umask(mask);
    int descriptor = mkstemp(output->temporary);
    if (descriptor >= 0) output->file = fdopen(descriptor, "wb");
    if (!output->file) {
        bool made = descriptor >= 0;
        fail(output, "cannot write", error);
        if (made) {
            unlink(output->temporary);
            close(descriptor);
        }
        cli_output_discard(output);
        return false;
    }
    fchmod(descriptor, 0666 & ~mask);
    return true;
}

gvc_result cli_output_write(void *user, const void *data, size_t size, gvc_error *error) {
    cli_output *output = user;
    if (fwrite(data, 1, size, output->file) == size) return GVC_OK;
    if (output->standard) {
        return gvc_fail(error, GVC_ERROR_IO, "cannot write to standard output: %s",
                        strerror(errno));
    }
    fail(output, "cannot write", error);
    return GVC_ERROR_IO;
}

/* link() never replaces a file that came into being meanwhile; where links are not to be had,
 * rename(). */
static bool give_name(const cli_output *output) {
    if (output->overwrite) return rename(output->temporary, output->path) == 0;
    if (link(output->temporary, output->path) == 0) return unlink(output->temporary) == 0;
    if (errno == EEXIST) return false;
    return rename(output->temporary, output->path) == 0;
}

bool cli_output_commit(cli_output *output, gvc_error *error) {
    if (output->standard) {
        if (fflush(output->file) == 0) return true;
        (void)gvc_fail(error, GVC_ERROR_IO, "cannot write to standard output: %s", strerror(errno));
        return false;
    }
    bool written = fflush(output->file) == 0;
    if (output->temporary) written = written && fsync(fileno(output->file)) == 0;
    int reason = errno;
    bool closed = fclose(output->file) == 0;
    output->file = NULL;
    if (!written || !closed) {
        if (!written) errno = reason;
        return fail(output, "cannot write", error);
    }
    if (!output->temporary) return true;
    if (!give_name(output)) return fail(output, "cannot name the finished file", error);
    free(output->temporary);
    output->temporary = NULL;
    return true;
}

void cli_output_discard(cli_output *output) {
    if (output->file && !output->standard) fclose(output->file);
    if (output->temporary) unlink(output->temporary);
    free(output->temporary);
    free(output->path);
    *output = (cli_output){0};
}

int cli_make_folder(const char *command, const char *path) {
    const char *slash = strrchr(path, '/');
    if (!slash || slash == path) return EXIT_DONE;
    char *folder = strdup(path);
    if (!folder) return EXIT_DATA;
    folder[slash - path] = '\0';
    int status = EXIT_DONE;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        fprintf(stderr, "gvc %s: %s: cannot make the folder: %s\n", command, folder,
                strerror(errno));
        status = EXIT_DATA;
    }
    free(folder);
    return status;
}
