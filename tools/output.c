/* SPDX-License-Identifier: MIT */
/** @file output.c  Where output goes: folders, and files in the way. */
#include "cli.h"

#include "base/output.h"
#include "frames.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool cli_in_the_way(const char *command, const char *path) {
    if (!gvc_output_in_the_way(path)) return false;
    fprintf(stderr, "gvc %s: %s: exists; not overwritten without -f\n", command, path);
    return true;
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

char *cli_frame_path(const char *pattern, uint64_t frame, bool only) {
    char *path = NULL;
    if (strchr(pattern, '%')) return pattern_fill(pattern, frame, &path) ? path : NULL;
    return only ? strdup(pattern) : NULL;
}

int cli_check_frames(const char *command, const char *pattern, uint64_t first, uint64_t last,
                     bool (*wanted)(void *user, uint64_t frame), void *user, bool force) {
    char *path = cli_frame_path(pattern, first, first == last);
    if (!path) {
        return cli_usage(command,
                         "the output needs one %%d for the frame number, as in out/%%04d.obj");
    }
    int status = cli_make_folder(command, path);
    free(path);
    if (status != EXIT_DONE) return status;
    for (uint64_t f = first; !force && f <= last; f++) {
        if (wanted && !wanted(user, f)) continue;
        path = cli_frame_path(pattern, f, first == last);
        bool there = path && cli_in_the_way(command, path);
        free(path);
        if (there) return EXIT_DATA;
    }
    return EXIT_DONE;
}
