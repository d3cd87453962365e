/* SPDX-License-Identifier: MIT */
/** @file replay_main.c  Runs a fuzz harness over files and folders given as arguments, without
 * libFuzzer: for compilers that lack it, for regressions in CTest, and for AFL++ (`@@`). */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MAX_INPUT ((size_t)1 << 26)

static int replay_file(const char *path, size_t size) {
    if (size > MAX_INPUT) {
        fprintf(stderr, "replay: %s: more than %zu bytes\n", path, MAX_INPUT);
        return 1;
    }
    /* Exactly as large as the file, so that a sanitizer sees a read past the end. */
    uint8_t *data = malloc(size ? size : 1);
    FILE *file = fopen(path, "rb");
    int failed = !data || !file || fread(data, 1, size, file) != size;
    if (file) fclose(file);
    if (failed) {
        fprintf(stderr, "replay: cannot read %s\n", path);
    } else {
        LLVMFuzzerTestOneInput(data, size);
    }
    free(data);
    return failed;
}

static int replay(const char *path, unsigned *count);

static int replay_folder(const char *path, unsigned *count) {
    struct dirent **entry;
    int failed = 0, entries = scandir(path, &entry, NULL, alphasort);
    if (entries < 0) {
        fprintf(stderr, "replay: cannot list %s\n", path);
        return 1;
    }
    for (int i = 0; i < entries; i++) {
        char child[4096];
        int length = snprintf(child, sizeof child, "%s/%s", path, entry[i]->d_name);
        if (entry[i]->d_name[0] != '.' && length > 0 && (size_t)length < sizeof child) {
            failed |= replay(child, count);
        }
        free(entry[i]);
    }
    free(entry);
    return failed;
}

static int replay(const char *path, unsigned *count) {
    struct stat status;
    if (stat(path, &status) != 0) {
        fprintf(stderr, "replay: cannot find %s\n", path);
        return 1;
    }
    if (S_ISDIR(status.st_mode)) return replay_folder(path, count);
    (*count)++;
    return replay_file(path, (size_t)status.st_size);
}

int main(int argc, char **argv) {
    unsigned count = 0;
    int failed = 0;
    for (int i = 1; i < argc; i++) failed |= replay(argv[i], &count);
    printf("%u inputs replayed\n", count);
    return failed || count == 0;
}
