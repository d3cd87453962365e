/* SPDX-License-Identifier: MIT */
/** @file cli.c  Messages, numbers, signals and progress of the subcommands. */
#include "cli.h"
#include "json.h"

#include "base/text.h"

#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* ------------------------------------------------------------------------------------ messages */

static bool is_box_path(const char *where) {
    return strchr(where, '.') == NULL && strlen(where) >= 4 &&
           (where[4] == '\0' || where[4] == '/');
}

int cli_fail(const char *command, const char *file, const gvc_error *error) {
    bool box = error->where[0] != '\0' && is_box_path(error->where);
    if (error->where[0] != '\0' && !box) file = error->where;
    fprintf(stderr, "gvc %s: ", command);
    if (file) fprintf(stderr, "%s: ", file);
    if (error->frame != GVC_NO_FRAME) fprintf(stderr, "frame %lld: ", (long long)error->frame);
    if (error->offset != GVC_NO_OFFSET) {
        fprintf(stderr, "byte %llu: ", (unsigned long long)error->offset);
    }
    if (box) fprintf(stderr, "%s: ", error->where);
    fprintf(stderr, "%s\n", error->message[0] ? error->message : gvc_result_string(error->code));
    switch (error->code) {
    case GVC_ERROR_ARGUMENT:
        return EXIT_USAGE;
    case GVC_ERROR_UNSUPPORTED:
        return EXIT_UNSUPPORTED;
    default:
        return EXIT_DATA;
    }
}

int cli_usage(const char *command, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "gvc %s: ", command);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, "\nTry 'gvc %s --help'.\n", command);
    va_end(arguments);
    return EXIT_USAGE;
}

void cli_warn(const char *command, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "gvc %s: warning: ", command);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

void cli_json_string(FILE *file, const char *text) {
    char escaped[JSON_ESCAPED];
    fputc('"', file);
    while (*text) fwrite(escaped, 1, json_escape(&text, escaped), file);
    fputc('"', file);
}

uint64_t cli_frame_count(const gvc_info *info) {
    uint64_t known = info->frame_count + info->lost_count;
    return info->declared_count > known ? info->declared_count : known;
}

void cli_tell_lost(const char *command, uint64_t lost, uint64_t count) {
    if (lost == 0) return;
    fprintf(stderr, "gvc %s: %llu of %llu frames were lost before the file was repaired\n", command,
            (unsigned long long)lost, (unsigned long long)count);
}

/* ------------------------------------------------------------------------------------- numbers */

bool cli_uint(const char *text, uint64_t least, uint64_t most, uint64_t *value) {
    int64_t number;
    const char *end = text + strlen(text);
    if (gvc_parse_int(text, end, &number) != end || number < 0) return false;
    if ((uint64_t)number < least || (uint64_t)number > most) return false;
    *value = (uint64_t)number;
    return true;
}

bool cli_double(const char *text, double *value) {
    const char *end = text + strlen(text);
    return gvc_parse_double(text, end, value) == end && isfinite(*value);
}

bool cli_size(const char *text, uint64_t *bytes) {
    static const char units[] = "KMG";
    const char *end = text + strlen(text);
    const char *unit = end > text ? strchr(units, end[-1]) : NULL;
    unsigned shift = unit && end > text ? 10 * (unsigned)(unit - units + 1) : 0;
    int64_t number;
    if (shift > 0) end--;
    if (gvc_parse_int(text, end, &number) != end || number <= 0) return false;
    if ((uint64_t)number > UINT64_MAX >> shift) return false;
    *bytes = (uint64_t)number << shift;
    return true;
}

bool cli_error_bound(const char *text, double *value, bool *relative) {
    const char *end = text + strlen(text);
    const char *after = gvc_parse_double(text, end, value);
    if (!after || !isfinite(*value) || *value <= 0) return false;
    *relative = after + 1 == end && *after == '%';
    if (*relative) *value /= 100;
    return *relative || after == end;
}

bool cli_rate(const char *text, uint32_t *num, uint32_t *den) {
    const char *slash = strchr(text, '/');
    int64_t n, d = 1;
    if (slash) {
        const char *end = slash + strlen(slash);
        if (gvc_parse_int(text, slash, &n) != slash || gvc_parse_int(slash + 1, end, &d) != end) {
            return false;
        }
    } else {
        double rate;
        if (!cli_double(text, &rate) || !(rate > 0 && rate < 100000)) return false;
        /* 29.97 and its kin mean n * 1000/1001 */
        double ntsc = rate * 1001 / 1000;
        bool whole = rate == floor(rate);
        d = whole ? 1 : 1001;
        n = whole ? (int64_t)rate : (int64_t)llround(ntsc) * 1000;
        if (!whole && fabs(ntsc - round(ntsc)) > 2e-3 * round(ntsc)) {
            d = 1000;
            n = llround(rate * 1000);
        }
    }
    if (n <= 0 || n > INT32_MAX || d <= 0 || d > INT32_MAX) return false;
    *num = (uint32_t)n;
    *den = (uint32_t)d;
    return true;
}

bool cli_range(const char *text, uint64_t count, uint64_t *first, uint64_t *last) {
    const char *end = text + strlen(text);
    int64_t a, b;
    const char *after = gvc_parse_int(text, end, &a);
    if (!after || a < 0 || count == 0) return false;
    b = a;
    if (after < end) {
        if (*after != '-') return false;
        after++;
        b = (int64_t)count - 1;
        if (after < end && gvc_parse_int(after, end, &b) != end) return false;
    }
    if (a > b || (uint64_t)b >= count) return false;
    *first = (uint64_t)a;
    *last = (uint64_t)b;
    return true;
}

int cli_choose_frames(const char *command, const char *text, uint64_t count, uint64_t *first,
                      uint64_t *last) {
    *first = 0;
    *last = count - 1;
    if (!text || cli_range(text, count, first, last)) return EXIT_DONE;
    return cli_usage(command, "'%s' is not a range of frames 0-%llu", text,
                     (unsigned long long)(count - 1));
}

/* ------------------------------------------------------------------------- signals and progress */

static volatile sig_atomic_t interrupted;

static void on_signal(int number) {
    (void)number;
    interrupted = 1;
}

bool cli_interrupted(void) { return interrupted != 0; }

void cli_catch_signals(void) {
    struct sigaction action = {.sa_handler = on_signal};
    sigemptyset(&action.sa_mask);
    action.sa_flags = (int)SA_RESETHAND; /* a second signal ends the program at once */
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    /* A closed pipe and a file too large are write errors like others. */
    struct sigaction ignore = {.sa_handler = SIG_IGN};
    sigemptyset(&ignore.sa_mask);
    sigaction(SIGPIPE, &ignore, NULL);
    sigaction(SIGXFSZ, &ignore, NULL);
}

double cli_now(void) {
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void cli_progress_begin(cli_progress *progress, const char *verb, bool quiet) {
    progress->verb = verb;
    progress->enabled = !quiet && isatty(STDERR_FILENO);
    progress->started = cli_now();
    progress->last = 0;
}

void cli_progress_show(cli_progress *progress, uint64_t done, uint64_t total) {
    double now = cli_now();
    if (!progress->enabled || (now - progress->last < 0.1 && done < total)) return;
    progress->last = now;
    double elapsed = now - progress->started;
    double rate = elapsed > 0 ? (double)done / elapsed : 0;
    fprintf(stderr, "\r%s %llu/%llu", progress->verb, (unsigned long long)done,
            (unsigned long long)total);
    if (rate > 0) {
        unsigned long left = (unsigned long)((double)(total - done) / rate + 0.5);
        fprintf(stderr, ", %.1f frames/s, %lu:%02lu left", rate, left / 60, left % 60);
    }
    fputs("\x1b[K", stderr);
    fflush(stderr);
}

void cli_progress_end(cli_progress *progress) {
    if (progress->enabled) fputs("\r\x1b[K", stderr);
    progress->enabled = false;
}
