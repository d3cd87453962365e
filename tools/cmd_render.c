/* SPDX-License-Identifier: MIT */
/** @file cmd_render.c  gvc render. */
#include "base/output.h"
#include "base/text.h"
#include "render_job.h"

#include <getopt.h>
#include <math.h>
#include <string.h>
#include <strings.h>

static const char usage[] =
    "usage: gvc render [options] FRAMES... -o picture.png\n"
    "       gvc render [options] capture.gvc -o picture.png\n"
    "       gvc render [options] capture.gvc --against FRAMES... -o picture.png\n"
    "\n"
    "Makes a picture: of the surfaces of a capture, front and back, with the cut graphs that the\n"
    "encoder finds; of the geometry images in a .gvc file; or of captured and decoded frames side "
    "by\n"
    "side, with the distance between them.\n"
    "\n"
    "  -o, --output FILE     PNG; - is standard output\n"
    "  -f, --force           replace FILE if it exists\n"
    "      --frames LIST     which frames: 7, 3-9, 3-, 0-100/20 (every 20th), and lists of these "
    "with\n"
    "                        commas (default: some spread over the capture)\n"
    "      --no-graph        surfaces only; these may be open or in pieces\n"
    "      --ambiguity       colour by how much of the surface lies at the same distances from "
    "all\n"
    "                        tips as a place, to within 10 % of the greatest distance in sum\n"
    "      --against         the arguments after the file are the frames it was made from\n"
    "      --size N          pixels of a panel's longer side (default 480)\n"
    "      --view A,E        azimuth and elevation of the eye in degrees (default 25,8)\n"
    "      --up AXIS         x, y or z (default y)\n"
    "      --no-weld         do not merge equal positions\n"
    "      --any-order       take files as given: no check of numbers\n"
    "  -j, --jobs N          threads (default: one per processor); never changes the picture\n"
    "  -q, --quiet           no progress, no remarks\n";

enum {
    OPT_FRAMES = 256,
    OPT_NO_GRAPH,
    OPT_AMBIGUITY,
    OPT_AGAINST,
    OPT_SIZE,
    OPT_VIEW,
    OPT_UP,
    OPT_NO_WELD,
    OPT_ANY_ORDER
};

/* "25,8" */
static bool parse_view(const char *text, render_view *view) {
    const char *end = text + strlen(text);
    const char *comma = gvc_parse_double(text, end, &view->yaw);
    if (!comma || *comma != ',' || !isfinite(view->yaw) || fabs(view->yaw) > 360) return false;
    return cli_double(comma + 1, &view->pitch) && fabs(view->pitch) <= 90;
}

static bool parse_up(const char *text, render_view *view) {
    if (strlen(text) != 1 || text[0] < 'x' || text[0] > 'z') return false;
    view->up = (render_up)(text[0] - 'x');
    return true;
}

/* False if the value is not one that the option takes. */
static bool set_value(render_job *job, int option, const char *value) {
    uint64_t number = 0;
    bool good = true;
    switch (option) {
    case 'o':
        job->output = value;
        break;
    case OPT_FRAMES:
        job->frames = value;
        break;
    case OPT_SIZE:
        good = cli_uint(value, 64, 4096, &number);
        job->size = (size_t)number;
        break;
    case OPT_VIEW:
        good = parse_view(value, &job->view);
        break;
    case OPT_UP:
        good = parse_up(value, &job->view);
        break;
    case 'j':
        good = cli_uint(value, 0, 256, &number);
        job->threads = (unsigned)number;
        break;
    }
    return good;
}

/* False if it is none of these. */
static bool set_switch(render_job *job, int option) {
    switch (option) {
    case 'f':
        return job->force = true;
    case 'q':
        return job->quiet = true;
    case OPT_NO_GRAPH:
        return job->no_graph = true;
    case OPT_AMBIGUITY:
        return job->ambiguity = true;
    case OPT_AGAINST:
        return job->against = true;
    case OPT_ANY_ORDER:
        return job->any_order = true;
    case OPT_NO_WELD:
        job->weld = false;
        return true;
    }
    return false;
}

static bool ends_in(const char *text, const char *ending) {
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && strcasecmp(text + length - tail, ending) == 0;
}

static int parse(render_job *job, int argc, char **argv) {
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                            {"force", no_argument, NULL, 'f'},
                                            {"frames", required_argument, NULL, OPT_FRAMES},
                                            {"no-graph", no_argument, NULL, OPT_NO_GRAPH},
                                            {"ambiguity", no_argument, NULL, OPT_AMBIGUITY},
                                            {"against", no_argument, NULL, OPT_AGAINST},
                                            {"size", required_argument, NULL, OPT_SIZE},
                                            {"view", required_argument, NULL, OPT_VIEW},
                                            {"up", required_argument, NULL, OPT_UP},
                                            {"no-weld", no_argument, NULL, OPT_NO_WELD},
                                            {"any-order", no_argument, NULL, OPT_ANY_ORDER},
                                            {"jobs", required_argument, NULL, 'j'},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "o:fj:qh", options, NULL)) != -1) {
        if (option == 'h') {
            fputs(usage, stdout);
            return -1;
        }
        if (option == '?') return cli_usage("render", "bad options");
        if (!set_switch(job, option) && !set_value(job, option, optarg)) {
            return cli_usage("render", "'%s' is not a value this option takes", optarg);
        }
    }
    job->input = argv + optind;
    job->input_count = argc - optind;
    if (job->input_count == 0) return cli_usage("render", "name frames or one .gvc file");
    if (job->ambiguity && (job->against || job->no_graph)) {
        return cli_usage("render", "--ambiguity is of the tips of cut graphs, and of frames alone");
    }
    if (job->against && job->input_count < 2) {
        return cli_usage("render", "name one .gvc file and, after it, the frames");
    }
    if (!job->output) return cli_usage("render", "name the picture to write with -o");
    if (strcmp(job->output, "-") != 0 && !ends_in(job->output, ".png")) {
        return cli_usage("render", "pictures are PNG: '%s' should end in .png", job->output);
    }
    return EXIT_DONE;
}

/* By content, as files may have any name; what cannot be read is told later, by name. */
static bool is_gvc_file(const char *path) {
    char head[8];
    FILE *file = strcmp(path, "-") != 0 ? fopen(path, "rb") : NULL;
    bool box = file && fread(head, 1, sizeof head, file) == sizeof head &&
               memcmp(head + 4, "ftyp", 4) == 0;
    if (file) fclose(file);
    return box || ends_in(path, ".gvc");
}

static int draw(render_job *job, render_image **image) {
    if (job->against) return render_against(job, image);
    if (!is_gvc_file(job->input[0])) return render_surfaces(job, image);
    if (job->input_count > 1) {
        return cli_usage("render", "frames to compare a file with come after --against");
    }
    return render_images(job, image);
}

int cmd_render(int argc, char **argv) {
    render_job job = {.size = 480, .weld = true};
    render_image *image = NULL;
    gvc_output output;
    gvc_error error;
    render_view_init(&job.view);
    int status = parse(&job, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_error_init(&error);
    /* Opened first: a picture that cannot be written is not drawn. */
    if (!job.force && cli_in_the_way("render", job.output)) return EXIT_DATA;
    if (gvc_output_begin(job.output, job.force, &output, &error) != GVC_OK) {
        return cli_fail("render", job.output, &error);
    }
    status = draw(&job, &image);
    if (status == EXIT_DONE && (render_image_write(image, &output, &error) != GVC_OK ||
                                gvc_output_end(&output, &error) != GVC_OK)) {
        status = cli_fail("render", job.output, &error);
    }
    gvc_output_discard(&output);
    render_image_destroy(&image);
    return status;
}
