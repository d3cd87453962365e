/* SPDX-License-Identifier: MIT */
/** @file cmd_info.c  gvc info. */
#include "cli.h"

#include <getopt.h>
#include <inttypes.h>

static const char usage[] = "usage: gvc info [options] capture.gvc\n"
                            "\n"
                            "      --json            machine-readable\n"
                            "      --frames          a line for every frame\n"
                            "      --keep-going      tell also of a damaged file\n";

enum { OPT_JSON = 256, OPT_FRAMES, OPT_KEEP_GOING };

typedef struct info_arguments {
    const char *input;
    bool json, frames, keep_going;
} info_arguments;

static int parse(info_arguments *a, int argc, char **argv) {
    static const struct option options[] = {{"json", no_argument, NULL, OPT_JSON},
                                            {"frames", no_argument, NULL, OPT_FRAMES},
                                            {"keep-going", no_argument, NULL, OPT_KEEP_GOING},
                                            {"help", no_argument, NULL, 'h'},
                                            {NULL, 0, NULL, 0}};
    int option;
    while ((option = getopt_long(argc, argv, "h", options, NULL)) != -1) {
        switch (option) {
        case OPT_JSON:
            a->json = true;
            break;
        case OPT_FRAMES:
            a->frames = true;
            break;
        case OPT_KEEP_GOING:
            a->keep_going = true;
            break;
        case 'h':
            fputs(usage, stdout);
            return -1;
        default:
            return cli_usage("info", "bad options");
        }
    }
    if (optind + 1 != argc) return cli_usage("info", "name one .gvc file");
    a->input = argv[optind];
    return EXIT_DONE;
}

static void print_digest(const uint8_t *digest, size_t size) {
    for (size_t i = 0; i < size; i++) printf("%02x", digest[i]);
}

static bool has_video(const gvc_info *info) { return !info->lossless || info->preview; }

static const char *profile(const gvc_info *info) {
    if (!info->lossless) return "lossy";
    return info->preview ? "lossless with preview" : "lossless";
}

static void print_track(const char *name, uint64_t bytes, const gvc_info *info) {
    if (bytes == 0) return; /* there is no such track */
    printf("track        %s, %" PRIu64 " bytes, %.0f a frame\n", name, bytes,
           (double)bytes / (double)info->frame_count);
}

static void print_text(const info_arguments *a, const gvc_info *info) {
    double rate = (double)info->frame_rate_num / info->frame_rate_den;
    printf("%s: gvc %u.%u, written by %s\n", a->input, info->format_version_major,
           info->format_version_minor, info->encoder);
    printf("frames       %" PRIu64 " at %.6g a second, %.3f s\n", info->frame_count, rate,
           (double)info->frame_count / rate);
    uint64_t missing = cli_frame_count(info) - info->frame_count - info->lost_count;
    if (missing > 0) {
        printf("missing      %" PRIu64 " frames\n", missing);
    }
    if (info->lost_count > 0) {
        printf("lost         %" PRIu64 " frames, before the file was repaired\n", info->lost_count);
    }
    if (info->damage_count > 0) printf("damage       %" PRIu64 " places\n", info->damage_count);
    printf("bytes        %" PRIu64, info->byte_count);
    if (info->frame_count > 0) {
        double each = (double)info->byte_count / (double)info->frame_count;
        printf(", %.0f a frame, %.1f kbit/s", each, each * rate * 8 / 1000);
    }
    printf("\nimage        %u x %u samples", info->image_size, info->image_size);
    if (has_video(info)) {
        printf(" (pictures of %u x %u)", info->picture_width, info->picture_height);
    }
    printf("\nprofile      %s, level %u\n", profile(info), info->level);
    print_track("H.264", info->geometry_bytes, info);
    print_track("exact", info->exact_bytes, info);
    print_track("shape", info->shape_bytes, info);
    printf("groups       %" PRIu64 "\n", info->gop_count);
    printf("unit         %s\n", info->unit[0] ? info->unit : "not stated");
    if (info->has_digest) {
        printf("SHA-256      ");
        print_digest(info->digest, sizeof info->digest);
        printf("\n");
    }
}

static void print_json(const info_arguments *a, const gvc_info *info) {
    printf("{\n  \"file\": ");
    cli_json_string(stdout, a->input);
    printf(",\n  \"format\": \"%u.%u\",\n  \"encoder\": ", info->format_version_major,
           info->format_version_minor);
    cli_json_string(stdout, info->encoder);
    printf(",\n  \"frames\": %" PRIu64 ",\n  \"declared_frames\": %" PRIu64
           ",\n  \"bytes\": %" PRIu64
           ",\n  \"image_size\": %u,\n  \"picture\": [%u, %u],\n  \"frame_rate\": [%u, %u],\n"
           "  \"profile\": \"%s\",\n  \"level\": %u,\n  \"track_bytes\": {\"h264\": %" PRIu64
           ", \"exact\": %" PRIu64 ", \"shape\": %" PRIu64 "},\n  \"groups\": %" PRIu64
           ",\n  \"damaged_places\": %" PRIu64 ",\n  \"unit\": ",
           info->frame_count, info->declared_count, info->byte_count, info->image_size,
           info->picture_width, info->picture_height, info->frame_rate_num, info->frame_rate_den,
           profile(info), info->level, info->geometry_bytes, info->exact_bytes, info->shape_bytes,
           info->gop_count, info->damage_count);
    cli_json_string(stdout, info->unit);
    printf(",\n  \"lost_frames\": %" PRIu64, info->lost_count);
    if (info->has_digest) {
        printf(",\n  \"sha256\": \"");
        print_digest(info->digest, sizeof info->digest);
        printf("\"");
    }
}

static void print_frame(const info_arguments *a, uint64_t frame, const gvc_frame_info *f,
                        bool first) {
    if (a->json) {
        printf("%s\n    {\"frame\": %" PRIu64 ", \"bytes\": %" PRIu64
               ", \"keyframe\": %s, \"segment\": %" PRIu64
               ", \"charts\": %u, \"genus\": %u, \"extrema\": %u, \"nodes\": %u, \"edges\": %u, "
               "\"digest\": \"",
               first ? "" : ",", frame, f->byte_count, f->keyframe ? "true" : "false", f->segment,
               f->chart_count, f->genus, f->extremum_count, f->node_count, f->edge_count);
        print_digest(f->digest, sizeof f->digest);
        printf("\", \"source\": ");
        cli_json_string(stdout, f->source);
        printf("}");
        return;
    }
    printf("%8" PRIu64 " %8" PRIu64 " %s segment %" PRIu64
           ", genus %u, %u extrema, %u nodes, %u edges, digest ",
           frame, f->byte_count, f->keyframe ? "key" : "   ", f->segment, f->genus,
           f->extremum_count, f->node_count, f->edge_count);
    print_digest(f->digest, sizeof f->digest);
    if (f->source[0]) printf(", from %s", f->source);
    printf("\n");
}

static int print_frames(const info_arguments *a, const gvc_reader *reader, const gvc_info *info) {
    uint64_t count = cli_frame_count(info);
    int status = EXIT_DONE;
    bool first = true;
    for (uint64_t frame = 0; frame < count; frame++) {
        gvc_frame_info facts;
        gvc_error error;
        gvc_error_init(&error);
        if (gvc_reader_frame_info(reader, frame, &facts, &error) == GVC_OK) {
            print_frame(a, frame, &facts, first);
            first = false;
            continue;
        }
        if (error.code == GVC_ERROR_LOST) continue;
        status = cli_fail("info", a->input, &error);
        if (!a->keep_going || error.code == GVC_ERROR_TRUNCATED) break;
    }
    return status;
}

int cmd_info(int argc, char **argv) {
    info_arguments arguments = {0};
    gvc_read_options options;
    gvc_reader *reader = NULL;
    gvc_error error;
    gvc_info info;
    int status = parse(&arguments, argc, argv);
    if (status != EXIT_DONE) return status < 0 ? EXIT_DONE : status;
    gvc_read_options_init(&options);
    options.keep_going = arguments.keep_going;
    gvc_error_init(&error);
    if (gvc_reader_open_file(arguments.input, &options, &reader, &error) != GVC_OK) {
        return cli_fail("info", arguments.input, &error);
    }
    gvc_reader_info(reader, &info);
    if (arguments.json) {
        print_json(&arguments, &info);
        if (arguments.frames) {
            printf(",\n  \"frame_list\": [");
            status = print_frames(&arguments, reader, &info);
            printf("\n  ]");
        }
        printf("\n}\n");
    } else {
        print_text(&arguments, &info);
        if (arguments.frames) status = print_frames(&arguments, reader, &info);
    }
    gvc_reader_close(&reader);
    if (info.damage_count > 0) status = EXIT_DATA;
    return status;
}
