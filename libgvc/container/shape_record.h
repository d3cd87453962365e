/* SPDX-License-Identifier: MIT */
/**
 * @file shape_record.h
 * The shape record: one sample of the shape track per frame. It holds the list of the frame's
 * charts (where each lies in the picture, its affine map, its cut graph and side table, its genus)
 * and the digest of what must come out. A record may say "as in the frame before" for everything
 * but the digest: the first of a fragment may not, and all others of it must.
 */
#ifndef GVC_CONTAINER_SHAPE_RECORD_H
#define GVC_CONTAINER_SHAPE_RECORD_H

#include "chart/side_table.h"
#include "container/config.h"

/* Layout of a record. "varint" is unsigned LEB128 in its shortest form, f64 is IEEE 754 binary64,
 * big-endian; a label is a length (u8) and that many bytes of UTF-8 without control characters.
 *
 *   type        field
 *   u8          flags: 1 same, 2 named, 4 zstd, 8 preview; others 0. "same" excludes "zstd"
 *   u8[8]       digest
 *   u8[8]       digest of the preview            only with "preview"
 *   label       source, 1 to 63 bytes            only with "named"
 *   ...         body, up to the end of the sample; absent with "same". With "zstd" it is one zstd
 *               frame (RFC 8878) with its content size, and the following is what it expands to
 *
 * Body:
 *   varint      segment
 *   varint      chart_count >= 1, then per chart
 *     varint      component = number of the chart, from 0
 *     varint      x, y
 *     varint      size S, 16 .. image_size of gvcC
 *     varint      genus
 *     f64 x 3     origin
 *     f64         step; |origin| + 65535 step does not exceed the greatest float32
 *     varint      node_count = edge_count + 1 - 2 genus
 *     varint      edge_count, 1 .. S - 1
 *     node_count times
 *       u8          kind
 *       varint      feature, below 2^32          only if kind is 1 (extremum)
 *     edge_count times
 *       varint      node[0], node[1] < node_count
 *     varint      start < 4 (S - 1)
 *     edge_count times
 *       varint      steps
 *     2 edge_count times
 *       varint      2 * edge + (1 if reversed)
 *
 * Charts lie in the plane and do not overlap. */

typedef struct gvc_shape_node {
    uint8_t kind;     /**< 0 root, 1 extremum, 2 junction */
    uint32_t feature; /**< extremum number; 0 otherwise */
} gvc_shape_node;

typedef struct gvc_shape_edge {
    uint32_t node[2]; /**< from, to; edge number = index = edge of the side table */
} gvc_shape_edge;

typedef struct gvc_chart_shape {
    uint32_t x, y; /**< top left sample in a plane */
    uint32_t genus;
    double origin[3], step; /**< position = origin + step * code (16-bit code) */
    size_t node_count, edge_count;
    gvc_shape_node *node;
    gvc_shape_edge *edge;
    gvc_side_table sides; /**< size, start, steps, sides */
} gvc_chart_shape;

typedef struct gvc_shape {
    uint64_t segment;   /**< number of the segment, 0-based */
    size_t chart_count; /**< >= 1 */
    gvc_chart_shape *chart;
} gvc_shape;

/** What changes with every frame. */
typedef struct gvc_shape_frame {
    bool same;         /**< charts as in the frame before */
    uint8_t digest[8]; /**< first bytes of the SHA-256 of the welded codes and faces of all charts,
                          one chart after the other: spec 10.3 */
    bool has_preview;  /**< the file has an exact track, which `digest` is of, and H.264 too */
    uint8_t preview_digest[8]; /**< of the frame as its H.264 picture gives it */
    char source[64]; /**< UTF-8 name of the original frame, may be empty; bytes that a label may
                        not hold are written as '?' */
} gvc_shape_frame;

void gvc_shape_free(gvc_shape *shape);
/** True if both describe the same charts to the bit. */
bool gvc_shape_equal(const gvc_shape *a, const gvc_shape *b);

/** Appends one record. With `frame->same`, `shape` is not looked at. Compressed with zstd where
 * that is smaller. */
gvc_result gvc_shape_record_write(const gvc_shape *shape, const gvc_shape_frame *frame,
                                  gvc_buffer *buffer, gvc_error *error);

/** Parses one record of untrusted bytes of a file with this configuration. `max_memory` bounds the
 * what is allocated, `data` not counted (GVC_ERROR_LIMIT). If the record says "same", `shape` stays
 * empty. Checks ranges: counts against bytes left, sizes 16..image_size, node and feature numbers,
 * chart rectangles inside the plane and disjoint, finite origin, step > 0 and finite, node_count -
 * edge_count == 1 - 2 * genus, and that each side table passes gvc_weld_build's rules with the
 * genus declared, and that walking the sides meets the nodes the edges name. */
gvc_result gvc_shape_record_read(const uint8_t *data, size_t size, const gvc_config *config,
                                 size_t max_memory, gvc_shape *shape, gvc_shape_frame *frame,
                                 gvc_error *error);

/** More bytes than a record of a file with this configuration can need: longer ones are refused. */
uint64_t gvc_shape_record_bytes(const gvc_config *config);
/** Bytes that reading records takes at most, the record and the shape read before it included. */
uint64_t gvc_shape_record_memory(const gvc_config *config);

#endif
