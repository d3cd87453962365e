/* SPDX-License-Identifier: MIT */
/** @file cmd_synth.c  gvc synth. */
#include "base/parallel.h"
#include "cli.h"
#include "frames.h"
#include "synth.h"

#include <getopt.h>
#include <stdlib.h>

static const char usage[] =
    "usage: gvc synth [options] -o 'frames/%04d.ply'\n"
    "\n"
    "Makes a sample capture: a dancing figure, every frame with its own connectivity.\n"
    "\n"
    "  -o, --output PATTERN  where to write; %d is the frame number\n"
    "      --frames N        how many (default 60)\n"
    "      --vertices N      about so many vertices, 1500 or more (default 6000)\n"
    "      --genus G         handles on the figure, 0 to 4 (default 0)\n"
    "      --seed S          another dance (default 1)\n"
    "  -f, --force           replace files that exist\n"
    "  -j, --jobs N          threads\n"
    "  -q, --quiet           no progress\n";

enum { OPT_FRAMES = 256, OPT_VERTICES, OPT_GENUS, OPT_SEED };

typedef struct synth_arguments {
    synth_options options;
    const char *output;
    bool force, quiet;
    unsigned threads;
    uint64_t first; /* of the chunk being made */
} synth_arguments;

static int parse(synth_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                            {"frames", required_argument, NULL, OPT_FRAMES},
                                            {"vertices", required_argument, NULL, OPT_VERTICES},
                                            {"genus", required_argument, NULL, OPT_GENUS},
                                            {"seed", required_argument, NULL, OPT_SEED},
                                            {"force", no_argument, NULL, 'f'},
                                            {"jobs", required_argument, NULL, 'j'},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "o:fj:qh", options, NULL)) != -1) {
        uint64_t number = 0;
        bool good = true;
        switch (option) {
        case 'o':
            a->output = optarg;
            break;
        case 'f':
            a->force = true;
            break;
        case 'q':
            a->quiet = true;
            break;
        case OPT_FRAMES:
            good = cli_uint(optarg, 1, 1000000, &a->options.frame_count);
            break;
        case OPT_VERTICES:
            good = cli_uint(optarg, 1500, 1000000, &number);
            a->options.vertex_count = (size_t)number;
            break;
        case OPT_GENUS:
            good = cli_uint(optarg, 0, SYNTH_MAX_GENUS, &number);
            a->options.genus = (unsigned)number;
            break;
        case OPT_SEED:
            good = cli_uint(optarg, 0, INT64_MAX, &a->options.seed);
            break;
        case 'j':
            good = cli_uint(optarg, 0, 256, &number);
            a->threads = (unsigned)number;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("synth", "bad options");
        }
        if (!good) return cli_usage("synth", "'%s' is not a value this option takes", optarg);
    }
    if (optind != argc) return cli_usage("synth", "'%s' is one argument too many", argv[optind]);
    if (!a->output) return cli_usage("synth", "name the files to write with -o");
    return EXIT_DONE;
}

static gvc_result write_one(void *user, size_t index, gvc_error *error) {
    const synth_arguments *a = user;
    uint64_t frame = a->first + index;
    gvc_mesh *mesh = NULL;
    char *path = NULL;
    gvc_result result = synth_frame(&a->options, frame, &mesh, error);
    if (result == GVC_OK && !pattern_fill(a->output, frame, &path)) result = gvc_fail_memory(error);
    if (result == GVC_OK) {
        result = gvc_mesh_write_file(mesh, path, GVC_MESH_AUTO, a->force, error);
    }
    free(path);
    gvc_mesh_destroy(&mesh);
    return result;
}

/* All files are looked for before the first is made. */
static int check_files(const synth_arguments *a) {
    for (uint64_t frame = 0; !a->force && frame < a->options.frame_count; frame++) {
        char *path;
        if (!pattern_fill(a->output, frame, &path)) return EXIT_DATA;
        bool there = cli_in_the_way("synth", path);
        free(path);
        if (there) return EXIT_DATA;
    }
    return EXIT_DONE;
}

static int write_frames(synth_arguments *a) {
    enum { CHUNK = 8 };
    cli_progress progress;
    uint64_t total = a->options.frame_count;
    cli_progress_begin(&progress, "making", a->quiet);
    for (a->first = 0; a->first < total; a->first += CHUNK) {
        gvc_error error;
        gvc_error_init(&error);
        uint64_t count = total - a->first < CHUNK ? total - a->first : CHUNK;
        gvc_result result = gvc_parallel_for(a->threads, (size_t)count, write_one, a, &error);
        if (result == GVC_OK && cli_interrupted()) {
            result = gvc_fail(&error, GVC_ERROR_CANCELLED, "interrupted");
        }
        if (result != GVC_OK) {
            cli_progress_end(&progress);
            return cli_fail("synth", NULL, &error);
        }
        cli_progress_show(&progress, a->first + count, total);
    }
    cli_progress_end(&progress);
    return EXIT_DONE;
}

int cmd_synth(int argc, char **argv) {
    synth_arguments arguments = {0};
    char *path;
    synth_options_init(&arguments.options);
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    if (!pattern_fill(arguments.output, 0, &path)) {
        return cli_usage("synth",
                         "the output needs one %%d for the frame number, as in frames/%%04d.ply");
    }
    status = cli_make_folder("synth", path);
    free(path);
    if (status == EXIT_DONE) status = check_files(&arguments);
    return status == EXIT_DONE ? write_frames(&arguments) : status;
}
