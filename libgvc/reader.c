/* SPDX-License-Identifier: MIT */
/** @file reader.c  Opens a `.gvc` file from a path, memory or callbacks, and tells facts about it.
 */
#include "base/memory.h"
#include "base/read_at.h"
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static gvc_result read_file_at(void *user, uint64_t offset, void *data, size_t size,
                               gvc_error *error) {
    const gvc_reader *reader = user;
    int status = gvc_read_at(reader->descriptor, offset, data, size);
    if (status == GVC_READ_ENDS) {
        return gvc_fail(error, GVC_ERROR_TRUNCATED, "the file became shorter");
    }
    if (status) return gvc_fail(error, GVC_ERROR_IO, "cannot read: %s", strerror(status));
    return GVC_OK;
}

static gvc_result read_memory_at(void *user, uint64_t offset, void *data, size_t size,
                                 gvc_error *error) {
    const gvc_reader *reader = user;
    if (offset > reader->io.size || size > reader->io.size - offset) {
        return gvc_fail(error, GVC_ERROR_TRUNCATED, "the data end before they should");
    }
    memcpy(data, reader->bytes + offset, size);
    return GVC_OK;
}

static gvc_result make_reader(const gvc_read_options *options, gvc_reader **reader,
                              gvc_error *error) {
    *reader = NULL;
    if (options && options->struct_size != sizeof *options) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "read options of another library version");
    }
    gvc_reader *made = gvc_alloc(1, sizeof *made);
    if (!made) return gvc_fail_memory(error);
    made->descriptor = -1;
    if (options) {
        made->options = *options;
    } else {
        gvc_read_options_init(&made->options);
    }
    *reader = made;
    return GVC_OK;
}

/* Parses through made->io and hands the reader out, or frees it. */
static gvc_result finish_open(gvc_reader *made, gvc_reader **reader, gvc_error *error) {
    gvc_result result = gvc_demux_open(&made->io, &made->options, &made->demux, error);
    if (result != GVC_OK) {
        gvc_reader_close(&made);
        return gvc_explain(error, result);
    }
    *reader = made;
    return GVC_OK;
}

gvc_result gvc_reader_open_file(const char *path, const gvc_read_options *options,
                                gvc_reader **reader, gvc_error *error) {
    gvc_reader *made;
    *reader = NULL;
    GVC_TRY(make_reader(options, &made, error));
    struct stat status;
    made->descriptor = open(path, O_RDONLY);
    if (made->descriptor < 0 || fstat(made->descriptor, &status) != 0) {
        int reason = errno;
        gvc_reader_close(&made);
        return gvc_fail(error, GVC_ERROR_IO, "cannot open: %s", strerror(reason));
    }
    if (!S_ISREG(status.st_mode)) {
        gvc_reader_close(&made);
        return gvc_fail(error, GVC_ERROR_IO, "not a regular file");
    }
    made->io = (gvc_io){.user = made, .size = (uint64_t)status.st_size, .read = read_file_at};
    return finish_open(made, reader, error);
}

gvc_result gvc_reader_open_memory(const void *data, size_t size, const gvc_read_options *options,
                                  gvc_reader **reader, gvc_error *error) {
    gvc_reader *made;
    *reader = NULL;
    GVC_TRY(make_reader(options, &made, error));
    made->bytes = data;
    made->io = (gvc_io){.user = made, .size = size, .read = read_memory_at};
    return finish_open(made, reader, error);
}

gvc_result gvc_reader_open_io(const gvc_io *io, const gvc_read_options *options,
                              gvc_reader **reader, gvc_error *error) {
    gvc_reader *made;
    *reader = NULL;
    GVC_TRY(make_reader(options, &made, error));
    made->io = *io;
    return finish_open(made, reader, error);
}

void gvc_reader_close(gvc_reader **reader) {
    if (!reader || !*reader) return;
    gvc_demux_free(&(*reader)->demux);
    if ((*reader)->descriptor >= 0) close((*reader)->descriptor);
    free(*reader);
    *reader = NULL;
}

static uint64_t track_bytes(const gvc_demux *demux, gvc_track_kind kind) {
    uint64_t sum = 0;
    for (size_t i = 0; i < demux->sample_count[kind]; i++) sum += demux->sample[kind][i].size;
    return sum;
}

/* Frames of a fragment that the file's end cuts through which are not whole. */
static uint64_t cut_frames(const gvc_reader *reader) {
    const gvc_demux *demux = &reader->demux;
    uint64_t cut = 0;
    for (size_t i = demux->fragment_count; i-- > 0;) {
        const gvc_fragment_entry *entry = &demux->fragment[i];
        if (entry->size <= reader->io.size - entry->offset) break;
        for (uint32_t f = 0; f < entry->frame_count; f++) {
            bool whole = true;
            for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
                if (!demux->has_track[kind]) continue;
                size_t index =
                    gvc_demux_sample_of(demux, entry, (gvc_track_kind)kind, entry->first_frame + f);
                const gvc_sample_entry *sample = &demux->sample[kind][index];
                whole = whole && sample->offset <= reader->io.size &&
                        sample->size <= reader->io.size - sample->offset;
            }
            cut += !whole;
        }
    }
    return cut;
}

/* 13.4: level n has four times the samples of level n - 1, in a picture and in a second. */
static uint32_t level_of(const gvc_config *config) {
    uint64_t rows = (3 * (uint64_t)config->plane_height + 15) / 16 * 16;
    uint64_t picture = ((uint64_t)config->picture_width + 15) / 16 * 16 * rows;
    uint64_t images = 128, samples = 65536;
    for (uint32_t level = 1; level <= 5; level++, images *= 2, samples *= 4) {
        /* picture * N / D <= 32 * samples, all below 2^64 */
        if (config->image_size <= images + 1 && picture <= samples &&
            picture * config->frame_rate_num <= 32 * samples * config->frame_rate_den) {
            return level;
        }
    }
    return 6;
}

void gvc_reader_info(const gvc_reader *reader, gvc_info *info) {
    const gvc_config *config = &reader->demux.config;
    *info = (gvc_info){
        .format_version_major = config->version_major,
        .format_version_minor = config->version_minor,
        .frame_count = reader->demux.sample_count[GVC_TRACK_SHAPE],
        .declared_count = config->declared_frames,
        .byte_count = reader->io.size,
        .image_size = config->image_size,
        .picture_width = config->picture_width,
        .picture_height = 3 * config->plane_height,
        .level = level_of(config),
        .frame_rate_num = config->frame_rate_num,
        .frame_rate_den = config->frame_rate_den,
        .gop_count = reader->demux.fragment_count,
        .damage_count = reader->demux.damage_count,
        .lossless = reader->demux.has_track[GVC_TRACK_EXACT],
        .preview = gvc_reader_has_preview(reader),
        .geometry_bytes = track_bytes(&reader->demux, GVC_TRACK_GEOMETRY),
        .shape_bytes = track_bytes(&reader->demux, GVC_TRACK_SHAPE),
        .exact_bytes = track_bytes(&reader->demux, GVC_TRACK_EXACT),
        .has_digest = reader->demux.digest_offset > 0,
    };
    memcpy(info->digest, reader->demux.digest, sizeof info->digest);
    info->frame_count -= cut_frames(reader);
    for (size_t i = 0; i < reader->demux.gap_count; i++) {
        info->lost_count += reader->demux.gap[i].frame_count;
    }
    snprintf(info->unit, sizeof info->unit, "%s", config->unit);
    snprintf(info->encoder, sizeof info->encoder, "%s", config->encoder);
}

static bool in_gap(const gvc_demux *demux, uint64_t frame) {
    for (size_t i = 0; i < demux->gap_count; i++) {
        const gvc_gap *gap = &demux->gap[i];
        if (frame >= gap->first_frame && frame - gap->first_frame < gap->frame_count) return true;
    }
    return false;
}

gvc_result gvc_reader_find(const gvc_reader *reader, uint64_t frame, size_t *fragment,
                           gvc_error *error) {
    const gvc_demux *demux = &reader->demux;
    size_t low = 0, high = demux->fragment_count; /* fragments lie in order of time */
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (demux->fragment[middle].first_frame <= frame) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    gvc_result result = GVC_OK;
    if (low == 0 ||
        frame - demux->fragment[low - 1].first_frame >= demux->fragment[low - 1].frame_count) {
        if (in_gap(demux, frame)) {
            result =
                gvc_fail(error, GVC_ERROR_LOST, "the frame was lost before the file was repaired");
        } else if (low < demux->fragment_count) {
            result = gvc_fail(error, GVC_ERROR_CORRUPT, "the frame lies in a damaged part");
        } else if (frame < demux->config.declared_frames) {
            result = gvc_fail(error, GVC_ERROR_TRUNCATED, "the frame is missing at the file's end");
        } else {
            result = gvc_fail(error, GVC_ERROR_ARGUMENT, "there is no such frame in the file");
        }
        return gvc_at_frame(error, result, (int64_t)frame);
    }
    *fragment = low - 1;
    return GVC_OK;
}

static gvc_result read_record(const gvc_reader *reader, size_t index, gvc_shape *shape,
                              gvc_shape_frame *facts, gvc_error *error) {
    const gvc_demux *demux = &reader->demux;
    gvc_buffer buffer = {0};
    uint64_t limit = gvc_reader_room(reader), most = gvc_shape_record_bytes(&demux->config);
    gvc_result result = gvc_demux_read(demux, &reader->io, GVC_TRACK_SHAPE, index,
                                       limit < most ? limit : most, &buffer, error);
    if (result == GVC_OK) {
        limit -= buffer.size;
        result =
            gvc_shape_record_read(buffer.data, buffer.size, &demux->config,
                                  limit > SIZE_MAX ? SIZE_MAX : (size_t)limit, shape, facts, error);
    }
    gvc_buffer_free(&buffer);
    return result;
}

gvc_result gvc_reader_record(const gvc_reader *reader, size_t fragment, uint64_t frame,
                             gvc_shape *shape, gvc_shape_frame *facts, gvc_error *error) {
    const gvc_demux *demux = &reader->demux;
    const gvc_fragment_entry *entry = &demux->fragment[fragment];
    size_t index = gvc_demux_sample_of(demux, entry, GVC_TRACK_SHAPE, frame);
    bool first = frame == entry->first_frame;
    *shape = (gvc_shape){0};
    gvc_result result = read_record(reader, index, shape, facts, error);
    if (result == GVC_OK && facts->same == first) {
        gvc_shape_free(shape);
        result = gvc_fail(error, GVC_ERROR_CORRUPT,
                          first ? "the first shape record of a fragment says \"same\""
                                : "a shape record inside a fragment does not say \"same\"");
    }
    if (result == GVC_OK && facts->has_preview != gvc_reader_has_preview(reader)) {
        gvc_shape_free(shape);
        result = gvc_fail(error, GVC_ERROR_CORRUPT,
                          facts->has_preview ? "a digest of a preview that the file does not have"
                                             : "the digest of the preview is missing");
    }
    if (result != GVC_OK && error && error->offset == GVC_NO_OFFSET) {
        error->offset = demux->sample[GVC_TRACK_SHAPE][index].offset;
        snprintf(error->where, sizeof error->where, "mdat/shape record");
    }
    return gvc_at_frame(error, result, (int64_t)frame);
}

const uint8_t *gvc_reader_digest(const gvc_reader *reader, const gvc_shape_frame *facts) {
    return facts->has_preview && reader->options.preview ? facts->preview_digest : facts->digest;
}

gvc_result gvc_reader_shape(const gvc_reader *reader, size_t fragment, gvc_shape *shape,
                            gvc_error *error) {
    gvc_shape_frame facts;
    uint64_t first = reader->demux.fragment[fragment].first_frame;
    return gvc_reader_record(reader, fragment, first, shape, &facts, error);
}

gvc_result gvc_reader_frame_info(const gvc_reader *reader, uint64_t frame, gvc_frame_info *info,
                                 gvc_error *error) {
    size_t fragment;
    gvc_shape shape;
    gvc_shape_frame facts;
    *info = (gvc_frame_info){0};
    GVC_TRY(gvc_reader_find(reader, frame, &fragment, error));
    GVC_TRY(gvc_reader_record(reader, fragment, frame, &shape, &facts, error));
    if (facts.same) GVC_TRY(gvc_reader_shape(reader, fragment, &shape, error));

    const gvc_demux *demux = &reader->demux;
    const gvc_fragment_entry *entry = &demux->fragment[fragment];
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        if (!demux->has_track[kind]) continue;
        size_t index = gvc_demux_sample_of(demux, entry, (gvc_track_kind)kind, frame);
        info->byte_count += demux->sample[kind][index].size;
    }
    gvc_track_kind main = gvc_demux_main(demux);
    info->keyframe = gvc_demux_sample_of(demux, entry, main, frame) == entry->first_sample[main];
    info->segment = shape.segment;
    info->chart_count = (uint32_t)shape.chart_count;
    for (size_t c = 0; c < shape.chart_count; c++) {
        const gvc_chart_shape *chart = &shape.chart[c];
        info->genus += chart->genus;
        info->node_count += (uint32_t)chart->node_count;
        info->edge_count += (uint32_t)chart->edge_count;
        for (size_t n = 0; n < chart->node_count; n++)
            info->extremum_count += chart->node[n].kind == 1;
    }
    memcpy(info->digest, gvc_reader_digest(reader, &facts), sizeof info->digest);
    snprintf(info->source, sizeof info->source, "%s", facts.source);
    gvc_shape_free(&shape);
    return GVC_OK;
}
