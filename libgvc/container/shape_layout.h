/* SPDX-License-Identifier: MIT */
/** @file shape_layout.h  What writer and reader of shape records share. */
#ifndef GVC_CONTAINER_SHAPE_LAYOUT_H
#define GVC_CONTAINER_SHAPE_LAYOUT_H

#include "container/shape_record.h"

/* Bits of the first byte of a record. */
#define GVC_RECORD_SAME 0x01u    /**< no body: charts as in the frame before */
#define GVC_RECORD_NAMED 0x02u   /**< a label with the source's name follows the digest */
#define GVC_RECORD_ZSTD 0x04u    /**< the body is one zstd frame */
#define GVC_RECORD_PREVIEW 0x08u /**< a second digest, that of the preview, follows the first */
#define GVC_RECORD_KNOWN 0x0fu

#define GVC_NODE_KINDS 3u
#define GVC_NODE_KIND_EXTREMUM 1u

/** Least bytes of a chart in a body: six varints before the affine map and two after it, four
 * binary64, one node, one edge with its steps and two sides. */
#define GVC_MIN_CHART_BYTES (8u + 32u + 1u + 5u)

/** The rules for whole shapes; those for single fields are checked while parsing. Rectangles inside
 * the plane and disjoint, decodable side tables of the genus declared, sides that walk along the
 * graph. GVC_ERROR_CORRUPT names the first chart that breaks one. */
gvc_result gvc_shape_check(const gvc_shape *shape, uint32_t plane_width, uint32_t plane_height,
                           gvc_error *error);

#endif
