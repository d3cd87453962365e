/* SPDX-License-Identifier: MIT */
/** @file group.h  A group of frames: images waiting to be coded as one fragment. */
#ifndef GVC_ENCODE_GROUP_H
#define GVC_ENCODE_GROUP_H

#include "codec/h264.h"
#include "container/writer.h"
#include "encode/segment.h"

typedef struct gvc_group_frame {
    uint16_t *luma;    /**< picture to be coded; NULL without video */
    uint16_t *decoded; /**< picture that comes out of the decoder; NULL until coded */
    uint16_t *codes;   /**< 3 planes of 16-bit codes to be kept exactly; NULL if not exact */
    gvc_buffer exact;  /**< these, coded (exact.h) */
} gvc_group_frame;

typedef struct gvc_group {
    const gvc_segment *segment; /**< borrowed */
    bool video;                 /**< code pictures with H.264 */
    bool exact;                 /**< code exact images */
    gvc_picture_layout layout;
    uint64_t first_frame;
    size_t count, capacity;
    gvc_group_frame *frame;
    gvc_shape shape; /**< what its shape records say */
    gvc_coded_group coded;
} gvc_group;

/** Of video only, until told otherwise. */
gvc_result gvc_group_create(size_t capacity, gvc_picture_layout layout, gvc_group *group,
                            gvc_error *error);
/** Makes it empty again, keeps the room for frames. */
void gvc_group_clear(gvc_group *group);
void gvc_group_free(gvc_group *group);

/** Codes the pictures at a rate factor and decodes them again, so that group->coded and `decoded`
 * are set. */
gvc_result gvc_group_code(gvc_group *group, const gvc_encode_options *options, double crf,
                          gvc_error *error);

/** What decodes to the codes of a chart. */
typedef enum gvc_code_source { GVC_CODES_VIDEO, GVC_CODES_EXACT } gvc_code_source;

/** The codes of a frame, 3 planes of size * size, as its decoded picture or the exact track gives
 * them. `plane` has room for them. */
void gvc_group_plane(const gvc_group *group, size_t index, gvc_code_source from, uint16_t *plane);

/** Writes the coded group as one fragment, with shape records and digests of the decoded frames. */
gvc_result gvc_group_write(gvc_group *group, const gvc_source *source, gvc_writer *writer,
                           gvc_error *error);

#endif
