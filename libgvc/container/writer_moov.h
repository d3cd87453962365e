/* SPDX-License-Identifier: MIT */
/** @file writer_moov.h  The head of a file. */
#ifndef GVC_CONTAINER_WRITER_MOOV_H
#define GVC_CONTAINER_WRITER_MOOV_H

#include "container/config.h"

/* Track numbers as this writer gives them; a reader takes any. */
#define GVC_GEOMETRY_TRACK 1u
#define GVC_SHAPE_TRACK 2u
#define GVC_EXACT_TRACK 3u

/** Frames by which the geometry track is shown later than its composition offsets alone would ask
 * for; the edit list takes them back. Pictures that are shown before they are decoded would need
 * negative offsets, which are legal, but players built on libavformat then begin late and repeat
 * the first frame. Two covers the reordering of B-pictures that H.264 encoders do; a group that
 * needs more still gets negative offsets. */
#define GVC_SHOWN_LATER 2u

/** Appends ftyp and moov to an empty buffer. `avc_config` is the content of avcC; NULL: there is no
 * geometry track. There is an exact track if config->features say so. */
void gvc_write_head(const gvc_config *config, const uint8_t *avc_config, size_t avc_config_size,
                    gvc_buffer *buffer);

#endif
