/* SPDX-License-Identifier: MIT */
/** @file cmd_compare_no_paper.c  Stands for cmd_compare_paper.c in builds without encoder. */
#include "cmd_compare.h"

int compare_paper_command(const compare_arguments *arguments, char *const *frames, int count) {
    (void)arguments, (void)frames, (void)count;
    fprintf(stderr, "gvc compare: this build has no encoder, which --paper needs\n");
    return EXIT_DATA;
}
