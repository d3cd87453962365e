/* SPDX-License-Identifier: MIT */
/** @file shape_record_read.c  Reading shape records, which are untrusted. */
#include "container/shape_record.h"

#include "base/memory.h"
#include "container/label.h"
#include "container/shape_layout.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>
#include <zstd_errors.h>

/** A varint that must fit in 32 bits. */
static uint32_t read_varint32(gvc_cursor *cursor) {
    uint64_t value = gvc_read_varint(cursor);
    if (value > UINT32_MAX) cursor->failed = true;
    return (uint32_t)value;
}

static gvc_result fail_chart(size_t index, const char *what, gvc_error *error) {
    return gvc_fail(error, GVC_ERROR_CORRUPT, "chart %zu: %s", index, what);
}

/** The affine map must be one that maps every 16-bit code to a finite float32. */
static bool map_is_usable(const gvc_chart_shape *chart) {
    if (!isfinite(chart->step) || chart->step <= 0) return false;
    for (unsigned k = 0; k < 3; k++) {
        if (!isfinite(chart->origin[k])) return false;
        if (fabs(chart->origin[k]) + chart->step * UINT16_MAX > FLT_MAX) return false;
    }
    return true;
}

/** What is left while the charts of a body are read: bytes, samples of the plane, and memory. */
typedef struct body_reader {
    gvc_cursor cursor;
    uint32_t image_size;
    uint64_t samples, memory;
} body_reader;

static gvc_result take_memory(body_reader *body, uint64_t size, gvc_error *error) {
    if (size > body->memory) {
        return gvc_fail(error, GVC_ERROR_LIMIT,
                        "the charts of a shape record take more memory than the limit");
    }
    body->memory -= size;
    return GVC_OK;
}

/** The fields before the graph. */
static gvc_result read_placement(body_reader *body, gvc_chart_shape *chart, size_t index,
                                 gvc_error *error) {
    gvc_cursor *cursor = &body->cursor;
    uint32_t image_size = body->image_size;
    uint32_t component = read_varint32(cursor);
    chart->x = read_varint32(cursor);
    chart->y = read_varint32(cursor);
    chart->sides.size = read_varint32(cursor);
    chart->genus = read_varint32(cursor);
    for (unsigned k = 0; k < 3; k++) chart->origin[k] = gvc_read_f64(cursor);
    chart->step = gvc_read_f64(cursor);
    if (cursor->failed) return fail_chart(index, "the record ends within it", error);
    if (component != index) return fail_chart(index, "its component is not its number", error);
    if (chart->sides.size < GVC_MIN_IMAGE_SIZE || chart->sides.size > image_size) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "chart %zu: its size %u is not %u to %u", index,
                        chart->sides.size, GVC_MIN_IMAGE_SIZE, image_size);
    }
    if (!map_is_usable(chart)) return fail_chart(index, "its map to space is not finite", error);
    /* Charts do not overlap. Known now, it bounds what they allocate. */
    uint64_t samples = (uint64_t)chart->sides.size * chart->sides.size;
    if (samples > body->samples) {
        return fail_chart(index, "the charts up to it have more samples than a plane", error);
    }
    body->samples -= samples;
    return GVC_OK;
}

/** Reads the counts, checks them against each other and the bytes left, and allocates. */
static gvc_result make_room(body_reader *body, gvc_chart_shape *chart, size_t index,
                            gvc_error *error) {
    gvc_cursor *cursor = &body->cursor;
    size_t node_count = read_varint32(cursor);
    size_t edge_count = read_varint32(cursor);
    if (cursor->failed) return fail_chart(index, "the record ends within it", error);
    /* Twice the sum of the steps, each at least two, is the border of 4 (size - 1) steps. */
    if (edge_count < 1 || edge_count > chart->sides.size - 1) {
        return fail_chart(index, "its number of edges cannot be", error);
    }
    if (node_count < 1 || node_count + 2 * (uint64_t)chart->genus != (uint64_t)edge_count + 1) {
        return fail_chart(index, "nodes - edges is not 1 - 2 * genus", error);
    }
    /* Per node at least its kind, per edge two nodes, steps and two sides. */
    if (node_count + 5 * edge_count > gvc_cursor_left(cursor)) {
        return fail_chart(index, "it has more nodes and edges than bytes", error);
    }
    gvc_side_table *sides = &chart->sides;
    GVC_TRY(take_memory(
        body,
        node_count * sizeof *chart->node +
            edge_count * (sizeof *chart->edge + sizeof *sides->steps + 2 * sizeof *sides->side),
        error));
    chart->node = gvc_alloc(node_count, sizeof *chart->node);
    chart->edge = gvc_alloc(edge_count, sizeof *chart->edge);
    sides->steps = gvc_alloc(edge_count, sizeof *sides->steps);
    sides->side = gvc_alloc(2 * edge_count, sizeof *sides->side);
    if (!chart->node || !chart->edge || !sides->steps || !sides->side) {
        return gvc_fail_memory(error);
    }
    chart->node_count = node_count;
    chart->edge_count = edge_count;
    sides->edge_count = edge_count;
    sides->side_count = 2 * edge_count;
    return GVC_OK;
}

static gvc_result read_graph(gvc_cursor *cursor, gvc_chart_shape *chart, size_t index,
                             gvc_error *error) {
    for (size_t i = 0; i < chart->node_count; i++) {
        gvc_shape_node *node = &chart->node[i];
        node->kind = gvc_read_u8(cursor);
        if (node->kind >= GVC_NODE_KINDS) return fail_chart(index, "a node is no kind", error);
        if (node->kind == GVC_NODE_KIND_EXTREMUM) node->feature = read_varint32(cursor);
    }
    for (size_t i = 0; i < chart->edge_count; i++) {
        for (unsigned k = 0; k < 2; k++) {
            uint32_t node = read_varint32(cursor);
            if (node >= chart->node_count) return fail_chart(index, "an edge has no node", error);
            chart->edge[i].node[k] = node;
        }
    }
    return GVC_OK;
}

static gvc_result read_sides(gvc_cursor *cursor, gvc_side_table *sides, size_t index,
                             gvc_error *error) {
    sides->start = read_varint32(cursor);
    for (size_t i = 0; i < sides->edge_count; i++) sides->steps[i] = read_varint32(cursor);
    for (size_t i = 0; i < sides->side_count; i++) {
        uint32_t code = read_varint32(cursor);
        sides->side[i] = (gvc_side){.edge = code / 2, .reversed = code % 2};
        if (code / 2 >= sides->edge_count) return fail_chart(index, "a side has no edge", error);
    }
    if (cursor->failed) return fail_chart(index, "the record ends within it", error);
    return GVC_OK;
}

static gvc_result read_chart(body_reader *body, gvc_chart_shape *chart, size_t index,
                             gvc_error *error) {
    GVC_TRY(read_placement(body, chart, index, error));
    GVC_TRY(make_room(body, chart, index, error));
    GVC_TRY(read_graph(&body->cursor, chart, index, error));
    return read_sides(&body->cursor, &chart->sides, index, error);
}

static gvc_result read_body(body_reader *body, gvc_shape *shape, gvc_error *error) {
    gvc_cursor *cursor = &body->cursor;
    size_t size = gvc_cursor_left(cursor);
    shape->segment = gvc_read_varint(cursor);
    uint64_t chart_count = gvc_read_varint(cursor);
    if (cursor->failed || chart_count < 1 ||
        chart_count > gvc_cursor_left(cursor) / GVC_MIN_CHART_BYTES ||
        chart_count > body->samples / (GVC_MIN_IMAGE_SIZE * GVC_MIN_IMAGE_SIZE)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%llu charts in a body of %zu bytes",
                        (unsigned long long)chart_count, size);
    }
    GVC_TRY(take_memory(body, chart_count * sizeof *shape->chart, error));
    shape->chart = gvc_alloc((size_t)chart_count, sizeof *shape->chart);
    if (!shape->chart) return gvc_fail_memory(error);
    shape->chart_count = (size_t)chart_count;
    for (size_t i = 0; i < shape->chart_count; i++) {
        GVC_TRY(read_chart(body, &shape->chart[i], i, error));
    }
    if (gvc_cursor_left(cursor)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are left after the last chart",
                        gvc_cursor_left(cursor));
    }
    return GVC_OK;
}

static uint64_t plane_samples(const gvc_config *config) {
    return (uint64_t)config->picture_width * config->plane_height;
}

/** No body is longer (spec 13.3): two varints of at most 10 bytes, and per chart at most 47 + 31 S
 * bytes, which is less than three for each of its S * S samples; charts do not overlap. */
static uint64_t greatest_body(const gvc_config *config) { return 20 + 3 * plane_samples(config); }

uint64_t gvc_shape_record_bytes(const gvc_config *config) {
    /* flags, digests and label; Zstandard may make a body longer by very little */
    return 1024 + greatest_body(config) + greatest_body(config) / 128;
}

/** Bytes that gvc_shape_check takes at a time: the weld of a chart, with what is needed to make it,
 * and the columns of the plane. */
static uint64_t check_memory(const gvc_shape *shape, const gvc_config *config) {
    uint64_t size = 0;
    for (size_t i = 0; i < shape->chart_count; i++) {
        if (shape->chart[i].sides.size > size) size = shape->chart[i].sides.size;
    }
    return size * size * sizeof(uint32_t) + size * 4 * 32 +
           config->picture_width * sizeof(uint32_t) + shape->chart_count * sizeof(void *);
}

uint64_t gvc_shape_record_memory(const gvc_config *config) {
    /* At 16 samples a side the arrays of a chart take 2.7 bytes a sample, and its check 7: the
     * record and its expanded body, this shape and the one before, and the check. */
    return 2 * gvc_shape_record_bytes(config) + (2 * 3 + 7) * plane_samples(config) + 4096;
}

/** Expands the zstd frame that fills [data, data + size) into `*body`, which the caller frees.
 * Nothing is allocated for a size that no body can have. */
static gvc_result expand_body(const uint8_t *data, size_t size, const gvc_config *config,
                              size_t max_memory, uint8_t **body, size_t *body_size,
                              gvc_error *error) {
    unsigned long long expanded = ZSTD_getFrameContentSize(data, size);
    if (expanded == ZSTD_CONTENTSIZE_UNKNOWN || expanded == ZSTD_CONTENTSIZE_ERROR ||
        ZSTD_findFrameCompressedSize(data, size) != size) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the body is not one zstd frame of stated size");
    }
    if (expanded > greatest_body(config)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a body of %llu bytes for planes of %u x %u",
                        expanded, config->picture_width, config->plane_height);
    }
    if (expanded > max_memory) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "a body of %llu bytes; the limit is %zu", expanded,
                        max_memory);
    }
    *body = gvc_alloc((size_t)expanded, 1);
    if (!*body) return gvc_fail_memory(error);
    *body_size = ZSTD_decompress(*body, (size_t)expanded, data, size);
    if (ZSTD_isError(*body_size)) {
        bool memory = ZSTD_getErrorCode(*body_size) == ZSTD_error_memory_allocation;
        return memory
                   ? gvc_fail_memory(error)
                   : gvc_fail(error, GVC_ERROR_CORRUPT, "zstd: %s", ZSTD_getErrorName(*body_size));
    }
    return GVC_OK;
}

static gvc_result read_head(gvc_cursor *cursor, gvc_shape_frame *frame, unsigned *flags,
                            gvc_error *error) {
    *flags = gvc_read_u8(cursor);
    if (*flags & ~GVC_RECORD_KNOWN) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "a shape record with flags 0x%02x", *flags);
    }
    frame->same = *flags & GVC_RECORD_SAME;
    const uint8_t *digest = gvc_read_bytes(cursor, sizeof frame->digest);
    if (digest) memcpy(frame->digest, digest, sizeof frame->digest);
    frame->has_preview = *flags & GVC_RECORD_PREVIEW;
    if (frame->has_preview) {
        digest = gvc_read_bytes(cursor, sizeof frame->preview_digest);
        if (digest) memcpy(frame->preview_digest, digest, sizeof frame->preview_digest);
    }
    if (cursor->failed) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are too few for a shape record",
                        cursor->size);
    }
    if (*flags & GVC_RECORD_NAMED &&
        (!gvc_read_label(cursor, frame->source, sizeof frame->source) ||
         frame->source[0] == '\0')) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "a source's name is empty, too long or not plain UTF-8");
    }
    /* One way to say a thing: "same" has no body that could be packed or trail. */
    if (frame->same && (gvc_cursor_left(cursor) || *flags & GVC_RECORD_ZSTD)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a record that says \"same\" goes on");
    }
    return GVC_OK;
}

gvc_result gvc_shape_record_read(const uint8_t *data, size_t size, const gvc_config *config,
                                 size_t max_memory, gvc_shape *shape, gvc_shape_frame *frame,
                                 gvc_error *error) {
    *shape = (gvc_shape){0};
    *frame = (gvc_shape_frame){0};
    gvc_cursor cursor = gvc_cursor_make(data, size);
    unsigned flags;
    GVC_TRY(read_head(&cursor, frame, &flags, error));
    if (frame->same) return GVC_OK;
    gvc_result result;
    uint8_t *expanded = NULL;
    size_t body_size = gvc_cursor_left(&cursor);
    const uint8_t *body = gvc_read_bytes(&cursor, body_size);
    if (flags & GVC_RECORD_ZSTD) {
        GVC_CHECK(expand_body(body, body_size, config, max_memory, &expanded, &body_size, error));
        body = expanded;
    }
    body_reader reader = {.cursor = gvc_cursor_make(body, body_size),
                          .image_size = config->image_size,
                          .samples = plane_samples(config),
                          .memory = max_memory - (expanded ? body_size : 0)};
    GVC_CHECK(read_body(&reader, shape, error));
    GVC_CHECK(take_memory(&reader, check_memory(shape, config), error));
    GVC_CHECK(gvc_shape_check(shape, config->picture_width, config->plane_height, error));
cleanup:
    free(expanded);
    if (result != GVC_OK) gvc_shape_free(shape);
    return result;
}
