/* SPDX-License-Identifier: MIT */
/** @file demux_fragment.c  Reads a moof and the header of its mdat into the index of samples. */
#include "base/digest.h"
#include "container/parser.h"

#include <string.h>

/** One traf while its fragment is read. */
typedef struct track_run {
    gvc_track_kind kind;
    gvc_box tfhd, trun;
    gvc_track_defaults defaults; /**< of trex, or what tfhd says instead */
    uint64_t first_frame;
    uint32_t flags, count; /**< of trun */
    uint8_t version;
    gvc_cursor crc;       /**< the checksums in gcks, as many as samples */
    uint64_t data_offset; /**< of the first sample, from the start of moof */
    uint64_t byte_count;  /**< of all samples */
} track_run;

/** tfhd with what overrides trex. The track number must have been read already. */
static gvc_result read_overrides(gvc_box *tfhd, uint32_t flags, gvc_track_defaults *defaults,
                                 gvc_error *error) {
    if (flags & (GVC_TFHD_BASE_DATA_OFFSET | GVC_TFHD_EMPTY) || !(flags & GVC_TFHD_BASE_IS_MOOF)) {
        return gvc_box_fail(tfhd, error, GVC_ERROR_CORRUPT,
                            "data offsets must count from the start of moof");
    }
    if (flags & GVC_TFHD_DESCRIPTION && gvc_read_u32(&tfhd->content) != 1) {
        return gvc_box_fail(tfhd, error, GVC_ERROR_CORRUPT, "a sample description other than 1");
    }
    if (flags & GVC_TFHD_DURATION) defaults->duration = gvc_read_u32(&tfhd->content);
    if (flags & GVC_TFHD_SIZE) defaults->size = gvc_read_u32(&tfhd->content);
    if (flags & GVC_TFHD_FLAGS) defaults->flags = gvc_read_u32(&tfhd->content);
    return gvc_box_check(tfhd, error);
}

/** Finds tfhd and reads its track number. */
static gvc_result read_track_id(const gvc_box *traf, gvc_box *tfhd, uint32_t *flags,
                                uint32_t *track_id, gvc_error *error) {
    uint8_t version;
    GVC_TRY(gvc_box_find(traf, GVC_BOX_TFHD, true, tfhd, error));
    GVC_TRY(gvc_box_version(tfhd, 0, &version, flags, error));
    *track_id = gvc_read_u32(&tfhd->content);
    return gvc_box_check(tfhd, error);
}

static gvc_result read_decode_time(gvc_parser *parser, const gvc_box *traf, track_run *run,
                                   gvc_error *error) {
    gvc_box tfdt;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(traf, GVC_BOX_TFDT, true, &tfdt, error));
    GVC_TRY(gvc_box_version(&tfdt, 1, &version, &flags, error));
    uint64_t time = version == 1 ? gvc_read_u64(&tfdt.content) : gvc_read_u32(&tfdt.content);
    GVC_TRY(gvc_box_check(&tfdt, error));
    uint32_t duration = parser->demux->config.frame_rate_den;
    run->first_frame = time / duration;
    if (time % duration == 0) return GVC_OK;
    return gvc_box_fail(&tfdt, error, GVC_ERROR_CORRUPT,
                        "time %llu is no whole number of frames of %u", (unsigned long long)time,
                        duration);
}

/** Bytes that trun holds per sample. */
static size_t sample_fields_size(uint32_t flags) {
    static const uint32_t per_sample[4] = {GVC_TRUN_DURATION, GVC_TRUN_SIZE, GVC_TRUN_FLAGS,
                                           GVC_TRUN_COMPOSITION};
    size_t size = 0;
    for (unsigned i = 0; i < 4; i++) size += flags & per_sample[i] ? 4 : 0;
    return size;
}

/** The fields of trun before the samples, and gcks, whose size shows that the count is honest. */
static gvc_result read_run_head(gvc_parser *parser, const gvc_box *traf, track_run *run,
                                gvc_error *error) {
    gvc_box gcks;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(traf, GVC_BOX_TRUN, true, &run->trun, error));
    GVC_TRY(gvc_box_find(traf, GVC_BOX_GCKS, true, &gcks, error));
    GVC_TRY(gvc_box_version(&run->trun, 1, &run->version, &run->flags, error));
    GVC_TRY(gvc_box_version(&gcks, 0, &version, &flags, error));
    gvc_box *trun = &run->trun;
    run->count = gvc_read_u32(&trun->content);
    if (!(run->flags & GVC_TRUN_DATA_OFFSET)) {
        return gvc_box_fail(trun, error, GVC_ERROR_CORRUPT, "there is no data offset");
    }
    uint32_t data_offset = gvc_read_u32(&trun->content); /* signed, but it cannot be negative */
    run->data_offset = data_offset;
    if (run->flags & GVC_TRUN_FIRST_FLAGS) {
        if (run->flags & GVC_TRUN_FLAGS) {
            return gvc_box_fail(trun, error, GVC_ERROR_CORRUPT, "the first flags are said twice");
        }
    }
    GVC_TRY(gvc_box_check(trun, error));
    run->crc = gcks.content;
    if (run->count == 0 || gvc_cursor_left(&gcks.content) / 4 != run->count ||
        gvc_cursor_left(&gcks.content) % 4 != 0) {
        return gvc_box_fail(&gcks, error, GVC_ERROR_CORRUPT,
                            "%zu bytes of checksums for %u samples", gvc_cursor_left(&gcks.content),
                            run->count);
    }
    uint64_t limit = parser->options->max_frames;
    if (run->first_frame > limit || run->count > limit - run->first_frame) {
        return gvc_box_fail(trun, error, GVC_ERROR_LIMIT, "frames %llu + %u; the limit is %llu",
                            (unsigned long long)run->first_frame, run->count,
                            (unsigned long long)limit);
    }
    return GVC_OK;
}

/** Position in the fragment, in presentation order, of sample `i` shown `ticks` after it is
 * decoded. */
static gvc_result read_order(const gvc_parser *parser, const track_run *run, uint32_t i,
                             int64_t ticks, uint32_t *shown, gvc_error *error) {
    uint32_t duration = parser->demux->config.frame_rate_den;
    int64_t place = (int64_t)i + ticks / (int64_t)duration - run->defaults.shown_later;
    if (ticks % (int64_t)duration != 0 || place < 0 || place >= (int64_t)run->count ||
        parser->met[place]) {
        return gvc_box_fail(&run->trun, error, GVC_ERROR_CORRUPT,
                            "sample %u with composition offset %lld is shown between frames, "
                            "outside of its fragment, or with another one",
                            i, (long long)ticks);
    }
    parser->met[place] = 1;
    *shown = (uint32_t)place;
    return GVC_OK;
}

/** Reads the fields of sample `i`; entry->offset is set by the caller. */
static gvc_result read_sample(gvc_parser *parser, track_run *run, uint32_t first_flags, uint32_t i,
                              gvc_sample_entry *entry, uint32_t *shown, gvc_error *error) {
    gvc_cursor *cursor = &run->trun.content;
    uint32_t duration = run->defaults.duration, size = run->defaults.size;
    uint32_t flags = i == 0 ? first_flags : run->defaults.flags;
    int64_t ticks = 0;
    if (run->flags & GVC_TRUN_DURATION) duration = gvc_read_u32(cursor);
    if (run->flags & GVC_TRUN_SIZE) size = gvc_read_u32(cursor);
    if (run->flags & GVC_TRUN_FLAGS) flags = gvc_read_u32(cursor);
    if (run->flags & GVC_TRUN_COMPOSITION) {
        ticks = gvc_read_u32(cursor);
        if (run->version == 1 && ticks > INT32_MAX) ticks -= (int64_t)UINT32_MAX + 1;
    }
    GVC_TRY(gvc_box_check(&run->trun, error));
    bool sync = !(flags & GVC_FLAG_IS_NON_SYNC);
    if (size == 0 || duration != parser->demux->config.frame_rate_den || sync != (i == 0)) {
        return gvc_box_fail(&run->trun, error, GVC_ERROR_CORRUPT,
                            "sample %u: %u bytes, duration %u, %s", i, size, duration,
                            sync ? "sync" : "not sync");
    }
    GVC_TRY(read_order(parser, run, i, ticks, shown, error));
    *entry = (gvc_sample_entry){
        .size = size, .crc = gvc_read_u32(&run->crc), .presentation = run->first_frame + *shown};
    return GVC_OK;
}

/** Reads the samples of a run behind those of earlier fragments; they do not count yet. */
static gvc_result read_samples(gvc_parser *parser, const gvc_box *moof, track_run *run,
                               gvc_error *error) {
    gvc_demux *demux = parser->demux;
    size_t before = demux->sample_count[run->kind];
    GVC_TRY(gvc_parser_grow(parser, (void **)&parser->met, &parser->met_capacity, run->count, 1,
                            error));
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->sample[run->kind],
                            &parser->sample_capacity[run->kind], before + run->count,
                            sizeof(gvc_sample_entry), error));
    memset(parser->met, 0, run->count);
    uint32_t first_flags =
        run->flags & GVC_TRUN_FIRST_FLAGS ? gvc_read_u32(&run->trun.content) : run->defaults.flags;
    if (gvc_cursor_left(&run->trun.content) / run->count != sample_fields_size(run->flags) ||
        gvc_cursor_left(&run->trun.content) % run->count != 0) {
        return gvc_box_fail(
            &run->trun, error, GVC_ERROR_CORRUPT, "%zu bytes for %u samples of %zu bytes each",
            gvc_cursor_left(&run->trun.content), run->count, sample_fields_size(run->flags));
    }
    for (uint32_t i = 0; i < run->count; i++) {
        gvc_sample_entry entry;
        uint32_t shown = 0;
        GVC_TRY(read_sample(parser, run, first_flags, i, &entry, &shown, error));
        entry.offset = moof->offset + run->data_offset + run->byte_count;
        run->byte_count += entry.size;
        size_t place = before + (run->kind == GVC_TRACK_GEOMETRY ? i : shown);
        demux->sample[run->kind][place] = entry;
    }
    for (size_t i = before; i < before + run->count; i++) {
        size_t shown = (size_t)(demux->sample[run->kind][i].presentation - run->first_frame);
        demux->sample[run->kind][before + shown].nth = (uint32_t)(i - before);
    }
    return GVC_OK;
}

/** Reads all trafs: one of each kind. Sets `*ours` as soon as there is one of our tracks. */
static gvc_result read_trafs(gvc_parser *parser, const gvc_box *moof,
                             track_run run[GVC_TRACK_KINDS], bool *ours, uint32_t *sequence,
                             gvc_error *error) {
    gvc_box rest = *moof, traf;
    bool found[GVC_TRACK_KINDS] = {false}, foreign = false;
    *ours = false;
    while (gvc_cursor_left(&rest.content)) {
        gvc_box tfhd;
        uint32_t flags, track_id;
        GVC_TRY(gvc_box_next(&rest, &traf, error));
        if (traf.type == GVC_BOX_MFHD && gvc_cursor_left(&traf.content) >= 8) {
            gvc_skip(&traf.content, 4); /* version and flags */
            *sequence = gvc_read_u32(&traf.content);
        }
        if (traf.type != GVC_BOX_TRAF) continue;
        GVC_TRY(read_track_id(&traf, &tfhd, &flags, &track_id, error));
        gvc_track_kind kind = gvc_parser_kind(parser, track_id);
        foreign = foreign || kind == GVC_TRACK_KINDS;
        if (kind == GVC_TRACK_KINDS) continue;
        *ours = true;
        if (found[kind]) {
            return gvc_box_fail(&traf, error, GVC_ERROR_CORRUPT, "a second traf of track %u",
                                track_id);
        }
        found[kind] = true;
        run[kind] = (track_run){.kind = kind, .defaults = parser->demux->track[kind]};
        GVC_TRY(read_overrides(&tfhd, flags, &run[kind].defaults, error));
        GVC_TRY(read_decode_time(parser, &traf, &run[kind], error));
        GVC_TRY(read_run_head(parser, &traf, &run[kind], error));
        GVC_TRY(read_samples(parser, moof, &run[kind], error));
    }
    if (!*ours) return GVC_OK;
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        if (found[kind] == parser->demux->has_track[kind] && !foreign) continue;
        return gvc_box_fail(moof, error, GVC_ERROR_CORRUPT,
                            "a fragment must hold each track of geometry images and shapes, and no "
                            "other");
    }
    return GVC_OK;
}

const gvc_track_kind gvc_data_order[GVC_TRACK_KINDS] = {GVC_TRACK_SHAPE, GVC_TRACK_GEOMETRY,
                                                        GVC_TRACK_EXACT};

/** The first track whose samples do not begin at `*next`, counted from moof, where those of the
 * track before end; NULL if there is none. Moves `*next` to their end. */
static const track_run *in_order(const gvc_parser *parser, const track_run *run, uint64_t *next) {
    for (unsigned i = 0; i < GVC_TRACK_KINDS; i++) {
        const track_run *of = &run[gvc_data_order[i]];
        if (!parser->demux->has_track[gvc_data_order[i]]) continue;
        if (of->data_offset != *next) return of;
        *next += of->byte_count;
    }
    return NULL;
}

/** mdat holds the samples of one track after the other, and nothing else: no byte escapes the
 * checksums. */
static gvc_result check_data(const gvc_parser *parser, const gvc_box *moof, const gvc_box *mdat,
                             const track_run *run, gvc_error *error) {
    uint64_t begin = moof->size + mdat->header_size, next = begin;
    const track_run *wrong = in_order(parser, run, &next);
    if (wrong) {
        return gvc_box_fail(moof, error, GVC_ERROR_CORRUPT,
                            "data offset %llu of track %u; should be %llu",
                            (unsigned long long)wrong->data_offset, wrong->defaults.track_id,
                            (unsigned long long)next);
    }
    if (next - begin == mdat->size - mdat->header_size) return GVC_OK;
    return gvc_box_fail(
        mdat, error, GVC_ERROR_CORRUPT, "%llu bytes of data, but the samples take %llu",
        (unsigned long long)(mdat->size - mdat->header_size), (unsigned long long)(next - begin));
}

/** All tracks must hold the same frames. */
static gvc_result check_same_frames(const gvc_parser *parser, const gvc_box *moof,
                                    const track_run *run, gvc_error *error) {
    const track_run *shape = &run[GVC_TRACK_SHAPE];
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        if (!parser->demux->has_track[kind] ||
            (run[kind].first_frame == shape->first_frame && run[kind].count == shape->count)) {
            continue;
        }
        return gvc_box_fail(moof, error, GVC_ERROR_CORRUPT,
                            "%u images from frame %llu, but %u shape records from frame %llu",
                            run[kind].count, (unsigned long long)run[kind].first_frame,
                            shape->count, (unsigned long long)shape->first_frame);
    }
    return GVC_OK;
}

/** Frames must go on where those before ended. With keep_going a gap is damage and only frames
 * that come again are refused. */
static gvc_result check_frames(gvc_parser *parser, const gvc_box *moof, const track_run *shape,
                               gvc_error *error) {
    uint64_t declared = parser->demux->config.declared_frames;
    if (declared && shape->first_frame + shape->count > declared) {
        return gvc_box_fail(
            moof, error, GVC_ERROR_CORRUPT, "frames %llu + %u, but the file declares %llu",
            (unsigned long long)shape->first_frame, shape->count, (unsigned long long)declared);
    }
    if (shape->first_frame == parser->next_frame) return GVC_OK;
    gvc_error gap;
    gvc_error_init(&gap);
    gvc_result result = gvc_box_fail(
        moof, &gap, GVC_ERROR_CORRUPT, "frame %llu follows, expected %llu",
        (unsigned long long)shape->first_frame, (unsigned long long)parser->next_frame);
    if (!parser->options->keep_going || shape->first_frame < parser->next_frame) {
        return gvc_hand_on(error, result, &gap);
    }
    /* Frames lost with a damaged stretch that ends here are not listed twice. */
    const gvc_demux *demux = parser->demux;
    if (demux->damage_count) {
        const gvc_damage *last = &demux->damage[demux->damage_count - 1];
        if (last->offset + last->size == moof->offset) return GVC_OK;
    }
    return gvc_parser_damage(parser, moof->offset, 0, &gap, error);
}

static gvc_result keep_fragment(gvc_parser *parser, const gvc_box *moof, const gvc_box *mdat,
                                const track_run *run, uint32_t sequence, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->fragment, &parser->fragment_capacity,
                            demux->fragment_count + 1, sizeof *demux->fragment, error));
    gvc_fragment_entry *fragment = &demux->fragment[demux->fragment_count++];
    *fragment = (gvc_fragment_entry){.offset = moof->offset,
                                     .size = moof->size + mdat->size,
                                     .moof_size = moof->size,
                                     .first_frame = run[GVC_TRACK_SHAPE].first_frame,
                                     .frame_count = run[GVC_TRACK_SHAPE].count,
                                     .sequence = sequence};
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        fragment->first_sample[kind] = demux->sample_count[kind];
        demux->sample_count[kind] += run[kind].count;
    }
    parser->next_frame = fragment->first_frame + fragment->frame_count;
    parser->data_begin = mdat->offset;
    return GVC_OK;
}

static gvc_result read_data_header(const gvc_parser *parser, const gvc_box *moof, gvc_box *mdat,
                                   gvc_error *error) {
    GVC_TRY(gvc_parser_header(parser, moof->offset + moof->size, mdat, error));
    if (mdat->type == GVC_BOX_MDAT) return GVC_OK;
    return gvc_box_fail(mdat, error, GVC_ERROR_CORRUPT, "mdat does not follow its moof");
}

/** With keep_going, a moof that is right tells all there is to know of its mdat: where the header
 * of that is damaged, or the file ends within it, the samples that are there can still be had, for
 * each has a checksum of its own. Lists `defect` and sets `mdat` as it should be; or gives it back
 * as an error. */
static gvc_result make_do(gvc_parser *parser, const gvc_box *moof, const track_run *run,
                          gvc_result result, const gvc_error *defect, gvc_box *mdat,
                          gvc_error *error) {
    uint64_t begin = moof->offset + moof->size, left = parser->io->size - begin;
    uint64_t header = run[GVC_TRACK_SHAPE].data_offset - moof->size, next = moof->size + header;
    bool known = (header == 8 || header == 16) && in_order(parser, run, &next) == NULL;
    if (!parser->options->keep_going || !known ||
        (result != GVC_ERROR_CORRUPT && result != GVC_ERROR_TRUNCATED)) {
        return gvc_hand_on(error, result, defect);
    }
    *mdat = (gvc_box){.type = GVC_BOX_MDAT,
                      .offset = begin,
                      .header_size = (uint32_t)header,
                      .size = next - moof->size};
    uint64_t damaged = mdat->size > left ? left : header;
    return gvc_parser_damage(parser, begin, damaged, defect, error);
}

gvc_result gvc_parse_fragment(gvc_parser *parser, gvc_box *moof, uint64_t *end, gvc_error *error) {
    track_run run[GVC_TRACK_KINDS] = {{0}};
    gvc_box mdat;
    bool ours;
    uint32_t sequence = (uint32_t)parser->demux->fragment_count + 1;
    GVC_TRY(gvc_parser_load(parser, moof, error));
    gvc_crc_state state = GVC_CRC_ABSENT;
    if (moof->size >= moof->header_size + GVC_GCRC_SIZE) {
        size_t tail = (size_t)moof->size - GVC_GCRC_SIZE;
        state = gvc_box_check_crc(gvc_crc32(0, parser->scratch, tail), parser->scratch + tail);
    }
    if (state == GVC_CRC_WRONG) {
        return gvc_box_fail(moof, error, GVC_ERROR_CORRUPT, "the checksum of moof is wrong");
    }
    GVC_TRY(read_trafs(parser, moof, run, &ours, &sequence, error));
    if (!ours) { /* of other tracks, such as sound */
        GVC_TRY(read_data_header(parser, moof, &mdat, error));
        *end = mdat.offset + mdat.size;
        return GVC_OK;
    }
    if (state == GVC_CRC_ABSENT) {
        return gvc_box_fail(moof, error, GVC_ERROR_CORRUPT,
                            "moof does not end with its checksum (gcrc)");
    }
    GVC_TRY(check_same_frames(parser, moof, run, error));
    GVC_TRY(check_frames(parser, moof, &run[GVC_TRACK_SHAPE], error));
    gvc_error defect;
    gvc_error_init(&defect);
    gvc_result result = read_data_header(parser, moof, &mdat, &defect);
    if (result == GVC_OK) result = check_data(parser, moof, &mdat, run, &defect);
    if (result != GVC_OK) {
        GVC_TRY(make_do(parser, moof, run, result, &defect, &mdat, error));
    }
    uint64_t left = parser->io->size - mdat.offset;
    *end = mdat.offset + (mdat.size < left ? mdat.size : left);
    return keep_fragment(parser, moof, &mdat, run, sequence, error);
}
