/* SPDX-License-Identifier: MIT */
/** @file mutate_samples.c  Changes samples; the writer then makes sizes, offsets and checksums. */
#include "mutate.h"

#include "memory_file.h"
#include "random.h"

#include "base/memory.h"
#include "container/shape_layout.h"
#include "container/shape_record.h"
#include "container/writer.h"

#include <stdlib.h>
#include <string.h>
#include <zstd.h>

#define ROOM_TO_GROW 64u
#define MAX_SAMPLE ((size_t)1 << 20)
#define MAX_SAMPLES 256u
#define EXR_HEAD 512u /* about where the attributes of an OpenEXR file lie */

/* All samples of a file, in the order of the demuxer. */
typedef struct samples {
    gvc_demux demux;
    gvc_io io;
    gvc_buffer *data[GVC_TRACK_KINDS];
} samples;

static void free_samples(samples *s) {
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        for (size_t i = 0; s->data[kind] && i < s->demux.sample_count[kind]; i++) {
            gvc_buffer_free(&s->data[kind][i]);
        }
        free(s->data[kind]);
    }
    gvc_demux_free(&s->demux);
}

static bool read_samples(samples *s) {
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        size_t count = s->demux.sample_count[kind];
        if (count > MAX_SAMPLES) return false;
        s->data[kind] = gvc_alloc(count, sizeof *s->data[kind]);
        for (size_t i = 0; s->data[kind] && i < count; i++) {
            if (gvc_demux_read(&s->demux, &s->io, (gvc_track_kind)kind, i, MAX_SAMPLE,
                               &s->data[kind][i], NULL) != GVC_OK) {
                return false;
            }
        }
        if (!s->data[kind]) return false;
    }
    return true;
}

/* ------------------------------------------------------------------------------------- mutations
 */

/* Lets libFuzzer change the bytes from `from` on, at most `count` of them. */
static void change_part(gvc_buffer *sample, size_t from, size_t count) {
    if (from > sample->size || sample->size > MAX_SAMPLE) return;
    if (count > sample->size - from) count = sample->size - from;
    size_t behind = sample->size - from - count;
    uint8_t *bytes = malloc(count + ROOM_TO_GROW);
    gvc_buffer changed = {0};
    if (!bytes) return;
    if (count) memcpy(bytes, sample->data + from, count);
    size_t now = LLVMFuzzerMutate(bytes, count, count + ROOM_TO_GROW);
    gvc_write_bytes(&changed, sample->data, from);
    gvc_write_bytes(&changed, bytes, now);
    gvc_write_bytes(&changed, sample->data + from + count, behind);
    free(bytes);
    if (changed.failed || changed.size == 0) {
        gvc_buffer_free(&changed);
        return;
    }
    gvc_buffer_free(sample);
    *sample = changed;
}

/* Bytes of a record before its body; 0 if it is none. */
static size_t record_head(const gvc_buffer *record) {
    gvc_cursor cursor = gvc_cursor_make(record->data, record->size);
    unsigned flags = gvc_read_u8(&cursor);
    gvc_skip(&cursor, flags & GVC_RECORD_PREVIEW ? 16 : 8);
    if (flags & GVC_RECORD_NAMED) gvc_skip(&cursor, gvc_read_u8(&cursor));
    return cursor.failed ? 0 : cursor.position;
}

/* A packed body cannot be changed usefully: expands it. */
static void unpack_record(gvc_buffer *record) {
    size_t head = record_head(record);
    if (head == 0 || !(record->data[0] & GVC_RECORD_ZSTD)) return;
    const uint8_t *packed = record->data + head;
    unsigned long long size = ZSTD_getFrameContentSize(packed, record->size - head);
    if (size > MAX_SAMPLE) return; /* as errors are */
    gvc_buffer plain = {0};
    uint8_t *body = malloc((size_t)size + 1);
    if (body && ZSTD_decompress(body, (size_t)size, packed, record->size - head) == size) {
        gvc_write_bytes(&plain, record->data, head);
        gvc_write_bytes(&plain, body, (size_t)size);
    }
    free(body);
    if (plain.failed || plain.size == 0) {
        gvc_buffer_free(&plain);
        return;
    }
    plain.data[0] &= (uint8_t)~GVC_RECORD_ZSTD;
    gvc_buffer_free(record);
    *record = plain;
}

/* A picture of one NAL unit keeps the length of that right. */
static void change_picture(gvc_buffer *picture) {
    change_part(picture, picture->size > 5 ? 5 : 0, SIZE_MAX);
    if (picture->size > 5) gvc_patch_u32(picture, 0, (uint32_t)(picture->size - 4));
}

static void change_sample(gvc_buffer *sample, unsigned kind, uint64_t *random) {
    size_t from = 0, count = SIZE_MAX;
    if (kind == GVC_TRACK_GEOMETRY && random_below(random, 8)) {
        change_picture(sample);
        return;
    }
    if (kind == GVC_TRACK_SHAPE && random_below(random, 8)) {
        unpack_record(sample);
        from = record_head(sample);
    }
    if (kind == GVC_TRACK_EXACT && random_below(random, 2)) count = EXR_HEAD;
    change_part(sample, from, count);
}

static void change_samples(samples *s, uint64_t *random) {
    unsigned kind = (unsigned)random_below(random, GVC_TRACK_KINDS);
    while (!s->demux.has_track[kind]) kind = (kind + 1) % GVC_TRACK_KINDS;
    size_t count = s->demux.sample_count[kind];
    if (count == 0) return;
    size_t a = random_below(random, count), b = random_below(random, count);
    gvc_buffer *data = s->data[kind];
    switch (random_below(random, 8)) {
    case 0: {
        gvc_buffer other = data[a];
        data[a] = data[b];
        data[b] = other;
        return;
    }
    case 1:
        if (a == b) return;
        gvc_buffer_clear(&data[a]);
        gvc_write_bytes(&data[a], data[b].data, data[b].size);
        return;
    default:
        change_sample(&data[a], kind, random);
    }
}

/* --------------------------------------------------------------------------------------- writing
 */

static gvc_result write_fragment(const samples *s, size_t index, gvc_writer *writer) {
    const gvc_fragment_entry *entry = &s->demux.fragment[index];
    gvc_sample *list[GVC_TRACK_KINDS] = {NULL};
    gvc_result result = GVC_OK;
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS && result == GVC_OK; kind++) {
        if (!s->demux.has_track[kind]) continue;
        list[kind] = gvc_alloc(entry->frame_count, sizeof *list[kind]);
        for (size_t i = 0; list[kind] && i < entry->frame_count; i++) {
            size_t place = entry->first_sample[kind] + i;
            uint64_t shown = s->demux.sample[kind][place].presentation - entry->first_frame;
            const gvc_buffer *data = &s->data[kind][place];
            int64_t offset = (int64_t)shown - (int64_t)i;
            list[kind][i] = (gvc_sample){data->data, data->size, (int32_t)offset, i == 0};
        }
        if (!list[kind]) result = GVC_ERROR_MEMORY;
    }
    gvc_fragment fragment = {entry->first_frame, entry->frame_count, list[GVC_TRACK_GEOMETRY],
                             list[GVC_TRACK_SHAPE], list[GVC_TRACK_EXACT]};
    if (result == GVC_OK) result = gvc_writer_fragment(writer, &fragment, NULL);
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) free(list[kind]);
    return result;
}

static gvc_result write_file(const samples *s, gvc_buffer *file) {
    gvc_sink sink = {file, sink_write};
    gvc_writer *writer;
    GVC_TRY(gvc_writer_create_from(&sink, &s->demux, &s->io, &writer, NULL));
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < s->demux.fragment_count && result == GVC_OK; i++) {
        result = write_fragment(s, i, writer);
    }
    if (result == GVC_OK) result = gvc_writer_finish(writer, NULL);
    gvc_writer_destroy(&writer);
    return result == GVC_OK && file->failed ? GVC_ERROR_MEMORY : result;
}

size_t mutate_samples(uint8_t *data, size_t size, size_t max_size, uint64_t *random) {
    samples s = {.io = io_of(data, size)};
    gvc_read_options options = {.struct_size = sizeof options,
                                .max_memory = MAX_SAMPLE << 4,
                                .max_image_size = 2049,
                                .max_frames = MAX_SAMPLES,
                                .keep_going = true};
    gvc_buffer file = {0};
    size_t changed = 0;
    if (gvc_demux_open(&s.io, &options, &s.demux, NULL) != GVC_OK) return 0;
    if (read_samples(&s)) {
        change_samples(&s, random);
        if (write_file(&s, &file) == GVC_OK && file.size <= max_size) {
            changed = file.size;
            memcpy(data, file.data, changed);
        }
    }
    gvc_buffer_free(&file);
    free_samples(&s);
    return changed;
}
