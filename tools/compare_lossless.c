/* SPDX-License-Identifier: MIT */
/** @file compare_lossless.c  What exact geometry images cost, and what they would cost otherwise.
 */
#include "compare_lossless.h"

#include "base/memory.h"
#include "base/result.h"
#include "chart/side_table.h"
#include "codec/exr.h"
#include "compare_clock.h"
#include "encode/tap.h"
#include "file.h"

#include <errno.h>
#include <lzma.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zstd.h>

#define ZSTD_LEVEL 19
#define XZ_LEVEL 9
#define MAX_WINDOW_BITS 27 /* of zstd, as every decoder takes it */

enum { ROW_GVC, ROW_UNQUANTISED, ROW_EXR_ZIP, ROW_EXR_PIZ, ROW_ZSTD, ROW_XZ };

typedef struct lossless_run {
    const gvc_source *source;
    const compare_options *options;
    FILE *images; /* one after the other: 3 planes of doubles each */
    uint32_t size;
    gvc_buffer file;
    gvc_reader *reader;
    gvc_decoder *decoder;
    gvc_buffer raw; /* codes of the group at hand */
    compare_row *row;
} lossless_run;

/* ------------------------------------------------------------------------------------ encoding */

/* Images are kept in a file: a capture need not fit into memory. Called from several threads. */
static gvc_result keep_image(void *user, uint64_t frame, const double *image, uint32_t size,
                             gvc_error *error) {
    lossless_run *run = user;
    size_t bytes = 3 * sizeof *image * size * size, done = 0;
    while (done < bytes) {
        ssize_t put = pwrite(fileno(run->images), (const char *)image + done, bytes - done,
                             (off_t)(frame * bytes + done));
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) {
            return gvc_fail(error, GVC_ERROR_IO, "cannot keep an image: %s", strerror(errno));
        }
        done += (size_t)put;
    }
    return GVC_OK;
}

static gvc_result encode_tapped(void *user, const gvc_source *source, const gvc_sink *sink,
                                const gvc_encode_options *options, gvc_error *error) {
    lossless_run *run = user;
    gvc_image_tap tap = {.user = run, .image = keep_image};
    gvc_encode_report report;
    GVC_TRY(gvc_encode_tapped(source, sink, options, &tap, &report, error));
    run->size = report.image_size;
    return GVC_OK;
}

static gvc_result measure_file(lossless_run *run, const gvc_encode_options *encode,
                               gvc_error *error) {
    uint64_t count = run->source->frame_count;
    double seconds;
    compare_frame *frames = gvc_alloc((size_t)count, sizeof *frames);
    if (!frames) return gvc_fail_memory(error);
    gvc_result result =
        compare_encode(run->source, encode, encode_tapped, run, &run->file, &seconds, error);
    if (result == GVC_OK) {
        result = compare_decode(run->source, &run->file, run->options, frames, error);
    }
    if (result == GVC_OK) {
        compare_row *row = &run->row[ROW_GVC];
        compare_summarise("gvc lossless", frames, count, row);
        row->bytes = (double)run->file.size / (double)count;
        row->encode_seconds = seconds / (double)count;
    }
    free(frames);
    return result;
}

/* ---------------------------------------------------------------------------------- unquantised */

static gvc_result read_image(const lossless_run *run, uint64_t frame, double *image,
                             gvc_error *error) {
    size_t bytes = 3 * sizeof *image * run->size * run->size, done = 0;
    while (done < bytes) {
        ssize_t got = pread(fileno(run->images), (char *)image + done, bytes - done,
                            (off_t)(frame * bytes + done));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return gvc_fail(error, GVC_ERROR_IO, "cannot read an image back");
        done += (size_t)got;
    }
    return GVC_OK;
}

/* The decoded mesh with its vertices where they were before rounding. */
static gvc_result unquantise(const lossless_run *run, uint64_t frame, const gvc_mesh *decoded,
                             gvc_mesh **mesh, gvc_error *error) {
    size_t fragment, samples = (size_t)run->size * run->size;
    size_t vertices = gvc_mesh_vertex_count(decoded);
    gvc_shape shape = {0};
    gvc_weld weld = {0};
    double *image = gvc_alloc(samples, 3 * sizeof *image);
    double *position = gvc_alloc(vertices, 3 * sizeof *position);
    gvc_result result = image && position ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_reader_find(run->reader, frame, &fragment, error);
    if (result == GVC_OK) result = gvc_reader_shape(run->reader, fragment, &shape, error);
    if (result == GVC_OK) result = gvc_weld_build(&shape.chart[0].sides, &weld, error);
    if (result == GVC_OK) result = read_image(run, frame, image, error);
    for (size_t i = 0; result == GVC_OK && i < samples; i++) { /* twins are equal */
        for (size_t k = 0; k < 3; k++) {
            position[3 * (size_t)weld.vertex[i] + k] = image[k * samples + i];
        }
    }
    if (result == GVC_OK) {
        result = gvc_mesh_create(position, vertices, gvc_mesh_faces(decoded),
                                 gvc_mesh_face_count(decoded), mesh, error);
    }
    gvc_weld_free(&weld);
    gvc_shape_free(&shape);
    free(image);
    free(position);
    return result;
}

static gvc_result measure_unquantised_frame(const lossless_run *run, uint64_t frame,
                                            compare_frame *measured, gvc_error *error) {
    gvc_mesh *original = NULL, *decoded = NULL, *mesh = NULL;
    gvc_result result = run->source->read(run->source->user, frame, &original, error);
    if (result == GVC_OK) result = gvc_decoder_frame(run->decoder, frame, &decoded, error);
    if (result == GVC_OK) result = unquantise(run, frame, decoded, &mesh, error);
    if (result == GVC_OK) {
        result = compare_measure(original, mesh, run->options->samples, measured, error);
    }
    gvc_mesh_destroy(&original);
    gvc_mesh_destroy(&decoded);
    gvc_mesh_destroy(&mesh);
    return gvc_at_frame(error, result, (int64_t)frame);
}

static gvc_result measure_unquantised(const lossless_run *run, gvc_error *error) {
    uint64_t count = run->source->frame_count;
    compare_frame *frames = gvc_alloc((size_t)count, sizeof *frames);
    if (!frames) return gvc_fail_memory(error);
    gvc_result result = GVC_OK;
    for (uint64_t f = 0; result == GVC_OK && f < count; f++) {
        result = measure_unquantised_frame(run, f, &frames[f], error);
    }
    if (result == GVC_OK) {
        compare_row *row = &run->row[ROW_UNQUANTISED];
        compare_summarise("before rounding", frames, count, row);
        row->bytes = row->encode_seconds = row->decode_seconds = NAN;
    }
    free(frames);
    return result;
}

/* --------------------------------------------------------------------------------------- rivals */

/* Adds size and time of one OpenEXR file to its row. */
static gvc_result add_exr(const uint16_t *codes, uint32_t size, bool piz, compare_row *row,
                          gvc_error *error) {
    const gvc_exr_facts facts = {.step = 1};
    const gvc_exr_options options = {.piz = piz};
    gvc_buffer bytes = {0};
    double begin = compare_process_seconds();
    gvc_result result = gvc_exr_encode_with(size, codes, &facts, &options, &bytes, error);
    row->encode_seconds += compare_process_seconds() - begin;
    row->bytes += (double)bytes.size;
    gvc_buffer_free(&bytes);
    return result;
}

static gvc_result add_zstd(const gvc_buffer *raw, gvc_buffer *room, compare_row *row,
                           gvc_error *error) {
    ZSTD_CCtx *context = ZSTD_createCCtx();
    if (!context) return gvc_fail_memory(error);
    double begin = compare_process_seconds();
    size_t size = ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, ZSTD_LEVEL);
    if (!ZSTD_isError(size)) {
        size = ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, MAX_WINDOW_BITS);
    }
    if (!ZSTD_isError(size)) {
        size = ZSTD_compress2(context, room->data, room->capacity, raw->data, raw->size);
    }
    ZSTD_freeCCtx(context);
    if (ZSTD_isError(size)) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "zstd: %s", ZSTD_getErrorName(size));
    }
    row->encode_seconds += compare_process_seconds() - begin;
    row->bytes += (double)size;
    return GVC_OK;
}

static gvc_result add_xz(const gvc_buffer *raw, gvc_buffer *room, compare_row *row,
                         gvc_error *error) {
    size_t size = 0;
    double begin = compare_process_seconds();
    lzma_ret status = lzma_easy_buffer_encode(XZ_LEVEL, LZMA_CHECK_CRC32, NULL, raw->data,
                                              raw->size, room->data, &size, room->capacity);
    if (status == LZMA_MEM_ERROR) return gvc_fail_memory(error);
    if (status != LZMA_OK) return gvc_fail(error, GVC_ERROR_INTERNAL, "xz: error %d", (int)status);
    row->encode_seconds += compare_process_seconds() - begin;
    row->bytes += (double)size;
    return GVC_OK;
}

/* Compresses the codes of the group that has just ended. */
static gvc_result end_group(lossless_run *run, gvc_error *error) {
    gvc_buffer room = {0};
    if (run->raw.failed) return gvc_fail_memory(error);
    if (run->raw.size == 0) return GVC_OK;
    size_t zstd = ZSTD_compressBound(run->raw.size);
    size_t xz = lzma_stream_buffer_bound(run->raw.size);
    if (!gvc_grow((void **)&room.data, &room.capacity, zstd > xz ? zstd : xz, 1)) {
        return gvc_fail_memory(error);
    }
    gvc_result result = add_zstd(&run->raw, &room, &run->row[ROW_ZSTD], error);
    if (result == GVC_OK) result = add_xz(&run->raw, &room, &run->row[ROW_XZ], error);
    gvc_buffer_free(&room);
    gvc_buffer_clear(&run->raw);
    return result;
}

static gvc_result add_frame(lossless_run *run, uint64_t frame, gvc_error *error) {
    const uint16_t *codes;
    uint32_t size;
    gvc_frame_info info;
    GVC_TRY(gvc_reader_frame_info(run->reader, frame, &info, error));
    if (info.keyframe) GVC_TRY(end_group(run, error));
    GVC_TRY(gvc_decoder_codes(run->decoder, frame, 0, &codes, &size, error));
    GVC_TRY(add_exr(codes, size, false, &run->row[ROW_EXR_ZIP], error));
    GVC_TRY(add_exr(codes, size, true, &run->row[ROW_EXR_PIZ], error));
    for (size_t i = 0; i < (size_t)3 * size * size; i++) {
        gvc_write_u8(&run->raw, (uint8_t)codes[i]);
        gvc_write_u8(&run->raw, (uint8_t)(codes[i] >> 8));
    }
    return GVC_OK;
}

static gvc_result measure_rivals(lossless_run *run, gvc_error *error) {
    static const char *const method[COMPARE_LOSSLESS_ROWS] = {
        NULL, NULL, "OpenEXR, ZIP", "OpenEXR, PIZ", "zstd -19 of codes", "xz -9 of codes"};
    uint64_t count = run->source->frame_count;
    for (size_t r = ROW_EXR_ZIP; r < COMPARE_LOSSLESS_ROWS; r++) {
        run->row[r] = run->row[ROW_GVC]; /* the same codes, the same errors */
        run->row[r].bytes = run->row[r].encode_seconds = 0;
        run->row[r].decode_seconds = NAN;
        snprintf(run->row[r].method, sizeof run->row[r].method, "%s", method[r]);
    }
    for (uint64_t f = 0; f < count; f++) GVC_TRY(add_frame(run, f, error));
    GVC_TRY(end_group(run, error));
    for (size_t r = ROW_EXR_ZIP; r < COMPARE_LOSSLESS_ROWS; r++) {
        run->row[r].bytes /= (double)count;
        run->row[r].encode_seconds /= (double)count;
    }
    return GVC_OK;
}

static gvc_result measure_all(lossless_run *run, const gvc_encode_options *encode,
                              gvc_error *error) {
    run->images = tmpfile();
    if (!run->images) {
        return gvc_fail(error, GVC_ERROR_IO, "cannot make a temporary file: %s", strerror(errno));
    }
    GVC_TRY(measure_file(run, encode, error));
    GVC_TRY(gvc_reader_open_memory(run->file.data, run->file.size, NULL, &run->reader, error));
    GVC_TRY(gvc_decoder_create(run->reader, &run->decoder, error));
    GVC_TRY(measure_unquantised(run, error));
    return measure_rivals(run, error);
}

gvc_result compare_lossless(const gvc_source *source, const gvc_encode_options *encode,
                            const compare_options *options, compare_row *row, gvc_error *error) {
    compare_row rows[COMPARE_LOSSLESS_ROWS];
    lossless_run run = {.source = source, .options = options, .row = rows};
    if (source->frame_count == 0) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "there are no frames to compare");
    }
    gvc_result result = measure_all(&run, encode, error);
    if (result == GVC_OK) memcpy(row, rows, sizeof rows);
    gvc_decoder_destroy(&run.decoder);
    gvc_reader_close(&run.reader);
    gvc_buffer_free(&run.file);
    gvc_buffer_free(&run.raw);
    if (run.images) fclose(run.images);
    return result;
}
