/* SPDX-License-Identifier: MIT */
/**
 * @file decoder.c
 * From a file to meshes: shape record of a frame, its charts cut out of its picture or taken from
 * the exact track, welded, triangulated, digested, placed in space. Everything up to the last
 * affine map is integer.
 */
#include "base/digest.h"
#include "base/memory.h"
#include "chart/picture.h"
#include "chart/rebuild.h"
#include "codec/h264.h"
#include "decoder_exact.h"
#include "file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NO_FRAGMENT SIZE_MAX
#define NO_FRAME UINT64_MAX
#define SAMPLE_SHARE 16u /* of the memory for images is for a sample as it stands in the file */
#define FIXED_MEMORY (UINT64_C(1) << 19) /* contexts of zstd and the like */

struct gvc_decoder {
    const gvc_reader *reader;
    size_t fragment; /* being decoded, or NO_FRAGMENT */
    gvc_shape shape; /* of all frames of the fragment; no charts until known */
    gvc_weld *weld;  /* one per chart of `shape` */

    bool is_exact;           /* codes come from the exact track, not from pictures */
    gvc_exact_decoder exact; /* only then */

    gvc_h264_decoder *h264; /* only if not */
    gvc_buffer sample;
    uint64_t most_bytes; /* that it, or one of the exact track, may have */
    uint16_t *luma;      /* last picture received: 3 planes, one above the other */
    gvc_picture_layout layout;
    size_t sent; /* samples of it fed to the H.264 decoder, or left out because damaged */
    size_t end;  /* samples of it before the first that the H.264 decoder does not take */
    bool flushed;
    uint64_t next_frame; /* pictures from here on have not come out yet */
    uint64_t shown;      /* the frame whose picture is in `luma`; NO_FRAME if there is none */
    uint64_t gap;        /* frames from this one to `shown` have none; only if there is `shown` */
    gvc_error defect;    /* the first in the pictures of the fragment; GVC_OK if there is none */

    uint16_t *codes; /* handed out by gvc_decoder_codes */
};

static void forget_shape(gvc_decoder *decoder) {
    for (size_t c = 0; decoder->weld && c < decoder->shape.chart_count; c++) {
        gvc_weld_free(&decoder->weld[c]);
    }
    free(decoder->weld);
    decoder->weld = NULL;
    gvc_shape_free(&decoder->shape);
}

static void forget_fragment(gvc_decoder *decoder) {
    decoder->fragment = NO_FRAGMENT;
    forget_shape(decoder);
}

/* Bytes held at most while one frame is decoded, besides images and what codecs hold, by sample of
 * a plane; charts do not overlap, so all of them have no more samples. */
static uint64_t surface_memory(const gvc_config *config) {
    enum {
        WELD = sizeof(uint32_t) + 4, /* vertex; the rest is by border sample, at most 60 of 256 */
        CODES = 2 * 3 * sizeof(uint16_t) + 3 * sizeof(uint16_t), /* before and after, handed out */
        MESH = 3 * sizeof(double) + 2 * 3 * sizeof(uint32_t)
    };
    uint64_t samples = (uint64_t)config->picture_width * config->plane_height;
    return samples * (WELD + CODES + MESH) + gvc_shape_record_memory(config) + FIXED_MEMORY;
}

/* `memory` is what is left for pictures and packets. */
static gvc_result open_video(gvc_decoder *decoder, uint64_t memory, gvc_error *error) {
    const gvc_demux *demux = &decoder->reader->demux;
    const gvc_config *config = &demux->config;
    decoder->layout = (gvc_picture_layout){config->picture_width, config->plane_height};
    uint64_t samples = (uint64_t)config->picture_width * config->plane_height * 3;
    uint64_t luma = samples * sizeof *decoder->luma;
    memory = memory > luma ? memory - luma : 0;
    decoder->most_bytes = memory / SAMPLE_SHARE;
    GVC_TRY(gvc_h264_decoder_create(demux->avc_config, demux->avc_config_size,
                                    config->picture_width, 3 * config->plane_height,
                                    memory - decoder->most_bytes, &decoder->h264, error));
    decoder->luma = gvc_alloc((size_t)samples, sizeof *decoder->luma);
    return decoder->luma ? GVC_OK : gvc_fail_memory(error);
}

gvc_result gvc_decoder_create(const gvc_reader *reader, gvc_decoder **decoder, gvc_error *error) {
    const gvc_config *config = &reader->demux.config;
    *decoder = NULL;
    bool preview = reader->options.preview;
    if (preview && !reader->demux.has_track[GVC_TRACK_GEOMETRY]) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the file has no preview");
    }
    bool is_exact = reader->demux.has_track[GVC_TRACK_EXACT] && !preview;
    uint64_t needed = reader->demux.held + surface_memory(config);
    uint64_t images = is_exact ? gvc_exact_decoder_memory(config) : 0;
    if (needed + images > reader->options.max_memory) {
        return gvc_fail(error, GVC_ERROR_LIMIT,
                        "decoding %u x %u pictures may take %llu MiB, more than the limit",
                        config->picture_width, 3 * config->plane_height,
                        (unsigned long long)((needed + images) >> 20));
    }
    uint64_t left = reader->options.max_memory - needed - images;
    gvc_decoder *made = gvc_alloc(1, sizeof *made);
    if (!made) return gvc_fail_memory(error);
    made->reader = reader;
    made->fragment = NO_FRAGMENT;
    made->is_exact = is_exact;
    made->most_bytes = left;
    gvc_result result = is_exact ? GVC_OK : open_video(made, left, error);
    if (result != GVC_OK) {
        gvc_decoder_destroy(&made);
        return result;
    }
    *decoder = made;
    return GVC_OK;
}

void gvc_decoder_destroy(gvc_decoder **decoder) {
    if (!decoder || !*decoder) return;
    forget_shape(*decoder);
    gvc_exact_decoder_free(&(*decoder)->exact);
    gvc_h264_decoder_destroy(&(*decoder)->h264);
    gvc_buffer_free(&(*decoder)->sample);
    free((*decoder)->luma);
    free((*decoder)->codes);
    free(*decoder);
    *decoder = NULL;
}

/* ------------------------------------------------------------------------------------ pictures */

/* A damaged picture costs those that are predicted from it. Which these are is not looked for: the
 * picture is left out, decoding goes on as far as the codec will, and the digest of each frame
 * proves whether it came out right (10.3). The first defect is what frames that are lost get told.
 */
static void note(gvc_decoder *decoder, const gvc_error *defect) {
    if (decoder->defect.code == GVC_OK) decoder->defect = *defect;
}

static gvc_result tell_defect(const gvc_decoder *decoder, gvc_error *error) {
    return gvc_hand_on(error, decoder->defect.code, &decoder->defect);
}

static void rewind_video(gvc_decoder *decoder) {
    gvc_h264_decoder_reset(decoder->h264);
    decoder->sent = 0;
    decoder->flushed = false;
    decoder->next_frame = decoder->reader->demux.fragment[decoder->fragment].first_frame;
    decoder->shown = NO_FRAME;
}

/* Damage is noted, and decoding goes on; what says nothing about the file is an error. */
static gvc_result pass_over(gvc_decoder *decoder, gvc_result result, const gvc_error *defect,
                            gvc_error *error) {
    if (result != GVC_ERROR_CORRUPT) return gvc_hand_on(error, result, defect);
    note(decoder, defect);
    return GVC_OK;
}

/* The group has no more samples that can be used. */
static gvc_result end_group(gvc_decoder *decoder, gvc_error *error) {
    gvc_error defect;
    gvc_error_init(&defect);
    decoder->flushed = true;
    gvc_result result = gvc_h264_decoder_flush(decoder->h264, &defect);
    return pass_over(decoder, result, &defect, error);
}

/* Feeds the next packet of the fragment, or the end of it. */
static gvc_result feed(gvc_decoder *decoder, gvc_error *error) {
    const gvc_demux *demux = &decoder->reader->demux;
    const gvc_fragment_entry *fragment = &demux->fragment[decoder->fragment];
    gvc_error defect;
    gvc_error_init(&defect);
    if (decoder->sent == decoder->end) return end_group(decoder, error);
    size_t index = fragment->first_sample[GVC_TRACK_GEOMETRY] + decoder->sent;
    const gvc_sample_entry *sample = &demux->sample[GVC_TRACK_GEOMETRY][index];
    gvc_result result = gvc_demux_read(demux, &decoder->reader->io, GVC_TRACK_GEOMETRY, index,
                                       decoder->most_bytes, &decoder->sample, &defect);
    if (result == GVC_ERROR_CORRUPT && decoder->sent > 0) {
        note(decoder, &defect);
        decoder->sent++;
        return GVC_OK;
    }
    if (result == GVC_OK) {
        result = gvc_h264_decoder_send(decoder->h264, decoder->sample.data, decoder->sample.size,
                                       (int64_t)sample->presentation, &defect);
        if (result == GVC_OK) {
            decoder->sent++;
            return GVC_OK;
        }
        if (defect.offset == GVC_NO_OFFSET) defect.offset = sample->offset;
        if (defect.frame == GVC_NO_FRAME) defect.frame = (int64_t)sample->presentation;
    }
    GVC_TRY(pass_over(decoder, result, &defect, error));
    /* Pictures that the codec has not given out yet would be lost with this one: once more, without
     * it. What came out comes out again, for up to here nothing changes. */
    decoder->end = decoder->sent;
    rewind_video(decoder);
    return GVC_OK;
}

/* Takes the picture in `luma` as that of `frame`. Pictures out of order are passed over, so that
 * what a frame gets does not depend on which frames were asked for before. */
static void take_picture(gvc_decoder *decoder, uint64_t frame) {
    gvc_error defect;
    gvc_error_init(&defect);
    if (frame < decoder->next_frame) {
        (void)gvc_fail(&defect, GVC_ERROR_CORRUPT, "the picture of frame %llu comes too late",
                       (unsigned long long)frame);
        note(decoder, &defect);
        return;
    }
    if (frame > decoder->next_frame) {
        (void)gvc_fail(&defect, GVC_ERROR_CORRUPT, "a picture is missing before frame %llu",
                       (unsigned long long)frame);
        note(decoder, &defect);
    }
    decoder->gap = decoder->next_frame;
    decoder->shown = frame;
    decoder->next_frame = frame + 1;
}

/* Takes a picture that is ready, or feeds the codec so that one may be. */
static gvc_result step(gvc_decoder *decoder, gvc_error *error) {
    gvc_error defect;
    gvc_error_init(&defect);
    int64_t presentation;
    bool available;
    decoder->shown = NO_FRAME;
    gvc_result result =
        gvc_h264_decoder_receive(decoder->h264, decoder->luma, &presentation, &available, &defect);
    if (result != GVC_OK) return pass_over(decoder, result, &defect, error);
    if (available) {
        take_picture(decoder, (uint64_t)presentation);
        return GVC_OK;
    }
    if (!decoder->flushed) return feed(decoder, error);
    if (decoder->defect.code != GVC_OK) return tell_defect(decoder, error);
    return gvc_fail(error, GVC_ERROR_CORRUPT, "the video holds fewer pictures than samples");
}

/* Leaves the picture of `frame` in decoder->luma. */
static gvc_result seek_picture(gvc_decoder *decoder, uint64_t frame, gvc_error *error) {
    if (decoder->shown == frame) return GVC_OK;
    if (decoder->shown != NO_FRAME && frame >= decoder->gap && frame < decoder->shown) {
        return tell_defect(decoder, error);
    }
    if (decoder->next_frame > frame) rewind_video(decoder);
    while (decoder->next_frame <= frame) GVC_TRY(step(decoder, error));
    return decoder->shown == frame ? GVC_OK : tell_defect(decoder, error);
}

/* -------------------------------------------------------------------------------------- shapes */

static gvc_result build_welds(gvc_decoder *decoder, gvc_error *error) {
    decoder->weld = gvc_alloc(decoder->shape.chart_count, sizeof *decoder->weld);
    if (!decoder->weld) return gvc_fail_memory(error);
    for (size_t c = 0; c < decoder->shape.chart_count; c++) {
        GVC_TRY(gvc_weld_build(&decoder->shape.chart[c].sides, &decoder->weld[c], error));
    }
    return GVC_OK;
}

/* Begins another fragment, of which only the number is known. */
static gvc_result set_fragment(gvc_decoder *decoder, size_t fragment, gvc_error *error) {
    forget_shape(decoder);
    decoder->fragment = fragment;
    GVC_TRY(gvc_reader_shape(decoder->reader, fragment, &decoder->shape, error));
    GVC_TRY(build_welds(decoder, error));
    if (decoder->is_exact) {
        return gvc_exact_decoder_begin(&decoder->exact, &decoder->shape, decoder->most_bytes,
                                       error);
    }
    decoder->end = decoder->reader->demux.fragment[fragment].frame_count;
    gvc_error_init(&decoder->defect);
    rewind_video(decoder);
    return GVC_OK;
}

static gvc_result begin_fragment(gvc_decoder *decoder, size_t fragment, gvc_error *error) {
    gvc_result result = set_fragment(decoder, fragment, error);
    if (result != GVC_OK) forget_fragment(decoder);
    return result;
}

/* Leaves the codes of `frame` of the fragment at hand in decoder->exact, or its picture in
 * decoder->luma. */
static gvc_result seek_codes(gvc_decoder *decoder, uint64_t frame, gvc_error *error) {
    if (decoder->is_exact) {
        return gvc_exact_decoder_seek(&decoder->exact, decoder->reader, decoder->fragment, frame,
                                      &decoder->shape, error);
    }
    return seek_picture(decoder, frame, error);
}

/* Copies the codes of a chart of the frame at hand to `plane`. */
static void copy_codes(const gvc_decoder *decoder, size_t c, uint16_t *plane) {
    const gvc_chart_shape *chart = &decoder->shape.chart[c];
    uint32_t size = chart->sides.size;
    if (decoder->is_exact) {
        memcpy(plane, gvc_exact_decoder_chart(&decoder->exact, &decoder->shape, c),
               (size_t)3 * size * size * sizeof *plane);
    } else {
        gvc_picture_cut(decoder->layout, decoder->luma, chart->x, chart->y, size,
                        decoder->reader->demux.config.code_shift, plane);
    }
}

/* ---------------------------------------------------------------------------------------- mesh */

/* Rebuilds chart `c` into `mesh` from vertex and face number `first_*` on, and adds it to the
 * digest. */
static gvc_result rebuild_chart(gvc_decoder *decoder, size_t c, gvc_mesh *mesh, size_t first_vertex,
                                size_t first_face, gvc_sha256 *digest, gvc_error *error) {
    const gvc_chart_shape *chart = &decoder->shape.chart[c];
    const gvc_weld *weld = &decoder->weld[c];
    size_t samples = (size_t)weld->size * weld->size;
    uint16_t *plane = gvc_alloc(3 * samples, sizeof *plane);
    uint16_t *code = gvc_alloc((size_t)3 * weld->vertex_count, sizeof *code);
    gvc_result result = plane && code ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        uint32_t *face = mesh->face + 3 * first_face;
        size_t face_count = gvc_rebuild_face_count(weld);
        copy_codes(decoder, c, plane);
        gvc_weld_codes(weld, plane, code);
        gvc_rebuild_faces(weld, code, face);
        result = gvc_rebuild_digest_update(digest, weld, code, face, error);
        gvc_rebuild_positions(weld, code, chart->origin, chart->step,
                              mesh->position + 3 * first_vertex);
        for (size_t i = 0; i < 3 * face_count; i++) face[i] += (uint32_t)first_vertex;
    }
    free(plane);
    free(code);
    return result;
}

static gvc_result rebuild_frame(gvc_decoder *decoder, const uint8_t expected[8], gvc_mesh **mesh,
                                gvc_error *error) {
    size_t vertex_count = 0, face_count = 0;
    for (size_t c = 0; c < decoder->shape.chart_count; c++) {
        vertex_count += decoder->weld[c].vertex_count;
        face_count += gvc_rebuild_face_count(&decoder->weld[c]);
    }
    GVC_TRY(gvc_mesh_allocate(vertex_count, face_count, mesh, error));
    gvc_sha256 *digest = gvc_sha256_begin();
    gvc_result result = digest ? GVC_OK : gvc_fail_memory(error);
    vertex_count = face_count = 0;
    for (size_t c = 0; result == GVC_OK && c < decoder->shape.chart_count; c++) {
        result = rebuild_chart(decoder, c, *mesh, vertex_count, face_count, digest, error);
        vertex_count += decoder->weld[c].vertex_count;
        face_count += gvc_rebuild_face_count(&decoder->weld[c]);
    }
    uint8_t got[32];
    gvc_sha256_end(digest, got);
    if (result == GVC_OK && memcmp(got, expected, 8) != 0) {
        result = decoder->defect.code != GVC_OK ? tell_defect(decoder, error)
                                                : gvc_fail(error, GVC_ERROR_CORRUPT,
                                                           "the decoded frame does not match its "
                                                           "digest");
    }
    if (result != GVC_OK) gvc_mesh_destroy(mesh);
    return result;
}

/* The error is about the frame asked for; if it lies with another that this one needs, that is
 * said, too. */
static gvc_result fail_frame(gvc_error *error, gvc_result result, uint64_t frame) {
    if (result == GVC_OK || !error) return result;
    int64_t other = error->frame;
    error->frame = (int64_t)frame;
    (void)gvc_explain(error, result);
    if (other != GVC_NO_FRAME && other != (int64_t)frame) {
        size_t length = strlen(error->message);
        snprintf(error->message + length, sizeof error->message - length,
                 " (of frame %lld, which is needed)", (long long)other);
    }
    return result;
}

/* Leaves images and shape of `frame` in the decoder. The record of the frame itself is always read,
 * for its digest. */
static gvc_result seek(gvc_decoder *decoder, uint64_t frame, gvc_shape_frame *facts,
                       gvc_error *error) {
    size_t fragment;
    gvc_shape shape = {0};
    GVC_TRY(gvc_reader_find(decoder->reader, frame, &fragment, error));
    if (decoder->fragment != fragment) GVC_TRY(begin_fragment(decoder, fragment, error));
    gvc_result result = gvc_reader_record(decoder->reader, fragment, frame, &shape, facts, error);
    gvc_shape_free(&shape);
    if (result == GVC_OK) result = seek_codes(decoder, frame, error);
    if (result != GVC_OK && result != GVC_ERROR_CORRUPT) forget_fragment(decoder);
    return result;
}

gvc_result gvc_decoder_frame(gvc_decoder *decoder, uint64_t frame, gvc_mesh **mesh,
                             gvc_error *error) {
    gvc_shape_frame facts;
    *mesh = NULL;
    gvc_result result = seek(decoder, frame, &facts, error);
    if (result == GVC_OK) {
        result = rebuild_frame(decoder, gvc_reader_digest(decoder->reader, &facts), mesh, error);
    }
    return fail_frame(error, result, frame);
}

static gvc_result cut_chart(gvc_decoder *decoder, size_t chart, uint32_t *size, gvc_error *error) {
    if (chart >= decoder->shape.chart_count) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the frame has no chart %zu", chart);
    }
    const gvc_chart_shape *shape = &decoder->shape.chart[chart];
    *size = shape->sides.size;
    decoder->codes = gvc_alloc((size_t)*size * *size, 3 * sizeof *decoder->codes);
    if (!decoder->codes) return gvc_fail_memory(error);
    copy_codes(decoder, chart, decoder->codes);
    return GVC_OK;
}

gvc_result gvc_decoder_codes(gvc_decoder *decoder, uint64_t frame, size_t chart,
                             const uint16_t **plane, uint32_t *size, gvc_error *error) {
    gvc_shape_frame facts;
    free(decoder->codes);
    decoder->codes = NULL;
    gvc_result result = seek(decoder, frame, &facts, error);
    if (result == GVC_OK) result = cut_chart(decoder, chart, size, error);
    *plane = decoder->codes;
    return fail_frame(error, result, frame);
}
