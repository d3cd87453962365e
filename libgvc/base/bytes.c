/* SPDX-License-Identifier: MIT */
/** @file bytes.c  Bounded cursor and growing buffer. */
#include "base/bytes.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

gvc_cursor gvc_cursor_make(const void *data, size_t size) {
    return (gvc_cursor){.data = data, .size = size};
}

size_t gvc_cursor_left(const gvc_cursor *cursor) { return cursor->size - cursor->position; }

const uint8_t *gvc_read_bytes(gvc_cursor *cursor, size_t size) {
    if (cursor->failed || size > gvc_cursor_left(cursor)) {
        cursor->failed = true;
        return NULL;
    }
    const uint8_t *bytes = cursor->data + cursor->position;
    cursor->position += size;
    return bytes;
}

void gvc_skip(gvc_cursor *cursor, size_t size) { (void)gvc_read_bytes(cursor, size); }

gvc_cursor gvc_read_sub(gvc_cursor *cursor, size_t size) {
    const uint8_t *bytes = gvc_read_bytes(cursor, size);
    gvc_cursor sub = gvc_cursor_make(bytes, bytes ? size : 0);
    sub.failed = bytes == NULL;
    return sub;
}

static uint64_t read_big_endian(gvc_cursor *cursor, size_t size) {
    const uint8_t *bytes = gvc_read_bytes(cursor, size);
    uint64_t value = 0;
    for (size_t i = 0; bytes && i < size; i++) value = value << 8 | bytes[i];
    return value;
}

uint8_t gvc_read_u8(gvc_cursor *cursor) { return (uint8_t)read_big_endian(cursor, 1); }
uint16_t gvc_read_u16(gvc_cursor *cursor) { return (uint16_t)read_big_endian(cursor, 2); }
uint32_t gvc_read_u24(gvc_cursor *cursor) { return (uint32_t)read_big_endian(cursor, 3); }
uint32_t gvc_read_u32(gvc_cursor *cursor) { return (uint32_t)read_big_endian(cursor, 4); }
uint64_t gvc_read_u64(gvc_cursor *cursor) { return read_big_endian(cursor, 8); }

double gvc_read_f64(gvc_cursor *cursor) {
    uint64_t bits = gvc_read_u64(cursor);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

uint64_t gvc_read_varint(gvc_cursor *cursor) {
    uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
        uint8_t byte = gvc_read_u8(cursor);
        if (cursor->failed) return 0;
        bool overflows = shift == 63 && byte > 1;
        bool not_minimal = shift > 0 && byte == 0;
        if (overflows || not_minimal) break;
        value |= (uint64_t)(byte & 0x7f) << shift;
        if (!(byte & 0x80)) return value;
    }
    cursor->failed = true;
    return 0;
}

void gvc_buffer_free(gvc_buffer *buffer) {
    free(buffer->data);
    *buffer = (gvc_buffer){0};
}

void gvc_buffer_clear(gvc_buffer *buffer) {
    buffer->size = 0;
    buffer->failed = false;
}

void gvc_write_bytes(gvc_buffer *buffer, const void *data, size_t size) {
    size_t needed;
    if (buffer->failed || !gvc_add(buffer->size, size, &needed) ||
        !gvc_grow((void **)&buffer->data, &buffer->capacity, needed, 1)) {
        buffer->failed = true;
        return;
    }
    if (size) memcpy(buffer->data + buffer->size, data, size);
    buffer->size = needed;
}

static void write_big_endian(gvc_buffer *buffer, uint64_t value, size_t size) {
    uint8_t bytes[8];
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(value >> 8 * (size - 1 - i));
    gvc_write_bytes(buffer, bytes, size);
}

void gvc_write_u8(gvc_buffer *buffer, uint8_t value) { write_big_endian(buffer, value, 1); }
void gvc_write_u16(gvc_buffer *buffer, uint16_t value) { write_big_endian(buffer, value, 2); }
void gvc_write_u24(gvc_buffer *buffer, uint32_t value) { write_big_endian(buffer, value, 3); }
void gvc_write_u32(gvc_buffer *buffer, uint32_t value) { write_big_endian(buffer, value, 4); }
void gvc_write_u64(gvc_buffer *buffer, uint64_t value) { write_big_endian(buffer, value, 8); }

void gvc_write_f64(gvc_buffer *buffer, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    gvc_write_u64(buffer, bits);
}

void gvc_write_varint(gvc_buffer *buffer, uint64_t value) {
    while (value >= 0x80) {
        gvc_write_u8(buffer, (uint8_t)(value | 0x80));
        value >>= 7;
    }
    gvc_write_u8(buffer, (uint8_t)value);
}

void gvc_patch_u32(gvc_buffer *buffer, size_t position, uint32_t value) {
    if (buffer->failed || buffer->size < 4 || position > buffer->size - 4) return;
    for (size_t i = 0; i < 4; i++) buffer->data[position + i] = (uint8_t)(value >> 8 * (3 - i));
}
