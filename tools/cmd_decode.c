/* SPDX-License-Identifier: MIT */
/** @file cmd_decode.c  gvc decode. */
#include "cli.h"
#include "frames.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gvc decode [options] capture.gvc -o 'out/%04d.obj'\n"
    "\n"
    "  -o, --output PATTERN  where to write; %d is the frame number; a plain name or - for one "
    "frame\n"
    "      --format F        off, obj, ply, ply-ascii (default: by the name's ending)\n"
    "      --frames A-B      only these frames: 7, 3-9, 3-\n"
    "  -f, --force           replace files that exist\n"
    "      --preview         of a lossless file, the preview instead of the exact frames\n"
    "      --keep-going      get all frames before and after damage; exit status 1 if any is lost\n"
    "      --no-output       decode only, write nothing (to time it)\n"
    "      --max-memory SIZE refuse what needs more to decode: 512M, 2G (default 1G)\n"
    "  -q, --quiet           no progress\n";

enum { OPT_FORMAT = 256, OPT_FRAMES, OPT_PREVIEW, OPT_KEEP_GOING, OPT_NO_OUTPUT, OPT_MAX_MEMORY };

typedef struct decode_arguments {
    const char *input, *output, *frames;
    gvc_mesh_format format;
    bool force, preview, keep_going, no_output, quiet;
    uint64_t first, last;
    uint64_t max_memory; /**< 0: the default */
} decode_arguments;

static bool parse_format(const char *text, gvc_mesh_format *format) {
    static const struct {
        const char *name;
        gvc_mesh_format format;
    } formats[] = {{"off", GVC_MESH_OFF},
                   {"obj", GVC_MESH_OBJ},
                   {"ply", GVC_MESH_PLY},
                   {"ply-ascii", GVC_MESH_PLY_ASCII}};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        if (strcmp(text, formats[i].name) != 0) continue;
        *format = formats[i].format;
        return true;
    }
    return false;
}

static int parse(decode_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                            {"format", required_argument, NULL, OPT_FORMAT},
                                            {"frames", required_argument, NULL, OPT_FRAMES},
                                            {"force", no_argument, NULL, 'f'},
                                            {"preview", no_argument, NULL, OPT_PREVIEW},
                                            {"keep-going", no_argument, NULL, OPT_KEEP_GOING},
                                            {"no-output", no_argument, NULL, OPT_NO_OUTPUT},
                                            {"max-memory", required_argument, NULL, OPT_MAX_MEMORY},
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
        case OPT_FORMAT:
            if (!parse_format(optarg, &a->format)) {
                return cli_usage("decode", "'%s' is not a format", optarg);
            }
            break;
        case OPT_FRAMES:
            a->frames = optarg;
            break;
        case OPT_PREVIEW:
            a->preview = true;
            break;
        case OPT_KEEP_GOING:
            a->keep_going = true;
            break;
        case OPT_MAX_MEMORY:
            if (!cli_size(optarg, &a->max_memory)) {
                return cli_usage("decode", "'%s' is not a number of bytes", optarg);
            }
            break;
        case OPT_NO_OUTPUT:
            a->no_output = true;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("decode", "bad options");
        }
    }
    if (optind + 1 != argc) return cli_usage("decode", "name one .gvc file");
    a->input = argv[optind];
    if (!a->output && !a->no_output) return cli_usage("decode", "name the files to write with -o");
    return EXIT_DONE;
}

static gvc_result write_frame(const decode_arguments *a, uint64_t frame, const gvc_mesh *mesh,
                              gvc_error *error) {
    if (a->no_output) return GVC_OK;
    char *path = cli_frame_path(a->output, frame, a->first == a->last);
    if (!path) {
        *error =
            (gvc_error){.code = GVC_ERROR_MEMORY, .frame = GVC_NO_FRAME, .offset = GVC_NO_OFFSET};
        return GVC_ERROR_MEMORY;
    }
    gvc_mesh_format format = a->format;
    if (format == GVC_MESH_AUTO && strcmp(path, "-") == 0) format = GVC_MESH_OBJ;
    gvc_result result = gvc_mesh_write_file(mesh, path, format, a->force, error);
    free(path);
    return result;
}

static int decode_frames(const decode_arguments *a, gvc_decoder *decoder) {
    cli_progress progress;
    uint64_t lost = 0, lost_before = 0;
    int status = EXIT_DONE;
    cli_progress_begin(&progress, "decoding", a->quiet);
    for (uint64_t frame = a->first; frame <= a->last; frame++) {
        gvc_mesh *mesh = NULL;
        gvc_error error;
        gvc_error_init(&error);
        gvc_result result = gvc_decoder_frame(decoder, frame, &mesh, &error);
        bool decoded = result == GVC_OK;
        if (decoded) result = write_frame(a, frame, mesh, &error);
        gvc_mesh_destroy(&mesh);
        if (result == GVC_ERROR_LOST && a->first < a->last) {
            lost_before++;
        } else if (result != GVC_OK) {
            status = cli_fail("decode", a->input, &error);
            lost++;
            if (!a->keep_going || decoded) break;
            if (error.code ==
                GVC_ERROR_TRUNCATED) { /* the file ends before it: so do all that follow */
                lost += a->last - frame;
                break;
            }
        }
        if (cli_interrupted()) {
            fprintf(stderr, "gvc decode: interrupted after frame %llu\n",
                    (unsigned long long)frame);
            status = EXIT_DATA;
            break;
        }
        cli_progress_show(&progress, frame - a->first + 1, a->last - a->first + 1);
    }
    cli_progress_end(&progress);
    cli_tell_lost("decode", lost_before, a->last - a->first + 1);
    if (lost > 0 && a->keep_going) {
        fprintf(stderr, "gvc decode: %llu of %llu frames lost\n", (unsigned long long)lost,
                (unsigned long long)(a->last - a->first + 1));
    }
    return status;
}

static int decode(decode_arguments *a, const gvc_reader *reader) {
    gvc_info info;
    gvc_error error;
    gvc_decoder *decoder = NULL;
    gvc_reader_info(reader, &info);
    uint64_t count = cli_frame_count(&info);
    if (count == 0) { /* not an error, unless some were asked for or may have been lost */
        fprintf(stderr, "gvc decode: %s: the file holds no frames\n", a->input);
        return a->frames || info.damage_count > 0 ? EXIT_DATA : EXIT_DONE;
    }
    int status = cli_choose_frames("decode", a->frames, count, &a->first, &a->last);
    if (status == EXIT_DONE && !a->no_output) {
        status = cli_check_frames("decode", a->output, a->first, a->last, NULL, NULL, a->force);
    }
    if (status != EXIT_DONE) return status;
    gvc_error_init(&error);
    if (gvc_decoder_create(reader, &decoder, &error) != GVC_OK) {
        return cli_fail("decode", a->input, &error);
    }
    status = decode_frames(a, decoder);
    gvc_decoder_destroy(&decoder);
    if (info.damage_count > 0) {
        fprintf(stderr, "gvc decode: %s: %llu damaged places\n", a->input,
                (unsigned long long)info.damage_count);
        status = EXIT_DATA;
    }
    return status;
}

int cmd_decode(int argc, char **argv) {
    decode_arguments arguments = {0};
    gvc_read_options options;
    gvc_reader *reader = NULL;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_read_options_init(&options);
    options.keep_going = arguments.keep_going;
    options.preview = arguments.preview;
    if (arguments.max_memory) options.max_memory = arguments.max_memory;
    gvc_error_init(&error);
    if (gvc_reader_open_file(arguments.input, &options, &reader, &error) != GVC_OK) {
        return cli_fail("decode", arguments.input, &error);
    }
    status = decode(&arguments, reader);
    gvc_reader_close(&reader);
    return status;
}
