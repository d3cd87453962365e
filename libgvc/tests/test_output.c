/* SPDX-License-Identifier: MIT */
/** @file test_output.c  Output files: whole under their name or not there, and what is in the way.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/output.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/** A new empty folder and the name of a file that is not there yet. */
typedef struct place {
    char folder[40], file[64];
} place;

static int make_place(void **state) {
    place *p = calloc(1, sizeof *p);
    assert_non_null(p);
    strcpy(p->folder, "/tmp/gvc-test-output-XXXXXX");
    assert_non_null(mkdtemp(p->folder));
    snprintf(p->file, sizeof p->file, "%s/out.bin", p->folder);
    *state = p;
    return 0;
}

static int free_place(void **state) {
    place *p = *state;
    unlink(p->file);
    assert_int_equal(rmdir(p->folder), 0); /* nothing unfinished lies about */
    free(p);
    return 0;
}

static size_t count_files(const place *p) {
    size_t count = 0;
    DIR *folder = opendir(p->folder);
    assert_non_null(folder);
    while (readdir(folder)) count++;
    closedir(folder);
    return count - 2; /* . and .. */
}

static void put_text(const char *path, const char *text) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void assert_text(const char *path, const char *text) {
    char got[64] = {0};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_int_equal(fread(got, 1, sizeof got - 1, file), strlen(text));
    fclose(file);
    assert_string_equal(got, text);
}

static void appears_when_whole(void **state) {
    const place *p = *state;
    gvc_output output;
    struct stat status;
    mode_t mask = umask(027);
    assert_int_equal(gvc_output_begin(p->file, false, &output, NULL), GVC_OK);
    umask(mask);
    assert_int_equal(gvc_output_write(&output, "whole", 5, NULL), GVC_OK);
    assert_int_not_equal(access(p->file, F_OK), 0);
    gvc_output_sync(&output);
    assert_int_not_equal(access(p->file, F_OK), 0);
    assert_int_equal(gvc_output_end(&output, NULL), GVC_OK);
    assert_text(p->file, "whole");
    assert_int_equal(stat(p->file, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    gvc_output_discard(&output); /* too late, and fine */
    assert_text(p->file, "whole");
    assert_int_equal(count_files(p), 1);
}

static void keeps_the_order_of_small_and_large_pieces(void **state) {
    const place *p = *state;
    static const size_t size[] = {1, 300000, 7, 0, 262144, 262143, 2, 1000000, 3};
    gvc_output output;
    size_t total = 0;
    assert_int_equal(gvc_output_begin(p->file, false, &output, NULL), GVC_OK);
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        uint8_t *piece = malloc(size[i] + 1);
        assert_non_null(piece);
        for (size_t k = 0; k < size[i]; k++) piece[k] = (uint8_t)((total + k) % 251);
        assert_int_equal(gvc_output_write(&output, piece, size[i], NULL), GVC_OK);
        total += size[i];
        memset(gvc_output_room(&output, 1), (int)(total++ % 251), 1);
        gvc_output_advance(&output, 1);
        free(piece);
    }
    assert_int_equal(gvc_output_end(&output, NULL), GVC_OK);
    FILE *file = fopen(p->file, "rb");
    assert_non_null(file);
    for (size_t k = 0; k < total; k++) {
        if (fgetc(file) != (int)(k % 251)) fail_msg("byte %zu is another one", k);
    }
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
}

static void replaces_only_when_told(void **state) {
    const place *p = *state;
    gvc_output output;
    gvc_error error;
    gvc_error_init(&error);
    put_text(p->file, "old");
    assert_true(gvc_output_in_the_way(p->file));
    assert_int_equal(gvc_output_begin(p->file, false, &output, &error), GVC_ERROR_IO);
    assert_string_equal(error.where, p->file);
    gvc_output_discard(&output); /* after a failed begin, too */
    assert_int_equal(gvc_output_begin(p->file, true, &output, NULL), GVC_OK);
    assert_int_equal(gvc_output_write(&output, "new", 3, NULL), GVC_OK);
    assert_text(p->file, "old");
    gvc_output_discard(&output);
    assert_text(p->file, "old");
    assert_int_equal(count_files(p), 1);
    assert_int_equal(gvc_output_begin(p->file, true, &output, NULL), GVC_OK);
    assert_int_equal(gvc_output_write(&output, "new", 3, NULL), GVC_OK);
    assert_int_equal(gvc_output_end(&output, NULL), GVC_OK);
    assert_text(p->file, "new");
}

static void a_file_that_came_meanwhile_is_kept(void **state) {
    const place *p = *state;
    gvc_output output, second;
    gvc_error error;
    gvc_error_init(&error);
    assert_int_equal(gvc_output_begin(p->file, false, &output, NULL), GVC_OK);
    assert_int_equal(gvc_output_begin(p->file, false, &second, NULL), GVC_OK); /* at once */
    assert_int_equal(gvc_output_write(&second, "first", 5, NULL), GVC_OK);
    assert_int_equal(gvc_output_end(&second, NULL), GVC_OK);
    assert_int_equal(gvc_output_end(&output, &error), GVC_ERROR_IO);
    assert_non_null(strstr(error.message, "exists"));
    assert_text(p->file, "first");
    assert_int_equal(count_files(p), 1);
}

static void folders_and_dangling_links_are_in_the_way(void **state) {
    const place *p = *state;
    gvc_output output;
    assert_true(gvc_output_in_the_way(p->folder));
    assert_int_equal(gvc_output_begin(p->folder, true, &output, NULL), GVC_ERROR_IO);
    assert_int_equal(symlink("nowhere", p->file), 0);
    assert_true(gvc_output_in_the_way(p->file));
    assert_int_equal(gvc_output_begin(p->file, false, &output, NULL), GVC_ERROR_IO);
    char below[80];
    snprintf(below, sizeof below, "%s/none/out.bin", p->folder);
    assert_false(gvc_output_in_the_way(below));
    assert_int_equal(gvc_output_begin(below, true, &output, NULL), GVC_ERROR_IO);
}

/** Written to, not replaced; nothing is held back. */
static void a_pipe_gets_the_bytes_at_once(void **state) {
    const place *p = *state;
    char got[8] = {0};
    gvc_output output;
    assert_int_equal(mkfifo(p->file, 0600), 0);
    int reader = open(p->file, O_RDONLY | O_NONBLOCK);
    assert_true(reader >= 0);
    assert_false(gvc_output_in_the_way(p->file));
    assert_int_equal(gvc_output_begin(p->file, false, &output, NULL), GVC_OK);
    assert_int_equal(gvc_output_write(&output, "now", 3, NULL), GVC_OK);
    assert_int_equal(read(reader, got, sizeof got), 3);
    assert_string_equal(got, "now");
    assert_int_equal(gvc_output_end(&output, NULL), GVC_OK);
    close(reader);
    struct stat status;
    assert_int_equal(stat(p->file, &status), 0);
    assert_true(S_ISFIFO(status.st_mode));
}

static void a_full_disk_is_told(void **state) {
    (void)state;
    gvc_output output;
    gvc_error error;
    gvc_error_init(&error);
    if (access("/dev/full", W_OK) != 0) skip();
    assert_int_equal(gvc_output_begin("/dev/full", false, &output, NULL), GVC_OK);
    assert_int_equal(gvc_output_write(&output, "x", 1, &error), GVC_ERROR_IO);
    assert_string_equal(error.where, "/dev/full");
    assert_int_equal(gvc_output_write(&output, "x", 1, NULL), GVC_ERROR_IO); /* still so */
    assert_int_equal(gvc_output_end(&output, NULL), GVC_ERROR_IO);
}

int main(void) {
#define IN_A_PLACE(test) cmocka_unit_test_setup_teardown(test, make_place, free_place)
    const struct CMUnitTest tests[] = {
        IN_A_PLACE(appears_when_whole),
        IN_A_PLACE(keeps_the_order_of_small_and_large_pieces),
        IN_A_PLACE(replaces_only_when_told),
        IN_A_PLACE(a_file_that_came_meanwhile_is_kept),
        IN_A_PLACE(folders_and_dangling_links_are_in_the_way),
        IN_A_PLACE(a_pipe_gets_the_bytes_at_once),
        cmocka_unit_test(a_full_disk_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
