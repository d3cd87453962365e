/* SPDX-License-Identifier: MIT */
/** @file cmd_compare.c  gvc compare. */
#include "cmd_compare.h"
#include "compare.h"
#include "compare_lossless.h"
#include "frames.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_METHODS "zip,draco,gvc"
#define DEFAULT_QP "7,8,9,10,11,12,13,14"
#define DEFAULT_MAX_RMS "0.2%,0.1%,0.05%"

static const char usage[] =
    "usage: gvc compare [options] FRAMES...\n"
    "       gvc compare --lossless [options] FRAMES...\n"
    "       gvc compare --paper [options] CAPTURE...\n"
    "\n"
    "Codes the frames in several ways and prints bytes per frame, mean, RMS and Hausdorff distance "
    "to the original\n"
    "(of the bounding box's diagonal, the worse direction), and CPU time per frame to encode and "
    "decode.\n"
    "\n"
    "      --methods LIST    of zip, draco, gvc (default: all)\n"
    "      --qp LIST         Draco's bits per coordinate (default " DEFAULT_QP ")\n"
    "  -e, --max-rms LIST    gvc's qualities (default " DEFAULT_MAX_RMS ")\n"
    "      --json, --csv     machine-readable\n"
    "      --any-order       take files as given: no check of numbers\n"
    "  -j, --jobs N          threads\n"
    "  -q, --quiet           no progress\n"
    "\n"
    "With --lossless: exact geometry images in this format, the same before they are rounded to 16 "
    "bits, as OpenEXR\n"
    "files with ZIP and PIZ, their codes compressed by zstd and xz (a group of frames at once); "
    "and "
    "Draco at qp 16,\n"
    "and zipped OFF.\n"
    "\n"
    "  -e, --max-rms BOUND   chooses the size of the images (default 0.1%)\n"
    "      --size N          samples a side\n"
    "      --gop N           frames from keyframe to keyframe (default 60)\n"
    "\n"
    "With --paper: the three tables of the paper (Tung and Matsuyama, Sect. 5) for each capture "
    "(folder or pattern; or all\n"
    "files of one capture), beside the paper's own figures where the folder is named after one of "
    "its captures.\n"
    "\n"
    "      --methods LIST    of gis (every frame cut by itself: Gu, Gortler and Hoppe 2002), fixed "
    "(this method), mixed\n"
    "                        (this method on --mixed), ref (meshes simplified to 125 vertices), "
    "zip (default: all)\n"
    "      --mixed FRAMES    the same motion at varying resolution; once for each capture, in "
    "their order\n"
    "      --paper-row NAME  row of the paper to print beside a capture; once for each, in their "
    "order\n"
    "      --tables LIST     of 1 (change of images in time), 2 (distance), 3 (bytes) (default: "
    "all); 1 alone is quick\n"
    "      --frames RANGE    part of every capture, such as 0-59\n"
    "      --size N          samples a side (default 128)\n"
    "      --crf X           x264's rate factor for gis, fixed and mixed "
    "(default " COMPARE_PAPER_CRF ")\n"
    "      --gop N           frames per group of pictures, likewise (default 250, x264's own)\n"
    "      --plot FILE.svg   draw the change of the images over time (the paper's Fig. 9)\n"
    "  -f, --force           replace FILE.svg\n";

enum {
    OPT_METHODS = 256,
    OPT_QP,
    OPT_JSON,
    OPT_CSV,
    OPT_ANY_ORDER,
    OPT_LOSSLESS,
    OPT_PAPER,
    OPT_MIXED,
    OPT_PAPER_ROW,
    OPT_TABLES,
    OPT_FRAMES,
    OPT_SIZE,
    OPT_CRF,
    OPT_GOP,
    OPT_PLOT
};
enum { MAX_ROWS = 64 };

typedef struct comparison {
    const compare_arguments *arguments;
    frame_list *list;
    gvc_source source;
    compare_options options;
    compare_row row[MAX_ROWS];
    size_t count;
} comparison;

static bool add_item(compare_list *list, char *item) {
    if (list->count == (int)(sizeof list->item / sizeof *list->item)) return false;
    list->item[list->count++] = item;
    return true;
}

/* Options of --paper; EXIT_DONE to go on, EXIT_USAGE for a bad one. */
static int set_paper_option(compare_arguments *a, int option, char *value) {
    uint64_t number;
    switch (option) {
    case OPT_LOSSLESS:
        a->lossless = true;
        return EXIT_DONE;
    case OPT_PAPER:
        a->paper = true;
        return EXIT_DONE;
    case OPT_MIXED:
        return add_item(&a->mixed, value) ? EXIT_DONE : cli_usage("compare", "too many captures");
    case OPT_PAPER_ROW:
        return add_item(&a->row, value) ? EXIT_DONE : cli_usage("compare", "too many captures");
    case OPT_TABLES:
        a->tables = value;
        return EXIT_DONE;
    case OPT_FRAMES:
        a->frames = value;
        return EXIT_DONE;
    case OPT_PLOT:
        a->plot = value;
        return EXIT_DONE;
    case 'f':
        a->force = true;
        return EXIT_DONE;
    case OPT_SIZE:
        if (!cli_uint(value, 16, 2049, &number)) return cli_usage("compare", "bad size");
        a->size = (uint32_t)number;
        return EXIT_DONE;
    case OPT_GOP:
        if (!cli_uint(value, 1, 10000, &number)) return cli_usage("compare", "bad group length");
        a->gop = (uint32_t)number;
        return EXIT_DONE;
    case OPT_CRF:
        if (!cli_double(value, &a->crf) || a->crf < -12 || a->crf > 51)
            return cli_usage("compare", "crf must be from -12 to 51");
        return EXIT_DONE;
    default:
        return cli_usage("compare", "bad options");
    }
}

static int set_option(compare_arguments *a, int option, char *value) {
    uint64_t number;
    switch (option) {
    case OPT_METHODS:
        a->methods = value;
        return EXIT_DONE;
    case OPT_QP:
        a->qp = value;
        return EXIT_DONE;
    case 'e':
        a->max_rms = value;
        return EXIT_DONE;
    case OPT_JSON:
        a->json = true;
        return EXIT_DONE;
    case OPT_CSV:
        a->csv = true;
        return EXIT_DONE;
    case OPT_ANY_ORDER:
        a->any_order = true;
        return EXIT_DONE;
    case 'j':
        if (!cli_uint(value, 0, 256, &number)) return cli_usage("compare", "bad number of jobs");
        a->threads = (unsigned)number;
        return EXIT_DONE;
    case 'q':
        a->quiet = true;
        return EXIT_DONE;
    case 'h':
        fputs(usage, stdout);
        return -1;
    default:
        return set_paper_option(a, option, value);
    }
}

/* An option of the other kind of comparison would be without effect. */
static int check_kind(const compare_arguments *a) {
    bool plain = a->qp || a->max_rms;
    bool paper = a->mixed.count || a->row.count || a->tables || a->frames || a->plot || a->force ||
                 !isnan(a->crf) || (!a->lossless && (a->size || a->gop));
    if (a->paper && a->lossless) return cli_usage("compare", "choose --paper or --lossless");
    if (a->lossless && (a->qp || a->methods)) {
        return cli_usage("compare", "--qp and --methods are not of --lossless");
    }
    if (a->paper && plain) return cli_usage("compare", "--qp and --max-rms are not of --paper");
    if (!a->paper && paper) return cli_usage("compare", "this option is only for --paper");
    return EXIT_DONE;
}

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
                                            {"lossless", no_argument, NULL, OPT_LOSSLESS},
                                            {"paper", no_argument, NULL, OPT_PAPER},
                                            {"mixed", required_argument, NULL, OPT_MIXED},
                                            {"paper-row", required_argument, NULL, OPT_PAPER_ROW},
                                            {"tables", required_argument, NULL, OPT_TABLES},
                                            {"frames", required_argument, NULL, OPT_FRAMES},
                                            {"size", required_argument, NULL, OPT_SIZE},
                                            {"crf", required_argument, NULL, OPT_CRF},
                                            {"gop", required_argument, NULL, OPT_GOP},
                                            {"plot", required_argument, NULL, OPT_PLOT},
                                            {"force", no_argument, NULL, 'f'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "e:j:qhf", options, NULL)) != -1) {
        int status = set_option(a, option, optarg);
        if (status != EXIT_DONE) return status;
    }
    if (a->json && a->csv) return cli_usage("compare", "choose one of --json and --csv");
    if (optind == argc) return cli_usage("compare", "name the frames");
    return check_kind(a);
}

bool compare_next_item(const char **list, char *item, size_t room) {
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

gvc_result compare_original_off(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error) {
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
    gvc_result result = compare_zip(&c->source, compare_original_off, &c->row[c->count], error);
    if (result == GVC_OK) c->count++;
    return result;
}

static gvc_result add_draco(comparison *c, gvc_error *error) {
    const char *list = c->arguments->qp ? c->arguments->qp : DEFAULT_QP;
    char item[32];
    while (c->count < MAX_ROWS && compare_next_item(&list, item, sizeof item)) {
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
    const char *list = c->arguments->max_rms ? c->arguments->max_rms : DEFAULT_MAX_RMS;
    char item[32], method[48];
    while (c->count < MAX_ROWS && compare_next_item(&list, item, sizeof item)) {
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

#define LOSSLESS_QP 16 /* as fine as the codes */

static gvc_result measure_lossless(comparison *c, gvc_error *error) {
    const compare_arguments *a = c->arguments;
    gvc_encode_options options;
    bool relative;
    double bound;
    gvc_encode_options_init(&options);
    if (a->max_rms) {
        if (!cli_error_bound(a->max_rms, &bound, &relative)) {
            snprintf(error->message, sizeof error->message, "'%s' is not an error bound",
                     a->max_rms);
            return error->code = GVC_ERROR_ARGUMENT;
        }
        *(relative ? &options.max_rms : &options.max_rms_length) = bound;
    }
    options.lossless = true;
    options.best_effort = true;
    options.image_size = a->size;
    if (a->gop) options.gop = a->gop;
    options.threads = a->threads;
    announce(c, "lossless");
    gvc_result result = compare_lossless(&c->source, &options, &c->options, c->row, error);
    if (result != GVC_OK) return result;
    c->count = COMPARE_LOSSLESS_ROWS;
    announce(c, "draco");
    result = compare_draco(&c->source, LOSSLESS_QP, &c->options, &c->row[c->count], error);
    if (result != GVC_OK) return result;
    c->count++;
    return add_zip(c, error);
}

static gvc_result measure(comparison *c, gvc_error *error) {
    if (c->arguments->lossless) return measure_lossless(c, error);
    const char *list = c->arguments->methods ? c->arguments->methods : DEFAULT_METHODS;
    char item[32];
    while (c->count < MAX_ROWS && compare_next_item(&list, item, sizeof item)) {
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
    compare_arguments arguments = {.crf = NAN};
    frame_list list;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    if (arguments.paper) return compare_paper_command(&arguments, argv + optind, argc - optind);
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
