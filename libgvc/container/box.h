/* SPDX-License-Identifier: MIT */
/**
 * @file box.h
 * Boxes of ISO/IEC 14496-12 in memory: walking over the children of an untrusted one, and writing
 * nested ones. Nothing here recurses: every parser descends by naming the child it wants.
 */
#ifndef GVC_CONTAINER_BOX_H
#define GVC_CONTAINER_BOX_H

#include "base/bytes.h"
#include "base/result.h"
#include "container/iso.h"

/** One box of a file. `content` is what follows the header (empty while it is not in memory). */
typedef struct gvc_box {
    uint32_t type;
    uint32_t header_size; /**< 8, or 16 with a 64-bit size */
    uint64_t offset;      /**< of the header in the file */
    uint64_t size;        /**< of header and content */
    char path[64];        /**< "moof/traf/trun" */
    gvc_cursor content;
} gvc_box;

/** gvc_fail with the offset and the path of a box. */
gvc_result gvc_box_fail(const gvc_box *box, gvc_error *error, gvc_result code, const char *format,
                        ...) __attribute__((format(printf, 4, 5)));

/** Reads a box header: type, size, header_size. `header` must be at `offset` in the file and may
 * hold fewer than 16 bytes only if the file or parent ends there. GVC_ERROR_CORRUPT for a size
 * smaller than the header and for size 0, GVC_ERROR_TRUNCATED if the header does not fit. Does not
 * look at what is behind the header. `parent` (may be NULL) gives the path. */
gvc_result gvc_box_header(gvc_cursor *header, uint64_t offset, const gvc_box *parent, gvc_box *box,
                          gvc_error *error);

/** Takes the next child out of parent->content; call while gvc_cursor_left() is not 0. */
gvc_result gvc_box_next(gvc_box *parent, gvc_box *child, gvc_error *error);

/** Looks for the children of a type among those not taken yet, without taking any.
 * GVC_ERROR_CORRUPT if there is more than one, or none and `mandatory`; an absent child gets type
 * 0. */
gvc_result gvc_box_find(const gvc_box *parent, uint32_t type, bool mandatory, gvc_box *child,
                        gvc_error *error);

/** Reads version and flags of a FullBox. GVC_ERROR_UNSUPPORTED for a version above `greatest`. */
gvc_result gvc_box_version(gvc_box *box, uint8_t greatest, uint8_t *version, uint32_t *flags,
                           gvc_error *error);

/** GVC_ERROR_CORRUPT if a read went past the end of the box. */
gvc_result gvc_box_check(const gvc_box *box, gvc_error *error);

/** Whether the 16 bytes at `tail` are a gcrc box that holds the CRC-32 of everything up to and
 * including its version and flags; `crc` is that of the bytes before `tail`. */
typedef enum gvc_crc_state { GVC_CRC_ABSENT, GVC_CRC_WRONG, GVC_CRC_RIGHT } gvc_crc_state;
gvc_crc_state gvc_box_check_crc(uint32_t crc, const uint8_t tail[GVC_GCRC_SIZE]);

/** Begins a box; returns its position for gvc_box_end, which patches its 32-bit size. */
size_t gvc_box_begin(gvc_buffer *buffer, uint32_t type);
/** The same for a FullBox. */
size_t gvc_box_begin_full(gvc_buffer *buffer, uint32_t type, uint8_t version, uint32_t flags);
void gvc_box_end(gvc_buffer *buffer, size_t begin);
/** Writes a gcrc box. `crc` is that of the bytes before buffer->data[begin]. */
void gvc_box_write_crc(gvc_buffer *buffer, size_t begin, uint32_t crc);

#endif
