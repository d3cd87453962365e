/* SPDX-License-Identifier: MIT */
/** @file reseal_main.c  reseal IN OUT: a copy of a file with all checksums made right, for making
 * test files by hand. */
#include "reseal.h"

#include <stdio.h>
#include <stdlib.h>

static uint8_t *load(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    uint8_t *data = NULL;
    long length = -1;
    if (file && fseek(file, 0, SEEK_END) == 0) length = ftell(file);
    if (length >= 0 && fseek(file, 0, SEEK_SET) == 0) data = malloc((size_t)length + 1);
    if (data && fread(data, 1, (size_t)length, file) != (size_t)length) {
        free(data);
        data = NULL;
    }
    if (file) fclose(file);
    *size = (size_t)length;
    return data;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: reseal IN OUT\n");
        return 2;
    }
    size_t size;
    uint8_t *data = load(argv[1], &size);
    FILE *out = data ? fopen(argv[2], "wb") : NULL;
    int failed = !out;
    if (out) {
        reseal(data, size);
        failed = fwrite(data, 1, size, out) != size;
        failed |= fclose(out) != 0;
    }
    if (failed) fprintf(stderr, "reseal: cannot copy %s to %s\n", argv[1], argv[2]);
    free(data);
    return failed;
}
