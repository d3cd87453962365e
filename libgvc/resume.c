/* SPDX-License-Identifier: MIT */
/** @file resume.c  Journal of an encode, and going on with one that ended early. */
#include "resume.h"

#include "base/digest.h"
#include "base/memory.h"
#include "base/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A dozen numbers of at most 24 characters with their names fit in the options. */
enum { LINE_SIZE = 1024, OPTIONS_SIZE = 768, DIGEST_TEXT = 64, NUMBER_TEXT = 40 };

/* ---------------------------------------------------------------------------------------- lines */

/* A line ends with the CRC-32 of what stands before it: one that was being written when the power
 * failed is no line. */
static gvc_result put_line(const gvc_encode_options *options, const char *text, gvc_error *error) {
    char line[LINE_SIZE + 16];
    if (!options->journal) return GVC_OK;
    snprintf(line, sizeof line, "%s #%08" PRIx32, text, gvc_crc32(0, text, strlen(text)));
    return options->journal(options->user, line, error);
}

/* Takes the next line; false at the end, or if it is not whole. */
static bool take_line(const char **journal, char text[LINE_SIZE]) {
    const char *end = strchr(*journal, '\n');
    if (!end || end - *journal < 10 || end - *journal > LINE_SIZE) return false;
    size_t length = (size_t)(end - *journal) - 10; /* " #" and eight digits */
    char seal[16];
    memcpy(text, *journal, length);
    text[length] = '\0';
    snprintf(seal, sizeof seal, " #%08" PRIx32, gvc_crc32(0, text, length));
    if (strncmp(*journal + length, seal, 10) != 0) return false;
    *journal = end + 1;
    return true;
}

static uint64_t bits_of(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static double of_bits(uint64_t bits) {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void format_group(const gvc_finished_group *group, char text[LINE_SIZE]) {
    snprintf(text, LINE_SIZE,
             "group %" PRIu64 " %" PRIu64 " %" PRIu64 " %016" PRIx64 " %016" PRIx64 " %016" PRIx64,
             group->first_frame, group->frame_count, group->end, bits_of(group->crf),
             bits_of(group->rms), bits_of(group->preview_rms));
}

/* What is read must be what would be written. */
static bool parse_group(const char *text, gvc_finished_group *group) {
    uint64_t crf, rms, preview_rms;
    char again[LINE_SIZE];
    if (sscanf(text, "group %" SCNu64 " %" SCNu64 " %" SCNu64 " %" SCNx64 " %" SCNx64 " %" SCNx64,
               &group->first_frame, &group->frame_count, &group->end, &crf, &rms,
               &preview_rms) != 6) {
        return false;
    }
    group->crf = of_bits(crf);
    group->rms = of_bits(rms);
    group->preview_rms = of_bits(preview_rms);
    format_group(group, again);
    return strcmp(text, again) == 0;
}

/* ----------------------------------------------------------------------------------- first line */

static void append_number(char *text, size_t size, const char *name, double value) {
    char number[NUMBER_TEXT];
    size_t used = strlen(text), length = gvc_format_double(number, value);
    snprintf(text + used, size - used, " %s=%.*s", name, (int)length, number);
}

/* All options that the bytes of the file depend on. */
static void format_options(const gvc_encode_options *o, char *text, size_t size) {
    snprintf(text, size,
             "libgvc=%s lossless=%d preview=%d size=%u gop=%u rate=%u/%u weld=%d unit=%s",
             gvc_version(), o->lossless, o->with_preview, o->image_size, o->gop, o->frame_rate_num,
             o->frame_rate_den, o->weld, o->unit);
    append_number(text, size, "max-rms", o->max_rms);
    append_number(text, size, "max-rms-length", o->max_rms_length);
    append_number(text, size, "crf", o->crf);
    append_number(text, size, "persistence", o->persistence);
    append_number(text, size, "prior", o->prior_weight);
    append_number(text, size, "curvature", o->curvature_weight);
    append_number(text, size, "shortest", o->shortest_weight);
    append_number(text, size, "lambda", o->lambda);
    append_number(text, size, "interior", o->interior_share);
    append_number(text, size, "registration", o->registration);
    append_number(text, size, "longest-edge", o->longest_edge);
    for (char *c = text; *c; c++) { /* the unit may hold anything */
        if ((unsigned char)*c < ' ') *c = '?';
    }
}

static const char *last_part(const char *name) {
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

/* SHA-256 of all that the source gives: every frame counts for every byte of the file, since cubes
 * and segments look ahead. Names are recorded in the file. */
static gvc_result digest_source(const gvc_source *source, const gvc_scan_frame *facts,
                                char text[DIGEST_TEXT + 1], gvc_error *error) {
    uint8_t digest[32];
    gvc_sha256 *state = gvc_sha256_begin();
    if (!state) return gvc_fail_memory(error);
    for (uint64_t i = 0; i < source->frame_count; i++) {
        const char *name = source->name ? source->name(source->user, i) : NULL;
        gvc_sha256_update(state, facts[i].digest, sizeof facts[i].digest);
        if (name) gvc_sha256_update(state, last_part(name), strlen(last_part(name)));
        gvc_sha256_update(state, "", 1);
    }
    gvc_sha256_end(state, digest);
    for (size_t i = 0; i < sizeof digest; i++) snprintf(text + 2 * i, 3, "%02x", digest[i]);
    return GVC_OK;
}

/* Moves both to the first word in which they differ. */
static void skip_same(const char **a, const char **b) {
    for (;;) {
        size_t length = strcspn(*a, " ");
        if (strncmp(*a, *b, length + 1) != 0 || (*a)[length] == '\0') return;
        *a += length + 1;
        *b += length + 1;
    }
}

static gvc_result compare_first(const char *journal, const char *text, const char *options,
                                gvc_error *error) {
    char before[LINE_SIZE];
    if (!take_line(&journal, before)) return GVC_OK; /* nothing was begun */
    if (strcmp(before, text) == 0) return GVC_OK;
    const char *then = strstr(before, "libgvc=");
    if (then && strcmp(then, options) != 0) {
        skip_same(&then, &options);
        return gvc_fail(error, GVC_ERROR_ARGUMENT,
                        "cannot resume: the encode began with %.*s, now it is %.*s",
                        (int)strcspn(then, " "), then, (int)strcspn(options, " "), options);
    }
    return gvc_fail(error, GVC_ERROR_ARGUMENT,
                    "cannot resume: the frames are not those that the encode began with");
}

/* --------------------------------------------------------------------------------------- begin */

/* Whether fragment `index` of the partial file is this group, and whole. */
static gvc_result is_there(const gvc_reader *file, size_t index, uint64_t begin,
                           const gvc_finished_group *group, gvc_buffer *scratch, bool *there,
                           gvc_error *error) {
    const gvc_demux *demux = &file->demux;
    *there = false;
    if (index >= demux->fragment_count) return GVC_OK;
    const gvc_fragment_entry *fragment = &demux->fragment[index];
    if (fragment->offset != begin || fragment->offset + fragment->size != group->end ||
        group->end > file->io.size || fragment->first_frame != group->first_frame ||
        fragment->frame_count != group->frame_count) {
        return GVC_OK;
    }
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        if (!demux->has_track[kind]) continue;
        for (uint32_t i = 0; i < fragment->frame_count; i++) {
            gvc_result result = gvc_demux_read(demux, &file->io, (gvc_track_kind)kind,
                                               fragment->first_sample[kind] + i,
                                               gvc_reader_room(file), scratch, error);
            if (result == GVC_ERROR_CORRUPT) return GVC_OK;
            GVC_TRY(result);
        }
    }
    *there = true;
    return GVC_OK;
}

static gvc_result find_groups(gvc_resume *resume, const char *journal, gvc_error *error) {
    char text[LINE_SIZE];
    size_t capacity = 0;
    gvc_buffer scratch = {0};
    gvc_result result = GVC_OK;
    uint64_t begin = resume->file->demux.head_size;
    bool there = take_line(&journal, text) && !resume->file->demux.head;
    while (there && take_line(&journal, text)) {
        gvc_finished_group group;
        if (!parse_group(text, &group) || group.first_frame != resume->end_frame) break;
        gvc_error ignored;
        GVC_CHECK(is_there(resume->file, resume->count, begin, &group, &scratch, &there, &ignored));
        if (!there) break;
        if (!gvc_grow((void **)&resume->group, &capacity, resume->count + 1,
                      sizeof *resume->group)) {
            GVC_CHECK(gvc_fail_memory(error));
        }
        resume->group[resume->count++] = group;
        resume->end_frame += group.frame_count;
        begin = group.end;
    }
cleanup:
    gvc_buffer_free(&scratch);
    return result;
}

gvc_result gvc_resume_begin(gvc_resume *resume, const gvc_partial *partial,
                            const gvc_source *source, const gvc_scan_frame *facts,
                            const gvc_encode_options *options, gvc_error *error) {
    char settings[OPTIONS_SIZE], digest[DIGEST_TEXT + 1], text[LINE_SIZE];
    if (!partial && !options->journal) return GVC_OK;
    format_options(options, settings, sizeof settings);
    GVC_TRY(digest_source(source, facts, digest, error));
    snprintf(text, sizeof text, "gvc-journal 1 frames=%" PRIu64 " source=%s %s",
             source->frame_count, digest, settings);
    if (partial) {
        GVC_TRY(compare_first(partial->journal, text, settings, error));
        resume->file = partial->file;
        GVC_TRY(find_groups(resume, partial->journal, error));
    }
    return put_line(options, text, error);
}

void gvc_resume_free(gvc_resume *resume) {
    free(resume->group);
    *resume = (gvc_resume){0};
}

/* ----------------------------------------------------------------------------------------- take */

static gvc_result differs(uint64_t frame, const char *what, gvc_error *error) {
    return gvc_at_frame(error,
                        gvc_fail(error, GVC_ERROR_ARGUMENT,
                                 "cannot resume: %s is not what the partial file holds; it was "
                                 "written by another version of the library or on another machine",
                                 what),
                        (int64_t)frame);
}

static gvc_result begin_writer(const gvc_resume *resume, const gvc_config *config,
                               const gvc_sink *sink, gvc_writer **writer, gvc_error *error) {
    const gvc_demux *demux = &resume->file->demux;
    bool same;
    GVC_TRY(gvc_config_equal(config, &demux->config, &same, error));
    if (!same) return differs(0, "the configuration", error);
    return gvc_writer_create(sink, config, demux->avc_config, demux->avc_config_size, writer,
                             error);
}

bool gvc_resume_can_skip(const gvc_resume *resume, uint64_t frame) {
    for (size_t i = 0; i < resume->count; i++) {
        if (resume->group[i].first_frame + resume->group[i].frame_count == frame) return true;
    }
    return false;
}

gvc_result gvc_resume_skip(gvc_resume *resume, uint64_t frame, const gvc_config *config,
                           const gvc_encode_options *options, const gvc_sink *sink,
                           gvc_writer **writer, gvc_error *error) {
    const gvc_reader *file = resume->file;
    GVC_TRY(begin_writer(resume, config, sink, writer, error));
    while (resume->next < resume->count && resume->group[resume->next].first_frame < frame) {
        GVC_TRY(gvc_writer_copy(*writer, &file->demux, &file->io, resume->next, error));
        GVC_TRY(gvc_resume_note(options, &resume->group[resume->next++], error));
    }
    return GVC_OK;
}

gvc_result gvc_resume_take(gvc_resume *resume, const gvc_group *group, const gvc_config *config,
                           const gvc_sink *sink, gvc_writer **writer, gvc_finished_group *finished,
                           gvc_error *error) {
    const gvc_demux *demux = &resume->file->demux;
    *finished = resume->group[resume->next];
    if (finished->first_frame != group->first_frame || finished->frame_count != group->count) {
        return differs(group->first_frame, "a group", error);
    }
    gvc_shape before;
    GVC_TRY(gvc_reader_shape(resume->file, resume->next, &before, error));
    bool same = gvc_shape_equal(&before, &group->shape);
    gvc_shape_free(&before);
    if (!same) return differs(group->first_frame, "the cut", error);
    if (!*writer) GVC_TRY(begin_writer(resume, config, sink, writer, error));
    return gvc_writer_copy(*writer, demux, &resume->file->io, resume->next++, error);
}

gvc_result gvc_resume_check_coded(const gvc_resume *resume, const gvc_coded_group *coded,
                                  gvc_error *error) {
    if (resume->count == 0) return GVC_OK;
    const gvc_demux *demux = &resume->file->demux;
    if (coded->config_size == 0 && demux->avc_config_size == 0) return GVC_OK;
    if (coded->config_size == demux->avc_config_size &&
        memcmp(coded->config, demux->avc_config, coded->config_size) == 0) {
        return GVC_OK;
    }
    return differs(resume->end_frame, "the H.264 configuration", error);
}

gvc_result gvc_resume_note(const gvc_encode_options *options, const gvc_finished_group *group,
                           gvc_error *error) {
    char text[LINE_SIZE];
    format_group(group, text);
    return put_line(options, text, error);
}
