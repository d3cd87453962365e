/* SPDX-License-Identifier: MIT */
/** @file cmd_compare_paper.c  gvc compare --paper. */
#include "cmd_compare.h"
#include "compare_paper.h"
#include "frames.h"

#include "base/memory.h"
#include "base/output.h"
#include "base/result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define DEFAULT_SIZE 128
#define DEFAULT_GOP 250

/* One capture of the command line. */
typedef struct job {
    char *const *frames; /* arguments that name its frames */
    int frame_arguments;
    char *const *mixed; /* NULL: none */
    const char *row;    /* NULL: by name */
} job;

typedef struct comparison {
    const compare_arguments *arguments;
    paper_options options;
    paper_request request; /* the methods; sources are set for each capture */
    cli_progress progress;
    char what[160]; /* being shown */
    const char *name;
    uint64_t first_frame; /* of --frames */
    paper_capture *capture;
    size_t capture_count;
} comparison;

/* ------------------------------------------------------------------------------------ arguments */

static bool names_capture(const char *argument) {
    struct stat status;
    if (stat(argument, &status) == 0) return S_ISDIR(status.st_mode);
    return strchr(argument, '%') != NULL;
}

/* Last folder in a path: a capture's name. */
static void name_capture(const char *argument, char *name, size_t room) {
    struct stat status;
    const char *end = argument + strlen(argument);
    bool folder = stat(argument, &status) == 0 && S_ISDIR(status.st_mode);
    if (!folder) {
        while (end > argument && end[-1] != '/') end--; /* leave the file's name off */
    }
    while (end > argument && end[-1] == '/') end--;
    const char *begin = end;
    while (begin > argument && begin[-1] != '/') begin--;
    size_t length = (size_t)(end - begin);
    if (length == 0 || strncmp(begin, ".", length) == 0) {
        snprintf(name, room, "frames");
    } else {
        snprintf(name, room, "%.*s", (int)length, begin);
    }
}

/* EXIT_DONE, or EXIT_USAGE with a message. */
static int choose_methods(comparison *c) {
    const char *list = c->arguments->methods ? c->arguments->methods : "gis,fixed,mixed,ref,zip";
    char item[32];
    while (compare_next_item(&list, item, sizeof item)) {
        bool known = false;
        for (int m = 0; m < PAPER_METHODS; m++) {
            if (strcmp(item, paper_method_name((paper_method)m)) != 0) continue;
            known = c->request.method[m] = true;
        }
        if (strcmp(item, "ref") == 0) known = c->request.reference = true;
        if (strcmp(item, "zip") == 0) known = c->request.zip = true;
        if (!known) return cli_usage("compare", "there is no method '%s' of --paper", item);
    }
    return EXIT_DONE;
}

static int choose_tables(comparison *c) {
    const char *list = c->arguments->tables ? c->arguments->tables : "1,2,3";
    char item[32];
    while (compare_next_item(&list, item, sizeof item)) {
        uint64_t number;
        if (!cli_uint(item, 1, 3, &number)) {
            return cli_usage("compare", "there is no table '%s'", item);
        }
        c->options.table[number - 1] = true;
    }
    return EXIT_DONE;
}

static int check_captures(const comparison *c, size_t captures) {
    const compare_arguments *a = c->arguments;
    if ((size_t)a->mixed.count > captures) {
        return cli_usage("compare", "%d times --mixed for %zu captures", a->mixed.count, captures);
    }
    if ((size_t)a->row.count > captures) {
        return cli_usage("compare", "%d times --paper-row for %zu captures", a->row.count,
                         captures);
    }
    for (int i = 0; i < a->row.count; i++) {
        if (!paper_row_named(a->row.item[i])) {
            return cli_usage("compare", "the paper has no capture '%s'", a->row.item[i]);
        }
    }
    return EXIT_DONE;
}

/* ------------------------------------------------------------------------------------- measuring
 */

static bool show_progress(void *user, const char *what, uint64_t done, uint64_t total) {
    comparison *c = user;
    char now[sizeof c->what];
    snprintf(now, sizeof now, "%.64s: %.80s", c->name, what);
    if (strcmp(now, c->what) != 0) {
        cli_progress_end(&c->progress);
        memcpy(c->what, now, sizeof now);
        cli_progress_begin(&c->progress, c->what, c->arguments->quiet);
    }
    cli_progress_show(&c->progress, done, total);
    return !cli_interrupted();
}

/* Leaves only the frames of --frames in the list. */
static gvc_result take_range(const char *range, frame_list *list, uint64_t *first_frame,
                             gvc_error *error) {
    uint64_t first = 0, last = list->count - 1;
    if (range && !cli_range(range, list->count, &first, &last)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there are no frames %s of %zu", range,
                        list->count);
    }
    for (uint64_t i = 0; i < list->count; i++) {
        if (i < first || i > last) {
            free(list->path[i]);
        } else {
            list->path[i - first] = list->path[i];
        }
    }
    list->count = (size_t)(last - first + 1);
    *first_frame = first;
    return GVC_OK;
}

static gvc_result list_frames(comparison *c, char *const *argument, int count, frame_list *list,
                              gvc_error *error) {
    GVC_TRY(frame_list_make(argument, count, c->arguments->any_order, list, error));
    gvc_result result = take_range(c->arguments->frames, list, &c->first_frame, error);
    if (result != GVC_OK) frame_list_free(list);
    return result;
}

static gvc_result measure(comparison *c, const job *j, paper_capture *capture, gvc_error *error) {
    frame_list list = {0}, mixed = {0};
    gvc_source source, mixed_source;
    paper_request request = c->request;
    gvc_result result = list_frames(c, j->frames, j->frame_arguments, &list, error);
    if (result == GVC_OK && j->mixed) result = list_frames(c, j->mixed, 1, &mixed, error);
    if (result == GVC_OK) {
        source = frame_list_source(&list);
        mixed_source = frame_list_source(&mixed);
        request.source = &source;
        request.mixed = j->mixed ? &mixed_source : NULL;
        request.original_off = compare_original_off;
        name_capture(j->frames[0], capture->name, sizeof capture->name);
        capture->row = j->row ? paper_row_named(j->row) : paper_row_of_capture(capture->name);
        c->name = capture->name;
        result = paper_measure(&request, &c->options, capture, error);
        /* as numbered in the whole capture */
        if (result != GVC_OK && error->frame >= 0) error->frame += (int64_t)c->first_frame;
        cli_progress_end(&c->progress);
    }
    frame_list_free(&list);
    frame_list_free(&mixed);
    return result;
}

static int print(const comparison *c) {
    gvc_buffer text = {0};
    int status = EXIT_DONE;
    if (c->arguments->json) {
        paper_print_json(c->capture, c->capture_count, &c->options, &text);
    } else if (c->arguments->csv) {
        paper_print_csv(c->capture, c->capture_count, &text);
    } else {
        paper_print_tables(c->capture, c->capture_count, &c->options, &text);
    }
    if (text.failed || fwrite(text.data, 1, text.size, stdout) != text.size) status = EXIT_DATA;
    gvc_buffer_free(&text);
    return status;
}

static gvc_result write_plot(const comparison *c, gvc_output *output, gvc_error *error) {
    gvc_buffer text = {0};
    paper_print_plot(c->capture, c->capture_count, &text);
    gvc_result result = text.failed ? gvc_fail_memory(error)
                                    : gvc_output_write(output, text.data, text.size, error);
    gvc_buffer_free(&text);
    if (result == GVC_OK) result = gvc_output_end(output, error);
    return result;
}

static gvc_result measure_all(comparison *c, char *const *frames, int count, bool each,
                              gvc_error *error) {
    const compare_arguments *a = c->arguments;
    size_t captures = each ? (size_t)count : 1;
    c->capture = gvc_alloc(captures, sizeof *c->capture);
    if (!c->capture) return gvc_fail_memory(error);
    for (size_t i = 0; i < captures; i++) {
        job j = {.frames = frames + i,
                 .frame_arguments = each ? 1 : count,
                 .mixed = (int)i < a->mixed.count ? &a->mixed.item[i] : NULL,
                 .row = (int)i < a->row.count ? a->row.item[i] : NULL};
        c->capture_count = i + 1;
        gvc_result result = measure(c, &j, &c->capture[i], error);
        if (result == GVC_OK) continue;
        return error->where[0] ? result : gvc_fail_in(error, result, frames[i]);
    }
    return GVC_OK;
}

static int compare_all(comparison *c, char *const *frames, int count) {
    const compare_arguments *a = c->arguments;
    bool each = true;
    gvc_output plot = {.descriptor = -1};
    gvc_error error;
    gvc_error_init(&error);
    for (int i = 0; i < count; i++) each &= names_capture(frames[i]);
    int status = check_captures(c, each ? (size_t)count : 1);
    if (status != EXIT_DONE) return status;
    /* a file that cannot be written is told before the work is done */
    if (a->plot && !a->force && cli_in_the_way("compare", a->plot)) return EXIT_DATA;
    gvc_result result = GVC_OK;
    if (a->plot) result = gvc_output_begin(a->plot, a->force, &plot, &error);
    if (result == GVC_OK) result = measure_all(c, frames, count, each, &error);
    if (result == GVC_OK && a->plot) result = write_plot(c, &plot, &error);
    if (a->plot) gvc_output_discard(&plot);
    return result == GVC_OK ? print(c) : cli_fail("compare", NULL, &error);
}

int compare_paper_command(const compare_arguments *arguments, char *const *frames, int count) {
    comparison c = {.arguments = arguments};
    gvc_encode_options defaults;
    gvc_encode_options_init(&defaults);
    double crf = defaults.crf;
    (void)cli_double(COMPARE_PAPER_CRF, &crf);
    c.options = (paper_options){.size = arguments->size ? arguments->size : DEFAULT_SIZE,
                                .crf = isnan(arguments->crf) ? crf : arguments->crf,
                                .gop = arguments->gop ? arguments->gop : DEFAULT_GOP,
                                .threads = arguments->threads,
                                .progress = show_progress,
                                .user = &c};
    int status = choose_methods(&c);
    if (status == EXIT_DONE) status = choose_tables(&c);
    if (status == EXIT_DONE) status = compare_all(&c, frames, count);
    for (size_t i = 0; i < c.capture_count; i++) paper_capture_free(&c.capture[i]);
    free(c.capture);
    return status;
}
