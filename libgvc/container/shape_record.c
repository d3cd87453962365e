/* SPDX-License-Identifier: MIT */
/** @file shape_record.c  Writing shape records. */
#include "container/shape_record.h"

#include "base/memory.h"
#include "container/label.h"
#include "container/shape_layout.h"

#include <stdlib.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Bodies are a few hundred bytes and written once per segment, so the search costs nothing. */
#define ZSTD_LEVEL 19

static void write_graph(const gvc_chart_shape *chart, gvc_buffer *body) {
    gvc_write_varint(body, chart->node_count);
    gvc_write_varint(body, chart->edge_count);
    for (size_t i = 0; i < chart->node_count; i++) {
        gvc_write_u8(body, chart->node[i].kind);
        if (chart->node[i].kind == GVC_NODE_KIND_EXTREMUM) {
            gvc_write_varint(body, chart->node[i].feature);
        }
    }
    for (size_t i = 0; i < chart->edge_count; i++) {
        gvc_write_varint(body, chart->edge[i].node[0]);
        gvc_write_varint(body, chart->edge[i].node[1]);
    }
}

static void write_sides(const gvc_side_table *sides, gvc_buffer *body) {
    gvc_write_varint(body, sides->start);
    for (size_t i = 0; i < sides->edge_count; i++) gvc_write_varint(body, sides->steps[i]);
    for (size_t i = 0; i < sides->side_count; i++) {
        uint64_t edge = sides->side[i].edge;
        gvc_write_varint(body, 2 * edge + (sides->side[i].reversed ? 1 : 0));
    }
}

static void write_body(const gvc_shape *shape, gvc_buffer *body) {
    gvc_write_varint(body, shape->segment);
    gvc_write_varint(body, shape->chart_count);
    for (size_t i = 0; i < shape->chart_count; i++) {
        const gvc_chart_shape *chart = &shape->chart[i];
        gvc_write_varint(body, i); /* component */
        gvc_write_varint(body, chart->x);
        gvc_write_varint(body, chart->y);
        gvc_write_varint(body, chart->sides.size);
        gvc_write_varint(body, chart->genus);
        for (unsigned k = 0; k < 3; k++) gvc_write_f64(body, chart->origin[k]);
        gvc_write_f64(body, chart->step);
        write_graph(chart, body);
        write_sides(&chart->sides, body);
    }
}

/** `*packed` gets the body as one zstd frame; freed by the caller, also after a failure. */
static gvc_result compress_body(const gvc_buffer *body, gvc_buffer *packed, gvc_error *error) {
    size_t bound = ZSTD_compressBound(body->size);
    if (!gvc_grow((void **)&packed->data, &packed->capacity, bound, 1)) {
        return gvc_fail_memory(error);
    }
    size_t size = ZSTD_compress(packed->data, bound, body->data, body->size, ZSTD_LEVEL);
    if (ZSTD_isError(size)) {
        if (ZSTD_getErrorCode(size) == ZSTD_error_memory_allocation) return gvc_fail_memory(error);
        return gvc_fail(error, GVC_ERROR_INTERNAL, "zstd: %s", ZSTD_getErrorName(size));
    }
    packed->size = size;
    return GVC_OK;
}

static void write_head(const gvc_shape_frame *frame, unsigned flags, gvc_buffer *buffer) {
    if (frame->same) flags |= GVC_RECORD_SAME;
    if (frame->source[0]) flags |= GVC_RECORD_NAMED;
    if (frame->has_preview) flags |= GVC_RECORD_PREVIEW;
    gvc_write_u8(buffer, (uint8_t)flags);
    gvc_write_bytes(buffer, frame->digest, sizeof frame->digest);
    if (frame->has_preview) {
        gvc_write_bytes(buffer, frame->preview_digest, sizeof frame->preview_digest);
    }
    if (frame->source[0]) gvc_write_label(buffer, frame->source, sizeof frame->source);
}

gvc_result gvc_shape_record_write(const gvc_shape *shape, const gvc_shape_frame *frame,
                                  gvc_buffer *buffer, gvc_error *error) {
    if (frame->same) {
        write_head(frame, 0, buffer);
        return buffer->failed ? gvc_fail_memory(error) : GVC_OK;
    }
    if (shape->chart_count == 0) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a shape without charts cannot be written");
    }
    gvc_result result = GVC_OK;
    gvc_buffer body = {0}, packed = {0};
    write_body(shape, &body);
    if (body.failed) {
        result = gvc_fail_memory(error);
        goto cleanup;
    }
    GVC_CHECK(compress_body(&body, &packed, error));
    bool smaller = packed.size < body.size;
    const gvc_buffer *chosen = smaller ? &packed : &body;
    write_head(frame, smaller ? GVC_RECORD_ZSTD : 0, buffer);
    gvc_write_bytes(buffer, chosen->data, chosen->size);
    if (buffer->failed) result = gvc_fail_memory(error);
cleanup:
    gvc_buffer_free(&packed);
    gvc_buffer_free(&body);
    return result;
}
