/* SPDX-License-Identifier: MIT */
/** @file writer.c  Writes a `.gvc` file front to back. */
#include "container/writer.h"

#include "base/digest.h"
#include "base/memory.h"
#include "container/box.h"
#include "container/shape_layout.h"
#include "container/writer_moov.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

enum { COPY_SIZE = 1 << 14, HEAD_COPY_LEVEL = 19 };

/** What mfra will say of a fragment. */
typedef struct index_entry {
    uint64_t offset; /**< of its moof */
    uint64_t time;   /**< composition time of its first sample, in ticks */
} index_entry;

struct gvc_writer {
    gvc_sink sink;
    uint32_t frame_duration;
    bool has_geometry, has_exact;
    bool other_defaults; /**< the head has other values in trex than this writer counts on */
    uint64_t declared_frames, next_frame, byte_count;
    uint32_t sequence;
    gvc_buffer buffer;  /**< the box being put together */
    gvc_buffer head;    /**< ftyp and moov, to be copied to the end */
    gvc_sha256 *digest; /**< of all bytes written; NULL once it is in the file */
    index_entry *entry;
    size_t entry_count, entry_capacity;
    bool closed; /**< finished, or failed halfway: nothing may be written any more */
};

static gvc_result put(gvc_writer *writer, const void *data, size_t size, gvc_error *error) {
    GVC_TRY(writer->sink.write(writer->sink.user, data, size, error));
    writer->byte_count += size;
    if (writer->digest) gvc_sha256_update(writer->digest, data, size);
    return GVC_OK;
}

static gvc_result put_buffer(gvc_writer *writer, gvc_error *error) {
    if (writer->buffer.failed) return gvc_fail_memory(error);
    return put(writer, writer->buffer.data, writer->buffer.size, error);
}

/** Refuses what the reader would refuse. The texts of a configuration cannot be wrong: labels are
 * cleaned as they are written. */
static gvc_result check_config(const gvc_config *config, gvc_buffer *scratch, gvc_error *error) {
    gvc_config back;
    gvc_buffer_clear(scratch);
    gvc_config_write(config, scratch);
    if (scratch->failed) return gvc_fail_memory(error);
    gvc_cursor cursor = gvc_cursor_make(scratch->data, scratch->size);
    gvc_result result = gvc_config_read(&cursor, &back, error);
    gvc_buffer_clear(scratch);
    if (result == GVC_OK) return GVC_OK;
    if (error) error->code = GVC_ERROR_ARGUMENT;
    return GVC_ERROR_ARGUMENT;
}

static gvc_result make_writer(const gvc_sink *sink, const gvc_config *config, gvc_writer **writer,
                              gvc_error *error) {
    *writer = gvc_alloc(1, sizeof **writer);
    if (!*writer) return gvc_fail_memory(error);
    **writer = (gvc_writer){.sink = *sink,
                            .frame_duration = config->frame_rate_den,
                            .declared_frames = config->declared_frames,
                            .digest = gvc_sha256_begin()};
    return (*writer)->digest ? GVC_OK : gvc_fail_memory(error);
}

static gvc_result put_head(gvc_writer *writer, gvc_error *error) {
    if (writer->head.failed) return gvc_fail_memory(error);
    return put(writer, writer->head.data, writer->head.size, error);
}

gvc_result gvc_writer_create(const gvc_sink *sink, const gvc_config *config,
                             const uint8_t *avc_config, size_t avc_config_size, gvc_writer **writer,
                             gvc_error *error) {
    *writer = NULL;
    gvc_writer *made;
    gvc_result result;
    GVC_CHECK(make_writer(sink, config, &made, error));
    GVC_CHECK(check_config(config, &made->buffer, error));
    made->has_geometry = avc_config != NULL;
    made->has_exact = config->features & GVC_FEATURE_EXACT;
    if (!made->has_geometry && !made->has_exact) {
        result = gvc_fail(error, GVC_ERROR_ARGUMENT, "a file without geometry images");
        goto cleanup;
    }
    gvc_write_head(config, avc_config, avc_config_size, &made->head);
    GVC_CHECK(put_head(made, error));
    *writer = made;
    return GVC_OK;
cleanup:
    gvc_writer_destroy(&made);
    return result;
}

/** True if the tracks of a file have the numbers and times that they have here. */
static bool is_laid_out_alike(const gvc_demux *demux) {
    static const uint32_t number[GVC_TRACK_KINDS] = {[GVC_TRACK_GEOMETRY] = GVC_GEOMETRY_TRACK,
                                                     [GVC_TRACK_SHAPE] = GVC_SHAPE_TRACK,
                                                     [GVC_TRACK_EXACT] = GVC_EXACT_TRACK};
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        uint32_t later = kind == GVC_TRACK_GEOMETRY ? GVC_SHOWN_LATER : 0;
        if (!demux->has_track[kind]) continue;
        if (demux->track[kind].track_id != number[kind] || demux->track[kind].shown_later != later)
            return false;
    }
    return true;
}

/** True if trex of each track says what gvc_write_head would have it say. */
static bool has_usual_defaults(const gvc_demux *demux) {
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        const gvc_track_defaults *track = &demux->track[kind];
        if (!demux->has_track[kind]) continue;
        if (track->duration != demux->config.frame_rate_den || track->flags != GVC_FLAGS_NON_SYNC)
            return false;
    }
    return true;
}

gvc_result gvc_writer_create_from(const gvc_sink *sink, const gvc_demux *demux, const gvc_io *io,
                                  gvc_writer **writer, gvc_error *error) {
    *writer = NULL;
    gvc_writer *made = NULL;
    gvc_result result;
    if (!is_laid_out_alike(demux)) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "the file's tracks have other numbers or times than this library writes");
    }
    GVC_CHECK(make_writer(sink, &demux->config, &made, error));
    made->has_geometry = demux->has_track[GVC_TRACK_GEOMETRY];
    made->has_exact = demux->has_track[GVC_TRACK_EXACT];
    made->other_defaults = !has_usual_defaults(demux);
    GVC_CHECK(gvc_demux_head(demux, io, &made->head, error));
    GVC_CHECK(put_head(made, error));
    *writer = made;
    return GVC_OK;
cleanup:
    gvc_writer_destroy(&made);
    return result;
}

/** Sum of the sizes of samples; fails for a size that trun cannot hold. */
static gvc_result sum_sizes(const gvc_sample *sample, size_t count, uint64_t *sum,
                            gvc_error *error) {
    *sum = 0;
    for (size_t i = 0; i < count; i++) {
        if (sample[i].size == 0 || sample[i].size > UINT32_MAX) {
            return gvc_fail(error, GVC_ERROR_ARGUMENT, "sample %zu has %zu bytes", i,
                            sample[i].size);
        }
        *sum += sample[i].size;
    }
    return GVC_OK;
}

/** Composition offset as trun holds it. */
static int64_t offset_ticks(const gvc_writer *writer, uint32_t track, const gvc_sample *sample) {
    int64_t frames = sample->composition_offset;
    if (track == GVC_GEOMETRY_TRACK) frames += GVC_SHOWN_LATER;
    return frames * writer->frame_duration;
}

/** The composition offsets of a track must make its frames a permutation, and fit trun. */
static gvc_result check_order(const gvc_writer *writer, uint32_t track, const gvc_sample *sample,
                              size_t count, gvc_error *error) {
    uint8_t *met = gvc_alloc(count, 1);
    if (!met) return gvc_fail_memory(error);
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < count; i++) {
        int64_t shown = (int64_t)i + sample[i].composition_offset;
        int64_t ticks = offset_ticks(writer, track, &sample[i]);
        if (shown < 0 || shown >= (int64_t)count || met[shown]) {
            result = gvc_fail(error, GVC_ERROR_ARGUMENT,
                              "the composition offsets do not order %zu samples", count);
            break;
        }
        if (ticks < INT32_MIN || ticks > INT32_MAX) {
            result = gvc_fail(error, GVC_ERROR_ARGUMENT,
                              "a composition offset of %lld ticks does not fit", (long long)ticks);
            break;
        }
        met[shown] = 1;
    }
    free(met);
    return result;
}

/** One track of a fragment. */
typedef struct track_run {
    uint32_t track;
    const gvc_sample *sample;
    uint64_t byte_count;
    size_t data_offset; /**< place of its data offset in the moof being built */
} track_run;

#define MOST_TRACKS 3u

/** The tracks of a fragment, in the order of their trafs; returns how many. */
static size_t list_runs(const gvc_fragment *fragment, track_run run[MOST_TRACKS]) {
    size_t count = 0;
    if (fragment->geometry)
        run[count++] = (track_run){GVC_GEOMETRY_TRACK, fragment->geometry, 0, 0};
    run[count++] = (track_run){GVC_SHAPE_TRACK, fragment->shape, 0, 0};
    if (fragment->exact) run[count++] = (track_run){GVC_EXACT_TRACK, fragment->exact, 0, 0};
    return count;
}

/** Only the first samples are sync samples, and only the first frame has a whole shape record.
 * Sizes must have been checked. */
static gvc_result check_first(const gvc_fragment *fragment, const track_run *run, size_t run_count,
                              gvc_error *error) {
    for (size_t i = 0; i < fragment->frame_count; i++) {
        const gvc_sample *shape = &fragment->shape[i];
        bool first = i == 0, whole = !(shape->data[0] & GVC_RECORD_SAME);
        bool first_shown = (int64_t)i + shape->composition_offset == 0;
        bool sync_right = true;
        for (size_t t = 0; t < run_count; t++) sync_right &= run[t].sample[i].sync == first;
        if (!sync_right || whole != first_shown) {
            return gvc_fail(error, GVC_ERROR_ARGUMENT,
                            "sample %zu: a fragment has one sync sample in each track and one "
                            "whole shape record, the first",
                            i);
        }
    }
    return GVC_OK;
}

static gvc_result check_fragment(const gvc_writer *writer, const gvc_fragment *fragment,
                                 track_run *run, size_t run_count, gvc_error *error) {
    size_t count = fragment->frame_count;
    if (writer->closed) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the file is finished, or writing it failed");
    }
    if (!fragment->geometry == writer->has_geometry || !fragment->exact == writer->has_exact) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a fragment of other tracks than the file's");
    }
    if (fragment->first_frame != writer->next_frame || count == 0 || count > INT32_MAX) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT,
                        "a fragment of %zu frames from %llu; the next frame is %llu", count,
                        (unsigned long long)fragment->first_frame,
                        (unsigned long long)writer->next_frame);
    }
    if (fragment->first_frame > UINT64_MAX / writer->frame_duration - count - GVC_SHOWN_LATER) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "frame %llu does not fit in time",
                        (unsigned long long)fragment->first_frame);
    }
    for (size_t t = 0; t < run_count; t++) {
        GVC_TRY(sum_sizes(run[t].sample, count, &run[t].byte_count, error));
    }
    GVC_TRY(check_first(fragment, run, run_count, error));
    for (size_t t = 0; t < run_count; t++) {
        GVC_TRY(check_order(writer, run[t].track, run[t].sample, count, error));
    }
    return GVC_OK;
}

/** Flags of trun, as few fields per sample as tell all. Flags of samples but the first are those of
 * trex. */
static uint32_t run_flags(const gvc_writer *writer, uint32_t track, const gvc_sample *sample,
                          size_t count) {
    uint32_t flags = GVC_TRUN_DATA_OFFSET | GVC_TRUN_FIRST_FLAGS | GVC_TRUN_SIZE;
    for (size_t i = 0; i < count; i++) {
        if (offset_ticks(writer, track, &sample[i])) flags |= GVC_TRUN_COMPOSITION;
    }
    return flags;
}

/** Returns the position of the data offset, which is patched when moof's size is known. */
static size_t write_trun(const gvc_writer *writer, uint32_t track, const gvc_sample *sample,
                         size_t count, gvc_buffer *buffer) {
    uint32_t flags = run_flags(writer, track, sample, count);
    size_t trun = gvc_box_begin_full(buffer, GVC_BOX_TRUN, 1, flags);
    gvc_write_u32(buffer, (uint32_t)count);
    size_t data_offset = buffer->size;
    gvc_write_u32(buffer, 0);
    gvc_write_u32(buffer, GVC_FLAGS_SYNC);
    for (size_t i = 0; i < count; i++) {
        gvc_write_u32(buffer, (uint32_t)sample[i].size);
        if (flags & GVC_TRUN_COMPOSITION) {
            int64_t ticks = offset_ticks(writer, track, &sample[i]);
            gvc_write_u32(buffer, (uint32_t)(int32_t)ticks);
        }
    }
    gvc_box_end(buffer, trun);
    return data_offset;
}

static void write_tfhd(const gvc_writer *writer, uint32_t track, gvc_buffer *buffer) {
    uint32_t flags = GVC_TFHD_BASE_IS_MOOF;
    if (writer->other_defaults) flags |= GVC_TFHD_DURATION | GVC_TFHD_FLAGS;
    size_t tfhd = gvc_box_begin_full(buffer, GVC_BOX_TFHD, 0, flags);
    gvc_write_u32(buffer, track);
    if (writer->other_defaults) {
        gvc_write_u32(buffer, writer->frame_duration);
        gvc_write_u32(buffer, GVC_FLAGS_NON_SYNC);
    }
    gvc_box_end(buffer, tfhd);
}

static size_t write_traf(const gvc_writer *writer, uint32_t track, const gvc_sample *sample,
                         size_t count, gvc_buffer *buffer) {
    size_t traf = gvc_box_begin(buffer, GVC_BOX_TRAF);
    write_tfhd(writer, track, buffer);
    size_t tfdt = gvc_box_begin_full(buffer, GVC_BOX_TFDT, 1, 0);
    gvc_write_u64(buffer, writer->next_frame * writer->frame_duration);
    gvc_box_end(buffer, tfdt);
    size_t data_offset = write_trun(writer, track, sample, count, buffer);
    size_t gcks = gvc_box_begin_full(buffer, GVC_BOX_GCKS, 0, 0);
    for (size_t i = 0; i < count; i++) {
        gvc_write_u32(buffer, gvc_crc32(0, sample[i].data, sample[i].size));
    }
    gvc_box_end(buffer, gcks);
    gvc_box_end(buffer, traf);
    return data_offset;
}

static void write_mdat_header(gvc_buffer *buffer, uint64_t size, uint32_t header_size) {
    gvc_write_u32(buffer, header_size == 16 ? 1 : (uint32_t)size);
    gvc_write_u32(buffer, GVC_BOX_MDAT);
    if (header_size == 16) gvc_write_u64(buffer, size);
}

/** Order of the tracks in mdat. Shape records come first: they are small, and a receiver then has
 * the weld of every frame when its picture arrives, so that each picture can be shown at once
 * instead of after the whole group. */
static const uint32_t data_order[MOST_TRACKS] = {GVC_SHAPE_TRACK, GVC_GEOMETRY_TRACK,
                                                 GVC_EXACT_TRACK};

/** The run of a track, or NULL. */
static track_run *run_of(track_run *run, size_t run_count, uint32_t track) {
    for (size_t t = 0; t < run_count; t++) {
        if (run[t].track == track) return &run[t];
    }
    return NULL;
}

/** Builds moof and the header of mdat. */
static gvc_result build_moof(gvc_writer *writer, const gvc_fragment *fragment, track_run *run,
                             size_t run_count, gvc_error *error) {
    gvc_buffer *buffer = &writer->buffer;
    gvc_buffer_clear(buffer);
    size_t moof = gvc_box_begin(buffer, GVC_BOX_MOOF);
    size_t mfhd = gvc_box_begin_full(buffer, GVC_BOX_MFHD, 0, 0);
    gvc_write_u32(buffer, writer->sequence + 1);
    gvc_box_end(buffer, mfhd);
    uint64_t payload = 0;
    for (size_t t = 0; t < run_count; t++) {
        run[t].data_offset =
            write_traf(writer, run[t].track, run[t].sample, fragment->frame_count, buffer);
        payload += run[t].byte_count;
    }
    uint32_t mdat_header = payload + 8 > UINT32_MAX ? 16 : 8;
    uint64_t moof_size = (uint64_t)buffer->size + GVC_GCRC_SIZE, next = moof_size + mdat_header;
    gvc_patch_u32(buffer, moof, (uint32_t)moof_size);
    for (size_t i = 0; i < MOST_TRACKS; i++) {
        const track_run *at = run_of(run, run_count, data_order[i]);
        if (!at) continue;
        if (next > INT32_MAX) {
            return gvc_fail(error, GVC_ERROR_LIMIT, "%llu bytes of samples in one fragment",
                            (unsigned long long)payload);
        }
        gvc_patch_u32(buffer, at->data_offset, (uint32_t)next);
        next += at->byte_count;
    }
    gvc_box_write_crc(buffer, moof, 0);
    write_mdat_header(buffer, payload + mdat_header, mdat_header);
    return buffer->failed ? gvc_fail_memory(error) : GVC_OK;
}

static gvc_result put_samples(gvc_writer *writer, const gvc_sample *sample, size_t count,
                              gvc_error *error) {
    for (size_t i = 0; i < count; i++) {
        GVC_TRY(put(writer, sample[i].data, sample[i].size, error));
    }
    return GVC_OK;
}

/** The track that the index points at. Its traf is the first, or, alone with that of the shape
 * track, the second. */
static uint32_t main_track(const gvc_writer *writer) {
    return writer->has_geometry ? GVC_GEOMETRY_TRACK : GVC_EXACT_TRACK;
}

/** Sets the next entry of the index, which counts once its fragment has been written. */
static gvc_result add_entry(gvc_writer *writer, index_entry entry, gvc_error *error) {
    if (!gvc_grow((void **)&writer->entry, &writer->entry_capacity, writer->entry_count + 1,
                  sizeof *writer->entry)) {
        return gvc_fail_memory(error);
    }
    writer->entry[writer->entry_count] = entry;
    return GVC_OK;
}

gvc_result gvc_writer_fragment(gvc_writer *writer, const gvc_fragment *fragment, gvc_error *error) {
    track_run run[MOST_TRACKS];
    size_t run_count = list_runs(fragment, run);
    GVC_TRY(check_fragment(writer, fragment, run, run_count, error));
    GVC_TRY(build_moof(writer, fragment, run, run_count, error));
    const gvc_sample *first = fragment->geometry ? fragment->geometry : fragment->exact;
    int64_t shown = offset_ticks(writer, main_track(writer), &first[0]);
    index_entry entry = {.offset = writer->byte_count,
                         .time = fragment->first_frame * writer->frame_duration + (uint64_t)shown};
    GVC_TRY(add_entry(writer, entry, error));
    writer->closed = true; /* unless all of it gets out */
    GVC_TRY(put_buffer(writer, error));
    for (size_t i = 0; i < MOST_TRACKS; i++) {
        const track_run *at = run_of(run, run_count, data_order[i]);
        if (at) GVC_TRY(put_samples(writer, at->sample, fragment->frame_count, error));
    }
    writer->closed = false;
    writer->entry_count++;
    writer->sequence++;
    writer->next_frame += fragment->frame_count;
    return GVC_OK;
}

/* ---------------------------------------------------------------------- parts of another file */

static gvc_result check_place(const gvc_writer *writer, uint64_t first, uint64_t count,
                              gvc_error *error) {
    uint64_t end = writer->declared_frames ? writer->declared_frames : UINT64_MAX;
    if (writer->closed) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the file is finished, or writing it failed");
    }
    if (first == writer->next_frame && count > 0 && first <= end && count <= end - first) {
        return GVC_OK;
    }
    return gvc_fail(error, GVC_ERROR_ARGUMENT, "%llu frames from %llu on; the next frame is %llu",
                    (unsigned long long)count, (unsigned long long)first,
                    (unsigned long long)writer->next_frame);
}

static gvc_result copy_bytes(gvc_writer *writer, const gvc_io *io, uint64_t offset, uint64_t size,
                             gvc_error *error) {
    uint8_t chunk[COPY_SIZE];
    while (size > 0) {
        size_t count = size < sizeof chunk ? (size_t)size : sizeof chunk;
        GVC_TRY(io->read(io->user, offset, chunk, count, error));
        GVC_TRY(put(writer, chunk, count, error));
        offset += count;
        size -= count;
    }
    return GVC_OK;
}

gvc_result gvc_writer_copy(gvc_writer *writer, const gvc_demux *demux, const gvc_io *io,
                           size_t index, gvc_error *error) {
    const gvc_fragment_entry *fragment = &demux->fragment[index];
    gvc_track_kind kind = gvc_demux_main(demux);
    const gvc_sample_entry *first = &demux->sample[kind][fragment->first_sample[kind]];
    GVC_TRY(check_place(writer, fragment->first_frame, fragment->frame_count, error));
    uint64_t shown = first->presentation + (kind == GVC_TRACK_GEOMETRY ? GVC_SHOWN_LATER : 0);
    index_entry entry = {writer->byte_count, shown * writer->frame_duration};
    GVC_TRY(add_entry(writer, entry, error));
    writer->closed = true; /* unless all of it gets out */
    uint64_t data = demux->sample[GVC_TRACK_SHAPE][fragment->first_sample[GVC_TRACK_SHAPE]].offset;
    uint64_t moof_end = fragment->offset + fragment->moof_size;
    uint64_t end = fragment->offset + fragment->size;
    gvc_buffer_clear(&writer->buffer);
    write_mdat_header(&writer->buffer, end - moof_end, (uint32_t)(data - moof_end));
    GVC_TRY(copy_bytes(writer, io, fragment->offset, fragment->moof_size, error));
    GVC_TRY(put_buffer(writer, error));
    GVC_TRY(copy_bytes(writer, io, data, end - data, error));
    writer->closed = false;
    writer->entry_count++;
    writer->sequence = fragment->sequence;
    writer->next_frame += fragment->frame_count;
    return GVC_OK;
}

gvc_result gvc_writer_gap(gvc_writer *writer, uint64_t count, gvc_error *error) {
    gvc_buffer *buffer = &writer->buffer;
    GVC_TRY(check_place(writer, writer->next_frame, count, error));
    gvc_buffer_clear(buffer);
    size_t ggap = gvc_box_begin_full(buffer, GVC_BOX_GGAP, 0, 0);
    gvc_write_u64(buffer, writer->next_frame);
    gvc_write_u64(buffer, count);
    gvc_patch_u32(buffer, ggap, GVC_GGAP_SIZE);
    gvc_box_write_crc(buffer, ggap, 0);
    GVC_TRY(put_buffer(writer, error));
    writer->next_frame += count;
    return GVC_OK;
}

/* --------------------------------------------------------------------------------------- index */

static void write_tfra(const gvc_writer *writer, gvc_buffer *buffer) {
    size_t tfra = gvc_box_begin_full(buffer, GVC_BOX_TFRA, 1, 0);
    gvc_write_u32(buffer, main_track(writer));
    gvc_write_u32(buffer, 0); /* traf, trun and sample numbers take one byte each */
    gvc_write_u32(buffer, (uint32_t)writer->entry_count);
    for (size_t i = 0; i < writer->entry_count; i++) {
        gvc_write_u64(buffer, writer->entry[i].time);
        gvc_write_u64(buffer, writer->entry[i].offset);
        gvc_write_u8(buffer, writer->has_geometry ? 1 : 2);
        gvc_write_u8(buffer, 1);
        gvc_write_u8(buffer, 1);
    }
    gvc_box_end(buffer, tfra);
}

/** The head once more, packed, so that the file survives the loss of its beginning. */
static gvc_result write_head_copy(const gvc_writer *writer, gvc_buffer *buffer, gvc_error *error) {
    size_t room = ZSTD_compressBound(writer->head.size);
    uint8_t *packed = gvc_alloc(room, 1);
    if (!packed) return gvc_fail_memory(error);
    size_t size =
        ZSTD_compress(packed, room, writer->head.data, writer->head.size, HEAD_COPY_LEVEL);
    gvc_result result = GVC_OK;
    if (ZSTD_isError(size)) {
        result = gvc_fail(error, GVC_ERROR_MEMORY, "zstd: %s", ZSTD_getErrorName(size));
    } else {
        size_t ghed = gvc_box_begin_full(buffer, GVC_BOX_GHED, 0, 0);
        gvc_write_bytes(buffer, packed, size);
        gvc_box_end(buffer, ghed);
    }
    free(packed);
    return result;
}

/** The digest of all bytes of the file up to here, with the head of its own box. */
static void write_digest(gvc_writer *writer, gvc_buffer *buffer) {
    uint8_t digest[GVC_FILE_DIGEST_SIZE];
    size_t gdig = gvc_box_begin_full(buffer, GVC_BOX_GDIG, 0, 0);
    gvc_patch_u32(buffer, gdig, GVC_GDIG_SIZE);
    if (!buffer->failed) gvc_sha256_update(writer->digest, buffer->data, buffer->size);
    gvc_sha256_end(writer->digest, digest);
    writer->digest = NULL;
    gvc_write_bytes(buffer, digest, sizeof digest);
}

gvc_result gvc_writer_finish(gvc_writer *writer, gvc_error *error) {
    if (writer->closed) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the file is finished, or writing it failed");
    }
    if (writer->declared_frames && writer->declared_frames != writer->next_frame) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "%llu frames written of %llu declared",
                        (unsigned long long)writer->next_frame,
                        (unsigned long long)writer->declared_frames);
    }
    gvc_buffer *buffer = &writer->buffer;
    gvc_buffer_clear(buffer);
    size_t mfra = gvc_box_begin(buffer, GVC_BOX_MFRA);
    write_tfra(writer, buffer);
    GVC_TRY(write_head_copy(writer, buffer, error));
    uint64_t mfra_size = (uint64_t)buffer->size + GVC_GDIG_SIZE + GVC_GCRC_SIZE + GVC_MFRO_SIZE;
    if (mfra_size > UINT32_MAX) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "%zu fragments are too many for an index",
                        writer->entry_count);
    }
    gvc_patch_u32(buffer, mfra, (uint32_t)mfra_size);
    write_digest(writer, buffer);
    gvc_box_write_crc(buffer, mfra, 0);
    size_t mfro = gvc_box_begin_full(buffer, GVC_BOX_MFRO, 0, 0);
    gvc_write_u32(buffer, (uint32_t)mfra_size); /* must be last: it is read from the file's end */
    gvc_box_end(buffer, mfro);
    writer->closed = true;
    return put_buffer(writer, error);
}

uint64_t gvc_writer_byte_count(const gvc_writer *writer) { return writer->byte_count; }

void gvc_writer_destroy(gvc_writer **writer) {
    if (!writer || !*writer) return;
    gvc_buffer_free(&(*writer)->buffer);
    gvc_buffer_free(&(*writer)->head);
    gvc_sha256_end((*writer)->digest, NULL);
    free((*writer)->entry);
    free(*writer);
    *writer = NULL;
}
