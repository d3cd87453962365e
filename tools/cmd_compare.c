/* SPDX-License-Identifier: MIT */
/** @file cmd_compare.c  gvc compare. */
#include "cli.h"
#include "compare.h"
#include "frames.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gvc compare [options] FRAMES...\n"
    "\n"
    "Codes the frames in several ways and prints bytes per frame, mean, RMS and Hausdorff distance "
    "to the original\n"
    "(of the bounding box's diagonal, the worse direction), and CPU time per frame to encode and "
    "decode.\n"
    "\n"
    "      --methods LIST    of zip, draco, gvc (default: all)\n"
    "      --qp LIST         Draco's bits per coordinate (default 7,8,9,10,11,12,13,14)\n"
    "  -e, --max-rms LIST    gvc's qualities (default 0.2%,0.1%,0.05%)\n"
    "      --json, --csv     machine-readable\n"
    "      --any-order       take files as given: no check of numbers\n"
    "  -j, --jobs N          threads\n"
    "  -q, --quiet           no progress\n";

enum { OPT_METHODS = 256, OPT_QP, OPT_JSON, OPT_CSV, OPT_ANY_ORDER };
enum { MAX_ROWS = 64 };

typedef struct compare_arguments {
    const char *methods, *qp, *max_rms;
    bool json, csv, any_order, quiet;
    unsigned threads;
} compare_arguments;

typedef struct comparison {
    const compare_arguments *arguments;
    frame_list *list;
    gvc_source source;
    compare_options options;
    compare_row row[MAX_ROWS];
    size_t count;
} comparison;

static int parse(compare_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"methods", required_argument, NULL, OPT_METHODS},
                                            {"qp", required_argument, NULL, OPT_QP},
                                            {"max-rms", required_argument, NULL, 'e'},
                                            {"json", no_argument, NULL, OPT_JSON},
                                            {"csv", no_argument, NULL, OPT_CSV},
                                            {"any-order", no_argument, NULL, OPT_ANY_ORDER},
                                            {"jobs", required_argument, NULL, 'j'},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    uint64_t number;
    while ((option = getopt_long(argc, argv, "e:j:qh", options, NULL)) != -1) {
        switch (option) {
        case OPT_METHODS:
            a->methods = optarg;
            break;
        case OPT_QP:
            a->qp = optarg;
            break;
        case 'e':
            a->max_rms = optarg;
            break;
        case OPT_JSON:
            a->json = true;
            break;
        case OPT_CSV:
            a->csv = true;
            break;
        case OPT_ANY_ORDER:
            a->any_order = true;
            break;
        case 'j':
            if (!cli_uint(optarg, 0, 256, &number))
                return cli_usage("compare", "bad number of jobs");
            a->threads = (unsigned)number;
            break;
        case 'q':
            a->quiet = true;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("compare", "bad options");
        }
    }
    if (a->json && a->csv) return cli_usage("compare", "choose one of --json and --csv");
    if (optind == argc) return cli_usage("compare", "name the frames");
    return EXIT_DONE;
}

/* Copies the next item of a comma-separated list; false at its end. */
static bool next_item(const char **list, char *item, size_t room) {
    if (!*list || **list == '\0') return false;
    const char *comma = strchr(*list, ',');
    size_t length = comma ? (size_t)(comma - *list) : strlen(*list);
    snprintf(item, room, "%.*s", (int)length, *list);
    *list = comma ? comma + 1 : *list + length;
    return true;
}

static void announce(const comparison *c, const char *method) {
    if (!c->arguments->quiet) fprintf(stderr, "measuring %s\n", method);
}

/* The bytes of a frame that came as an OFF file go into the archive as they are. */
static gvc_result original_off(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error) {
    const frame_list *list = user;
    const char *path = list->path[frame], *dot = strrchr(path, '.');
    if (!dot || strcmp(dot, ".off") != 0) return GVC_OK;
    FILE *file = fopen(path, "rb");
    if (!file) {
        error->code = GVC_ERROR_IO;
        snprintf(error->message, sizeof error->message, "cannot open: %s", strerror(errno));
        snprintf(error->where, sizeof error->where, "%s", path);
        return GVC_ERROR_IO;
    }
    char block[65536];
    size_t got;
    while ((got = fread(block, 1, sizeof block, file)) > 0) gvc_write_bytes(bytes, block, got);
    fclose(file);
    return GVC_OK;
}

static gvc_result add_zip(comparison *c, gvc_error *error) {
    announce(c, "zip");
    gvc_result result = compare_zip(&c->source, original_off, &c->row[c->count], error);
    if (result == GVC_OK) c->count++;
    return result;
}

static gvc_result add_draco(comparison *c, gvc_error *error) {
    const char *list = c->arguments->qp;
    char item[32];
    while (c->count < MAX_ROWS && next_item(&list, item, sizeof item)) {
        uint64_t bits;
        if (!cli_uint(item, 1, 30, &bits)) {
            snprintf(error->message, sizeof error->message, "'%s' is not a number of bits 1-30",
                     item);
            return error->code = GVC_ERROR_ARGUMENT;
        }
        announce(c, "draco");
        gvc_result result =
            compare_draco(&c->source, (int)bits, &c->options, &c->row[c->count], error);
        if (result != GVC_OK) return result;
        c->count++;
    }
    return GVC_OK;
}

static gvc_result add_gvc(comparison *c, gvc_error *error) {
    const char *list = c->arguments->max_rms;
    char item[32], method[48];
    while (c->count < MAX_ROWS && next_item(&list, item, sizeof item)) {
        gvc_encode_options options;
        double bound;
        bool relative;
        gvc_encode_options_init(&options);
        if (!cli_error_bound(item, &bound, &relative)) {
            snprintf(error->message, sizeof error->message, "'%s' is not an error bound", item);
            return error->code = GVC_ERROR_ARGUMENT;
        }
        *(relative ? &options.max_rms : &options.max_rms_length) = bound;
        options.best_effort = true; /* the table shows what was reached */
        options.threads = c->arguments->threads;
        snprintf(method, sizeof method, "gvc %s", item);
        announce(c, method);
        gvc_result result =
            compare_gvc(&c->source, method, &options, &c->options, &c->row[c->count], error);
        if (result != GVC_OK) return result;
        c->count++;
    }
    return GVC_OK;
}

static gvc_result measure(comparison *c, gvc_error *error) {
    const char *list = c->arguments->methods;
    char item[32];
    while (c->count < MAX_ROWS && next_item(&list, item, sizeof item)) {
        gvc_result result;
        if (strcmp(item, "zip") == 0) {
            result = add_zip(c, error);
        } else if (strcmp(item, "draco") == 0) {
            result = add_draco(c, error);
        } else if (strcmp(item, "gvc") == 0) {
            result = add_gvc(c, error);
        } else {
            snprintf(error->message, sizeof error->message, "there is no method '%s'", item);
            result = error->code = GVC_ERROR_ARGUMENT;
        }
        if (result != GVC_OK) return result;
    }
    return GVC_OK;
}

static int print(const comparison *c) {
    gvc_buffer text = {0};
    int status = EXIT_DONE;
    if (c->arguments->json) {
        compare_print_json(c->row, c->count, &text);
    } else if (c->arguments->csv) {
        compare_print_csv(c->row, c->count, &text);
    } else {
        compare_print_table(c->row, c->count, &text);
    }
    if (text.failed || fwrite(text.data, 1, text.size, stdout) != text.size) status = EXIT_DATA;
    gvc_buffer_free(&text);
    return status;
}

int cmd_compare(int argc, char **argv) {
    compare_arguments arguments = {
        .methods = "zip,draco,gvc", .qp = "7,8,9,10,11,12,13,14", .max_rms = "0.2%,0.1%,0.05%"};
    frame_list list;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_error_init(&error);
    if (frame_list_make(argv + optind, argc - optind, arguments.any_order, &list, &error) !=
        GVC_OK) {
        return cli_fail("compare", NULL, &error);
    }
    comparison c = {.arguments = &arguments,
                    .list = &list,
                    .source = frame_list_source(&list),
                    .options = {.threads = arguments.threads}};
    status = measure(&c, &error) == GVC_OK ? print(&c) : cli_fail("compare", NULL, &error);
    frame_list_free(&list);
    return status;
}
