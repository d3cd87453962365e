/* SPDX-License-Identifier: MIT */
/** @file cmd_verify.c  gvc verify. */
#include "cli.h"
#include "frames.h"

#include <getopt.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: gvc verify capture.gvc\n"
    "       gvc verify capture.gvc --against FRAMES...\n"
    "\n"
    "Checks every byte and the digest of the file, decodes every frame, compares its digest, and\n"
    "checks that each surface is closed, manifold, oriented and of the genus declared; with "
    "--against\n"
    "also measures the distance to the capture. Names what is damaged (fragment, track, frame, "
    "byte)\n"
    "and every frame that is not good. Fragments are numbered from 1, frames from 0.\n"
    "\n"
    "      --against         the arguments after the file are the frames it was made from\n"
    "      --any-order       take frames as given: no check of numbers\n"
    "      --max-memory SIZE refuse what needs more to decode: 512M, 2G (default 1G)\n"
    "  -q, --quiet           say nothing of a good file\n";

enum { OPT_AGAINST = 256, OPT_ANY_ORDER, OPT_MAX_MEMORY };

typedef struct verify_arguments {
    const char *input;
    bool against, any_order, quiet;
    uint64_t max_memory; /**< 0: the default */
} verify_arguments;

/* Errors so far, as fractions of each frame's diagonal. */
typedef struct verify_totals {
    uint64_t good, bad, lost_before, defects;
    double mean_sum, square_sum, hausdorff;
} verify_totals;

static int parse(verify_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"against", no_argument, NULL, OPT_AGAINST},
                                            {"any-order", no_argument, NULL, OPT_ANY_ORDER},
                                            {"max-memory", required_argument, NULL, OPT_MAX_MEMORY},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "qh", options, NULL)) != -1) {
        switch (option) {
        case OPT_AGAINST:
            a->against = true;
            break;
        case OPT_ANY_ORDER:
            a->any_order = true;
            break;
        case OPT_MAX_MEMORY:
            if (!cli_size(optarg, &a->max_memory)) {
                return cli_usage("verify", "'%s' is not a number of bytes", optarg);
            }
            break;
        case 'q':
            a->quiet = true;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("verify", "bad options");
        }
    }
    if (optind == argc) return cli_usage("verify", "name one .gvc file");
    if (!a->against && optind + 1 != argc) {
        return cli_usage("verify", "name one .gvc file, or frames after --against");
    }
    if (a->against && optind + 1 == argc) return cli_usage("verify", "name the frames");
    a->input = argv[optind];
    return EXIT_DONE;
}

static gvc_result wrong(gvc_error *error, uint64_t frame, const char *message) {
    gvc_error_init(error);
    error->code = GVC_ERROR_CORRUPT;
    error->frame = (int64_t)frame;
    snprintf(error->message, sizeof error->message, "%s", message);
    return error->code;
}

static gvc_result check_surface(const gvc_reader *reader, uint64_t frame, const gvc_mesh *mesh,
                                gvc_error *error) {
    gvc_topology topology;
    gvc_frame_info info;
    gvc_result result = gvc_mesh_topology(mesh, &topology, error);
    if (result == GVC_OK) result = gvc_reader_frame_info(reader, frame, &info, error);
    if (result != GVC_OK) return result;
    if (!topology.closed_manifold)
        return wrong(error, frame, "the surface is not a closed manifold");
    if (topology.genus != (int64_t)info.genus) {
        return wrong(error, frame, "the surface is not of the genus declared");
    }
    return GVC_OK;
}

static gvc_result check_distance(const gvc_source *source, uint64_t frame, const gvc_mesh *mesh,
                                 verify_totals *totals, gvc_error *error) {
    gvc_mesh *original = NULL;
    gvc_distance d;
    gvc_result result = source->read(source->user, frame, &original, error);
    if (result == GVC_OK) result = gvc_mesh_distance(original, mesh, 0, &d, error);
    if (result == GVC_OK) {
        double rms = fmax(d.rms[0], d.rms[1]) / d.diagonal;
        totals->mean_sum += fmax(d.mean[0], d.mean[1]) / d.diagonal;
        totals->square_sum += rms * rms;
        totals->hausdorff = fmax(totals->hausdorff, fmax(d.maximum[0], d.maximum[1]) / d.diagonal);
    }
    gvc_mesh_destroy(&original);
    return result;
}

/* Frames that follow each other and are bad for the same reason. */
typedef struct bad_run {
    uint64_t first, count;
    gvc_error error;
} bad_run;

static void end_run(const verify_arguments *a, bad_run *run) {
    if (run->count > 1) {
        fprintf(stderr, "gvc verify: %s: frames %" PRIu64 "-%" PRIu64 ": %s\n", a->input,
                run->first, run->first + run->count - 1, run->error.message);
    } else if (run->count == 1) {
        (void)cli_fail("verify", a->input, &run->error);
    }
    run->count = 0;
}

static void add_bad(const verify_arguments *a, bad_run *run, uint64_t frame,
                    const gvc_error *error) {
    bool same = run->count > 0 && strcmp(run->error.message, error->message) == 0;
    if (!same) {
        end_run(a, run);
        *run = (bad_run){.first = frame, .error = *error};
    }
    run->count++;
}

static void verify_frames(const verify_arguments *a, const gvc_reader *reader, gvc_decoder *decoder,
                          uint64_t count, const gvc_source *source, verify_totals *totals) {
    cli_progress progress;
    bad_run run = {0};
    cli_progress_begin(&progress, "verifying", a->quiet);
    for (uint64_t frame = 0; frame < count && !cli_interrupted(); frame++) {
        gvc_mesh *mesh = NULL;
        gvc_error error;
        gvc_error_init(&error);
        gvc_result result = gvc_decoder_frame(decoder, frame, &mesh, &error);
        if (result == GVC_OK) result = check_surface(reader, frame, mesh, &error);
        if (result == GVC_OK && source)
            result = check_distance(source, frame, mesh, totals, &error);
        gvc_mesh_destroy(&mesh);
        if (result == GVC_OK) {
            totals->good++;
        } else if (result == GVC_ERROR_LOST) {
            totals->lost_before++;
        } else {
            totals->bad++;
            add_bad(a, &run, frame, &error);
        }
        cli_progress_show(&progress, frame + 1, count);
    }
    end_run(a, &run);
    cli_progress_end(&progress);
}

/* ---------------------------------------------------------------------------------------- damage
 */

typedef struct damage_list {
    const verify_arguments *arguments;
    uint64_t count;
} damage_list;

static void print_range(const char *what, uint64_t first, uint64_t last) {
    fprintf(stderr, "%s%s %" PRIu64, what, last > first ? "s" : "", first);
    if (last > first) fprintf(stderr, "-%" PRIu64, last);
}

static bool print_defect(void *user, const gvc_defect *defect) {
    static const char *const part[] = {
        "head", "structure", "geometry track", "shape track", "exact track", "index", "file"};
    damage_list *list = user;
    list->count++;
    fprintf(stderr, "gvc verify: %s: ", list->arguments->input);
    if (defect->first_fragment) {
        print_range("fragment", defect->first_fragment, defect->last_fragment);
        fprintf(stderr, defect->last_fragment ? ", " : " and what follows, ");
    }
    fprintf(stderr, "%s, ", part[defect->part]);
    if (defect->frame_count > 0) {
        print_range("frame", defect->first_frame, defect->first_frame + defect->frame_count - 1);
        fprintf(stderr, ", ");
    }
    fprintf(stderr, "byte %" PRIu64, defect->offset);
    if (defect->size > 1) fprintf(stderr, "-%" PRIu64, defect->offset + defect->size - 1);
    fprintf(stderr, ": %s\n", defect->error.message);
    return !cli_interrupted();
}

static void print_totals(const verify_arguments *a, const char *what, const verify_totals *totals,
                         uint64_t count) {
    if (a->quiet && totals->good == count && totals->defects == 0) return;
    printf("%s: %" PRIu64 " of %" PRIu64 " %s good", a->input, totals->good, count, what);
    if (totals->lost_before > 0) {
        printf(", %" PRIu64 " lost before it was repaired", totals->lost_before);
    }
    if (totals->defects > 0) {
        printf(", %" PRIu64 " damaged place%s", totals->defects, totals->defects > 1 ? "s" : "");
    }
    if (a->against && totals->good > 0) {
        double n = (double)totals->good;
        printf("; distance to the capture, %% of the diagonal: mean %.4f, RMS %.4f, Hausdorff %.3f",
               100 * totals->mean_sum / n, 100 * sqrt(totals->square_sum / n),
               100 * totals->hausdorff);
    }
    printf("\n");
}

static int verify(const verify_arguments *a, const gvc_reader *reader, bool preview,
                  const gvc_source *source) {
    gvc_info info;
    gvc_error error;
    gvc_decoder *decoder = NULL;
    verify_totals totals = {0};
    gvc_reader_info(reader, &info);
    uint64_t count = cli_frame_count(&info);
    gvc_error_init(&error);
    if (source && source->frame_count != count) {
        fprintf(stderr,
                "gvc verify: %s: the file has %" PRIu64 " frames, the capture %" PRIu64 "\n",
                a->input, count, source->frame_count);
        return EXIT_DATA;
    }
    damage_list damage = {.arguments = a};
    if ((!preview && gvc_reader_check(reader, print_defect, &damage, &error) != GVC_OK) ||
        gvc_decoder_create(reader, &decoder, &error) != GVC_OK) {
        return cli_fail("verify", a->input, &error);
    }
    totals.defects = damage.count;
    verify_frames(a, reader, decoder, count, source, &totals);
    gvc_decoder_destroy(&decoder);
    print_totals(a, preview ? "previews" : "frames", &totals, count);
    bool whole = totals.good + totals.lost_before == count && totals.defects == 0;
    return whole ? EXIT_DONE : EXIT_DATA;
}

/* Frames as they are decoded by default and, of a lossless file with previews, these. */
static int verify_file(const verify_arguments *a, const gvc_source *source) {
    int status = EXIT_DONE;
    bool more = true;
    for (bool preview = false; more; preview = true) {
        gvc_reader *reader = NULL;
        gvc_info info;
        gvc_error error;
        gvc_read_options options;
        gvc_error_init(&error);
        gvc_read_options_init(&options);
        options.keep_going = true;
        options.preview = preview;
        if (a->max_memory) options.max_memory = a->max_memory;
        if (gvc_reader_open_file(a->input, &options, &reader, &error) != GVC_OK) {
            return cli_fail("verify", a->input, &error);
        }
        gvc_reader_info(reader, &info);
        int found = verify(a, reader, preview, source);
        if (found != EXIT_DONE) status = found;
        more = !preview && info.preview;
        gvc_reader_close(&reader);
    }
    return status;
}

int cmd_verify(int argc, char **argv) {
    verify_arguments arguments = {0};
    frame_list list = {0};
    gvc_source source;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_error_init(&error);
    if (arguments.against) {
        if (frame_list_make(argv + optind + 1, argc - optind - 1, arguments.any_order, &list,
                            &error) != GVC_OK) {
            return cli_fail("verify", NULL, &error);
        }
        source = frame_list_source(&list);
    }
    status = verify_file(&arguments, arguments.against ? &source : NULL);
    frame_list_free(&list);
    return status;
}
