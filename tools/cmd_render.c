/* SPDX-License-Identifier: MIT */
/** @file cmd_render.c  gvc render. */
#include "cli.h"
int cmd_render(int argc, char **argv) {
    (void)argc;
    (void)argv;
    return 0;
}
