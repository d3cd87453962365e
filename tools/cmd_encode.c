/* SPDX-License-Identifier: MIT */
/** @file cmd_encode.c  gvc encode. */
#include "base/output.h"
#include "cli.h"
#include "frames.h"
#include "from_exr.h"
#include "partial.h"

#include <getopt.h>
#include <math.h>
#include <string.h>

static const char usage[] =
    "usage: gvc encode [options] FRAMES... -o capture.gvc\n"
    "       gvc encode --from-exr FRAMES.exr... -o capture.gvc\n"
    "\n"
    "FRAMES are OFF, OBJ or PLY files, a folder of them, a pattern such as scan/%04d.obj, or - for "
    "one\n"
    "frame on standard input. Each must be one closed, oriented, manifold surface.\n"
    "\n"
    "  -o, --output FILE     where to write; - is standard output\n"
    "  -f, --force           replace FILE if it exists, and drop what a run that did not end has "
    "left\n"
    "      --resume          go on where a run that did not end has left off, with the same frames "
    "and\n"
    "                        options: the file will be the same as if nothing had happened\n"
    "  -e, --max-rms BOUND   RMS distance to hold in every group of frames: a share of the\n"
    "                        bounding box's diagonal (0.05%), or a length in the unit of the "
    "meshes\n"
    "                        (0.5). Fails where it is out of reach. Default 0.1%, best effort\n"
    "      --lossless        keep the geometry images exactly, as 16-bit codes; --max-rms then "
    "bounds\n"
    "                        what sampling alone costs\n"
    "      --with-preview    and H.264 pictures of them, within --max-rms or at --crf\n"
    "      --from-exr        FRAMES are OpenEXR files of gvc extract-exr; they say everything, and "
    "give\n"
    "                        the same lossless file again\n"
    "      --size S          samples a side of the geometry images, 16 to 2049 (default: by "
    "--max-rms)\n"
    "      --crf Q           x264's rate factor, -12 to 51, instead of --max-rms\n"
    "      --gop N           frames in a group, the unit of random access, and from keyframe to\n"
    "                        keyframe (default 60)\n"
    "  -r, --rate R          frames per second: 30, 29.97, 30000/1001 (default 30)\n"
    "      --unit U          unit of the coordinates, recorded only: m, mm, ...\n"
    "      --no-weld         do not merge equal positions (OBJ captures split along texture "
    "seams)\n"
    "      --any-order       take files as given: no check of numbers\n"
    "  -j, --jobs N          threads (default: one per processor); never changes the output\n"
    "  -q, --quiet           no progress, no summary\n"
    "\n"
    "FILE is written as FILE.part, which 'gvc decode --keep-going' can read at any time, and gets "
    "its\n"
    "name at the end.\n"
    "\n"
    "The method itself, for experiments (docs/ablation.md); numbers are the defaults:\n"
    "\n"
    "      --persistence 0.2 least persistence of an extremum to cut to, as a share of the range\n"
    "      --curvature 0.25  exponent of the curvature metric\n"
    "      --prior 1         weight of the path before (E_p)\n"
    "      --shortest 0.05   weight of the shortest path (E_d)\n"
    "      --lambda 0.95     weight of a junction's place before (Eq. 10)\n"
    "      --interior 0.8    how far the inside of a chart goes to where the one before was\n"
    "      --no-registration do not move along with the surface what is known of the frame "
    "before\n";

enum {
    OPT_SIZE = 256,
    OPT_LOSSLESS,
    OPT_WITH_PREVIEW,
    OPT_FROM_EXR,
    OPT_CRF,
    OPT_GOP,
    OPT_UNIT,
    OPT_NO_WELD,
    OPT_ANY_ORDER,
    OPT_RESUME,
    OPT_PERSISTENCE,
    OPT_CURVATURE,
    OPT_PRIOR,
    OPT_SHORTEST,
    OPT_LAMBDA,
    OPT_INTERIOR,
    OPT_NO_REGISTRATION
};

typedef struct encode_arguments {
    gvc_encode_options options;
    const char *output;
    bool force, quiet, any_order, from_exr, resume;
    partial_file partial;
    cli_progress progress;
    bool scanning;
} encode_arguments;

static bool on_progress(void *user, gvc_stage stage, uint64_t done, uint64_t total) {
    encode_arguments *arguments = user;
    if (arguments->scanning && stage == GVC_STAGE_ENCODE) {
        cli_progress_end(&arguments->progress);
        cli_progress_begin(&arguments->progress, "encoding", arguments->quiet);
        arguments->scanning = false;
    }
    cli_progress_show(&arguments->progress, done, total);
    return !cli_interrupted();
}

static void on_warning(void *user, int64_t frame, const char *message) {
    const encode_arguments *arguments = user;
    if (arguments->progress.enabled) fputs("\r\x1b[K", stderr);
    if (frame == GVC_NO_FRAME) {
        cli_warn("encode", "%s", message);
    } else {
        cli_warn("encode", "frame %lld: %s", (long long)frame, message);
    }
}

/* The option that is just a number, or NULL. */
static double *plain_number(gvc_encode_options *o, int option) {
    switch (option) {
    case OPT_CRF:
        return &o->crf;
    case OPT_PERSISTENCE:
        return &o->persistence;
    case OPT_CURVATURE:
        return &o->curvature_weight;
    case OPT_PRIOR:
        return &o->prior_weight;
    case OPT_SHORTEST:
        return &o->shortest_weight;
    case OPT_LAMBDA:
        return &o->lambda;
    case OPT_INTERIOR:
        return &o->interior_share;
    default:
        return NULL;
    }
}

/* EXIT_DONE to go on, EXIT_USAGE for a bad option, -1 after --help. */
static int set_option(encode_arguments *a, int option, const char *value) {
    gvc_encode_options *o = &a->options;
    uint64_t number;
    bool relative;
    double bound, *plain = plain_number(o, option);
    if (plain)
        return cli_double(value, plain)
                   ? EXIT_DONE
                   : cli_usage("encode", "'%s' is not a value this option takes", value);
    switch (option) {
    case 'o':
        a->output = value;
        return EXIT_DONE;
    case 'f':
        a->force = true;
        return EXIT_DONE;
    case 'q':
        a->quiet = true;
        return EXIT_DONE;
    case 'e':
        if (!cli_error_bound(value, &bound, &relative)) break;
        *(relative ? &o->max_rms : &o->max_rms_length) = bound;
        o->best_effort = false;
        return EXIT_DONE;
    case OPT_SIZE:
        if (!cli_uint(value, 16, 2049, &number)) break;
        o->image_size = (uint32_t)number;
        return EXIT_DONE;
    case OPT_GOP:
        if (!cli_uint(value, 1, 10000, &number)) break;
        o->gop = (uint32_t)number;
        return EXIT_DONE;
    case 'r':
        if (!cli_rate(value, &o->frame_rate_num, &o->frame_rate_den)) break;
        return EXIT_DONE;
    case 'j':
        if (!cli_uint(value, 0, 256, &number)) break;
        o->threads = (unsigned)number;
        return EXIT_DONE;
    case OPT_UNIT:
        if (strlen(value) >= sizeof o->unit) break;
        snprintf(o->unit, sizeof o->unit, "%s", value);
        return EXIT_DONE;
    case OPT_NO_REGISTRATION:
        o->registration = false;
        return EXIT_DONE;
    case OPT_LOSSLESS:
        o->lossless = true;
        return EXIT_DONE;
    case OPT_WITH_PREVIEW:
        o->with_preview = true;
        return EXIT_DONE;
    case OPT_FROM_EXR:
        a->from_exr = true;
        return EXIT_DONE;
    case OPT_NO_WELD:
        o->weld = false;
        return EXIT_DONE;
    case OPT_RESUME:
        a->resume = true;
        return EXIT_DONE;
    case OPT_ANY_ORDER:
        a->any_order = true;
        return EXIT_DONE;
    case 'h':
        fputs(usage, stdout);
        return -1;
    default:
        return cli_usage("encode", "bad options");
    }
    return cli_usage("encode", "'%s' is not a value this option takes", value);
}

/* Whether an option says how meshes become images. */
static bool is_of_meshes(int option) {
    switch (option) {
    case 'o':
    case 'f':
    case 'q':
    case 'j':
    case OPT_FROM_EXR:
    case OPT_LOSSLESS:
    case OPT_ANY_ORDER:
        return false;
    default:
        return true;
    }
}

static int parse(encode_arguments *a, int argc, char **argv) {
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"force", no_argument, NULL, 'f'},
        {"quiet", no_argument, NULL, 'q'},
        {"max-rms", required_argument, NULL, 'e'},
        {"size", required_argument, NULL, OPT_SIZE},
        {"crf", required_argument, NULL, OPT_CRF},
        {"gop", required_argument, NULL, OPT_GOP},
        {"rate", required_argument, NULL, 'r'},
        {"unit", required_argument, NULL, OPT_UNIT},
        {"lossless", no_argument, NULL, OPT_LOSSLESS},
        {"with-preview", no_argument, NULL, OPT_WITH_PREVIEW},
        {"from-exr", no_argument, NULL, OPT_FROM_EXR},
        {"no-weld", no_argument, NULL, OPT_NO_WELD},
        {"any-order", no_argument, NULL, OPT_ANY_ORDER},
        {"resume", no_argument, NULL, OPT_RESUME},
        {"persistence", required_argument, NULL, OPT_PERSISTENCE},
        {"prior", required_argument, NULL, OPT_PRIOR},
        {"curvature", required_argument, NULL, OPT_CURVATURE},
        {"shortest", required_argument, NULL, OPT_SHORTEST},
        {"lambda", required_argument, NULL, OPT_LAMBDA},
        {"interior", required_argument, NULL, OPT_INTERIOR},
        {"no-registration", no_argument, NULL, OPT_NO_REGISTRATION},
        {"jobs", required_argument, NULL, 'j'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0}};
    int option;
    bool of_meshes = false;
    while ((option = getopt_long(argc, argv, "o:fqe:r:j:h", options, NULL)) != -1) {
        int status = set_option(a, option, optarg);
        if (status != EXIT_DONE) return status;
        of_meshes = of_meshes || is_of_meshes(option);
    }
    if (a->from_exr && of_meshes) {
        return cli_usage("encode", "with --from-exr the frames say everything but -o, -f, -q, -j "
                                   "and --any-order");
    }
    if (optind == argc) return cli_usage("encode", "name the frames to encode");
    if (!a->output) return cli_usage("encode", "name the file to write with -o");
    const gvc_encode_options *o = &a->options;
    if (o->with_preview && !o->lossless) {
        return cli_usage("encode",
                         "--with-preview is for --lossless: other files are H.264 anyway");
    }
    if (o->lossless && !o->with_preview && !isnan(o->crf)) {
        return cli_usage("encode", "--lossless without --with-preview has no use for --crf");
    }
    return EXIT_DONE;
}

/* Nothing of these is measured where images come from OpenEXR files. */
static void summarise_images(const encode_arguments *a, const gvc_encode_report *report,
                             double seconds) {
    if (a->quiet) return;
    fprintf(stderr, "%llu frames, %llu bytes (%.0f a frame), %u x %u images, %.1f s\n",
            (unsigned long long)report->frame_count, (unsigned long long)report->byte_count,
            (double)report->byte_count / (double)report->frame_count, report->image_size,
            report->image_size, seconds);
}

static void summarise(const encode_arguments *a, const gvc_encode_report *report, double seconds) {
    if (a->quiet) return;
    fprintf(stderr,
            "%llu frames, %llu bytes (%.0f a frame), %u x %u images, %llu segment%s, "
            "RMS error %.4f%% of the diagonal at worst, ",
            (unsigned long long)report->frame_count, (unsigned long long)report->byte_count,
            (double)report->byte_count / (double)report->frame_count, report->image_size,
            report->image_size, (unsigned long long)report->segment_count,
            report->segment_count == 1 ? "" : "s", 100 * report->worst_rms);
    if (a->options.with_preview) fprintf(stderr, "preview %.4f%%, ", 100 * report->preview_rms);
    fprintf(stderr, "%.1f s\n", seconds);
}

static gvc_result on_journal(void *user, const char *line, gvc_error *error) {
    encode_arguments *a = user;
    return partial_note(&a->partial, line, error);
}

static gvc_result on_checkpoint(void *user, const void *data, size_t size, gvc_error *error) {
    encode_arguments *a = user;
    (void)error;
    partial_checkpoint(&a->partial, data, size);
    return GVC_OK;
}

/* To standard output or a device, which cannot be looked at again, and from geometry images, which
 * takes no time: nothing is kept of a run that fails. */
static gvc_result encode_whole(encode_arguments *a, frame_list *list, gvc_encode_report *report,
                               gvc_error *error) {
    gvc_output output;
    gvc_sink sink = {.user = &output, .write = gvc_output_write};
    gvc_result result = gvc_output_begin(a->output, a->force, &output, error);
    if (result != GVC_OK) return result;
    if (a->from_exr) {
        result = encode_from_exr(list, &sink, &a->options, report, error);
    } else {
        gvc_source source = frame_list_source(list);
        result = gvc_encode(&source, &sink, &a->options, report, error);
    }
    if (result == GVC_OK) {
        gvc_output_sync(&output);
        return gvc_output_end(&output, error);
    }
    gvc_output_discard(&output);
    return result;
}

/* To a file of whose finished groups nothing is lost when this ends early. */
static gvc_result encode_file(encode_arguments *a, const gvc_source *source,
                              gvc_encode_report *report, gvc_error *error) {
    partial_file *p = &a->partial;
    gvc_sink sink = {.user = &p->output, .write = gvc_output_write};
    gvc_result result = partial_begin(a->output, a->force, a->resume, p, error);
    if (result != GVC_OK) {
        if (result == GVC_ERROR_IO && !a->resume && strstr(error->message, "left by a run")) {
            cli_warn("encode", "%s", "--resume goes on with it, -f begins anew");
        }
        return result;
    }
    a->options.journal = on_journal;
    a->options.checkpoint = on_checkpoint;
    gvc_partial before = {.file = p->reader,
                          .journal = p->journal_text,
                          .checkpoint = p->state.size > 0 ? p->state.data : NULL,
                          .checkpoint_size = p->state.size};
    result =
        gvc_encode_resume(source, &sink, &a->options, p->reader ? &before : NULL, report, error);
    bool kept = false;
    if (result == GVC_OK) {
        result = partial_end(p, error);
        kept = result != GVC_OK;
    } else {
        kept = partial_leave(p, result == GVC_ERROR_IO || result == GVC_ERROR_CANCELLED ||
                                    result == GVC_ERROR_MEMORY);
    }
    if (kept) {
        fprintf(stderr, "gvc encode: what is finished is kept as %s.part; --resume goes on\n",
                a->output);
    }
    return result;
}

static int encode(encode_arguments *a, frame_list *list) {
    gvc_error error;
    gvc_encode_report report;
    double started = cli_now();
    gvc_error_init(&error);
    if (!a->force && cli_in_the_way("encode", a->output)) return EXIT_DATA;
    bool stream = gvc_output_is_stream(a->output);
    if (stream && a->resume) return cli_usage("encode", "only a file can be resumed");
    if (a->from_exr && a->resume) return cli_usage("encode", "--from-exr needs no --resume");
    gvc_source source = frame_list_source(list);
    a->scanning = true;
    cli_progress_begin(&a->progress, "reading", a->quiet);
    bool whole = stream || a->from_exr;
    gvc_result result =
        whole ? encode_whole(a, list, &report, &error) : encode_file(a, &source, &report, &error);
    cli_progress_end(&a->progress);
    if (result != GVC_OK) return cli_fail("encode", a->output, &error);
    if (a->from_exr) {
        summarise_images(a, &report, cli_now() - started);
    } else {
        summarise(a, &report, cli_now() - started);
    }
    return EXIT_DONE;
}

int cmd_encode(int argc, char **argv) {
    encode_arguments arguments = {0};
    frame_list list;
    gvc_error error;
    gvc_encode_options_init(&arguments.options);
    arguments.options.best_effort = true;
    arguments.options.progress = on_progress;
    arguments.options.warn = on_warning;
    arguments.options.user = &arguments;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_error_init(&error);
    gvc_result listed =
        arguments.from_exr
            ? frame_list_make_exr(argv + optind, argc - optind, arguments.any_order, &list, &error)
            : frame_list_make(argv + optind, argc - optind, arguments.any_order, &list, &error);
    if (listed != GVC_OK) return cli_fail("encode", NULL, &error);
    status = encode(&arguments, &list);
    frame_list_free(&list);
    return status;
}
