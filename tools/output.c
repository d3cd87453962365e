/* SPDX-License-Identifier: MIT */
/** @file output.c  Where output goes: folders, and files in the way. */
#include "cli.h"

#include "base/output.h"

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
