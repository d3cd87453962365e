/* SPDX-License-Identifier: MIT */
/** @file exr_read.c  Geometry images as OpenEXR files: reading, which is of untrusted bytes. */
#include "base/memory.h"
#include "base/utf8.h"
#include "chart/side_table.h"
#include "codec/exr.h"
#include "codec/exr_half.h"

#include <math.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>

/* Four bytes of magic number and four of version and flags, little-endian. */
static const uint8_t plain_file[8] = {0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0};
#define LONG_NAMES 4u /* a flag in byte 5 that says nothing about the image */

/* The library would print to stderr; results say enough. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static int64_t read_at(exr_const_context_t context, void *user, void *data, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    const gvc_cursor *bytes = user;
    if (offset >= bytes->size) return 0;
    if (size > bytes->size - offset) size = bytes->size - offset;
    memcpy(data, bytes->data + offset, (size_t)size);
    return (int64_t)size;
}

static int64_t size_of(exr_const_context_t context, void *user) {
    (void)context;
    return (int64_t)((const gvc_cursor *)user)->size;
}

static gvc_result fail_exr(exr_result_t status, gvc_error *error) {
    if (status == EXR_ERR_OUT_OF_MEMORY) return gvc_fail_memory(error);
    return gvc_fail(error, GVC_ERROR_CORRUPT, "OpenEXR: %s", exr_get_default_error_message(status));
}

/* ----------------------------------------------------------------------------------------- header
 */

/* Before the library sees the bytes: other kinds of files have code of their own there, which an
 * image of ours never needs. */
static gvc_result check_kind(const uint8_t *data, size_t size, gvc_error *error) {
    if (size < sizeof plain_file || memcmp(data, plain_file, 4) != 0) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are no OpenEXR file", size);
    }
    uint8_t kind[4];
    memcpy(kind, data + 4, sizeof kind);
    kind[1] &= (uint8_t)~LONG_NAMES;
    if (memcmp(kind, plain_file + 4, sizeof kind) != 0) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "an OpenEXR file that is tiled, deep, of several parts or of version %u",
                        kind[0]);
    }
    return GVC_OK;
}

/* Passes a text of at most 255 bytes and its zero; false if there is none. An empty one sets
 * `*empty`. */
static bool pass_name(gvc_cursor *in, bool *empty) {
    size_t left = gvc_cursor_left(in);
    const uint8_t *begin = in->data + in->position;
    const uint8_t *zero = memchr(begin, 0, left < 256 ? left : 256);
    if (!zero) return false;
    *empty = zero == begin;
    gvc_skip(in, (size_t)(zero - begin) + 1);
    return true;
}

/* The library reads all attributes into memory, whatever they are: before that, their size. */
static gvc_result check_header(const uint8_t *data, size_t size, gvc_error *error) {
    gvc_cursor in = gvc_cursor_make(data, size);
    gvc_skip(&in, sizeof plain_file);
    for (;;) {
        bool end = false, ignored;
        bool named = pass_name(&in, &end);
        if (named && !end) named = pass_name(&in, &ignored);
        const uint8_t *bytes = named && !end ? gvc_read_bytes(&in, 4) : NULL;
        if (bytes) {
            gvc_skip(&in, (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
                              (uint32_t)bytes[3] << 24);
        }
        if (!named || in.failed) {
            return gvc_fail(error, GVC_ERROR_CORRUPT, "the header of the OpenEXR file is damaged");
        }
        if (in.position > GVC_EXR_MAX_HEADER) {
            return gvc_fail(error, GVC_ERROR_LIMIT,
                            "the header of the OpenEXR file has more than %u bytes",
                            (unsigned)GVC_EXR_MAX_HEADER);
        }
        if (end) return GVC_OK;
    }
}

static bool window_is(const exr_attr_box2i_t *window, uint32_t size) {
    return window->min.x == 0 && window->min.y == 0 && window->max.x == (int32_t)size - 1 &&
           window->max.y == (int32_t)size - 1;
}

static gvc_result check_layout(exr_context_t file, uint32_t size, gvc_error *error) {
    int parts;
    exr_storage_t storage;
    exr_compression_t compression;
    exr_lineorder_t order;
    exr_attr_box2i_t window;
    exr_result_t status = exr_get_count(file, &parts);
    if (!status) status = exr_get_storage(file, 0, &storage);
    if (!status) status = exr_get_compression(file, 0, &compression);
    if (!status) status = exr_get_lineorder(file, 0, &order);
    if (!status) status = exr_get_data_window(file, 0, &window);
    if (status) return fail_exr(status, error);
    if (parts != 1 || storage != EXR_STORAGE_SCANLINE || order != EXR_LINEORDER_INCREASING_Y) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "an OpenEXR file that is not one part of scan lines in increasing order");
    }
    /* PIZ is exact too, but no decoder should need a wavelet and a Huffman coder for these files.
     */
    if (compression != EXR_COMPRESSION_NONE && compression != EXR_COMPRESSION_RLE &&
        compression != EXR_COMPRESSION_ZIPS && compression != EXR_COMPRESSION_ZIP) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                        "an OpenEXR file with compression %d, not none, RLE, ZIPS or ZIP",
                        (int)compression);
    }
    if (!window_is(&window, size)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "the window of the OpenEXR file is not 0 to %u in both directions",
                        size - 1);
    }
    return GVC_OK;
}

static gvc_result check_channels(exr_context_t file, gvc_error *error) {
    const exr_attr_chlist_t *list;
    exr_result_t status = exr_get_channels(file, 0, &list);
    if (status) return fail_exr(status, error);
    bool right = list->num_channels == GVC_EXR_CHANNELS;
    for (unsigned c = 0; right && c < GVC_EXR_CHANNELS; c++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[c];
        right = strcmp(entry->name.str, gvc_exr_channel_name[c]) == 0 &&
                entry->pixel_type == EXR_PIXEL_HALF && entry->x_sampling == 1 &&
                entry->y_sampling == 1;
    }
    if (right) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CORRUPT,
                    "the channels of the OpenEXR file are not X, X.lo, Y, Y.lo, Z, Z.lo of HALF");
}

static gvc_result read_unit(exr_context_t file, gvc_exr_facts *facts, gvc_error *error) {
    int32_t length;
    const char *unit;
    exr_result_t status = exr_attr_get_string(file, 0, GVC_EXR_UNIT_NAME, &length, &unit);
    if (status == EXR_ERR_NO_ATTR_BY_NAME) return GVC_OK;
    if (status) return fail_exr(status, error);
    if (length < 1 || (size_t)length >= sizeof facts->unit ||
        !gvc_utf8_is_plain((const uint8_t *)unit, (size_t)length)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "the unit of the OpenEXR file, %d bytes, is too long or not plain UTF-8",
                        (int)length);
    }
    memcpy(facts->unit, unit, (size_t)length);
    return GVC_OK;
}

static gvc_result read_facts(exr_context_t file, gvc_exr_facts *facts, gvc_error *error) {
    int32_t version;
    exr_attr_v3d_t origin;
    *facts = (gvc_exr_facts){0};
    exr_result_t status = exr_attr_get_int(file, 0, GVC_EXR_VERSION_NAME, &version);
    if (status) return fail_exr(status, error);
    if (version != GVC_EXR_VERSION) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "an OpenEXR file of gvcVersion %d",
                        (int)version);
    }
    status = exr_attr_get_v3d(file, 0, GVC_EXR_ORIGIN_NAME, &origin);
    if (!status) status = exr_attr_get_double(file, 0, GVC_EXR_STEP_NAME, &facts->step);
    if (!status) status = exr_attr_get_double(file, 0, GVC_EXR_TIME_NAME, &facts->time);
    if (status) return fail_exr(status, error);
    memcpy(facts->origin, origin.arr, sizeof facts->origin);
    if (!isfinite(origin.x) || !isfinite(origin.y) || !isfinite(origin.z) ||
        !isfinite(facts->step) || facts->step <= 0 || !isfinite(facts->time)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a number of the OpenEXR file is not finite");
    }
    return read_unit(file, facts, error);
}

/* ----------------------------------------------------------------------------------------- pixels
 */

/* `half` holds rows y ... y + rows - 1 of all channels, one channel after the other. */
static gvc_result take_rows(uint32_t size, uint32_t y, uint32_t rows, const uint16_t *half,
                            uint16_t *codes, gvc_error *error) {
    size_t count = (size_t)rows * size;
    for (unsigned k = 0; k < 3; k++) {
        const uint16_t *high = half + 2 * k * count, *low = high + count;
        uint16_t *code = codes + (size_t)k * size * size + (size_t)y * size;
        for (size_t i = 0; i < count; i++) {
            if (!gvc_exr_code(high[i], low[i], &code[i])) {
                return gvc_fail(error, GVC_ERROR_CORRUPT,
                                "a pixel of the OpenEXR file, in line %u, is no code",
                                (unsigned)(y + i / size));
            }
        }
    }
    return GVC_OK;
}

static exr_result_t read_chunk(exr_context_t file, uint32_t size, uint32_t y, uint32_t rows,
                               exr_decode_pipeline_t *pipeline, uint16_t *half) {
    exr_chunk_info_t chunk;
    exr_result_t status = exr_read_scanline_chunk_info(file, 0, (int)y, &chunk);
    if (status) return status;
    if (chunk.start_y != (int32_t)y || chunk.height != (int32_t)rows ||
        chunk.width != (int32_t)size) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    status = y == 0 ? exr_decoding_initialize(file, 0, &chunk, pipeline)
                    : exr_decoding_update(file, 0, &chunk, pipeline);
    if (status) return status;
    if (pipeline->channel_count != GVC_EXR_CHANNELS) return EXR_ERR_CORRUPT_CHUNK;
    for (unsigned c = 0; c < GVC_EXR_CHANNELS; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        channel->user_pixel_stride = sizeof *half;
        channel->user_line_stride = (int32_t)(size * sizeof *half);
        channel->decode_to_ptr = (uint8_t *)(half + (size_t)c * rows * size);
    }
    if (y == 0) status = exr_decoding_choose_default_routines(file, 0, pipeline);
    return status ? status : exr_decoding_run(file, 0, pipeline);
}

static gvc_result read_pixels(exr_context_t file, uint32_t size, uint16_t *codes,
                              gvc_error *error) {
    int32_t lines;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t status = exr_get_scanlines_per_chunk(file, 0, &lines);
    if (status) return fail_exr(status, error);
    uint16_t *half = gvc_alloc((size_t)lines * size, GVC_EXR_CHANNELS * sizeof *half);
    gvc_result result = half ? GVC_OK : gvc_fail_memory(error);
    for (uint32_t y = 0; result == GVC_OK && y < size; y += (uint32_t)lines) {
        uint32_t rows = size - y < (uint32_t)lines ? size - y : (uint32_t)lines;
        status = read_chunk(file, size, y, rows, &pipeline, half);
        result = status ? fail_exr(status, error) : take_rows(size, y, rows, half, codes, error);
    }
    exr_decoding_destroy(file, &pipeline);
    free(half);
    return result;
}

/* Parses the header; `*file` is to be finished by the caller, on failure too. `bytes` is borrowed.
 */
static gvc_result open_file(gvc_cursor *bytes, exr_context_t *file, gvc_error *error) {
    *file = NULL;
    GVC_TRY(check_kind(bytes->data, bytes->size, error));
    GVC_TRY(check_header(bytes->data, bytes->size, error));
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = keep_quiet;
    init.user_data = bytes;
    init.read_fn = read_at;
    init.size_fn = size_of;
    init.max_image_width = init.max_image_height = (int)GVC_MAX_IMAGE_SIZE;
    init.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t status = exr_start_read(file, "image.exr", &init);
    return status ? fail_exr(status, error) : GVC_OK;
}

gvc_result gvc_exr_read_text(const uint8_t *data, size_t data_size, const char *name,
                             gvc_buffer *text, gvc_error *error) {
    gvc_cursor bytes = gvc_cursor_make(data, data_size);
    exr_context_t file;
    gvc_result result = open_file(&bytes, &file, error);
    if (result == GVC_OK) {
        int32_t length = 0;
        const char *value = NULL;
        exr_result_t status = exr_attr_get_string(file, 0, name, &length, &value);
        if (status == EXR_ERR_OUT_OF_MEMORY) {
            result = gvc_fail_memory(error);
        } else if (status || length < 0) {
            result = gvc_fail(error, GVC_ERROR_CORRUPT,
                              "the OpenEXR file has no attribute %s of text", name);
        } else {
            gvc_write_bytes(text, value, (size_t)length);
            if (text->failed) result = gvc_fail_memory(error);
        }
    }
    if (file) exr_finish(&file);
    return result;
}

gvc_result gvc_exr_decode(const uint8_t *data, size_t data_size, uint32_t size, uint16_t *codes,
                          gvc_exr_facts *facts, gvc_error *error) {
    if (size < GVC_MIN_IMAGE_SIZE || size > GVC_MAX_IMAGE_SIZE) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "no image of %u samples a side", size);
    }
    gvc_cursor bytes = gvc_cursor_make(data, data_size);
    gvc_exr_facts found;
    exr_context_t file;
    gvc_result result = open_file(&bytes, &file, error);
    if (result == GVC_OK) result = check_layout(file, size, error);
    if (result == GVC_OK) result = check_channels(file, error);
    if (result == GVC_OK) result = read_facts(file, &found, error);
    if (result == GVC_OK) result = read_pixels(file, size, codes, error);
    if (file) exr_finish(&file);
    if (result == GVC_OK && facts) *facts = found;
    return result;
}
