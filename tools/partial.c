/* SPDX-License-Identifier: MIT */
/** @file partial.c  A .gvc file being encoded, and its journal. */
#include "partial.h"

#include "base/read_at.h"
#include "base/result.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PART_SUFFIX ".part"
#define JOURNAL_SUFFIX ".part-journal"
#define STATE_SUFFIX ".part-state"
#define NEW_SUFFIX ".new"

/* A lock of this kind is gone as soon as any descriptor of the file is closed; so the file is not
 * opened a second time. */
static gvc_result read_part(void *user, uint64_t offset, void *data, size_t size,
                            gvc_error *error) {
    const gvc_output *output = user;
    int status = gvc_read_at(output->descriptor, offset, data, size);
    if (status == GVC_READ_ENDS) {
        return gvc_fail(error, GVC_ERROR_TRUNCATED, "the file became shorter");
    }
    return status ? gvc_fail_errno(error, "read", status, output->temporary) : GVC_OK;
}

static gvc_result read_journal(partial_file *p, gvc_error *error) {
    size_t size = (size_t)p->journal.there;
    p->journal_text = malloc(size + 1);
    if (!p->journal_text) return gvc_fail_memory(error);
    p->journal_text[size] = '\0';
    return read_part(&p->journal, 0, p->journal_text, size, error);
}

/* A state that cannot be read is as good as none. */
static void read_state(partial_file *p) {
    FILE *file = fopen(p->state_path, "rb");
    char chunk[4096];
    if (!file) return;
    for (size_t got; (got = fread(chunk, 1, sizeof chunk, file)) > 0;) {
        gvc_write_bytes(&p->state, chunk, got);
    }
    if (ferror(file) || p->state.failed) gvc_buffer_clear(&p->state);
    (void)fclose(file);
}

static void remove_state(partial_file *p) {
    if (p->state_path) (void)unlink(p->state_path);
    if (p->state_temporary) (void)unlink(p->state_temporary);
}

static char *join(const char *path, const char *suffix) {
    size_t room = strlen(path) + strlen(suffix) + 1;
    char *joined = malloc(room);
    if (joined) snprintf(joined, room, "%s%s", path, suffix);
    return joined;
}

/* Opens what an earlier run has left, if its head is there. */
static gvc_result open_left(partial_file *p, gvc_error *error) {
    gvc_read_options options;
    gvc_error defect;
    gvc_read_options_init(&options);
    options.keep_going = true;
    p->io = (gvc_io){.user = &p->output, .size = p->output.there, .read = read_part};
    gvc_result result = gvc_reader_open_io(&p->io, &options, &p->reader, &defect);
    if (result == GVC_OK || result == GVC_ERROR_CORRUPT || result == GVC_ERROR_TRUNCATED) {
        return GVC_OK;
    }
    if (error) *error = defect;
    return result;
}

gvc_result partial_begin(const char *path, bool force, bool resume, partial_file *p,
                         gvc_error *error) {
    *p = (partial_file){0};
    gvc_leftover leftover = resume  ? GVC_LEFTOVER_KEEP
                            : force ? GVC_LEFTOVER_DROP
                                    : GVC_LEFTOVER_REFUSE;
    gvc_result result =
        gvc_output_begin_known(path, PART_SUFFIX, force, leftover, &p->output, error);
    if (result != GVC_OK) return result;
    p->resumed = p->output.there > 0;
    leftover = p->resumed ? GVC_LEFTOVER_KEEP : GVC_LEFTOVER_DROP;
    result = gvc_output_begin_known(path, JOURNAL_SUFFIX, force, leftover, &p->journal, error);
    p->state_path = join(path, STATE_SUFFIX);
    p->state_temporary = join(path, STATE_SUFFIX NEW_SUFFIX);
    if (result == GVC_OK && (!p->state_path || !p->state_temporary)) {
        result = gvc_fail_memory(error);
    }
    if (result == GVC_OK && p->resumed) read_state(p);
    if (result == GVC_OK && !p->resumed) remove_state(p);
    if (result == GVC_OK && p->resumed) result = read_journal(p, error);
    if (result == GVC_OK && p->resumed) result = open_left(p, error);
    if (result != GVC_OK) partial_leave(p, false);
    return result;
}

gvc_result partial_note(partial_file *p, const char *line, gvc_error *error) {
    gvc_output_sync(&p->output);
    GVC_TRY(gvc_output_write(&p->output, "", 0, error)); /* tells of a failure */
    GVC_TRY(gvc_output_write(&p->journal, line, strlen(line), error));
    GVC_TRY(gvc_output_write(&p->journal, "\n", 1, error));
    gvc_output_sync(&p->journal);
    GVC_TRY(gvc_output_write(&p->journal, "", 0, error));
    p->lines++;
    return GVC_OK;
}

void partial_checkpoint(partial_file *p, const void *data, size_t size) {
    gvc_output output;
    if (gvc_output_begin_known(p->state_path, NEW_SUFFIX, true, GVC_LEFTOVER_DROP, &output, NULL) !=
        GVC_OK) {
        return;
    }
    if (gvc_output_write(&output, data, size, NULL) != GVC_OK) {
        gvc_output_discard(&output);
        return;
    }
    gvc_output_sync(&output);
    if (gvc_output_end(&output, NULL) != GVC_OK) (void)unlink(p->state_temporary);
}

static void forget(partial_file *p) {
    gvc_reader_close(&p->reader);
    free(p->journal_text);
    p->journal_text = NULL;
    gvc_buffer_free(&p->state);
    free(p->state_path);
    free(p->state_temporary);
    p->state_path = p->state_temporary = NULL;
}

gvc_result partial_end(partial_file *p, gvc_error *error) {
    gvc_output_sync(&p->output);
    gvc_result result = gvc_output_end(&p->output, error);
    if (result == GVC_OK) {
        gvc_output_discard(&p->journal);
        remove_state(p);
    } else { /* the disk is full at last, or a file of that name has come into being */
        gvc_output_leave(&p->journal);
    }
    forget(p);
    return result;
}

bool partial_leave(partial_file *p, bool worth_keeping) {
    bool keep = p->resumed || (worth_keeping && p->lines > 1);
    if (keep) {
        gvc_output_leave(&p->output);
        gvc_output_leave(&p->journal);
    } else {
        gvc_output_discard(&p->journal);
        gvc_output_discard(&p->output);
        remove_state(p);
    }
    forget(p);
    return keep;
}
