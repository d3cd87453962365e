/* SPDX-License-Identifier: MIT */
/** @file cmd_repair.c  gvc repair. */
#include "base/output.h"
#include "cli.h"

#include <getopt.h>
#include <inttypes.h>

static const char usage[] =
    "usage: gvc repair [options] damaged.gvc -o good.gvc\n"
    "\n"
    "Writes a good file of what is undamaged in another one, which stays as it is. Groups of "
    "frames\n"
    "that are whole are copied bit for bit; of a damaged group the frames before the damage are "
    "kept\n"
    "where they need nothing behind it. Frames keep their numbers and times, and the file states "
    "which\n"
    "are lost. 'gvc decode --keep-going' may get some more frames out of a damaged group.\n"
    "\n"
    "  -o, --output FILE     where to write; - is standard output\n"
    "  -f, --force           replace FILE if it exists\n"
    "  -q, --quiet           do not list what is lost\n"
    "\n"
    "Exit status 0 if something was saved, whether all or not.\n";

typedef struct repair_arguments {
    const char *input, *output;
    bool force, quiet;
} repair_arguments;

static int parse(repair_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
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
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("repair", "bad options");
        }
    }
    if (optind + 1 != argc) return cli_usage("repair", "name one .gvc file");
    if (!a->output) return cli_usage("repair", "name the file to write with -o");
    a->input = argv[optind];
    return EXIT_DONE;
}

static void print_lost(void *user, uint64_t first, uint64_t count) {
    const repair_arguments *a = user;
    if (a->quiet) return;
    fprintf(stderr, "gvc repair: %s: lost: frame", a->input);
    if (count > 1) {
        fprintf(stderr, "s %" PRIu64 "-%" PRIu64 "\n", first, first + count - 1);
    } else {
        fprintf(stderr, " %" PRIu64 "\n", first);
    }
}

static int repair(repair_arguments *a, const gvc_reader *reader) {
    gvc_error error;
    gvc_output output;
    gvc_repair_report report;
    gvc_error_init(&error);
    if (gvc_output_begin(a->output, a->force, &output, &error) != GVC_OK) {
        return cli_fail("repair", a->output, &error);
    }
    gvc_sink sink = {.user = &output, .write = gvc_output_write};
    gvc_result result = gvc_repair(reader, &sink, print_lost, a, &report, &error);
    if (result == GVC_OK) {
        gvc_output_sync(&output);
        result = gvc_output_end(&output, &error);
        if (result != GVC_OK) return cli_fail("repair", a->output, &error);
    } else {
        gvc_output_discard(&output);
        return cli_fail("repair", a->input, &error);
    }
    if (!a->quiet) {
        fprintf(stderr,
                "%" PRIu64 " of %" PRIu64 " frames saved, %" PRIu64 " groups whole, %" PRIu64
                " in part; %" PRIu64 " bytes\n",
                report.frame_count, report.frame_count + report.lost_count, report.whole_groups,
                report.cut_groups, report.byte_count);
    }
    return EXIT_DONE;
}

int cmd_repair(int argc, char **argv) {
    repair_arguments arguments = {0};
    gvc_read_options options;
    gvc_reader *reader = NULL;
    gvc_error error;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    if (!arguments.force && cli_in_the_way("repair", arguments.output)) return EXIT_DATA;
    gvc_read_options_init(&options);
    options.keep_going = true;
    gvc_error_init(&error);
    if (gvc_reader_open_file(arguments.input, &options, &reader, &error) != GVC_OK) {
        return cli_fail("repair", arguments.input, &error);
    }
    status = repair(&arguments, reader);
    gvc_reader_close(&reader);
    return status;
}
