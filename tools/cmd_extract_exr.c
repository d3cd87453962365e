/* SPDX-License-Identifier: MIT */
/** @file cmd_extract_exr.c  gvc extract-exr. */
#include "base/bytes.h"
#include "base/output.h"
#include "base/result.h"
#include "cli.h"
#include "exr_frame.h"

#include <getopt.h>
#include <stdlib.h>

static const char usage[] =
    "usage: gvc extract-exr [options] capture.gvc -o 'images/%04d.exr'\n"
    "\n"
    "Writes the geometry image of every frame as an OpenEXR file: channels X, Y, Z show the "
    "surface,\n"
    "X.lo, Y.lo, Z.lo hold the bits below. The files say all that is needed to make a lossless "
    "file "
    "of\n"
    "them: gvc encode --from-exr.\n"
    "\n"
    "  -o, --output PATTERN  where to write; %d is the frame number; a plain name or - for one "
    "frame\n"
    "      --keyframes       only the first frame of every group\n"
    "      --preview         of a lossless file, the preview instead of the exact images\n"
    "      --frames A-B      only these frames: 7, 3-9, 3-\n"
    "  -f, --force           replace files that exist\n"
    "  -q, --quiet           no progress\n";

enum { OPT_KEYFRAMES = 256, OPT_PREVIEW, OPT_FRAMES };

typedef struct extract_arguments {
    const char *input, *output, *frames;
    bool keyframes, preview, force, quiet;
    const gvc_reader *reader;
    uint64_t first, last;
} extract_arguments;

static int parse(extract_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                            {"keyframes", no_argument, NULL, OPT_KEYFRAMES},
                                            {"preview", no_argument, NULL, OPT_PREVIEW},
                                            {"frames", required_argument, NULL, OPT_FRAMES},
                                            {"force", no_argument, NULL, 'f'},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "o:fqh", options, NULL)) != -1) {
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
        case OPT_KEYFRAMES:
            a->keyframes = true;
            break;
        case OPT_PREVIEW:
            a->preview = true;
            break;
        case OPT_FRAMES:
            a->frames = optarg;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("extract-exr", "bad options");
        }
    }
    if (optind + 1 != argc) return cli_usage("extract-exr", "name one .gvc file");
    a->input = argv[optind];
    if (!a->output) return cli_usage("extract-exr", "name the files to write with -o");
    return EXIT_DONE;
}

typedef enum choice { TAKE, LEAVE, LOST } choice;

/* A frame that cannot be read is taken, so that the failure is told; one that was lost before the
 * file was repaired is not, if there are others. */
static choice choose(const extract_arguments *a, uint64_t frame) {
    gvc_frame_info info;
    gvc_result result = gvc_reader_frame_info(a->reader, frame, &info, NULL);
    if (result == GVC_ERROR_LOST) return a->first < a->last ? LOST : TAKE;
    return result != GVC_OK || !a->keyframes || info.keyframe ? TAKE : LEAVE;
}

static bool is_wanted(void *user, uint64_t frame) { return choose(user, frame) == TAKE; }

static gvc_result write_file(const extract_arguments *a, uint64_t frame, const gvc_buffer *bytes,
                             gvc_error *error) {
    char *path = cli_frame_path(a->output, frame, a->first == a->last);
    if (!path) return gvc_fail_memory(error);
    gvc_output output;
    gvc_result result = gvc_output_begin(path, a->force, &output, error);
    if (result == GVC_OK) {
        result = gvc_output_write(&output, bytes->data, bytes->size, error);
        if (result == GVC_OK) {
            result = gvc_output_end(&output, error);
        } else {
            gvc_output_discard(&output);
        }
    }
    if (result != GVC_OK) (void)gvc_fail_in(error, result, path);
    free(path);
    return result;
}

static gvc_result extract_frame(const extract_arguments *a, gvc_decoder *decoder, uint64_t number,
                                gvc_error *error) {
    gvc_exr_frame frame;
    gvc_buffer bytes = {0};
    gvc_result result = gvc_exr_frame_take(a->reader, decoder, number, &frame, error);
    if (result == GVC_OK) result = gvc_exr_frame_write(&frame, &bytes, error);
    if (result == GVC_OK) result = write_file(a, number, &bytes, error);
    gvc_buffer_free(&bytes);
    gvc_exr_frame_free(&frame);
    return result;
}

static int extract_frames(extract_arguments *a, gvc_decoder *decoder) {
    cli_progress progress;
    uint64_t lost = 0;
    int status = EXIT_DONE;
    cli_progress_begin(&progress, "extracting", a->quiet);
    for (uint64_t frame = a->first; status == EXIT_DONE && frame <= a->last; frame++) {
        gvc_error error;
        gvc_error_init(&error);
        choice chosen = choose(a, frame);
        lost += chosen == LOST;
        if (chosen == TAKE && extract_frame(a, decoder, frame, &error) != GVC_OK) {
            status = cli_fail("extract-exr", a->input, &error);
        } else if (cli_interrupted()) {
            fprintf(stderr, "gvc extract-exr: interrupted after frame %llu\n",
                    (unsigned long long)frame);
            status = EXIT_DATA;
        }
        cli_progress_show(&progress, frame - a->first + 1, a->last - a->first + 1);
    }
    cli_progress_end(&progress);
    cli_tell_lost("extract-exr", lost, a->last - a->first + 1);
    return status;
}

static int extract(extract_arguments *a) {
    gvc_info info;
    gvc_error error;
    gvc_decoder *decoder = NULL;
    gvc_reader_info(a->reader, &info);
    uint64_t count = cli_frame_count(&info);
    if (count == 0) {
        fprintf(stderr, "gvc extract-exr: %s: the file holds no frames\n", a->input);
        return EXIT_DATA;
    }
    int status = cli_choose_frames("extract-exr", a->frames, count, &a->first, &a->last);
    if (status == EXIT_DONE) {
        status =
            cli_check_frames("extract-exr", a->output, a->first, a->last, is_wanted, a, a->force);
    }
    if (status != EXIT_DONE) return status;
    gvc_error_init(&error);
    if (gvc_decoder_create(a->reader, &decoder, &error) != GVC_OK) {
        return cli_fail("extract-exr", a->input, &error);
    }
    status = extract_frames(a, decoder);
    gvc_decoder_destroy(&decoder);
    return status;
}

int cmd_extract_exr(int argc, char **argv) {
    extract_arguments arguments = {0};
    gvc_read_options options;
    gvc_reader *reader = NULL;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_read_options_init(&options);
    options.preview = arguments.preview;
    gvc_error_init(&error);
    if (gvc_reader_open_file(arguments.input, &options, &reader, &error) != GVC_OK) {
        return cli_fail("extract-exr", arguments.input, &error);
    }
    arguments.reader = reader;
    status = extract(&arguments);
    gvc_reader_close(&reader);
    return status;
}
