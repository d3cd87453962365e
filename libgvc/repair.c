/* SPDX-License-Identifier: MIT */
/**
 * @file repair.c
 * A good file of what is undamaged in another (spec 12.8). Whole fragments are copied; a damaged
 * one is cut before the damage where that leaves a closed group; gaps are stated. Checksums decide
 * what is good; nothing is decoded.
 */
#include "base/memory.h"
#include "container/shape_layout.h"
#include "container/writer.h"
#include "file.h"

#include <stdlib.h>

typedef struct repairer {
    const gvc_reader *reader;
    gvc_writer *writer;
    void (*lost)(void *user, uint64_t first_frame, uint64_t frame_count);
    void *user;
    uint64_t next_frame; /* of the new file */
    gvc_repair_report report;
} repairer;

/* -------------------------------------------------------------------------------------- samples */

/* The samples of one fragment that are good: of geometry in decoding order, of other tracks in
 * presentation order; NULL of a track that the file has not. */
typedef struct good_part {
    size_t count;
    gvc_buffer *data[GVC_TRACK_KINDS];
    gvc_sample *sample[GVC_TRACK_KINDS];
    bool *good[GVC_TRACK_KINDS];
    bool whole;
    uint64_t room; /* bytes that samples may still take */
} good_part;

static void free_part(good_part *part) {
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; part->data[kind] && i < part->count; i++) {
            gvc_buffer_free(&part->data[kind][i]);
        }
        free(part->data[kind]);
        free(part->sample[kind]);
        free(part->good[kind]);
    }
}

/* Sample `i` of a track: in decoding order for geometry, in presentation order for others. */
static size_t sample_index(const gvc_demux *demux, const gvc_fragment_entry *fragment,
                           unsigned kind, size_t i) {
    if (kind == GVC_TRACK_GEOMETRY) return fragment->first_sample[kind] + i;
    return gvc_demux_sample_of(demux, fragment, (gvc_track_kind)kind, fragment->first_frame + i);
}

/* A record that is whole where it should say "same", or the reverse, is of no use, whatever its
 * checksum (7.1.2). */
static bool is_in_place(unsigned kind, size_t i, const gvc_buffer *data) {
    return kind != GVC_TRACK_SHAPE || !(data->data[0] & GVC_RECORD_SAME) == (i == 0);
}

static gvc_result read_track(const gvc_reader *reader, const gvc_fragment_entry *fragment,
                             unsigned kind, good_part *part, gvc_error *error) {
    const gvc_demux *demux = &reader->demux;
    part->data[kind] = gvc_alloc(part->count, sizeof *part->data[kind]);
    part->sample[kind] = gvc_alloc(part->count, sizeof *part->sample[kind]);
    part->good[kind] = gvc_alloc(part->count, sizeof *part->good[kind]);
    if (!part->data[kind] || !part->sample[kind] || !part->good[kind]) {
        return gvc_fail_memory(error);
    }
    for (size_t i = 0; i < part->count; i++) {
        size_t index = sample_index(demux, fragment, kind, i);
        gvc_buffer *data = &part->data[kind][i];
        gvc_error defect;
        gvc_error_init(&defect);
        gvc_result result = gvc_demux_read(demux, &reader->io, (gvc_track_kind)kind, index,
                                           part->room, data, &defect);
        part->room -= data->size;
        if (result != GVC_ERROR_CORRUPT) GVC_TRY(gvc_hand_on(error, result, &defect));
        uint64_t shown = demux->sample[kind][index].presentation - fragment->first_frame;
        bool good = result == GVC_OK && is_in_place(kind, i, data);
        part->good[kind][i] = good;
        part->whole = part->whole && good;
        part->sample[kind][i] =
            (gvc_sample){.data = data->data,
                         .size = data->size,
                         .composition_offset = (int32_t)((int64_t)shown - (int64_t)i),
                         .sync = i == 0};
    }
    return GVC_OK;
}

/* The most frames that can be kept: the first m pictures in decoding order are good and are those
 * of the first m frames, so they need nothing behind them; and the records of these frames are
 * good. */
static size_t closed_part(const good_part *part) {
    size_t kept = 0, shown = 0;
    for (size_t i = 0; i < part->count; i++) {
        for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++)
            if (part->good[kind] && !part->good[kind][i]) return kept;
        const gvc_sample *picture = part->sample[GVC_TRACK_GEOMETRY];
        size_t place = picture ? (size_t)((int64_t)i + picture[i].composition_offset) : i;
        if (place > shown) shown = place;
        if (shown == i) kept = i + 1;
    }
    return kept;
}

/* -------------------------------------------------------------------------------------- writing */

static void tell_lost(const repairer *r, uint64_t first, uint64_t end) {
    if (r->lost && end > first) r->lost(r->user, first, end - first);
}

/* Frames up to `end` are lost, some of them perhaps before. */
static gvc_result leave_gap(repairer *r, uint64_t end, gvc_error *error) {
    if (end <= r->next_frame) return GVC_OK;
    uint64_t first = r->next_frame, run = first;
    const gvc_demux *demux = &r->reader->demux;
    GVC_TRY(gvc_writer_gap(r->writer, end - first, error));
    for (size_t i = 0; i < demux->gap_count; i++) { /* they are in order */
        const gvc_gap *gap = &demux->gap[i];
        if (gap->first_frame + gap->frame_count <= run || gap->first_frame >= end) continue;
        tell_lost(r, run, gap->first_frame);
        run = gap->first_frame + gap->frame_count;
    }
    tell_lost(r, run, end);
    r->report.lost_count += end - first;
    r->next_frame = end;
    return GVC_OK;
}

static gvc_result save_fragment(repairer *r, size_t index, gvc_error *error) {
    const gvc_demux *demux = &r->reader->demux;
    const gvc_fragment_entry *fragment = &demux->fragment[index];
    good_part part = {.count = fragment->frame_count, .whole = true};
    uint64_t lists = fragment->frame_count * (sizeof(gvc_buffer) + sizeof(gvc_sample) + 1);
    part.room = gvc_reader_room(r->reader);
    part.room -= 3 * lists < part.room ? 3 * lists : part.room;
    gvc_result result = leave_gap(r, fragment->first_frame, error);
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS && result == GVC_OK; kind++) {
        if (demux->has_track[kind]) result = read_track(r->reader, fragment, kind, &part, error);
    }
    size_t kept = 0;
    if (result == GVC_OK && part.whole) {
        kept = part.count;
        result = gvc_writer_copy(r->writer, demux, &r->reader->io, index, error);
        r->report.whole_groups++;
    } else if (result == GVC_OK && (kept = closed_part(&part)) > 0) {
        gvc_fragment cut = {.first_frame = fragment->first_frame,
                            .frame_count = kept,
                            .geometry = part.sample[GVC_TRACK_GEOMETRY],
                            .shape = part.sample[GVC_TRACK_SHAPE],
                            .exact = part.sample[GVC_TRACK_EXACT]};
        result = gvc_writer_fragment(r->writer, &cut, error);
        r->report.cut_groups++;
    }
    free_part(&part);
    r->next_frame += kept;
    r->report.frame_count += kept;
    return result;
}

static gvc_result save_all(repairer *r, gvc_error *error) {
    const gvc_demux *demux = &r->reader->demux;
    for (size_t i = 0; i < demux->fragment_count; i++) GVC_TRY(save_fragment(r, i, error));
    uint64_t end = demux->config.declared_frames;
    if (demux->gap_count > 0) { /* frames at the end may be known to be lost */
        const gvc_gap *last = &demux->gap[demux->gap_count - 1];
        if (last->first_frame + last->frame_count > end) {
            end = last->first_frame + last->frame_count;
        }
    }
    GVC_TRY(leave_gap(r, end, error));
    if (r->report.frame_count == 0) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "there is no frame that could be saved");
    }
    return gvc_writer_finish(r->writer, error);
}

gvc_result gvc_repair(const gvc_reader *reader, const gvc_sink *sink,
                      void (*lost)(void *user, uint64_t first_frame, uint64_t frame_count),
                      void *user, gvc_repair_report *report, gvc_error *error) {
    repairer r = {.reader = reader, .lost = lost, .user = user};
    GVC_TRY(gvc_writer_create_from(sink, &reader->demux, &reader->io, &r.writer, error));
    gvc_result result = save_all(&r, error);
    if (result == GVC_OK && report) {
        *report = r.report;
        report->byte_count = gvc_writer_byte_count(r.writer);
    }
    gvc_writer_destroy(&r.writer);
    return result;
}
