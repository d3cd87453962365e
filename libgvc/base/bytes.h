/* SPDX-License-Identifier: MIT */
/**
 * @file bytes.h
 * The only way untrusted bytes are read and file bytes are put together: a bounded cursor with a
 * sticky failure flag, and a growing buffer with a sticky out-of-memory flag. Big-endian unless
 * named otherwise (ISO/IEC 14496-12 4.2).
 */
#ifndef GVC_BASE_BYTES_H
#define GVC_BASE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Cursor over borrowed bytes. After a read past the end `failed` is set, every further read gives
 *  0 or NULL and the position stays. */
typedef struct gvc_cursor {
    const uint8_t *data;
    size_t size, position;
    bool failed;
} gvc_cursor;

gvc_cursor gvc_cursor_make(const void *data, size_t size);
size_t gvc_cursor_left(const gvc_cursor *cursor);
uint8_t gvc_read_u8(gvc_cursor *cursor);
uint16_t gvc_read_u16(gvc_cursor *cursor);
uint32_t gvc_read_u24(gvc_cursor *cursor);
uint32_t gvc_read_u32(gvc_cursor *cursor);
uint64_t gvc_read_u64(gvc_cursor *cursor);
/** IEEE 754 binary64, big-endian. */
double gvc_read_f64(gvc_cursor *cursor);
/** Unsigned LEB128, at most 64 bits; non-minimal encodings fail. */
uint64_t gvc_read_varint(gvc_cursor *cursor);
/** Pointer to `size` bytes inside the borrowed data, or NULL. */
const uint8_t *gvc_read_bytes(gvc_cursor *cursor, size_t size);
/** Cursor over the next `size` bytes, which are skipped here. */
gvc_cursor gvc_read_sub(gvc_cursor *cursor, size_t size);
void gvc_skip(gvc_cursor *cursor, size_t size);

/** Growing byte buffer; free with gvc_buffer_free. */
typedef struct gvc_buffer {
    uint8_t *data;
    size_t size, capacity;
    bool failed; /**< memory ran out; contents are then meaningless */
} gvc_buffer;

void gvc_buffer_free(gvc_buffer *buffer);
/** Empties the buffer, keeps its memory, clears `failed`. */
void gvc_buffer_clear(gvc_buffer *buffer);
void gvc_write_u8(gvc_buffer *buffer, uint8_t value);
void gvc_write_u16(gvc_buffer *buffer, uint16_t value);
void gvc_write_u24(gvc_buffer *buffer, uint32_t value);
void gvc_write_u32(gvc_buffer *buffer, uint32_t value);
void gvc_write_u64(gvc_buffer *buffer, uint64_t value);
void gvc_write_f64(gvc_buffer *buffer, double value);
void gvc_write_varint(gvc_buffer *buffer, uint64_t value);
void gvc_write_bytes(gvc_buffer *buffer, const void *data, size_t size);
/** Overwrites four bytes written earlier at `position`. */
void gvc_patch_u32(gvc_buffer *buffer, size_t position, uint32_t value);

#endif
