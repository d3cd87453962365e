/* SPDX-License-Identifier: MIT */
/** @file group.h  A group of frames: pictures waiting to be coded as one fragment. */
#ifndef GVC_ENCODE_GROUP_H
#define GVC_ENCODE_GROUP_H

#include "codec/h264.h"
#include "container/writer.h"
#include "encode/segment.h"

typedef struct gvc_group_frame {
    uint16_t *luma;    /**< picture to be coded */
    uint16_t *decoded; /**< picture that comes out of the decoder; NULL until coded */
} gvc_group_frame;

typedef struct gvc_group {
    const gvc_segment *segment; /**< borrowed */
    gvc_picture_layout layout;
    uint64_t first_frame;
    size_t count, capacity;
    gvc_group_frame *frame;
    gvc_shape shape; /**< what its shape records say */
    gvc_coded_group coded;
} gvc_group;

gvc_result gvc_group_create(size_t capacity, gvc_picture_layout layout, gvc_group *group,
                            gvc_error *error);
/** Makes it empty again, keeps the room for frames. */
void gvc_group_clear(gvc_group *group);
void gvc_group_free(gvc_group *group);

/** Codes the pictures at a rate factor and decodes them again, so that group->coded and `decoded`
 * are set. */
gvc_result gvc_group_code(gvc_group *group, const gvc_encode_options *options, double crf,
                          gvc_error *error);

/** Writes the coded group as one fragment, with shape records and digests of the decoded frames. */
gvc_result gvc_group_write(gvc_group *group, const gvc_source *source, gvc_writer *writer,
                           gvc_error *error);

#endif
