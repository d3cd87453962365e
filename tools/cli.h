/* SPDX-License-Identifier: MIT */
/** @file cli.h  What the subcommands of gvc share: exit status, messages, numbers, progress. */
#ifndef GVC_TOOLS_CLI_H
#define GVC_TOOLS_CLI_H

#include "gvc/gvc.h"

#include <stdio.h>

enum {
    EXIT_DONE = 0,
    EXIT_DATA = 1,        /**< bad data, or reading or writing failed */
    EXIT_USAGE = 2,       /**< wrong usage */
    EXIT_UNSUPPORTED = 3, /**< a good file that needs a newer version or a feature not built in */
};

int cmd_encode(int argc, char **argv);
int cmd_decode(int argc, char **argv);
int cmd_info(int argc, char **argv);
int cmd_verify(int argc, char **argv);
int cmd_repair(int argc, char **argv);
int cmd_extract_exr(int argc, char **argv);
int cmd_compare(int argc, char **argv);
int cmd_synth(int argc, char **argv);
int cmd_render(int argc, char **argv);

/** "gvc COMMAND: <file> (frame n, byte m, box): message" to stderr; gives EXIT_DATA, or
 * what fits the code. `file` may be NULL; error->where is used as the file name when it names one.
 */
int cli_fail(const char *command, const char *file, const gvc_error *error);
/** "gvc COMMAND: message" and a hint at --help to stderr; gives EXIT_USAGE. */
int cli_usage(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
/** A warning line to stderr. */
void cli_warn(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Makes the folder that `path` lies in, if it is missing; EXIT_DONE or, with a message, EXIT_DATA.
 */
int cli_make_folder(const char *command, const char *path);
/** Whether a file that only -f would replace has this name; then it is told. */
bool cli_in_the_way(const char *command, const char *path);

/** Name of a frame's file, allocated: the pattern filled with its number, or, if `only` one frame
 * is written, a plain name as it is. NULL if the pattern does not fit. */
char *cli_frame_path(const char *pattern, uint64_t frame, bool only);
/** Everything that can be told of the output before decoding: the pattern, the folder, which is
 * made, and, unless `force`, files in the way. `wanted` tells which of frames first ... last are
 * written; NULL: all. EXIT_DONE or, with a message, EXIT_USAGE or EXIT_DATA. */
int cli_check_frames(const char *command, const char *pattern, uint64_t first, uint64_t last,
                     bool (*wanted)(void *user, uint64_t frame), void *user, bool force);

/** Frames a file should have: those it declares, or those it holds and says are lost if that is
 * more. */
uint64_t cli_frame_count(const gvc_info *info);
/** Tells that `lost` of `count` frames were lost before the file was repaired, if any were. */
void cli_tell_lost(const char *command, uint64_t lost, uint64_t count);

/** Whole-string numbers, independent of the locale; false if malformed or out of range. */
bool cli_uint(const char *text, uint64_t least, uint64_t most, uint64_t *value);
bool cli_double(const char *text, double *value);
/** Bytes: "1000000", "512K", "64M", "2G" (powers of 1,024); false if malformed or too great. */
bool cli_size(const char *text, uint64_t *bytes);
/** "0.1%" (*relative = true, value 0.001) or a length "0.5" (*relative = false). Positive. */
bool cli_error_bound(const char *text, double *value, bool *relative);
/** "30", "29.97", "30000/1001". */
bool cli_rate(const char *text, uint32_t *num, uint32_t *den);
/** "7", "3-9", "3-" over `count` frames; false if malformed or empty. */
bool cli_range(const char *text, uint64_t count, uint64_t *first, uint64_t *last);
/** The frames of a file of `count` > 0 that --frames asks for; NULL: all. EXIT_DONE, or EXIT_USAGE
 * with a message. */
int cli_choose_frames(const char *command, const char *text, uint64_t count, uint64_t *first,
                      uint64_t *last);

/** True once SIGINT or SIGTERM came. */
bool cli_interrupted(void);
void cli_catch_signals(void);

/** Progress on stderr: in place on a terminal, silent otherwise. */
typedef struct cli_progress {
    const char *verb; /**< "encoding" */
    bool enabled;
    double started, last;
} cli_progress;

void cli_progress_begin(cli_progress *progress, const char *verb, bool quiet);
void cli_progress_show(cli_progress *progress, uint64_t done, uint64_t total);
void cli_progress_end(cli_progress *progress);

/** Seconds of a clock that never goes back. */
double cli_now(void);

/** A string in JSON, quoted and escaped; bytes that are not UTF-8 become U+FFFD. */
void cli_json_string(FILE *file, const char *text);

#endif
