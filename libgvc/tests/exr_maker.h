/* SPDX-License-Identifier: MIT */
/** @file exr_maker.h  OpenEXR files put together byte by byte, right or wrong, and a reader of
 * those gvc writes: from the description of the format, without the library. Little-endian. */
#ifndef GVC_TESTS_EXR_MAKER_H
#define GVC_TESTS_EXR_MAKER_H

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "base/bytes.h"

static inline void exr_u16(gvc_buffer *out, uint32_t value) {
    gvc_write_u8(out, (uint8_t)value);
    gvc_write_u8(out, (uint8_t)(value >> 8));
}

static inline void exr_u32(gvc_buffer *out, uint32_t value) {
    exr_u16(out, value);
    exr_u16(out, value >> 16);
}

static inline void exr_f64(gvc_buffer *out, double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    exr_u32(out, (uint32_t)bits);
    exr_u32(out, (uint32_t)(bits >> 32));
}

static inline void exr_text(gvc_buffer *out, const char *text) {
    gvc_write_bytes(out, text, strlen(text) + 1);
}

static inline void exr_attribute(gvc_buffer *out, const char *name, const char *type,
                                 uint32_t size) {
    exr_text(out, name);
    exr_text(out, type);
    exr_u32(out, size);
}

/** What a file says; exr_plain() gives one that is right. */
typedef struct exr_plan {
    uint32_t size, flags, compression, order, pixel_type, sampling, version;
    uint32_t first;      /**< of both windows, in both directions */
    const char *name[6]; /**< channels */
    unsigned channels;
    double origin, step, time;
    const char *unit;            /**< NULL: none */
    bool extra;                  /**< one more attribute */
    const char *without;         /**< an attribute of gvc's to leave out, or NULL */
    uint16_t high, low;          /**< HALFs of all pixels */
    uint32_t chunk_y, chunk_gap; /**< added to the line, and to the place, of the second chunk */
} exr_plan;

static inline exr_plan exr_plain(void) {
    return (exr_plan){.size = 16,
                      .flags = 2,
                      .pixel_type = 1,
                      .sampling = 1,
                      .name = {"X", "X.lo", "Y", "Y.lo", "Z", "Z.lo"},
                      .channels = 6,
                      .origin = 0.5,
                      .step = 0.25,
                      .time = 2,
                      .high = 0x3800,
                      .low = 0x3803};
}

static inline bool exr_wanted(const exr_plan *plan, const char *name) {
    return !plan->without || strcmp(plan->without, name) != 0;
}

static inline void exr_head(const exr_plan *plan, gvc_buffer *out) {
    uint32_t channel_bytes = 1;
    exr_u32(out, 20000630);
    exr_u32(out, plan->flags);
    for (unsigned c = 0; c < plan->channels; c++) {
        channel_bytes += (uint32_t)strlen(plan->name[c]) + 17;
    }
    exr_attribute(out, "channels", "chlist", channel_bytes);
    for (unsigned c = 0; c < plan->channels; c++) {
        exr_text(out, plan->name[c]);
        exr_u32(out, plan->pixel_type);
        exr_u32(out, 0);
        exr_u32(out, plan->sampling);
        exr_u32(out, plan->sampling);
    }
    gvc_write_u8(out, 0);
    exr_attribute(out, "compression", "compression", 1);
    gvc_write_u8(out, (uint8_t)plan->compression);
    for (unsigned i = 0; i < 2; i++) {
        exr_attribute(out, i ? "displayWindow" : "dataWindow", "box2i", 16);
        for (unsigned j = 0; j < 4; j++) exr_u32(out, plan->first + (j < 2 ? 0 : plan->size - 1));
    }
    exr_attribute(out, "lineOrder", "lineOrder", 1);
    gvc_write_u8(out, (uint8_t)plan->order);
    exr_attribute(out, "pixelAspectRatio", "float", 4);
    exr_u32(out, 0x3f800000);
    exr_attribute(out, "screenWindowCenter", "v2f", 8);
    exr_u32(out, 0);
    exr_u32(out, 0);
    exr_attribute(out, "screenWindowWidth", "float", 4);
    exr_u32(out, 0x3f800000);
}

static inline void exr_facts(const exr_plan *plan, gvc_buffer *out) {
    if (exr_wanted(plan, "gvcVersion")) {
        exr_attribute(out, "gvcVersion", "int", 4);
        exr_u32(out, plan->version);
    }
    if (exr_wanted(plan, "gvcOrigin")) {
        exr_attribute(out, "gvcOrigin", "v3d", 24);
        for (unsigned k = 0; k < 3; k++) exr_f64(out, plan->origin + k);
    }
    if (exr_wanted(plan, "gvcStep")) {
        exr_attribute(out, "gvcStep", "double", 8);
        exr_f64(out, plan->step);
    }
    if (exr_wanted(plan, "gvcTime")) {
        exr_attribute(out, "gvcTime", "double", 8);
        exr_f64(out, plan->time);
    }
    if (plan->unit) {
        exr_attribute(out, "gvcUnit", "string", (uint32_t)strlen(plan->unit));
        gvc_write_bytes(out, plan->unit, strlen(plan->unit));
    }
    if (plan->extra) {
        exr_attribute(out, "owner", "string", 2);
        gvc_write_bytes(out, "me", 2);
    }
    gvc_write_u8(out, 0);
}

/** The whole file, chunks of one line, not compressed. */
static inline gvc_buffer exr_make(const exr_plan *plan) {
    gvc_buffer out = {0};
    exr_head(plan, &out);
    exr_facts(plan, &out);
    uint32_t line = 2 * plan->channels * plan->size, table = 8 * plan->size;
    size_t pixels = out.size + table;
    for (uint32_t y = 0; y < plan->size; y++) {
        exr_u32(&out, (uint32_t)pixels + y * (8 + line) + (y == 1 ? plan->chunk_gap : 0));
        exr_u32(&out, 0);
    }
    for (uint32_t y = 0; y < plan->size; y++) {
        exr_u32(&out, plan->first + y + (y == 1 ? plan->chunk_y : 0));
        exr_u32(&out, line);
        for (unsigned c = 0; c < plan->channels; c++) {
            for (uint32_t x = 0; x < plan->size; x++) exr_u16(&out, c % 2 ? plan->low : plan->high);
        }
    }
    return out;
}

/* ------------------------------------------------------------------------------------------ reader
 */

static inline uint32_t exr_get(const uint8_t *data, unsigned bytes) {
    uint32_t value = 0;
    for (unsigned i = bytes; i-- > 0;) value = value << 8 | data[i];
    return value;
}

/** Value of an attribute, or NULL; `end` is set to what follows the header. */
static inline const uint8_t *exr_find(const uint8_t *file, const char *name, const uint8_t **end) {
    const uint8_t *at = file + 8, *found = NULL;
    while (*at) {
        const char *here = (const char *)at;
        at += strlen(here) + 1;
        at += strlen((const char *)at) + 1;
        if (strcmp(here, name) == 0) found = at + 4;
        at += 4 + exr_get(at, 4);
    }
    *end = at + 1;
    return found;
}

/** A chunk that ZIP left: deflate, differences of bytes, the two halves of the bytes interleaved.
 */
static inline void exr_unzip(const uint8_t *data, uint32_t size, uint8_t *bytes, size_t count) {
    uint8_t *packed = malloc(count);
    uLongf got = (uLongf)count;
    if (!packed || uncompress(packed, &got, data, size) != Z_OK || got != count) abort();
    for (size_t i = 1; i < count; i++) packed[i] = (uint8_t)(packed[i - 1] + packed[i] - 128);
    for (size_t i = 0; i < count; i++) bytes[i] = packed[i % 2 ? (count + 1) / 2 + i / 2 : i / 2];
    free(packed);
}

/** The HALF of channel c (0 .. 5) at (x, y) of a file with ZIP compression. */
static inline uint16_t *exr_halves(const uint8_t *file, uint32_t size) {
    const uint8_t *table;
    exr_find(file, "", &table);
    uint16_t *half = malloc(6 * (size_t)size * size * sizeof *half);
    uint8_t *bytes = malloc(16 * 12 * (size_t)size);
    if (!half || !bytes) abort();
    for (uint32_t y = 0; y < size; y += 16, table += 8) {
        const uint8_t *chunk = file + exr_get(table, 4);
        uint32_t rows = size - y < 16 ? size - y : 16, packed = exr_get(chunk + 4, 4);
        if (exr_get(chunk, 4) != y) abort();
        if (packed == rows * 12 * size) {
            memcpy(bytes, chunk + 8, packed); /* ZIP gave nothing */
        } else {
            exr_unzip(chunk + 8, packed, bytes, (size_t)rows * 12 * size);
        }
        for (uint32_t i = 0; i < rows * 6 * size; i++) {
            uint32_t v = i / (6 * size), c = i / size % 6, x = i % size;
            half[((size_t)c * size + y + v) * size + x] = (uint16_t)exr_get(bytes + 2 * i, 2);
        }
    }
    free(bytes);
    return half;
}

#endif
