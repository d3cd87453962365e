/* SPDX-License-Identifier: MIT */
/** @file main.c  The program gvc: finds the subcommand. */
#include "cli.h"

#include <string.h>

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
} commands[] = {
#ifdef GVC_PROGRAM_ENCODES
    {"encode", cmd_encode, "turn a capture (OFF, OBJ or PLY frames) into one .gvc file"},
#endif
    {"decode", cmd_decode, "get closed meshes back, all frames or some"},
    {"info", cmd_info, "tell what is in a .gvc file"},
    {"verify", cmd_verify, "prove a .gvc file good, or measure it against its capture"},
    {"repair", cmd_repair, "save what is undamaged in a damaged or cut-off file"},
    {"extract-exr", cmd_extract_exr,
     "get geometry images as OpenEXR files, which encode takes back"},
#ifdef GVC_PROGRAM_ENCODES
    {"compare", cmd_compare, "sizes and errors beside zipped OFF and Draco"},
    {"synth", cmd_synth, "make a sample capture"},
    {"render", cmd_render, "make pictures: surfaces, cut graphs, geometry images"},
#endif
};

static void print_usage(FILE *file) {
    fprintf(file, "usage: gvc COMMAND ...\n\n");
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        fprintf(file, "  %-11s %s\n", commands[i].name, commands[i].summary);
    }
    fprintf(file,
            "\n'gvc COMMAND --help' tells more. Exit status: 0 done, 1 bad data or I/O, 2 usage,\n"
            "3 a file that needs a newer gvc.\n");
}

static int no_command(const char *name) {
#ifndef GVC_PROGRAM_ENCODES
    static const char *const left_out[] = {"encode", "compare", "synth", "render"};
    for (size_t i = 0; i < sizeof left_out / sizeof *left_out; i++) {
        if (strcmp(name, left_out[i]) != 0) continue;
        fprintf(stderr, "gvc: this build only decodes, it has no '%s'\n", name);
        return EXIT_UNSUPPORTED;
    }
#endif
    fprintf(stderr, "gvc: there is no command '%s'\n\n", name);
    print_usage(stderr);
    return EXIT_USAGE;
}

static int run(int argc, char **argv) {
    if (argc < 2) {
        print_usage(stderr);
        return EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_usage(stdout);
        return EXIT_DONE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("gvc %s\n", gvc_version());
        return EXIT_DONE;
    }
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) return commands[i].run(argc - 1, argv + 1);
    }
    return no_command(argv[1]);
}

int main(int argc, char **argv) {
    cli_catch_signals();
    int status = run(argc, argv);
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    if (written || status != EXIT_DONE) return status;
    fprintf(stderr, "gvc: cannot write to standard output\n");
    return EXIT_DATA;
}
