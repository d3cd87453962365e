/* SPDX-License-Identifier: MIT */
/** @file check.c  Looks for damage in every byte of a file and names what it is part of. */
#include "file.h"

#include <string.h>

/* What stands before and behind a damaged place. */
typedef struct surroundings {
    uint64_t first_frame, end_frame; /* frames that should be there */
    uint32_t before, behind;         /* fragments; 0: none */
} surroundings;

/* A fragment or gap that ends at or before `at`, or begins there or later. */
static void meet(surroundings *s, uint64_t at, uint64_t offset, uint64_t first, uint64_t count,
                 uint32_t sequence) {
    if (offset < at) {
        if (first + count >= s->first_frame) s->first_frame = first + count;
        if (sequence) s->before = sequence;
    } else {
        if (first < s->end_frame) s->end_frame = first;
        if (sequence && !s->behind) s->behind = sequence;
    }
}

static surroundings look_round(const gvc_demux *demux, uint64_t offset) {
    uint64_t declared = demux->config.declared_frames;
    surroundings s = {.end_frame = declared ? declared : UINT64_MAX};
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *f = &demux->fragment[i];
        meet(&s, offset, f->offset, f->first_frame, f->frame_count, f->sequence);
    }
    for (size_t i = 0; i < demux->gap_count; i++) {
        const gvc_gap *gap = &demux->gap[i];
        meet(&s, offset, gap->offset, gap->first_frame, gap->frame_count, 0);
    }
    if (s.end_frame == UINT64_MAX || s.end_frame < s.first_frame) s.end_frame = s.first_frame;
    return s;
}

/* The fragment whose bytes hold this one; NULL if none. */
static const gvc_fragment_entry *fragment_at(const gvc_demux *demux, uint64_t offset) {
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *f = &demux->fragment[i];
        if (offset >= f->offset && offset - f->offset < f->size) return f;
    }
    return NULL;
}

static gvc_defect describe_damage(const gvc_demux *demux, const gvc_damage *damage) {
    gvc_defect defect = {.offset = damage->offset, .size = damage->size, .error = damage->error};
    if (demux->head && damage->offset == 0) {
        defect.part = GVC_PART_HEAD;
        return defect;
    }
    const gvc_fragment_entry *inside = fragment_at(demux, damage->offset);
    defect.part = GVC_PART_FRAGMENT;
    if (inside && damage->offset != inside->offset) { /* the header of its mdat, or its end */
        defect.first_fragment = defect.last_fragment = inside->sequence;
        return defect;
    }
    surroundings s = look_round(demux, damage->offset + (damage->size == 0 ? 0 : 1));
    defect.first_frame = s.first_frame;
    defect.frame_count = s.end_frame - s.first_frame;
    if (strncmp(damage->error.where, "mfra", 4) == 0) defect.frame_count = 0;
    if (defect.frame_count == 0) {
        defect.part = GVC_PART_INDEX;
    } else {
        defect.first_fragment = s.before + 1;
        if (s.behind) defect.last_fragment = s.behind > s.before + 1 ? s.behind - 1 : s.before + 1;
    }
    return defect;
}

typedef struct checker {
    const gvc_reader *reader;
    bool (*found)(void *user, const gvc_defect *defect);
    void *user;
    uint64_t defects;
} checker;

static gvc_result tell(checker *c, const gvc_defect *defect, gvc_error *error) {
    c->defects++;
    if (c->found(c->user, defect)) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CANCELLED, "cancelled");
}

static gvc_result check_samples(checker *c, const gvc_fragment_entry *fragment, unsigned kind,
                                gvc_buffer *buffer, gvc_error *error) {
    static const gvc_part part[GVC_TRACK_KINDS] = {[GVC_TRACK_GEOMETRY] = GVC_PART_GEOMETRY,
                                                   [GVC_TRACK_SHAPE] = GVC_PART_SHAPE,
                                                   [GVC_TRACK_EXACT] = GVC_PART_EXACT};
    const gvc_demux *demux = &c->reader->demux;
    for (uint32_t i = 0; i < fragment->frame_count; i++) {
        size_t index = fragment->first_sample[kind] + i;
        const gvc_sample_entry *sample = &demux->sample[kind][index];
        gvc_defect defect = {.part = part[kind],
                             .offset = sample->offset,
                             .size = sample->size,
                             .first_fragment = fragment->sequence,
                             .last_fragment = fragment->sequence,
                             .first_frame = sample->presentation,
                             .frame_count = 1};
        gvc_error_init(&defect.error);
        gvc_result result = gvc_demux_read(demux, &c->reader->io, (gvc_track_kind)kind, index,
                                           gvc_reader_room(c->reader), buffer, &defect.error);
        if (result == GVC_ERROR_CORRUPT) {
            GVC_TRY(tell(c, &defect, error));
        } else {
            GVC_TRY(gvc_hand_on(error, result, &defect.error));
        }
    }
    return GVC_OK;
}

/* Damaged places and fragments, both in the order of the file. */
static gvc_result check_content(checker *c, gvc_buffer *buffer, gvc_error *error) {
    const gvc_demux *demux = &c->reader->demux;
    size_t damage = 0;
    for (size_t i = 0; i <= demux->fragment_count; i++) {
        bool last = i == demux->fragment_count;
        uint64_t end = last ? UINT64_MAX : demux->fragment[i].offset + demux->fragment[i].size;
        for (; damage < demux->damage_count && demux->damage[damage].offset < end; damage++) {
            gvc_defect defect = describe_damage(demux, &demux->damage[damage]);
            GVC_TRY(tell(c, &defect, error));
        }
        for (unsigned k = 0; !last && k < GVC_TRACK_KINDS; k++) {
            if (!demux->has_track[gvc_data_order[k]]) continue;
            GVC_TRY(check_samples(c, &demux->fragment[i], gvc_data_order[k], buffer, error));
        }
    }
    return GVC_OK;
}

gvc_result gvc_reader_check(const gvc_reader *reader,
                            bool (*found)(void *user, const gvc_defect *defect), void *user,
                            gvc_error *error) {
    checker c = {.reader = reader, .found = found, .user = user};
    gvc_buffer buffer = {0};
    gvc_result result = check_content(&c, &buffer, error);
    gvc_buffer_free(&buffer);
    /* Once a checksum is wrong the digest must be, too. */
    if (result != GVC_OK || c.defects > 0) return result;
    gvc_defect defect = {.part = GVC_PART_FILE, .size = reader->demux.digest_offset};
    gvc_error_init(&defect.error);
    result = gvc_demux_check_digest(&reader->demux, &reader->io, &defect.error);
    if (result == GVC_ERROR_CORRUPT) return tell(&c, &defect, error);
    if (result != GVC_OK && error) *error = defect.error;
    return result;
}
