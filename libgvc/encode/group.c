/* SPDX-License-Identifier: MIT */
/** @file group.c  Codes a group of frames and writes it as a fragment. */
#include "encode/group.h"

#include "base/memory.h"
#include "chart/rebuild.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t picture_samples(const gvc_group *group) {
    return (size_t)3 * group->layout.width * group->layout.plane_height;
}

gvc_result gvc_group_create(size_t capacity, gvc_picture_layout layout, gvc_group *group,
                            gvc_error *error) {
    *group = (gvc_group){.layout = layout, .video = true};
    group->frame = gvc_alloc(capacity, sizeof *group->frame);
    if (!group->frame) return gvc_fail_memory(error);
    group->capacity = capacity;
    return GVC_OK;
}

void gvc_group_clear(gvc_group *group) {
    for (size_t i = 0; i < group->count; i++) {
        free(group->frame[i].luma);
        free(group->frame[i].decoded);
        free(group->frame[i].codes);
        gvc_buffer_free(&group->frame[i].exact);
        group->frame[i] = (gvc_group_frame){0};
    }
    group->count = 0;
    gvc_shape_free(&group->shape);
    gvc_coded_group_free(&group->coded);
}

void gvc_group_free(gvc_group *group) {
    gvc_group_clear(group);
    free(group->frame);
    *group = (gvc_group){0};
}

/* ---------------------------------------------------------------------------------------- code */

static gvc_result take_pictures(gvc_group *group, gvc_h264_decoder *decoder, size_t *next,
                                gvc_error *error) {
    bool available = true;
    while (available && *next < group->count) {
        gvc_group_frame *frame = &group->frame[*next];
        int64_t presentation;
        if (!frame->decoded) {
            frame->decoded = gvc_alloc(picture_samples(group), sizeof *frame->decoded);
            if (!frame->decoded) return gvc_fail_memory(error);
        }
        GVC_TRY(
            gvc_h264_decoder_receive(decoder, frame->decoded, &presentation, &available, error));
        if (available && presentation != (int64_t)*next) {
            return gvc_fail(error, GVC_ERROR_INTERNAL, "pictures came back out of order");
        }
        if (available) (*next)++;
    }
    return GVC_OK;
}

/* What the decoder will see; H.264 decoding is exact, so the digests can be taken from it. */
static gvc_result decode_again(gvc_group *group, gvc_error *error) {
    gvc_h264_decoder *decoder = NULL;
    size_t next = 0;
    gvc_result result =
        gvc_h264_decoder_create(group->coded.config, group->coded.config_size, group->layout.width,
                                3 * group->layout.plane_height, UINT64_MAX, &decoder, error);
    for (size_t i = 0; result == GVC_OK && i < group->coded.packet_count; i++) {
        const gvc_packet *packet = &group->coded.packet[i];
        result = gvc_h264_decoder_send(decoder, packet->data, packet->size,
                                       (int64_t)packet->presentation, error);
        if (result == GVC_OK) result = take_pictures(group, decoder, &next, error);
    }
    if (result == GVC_OK) result = gvc_h264_decoder_flush(decoder, error);
    if (result == GVC_OK) result = take_pictures(group, decoder, &next, error);
    if (result == GVC_OK && next != group->count) {
        result = gvc_fail(error, GVC_ERROR_INTERNAL, "the video codec lost a picture");
    }
    gvc_h264_decoder_destroy(&decoder);
    return result;
}

gvc_result gvc_group_code(gvc_group *group, const gvc_encode_options *options, double crf,
                          gvc_error *error) {
    gvc_h264_options h264 = {.width = group->layout.width,
                             .height = 3 * group->layout.plane_height,
                             .frame_rate_num = options->frame_rate_num,
                             .frame_rate_den = options->frame_rate_den,
                             .crf = crf,
                             .effort = 1};
    const uint16_t **luma = gvc_alloc(group->count, sizeof *luma);
    if (!luma) return gvc_fail_memory(error);
    for (size_t i = 0; i < group->count; i++) luma[i] = group->frame[i].luma;
    gvc_coded_group_free(&group->coded);
    gvc_result result = gvc_h264_encode(&h264, luma, group->count, &group->coded, error);
    free(luma);
    if (result == GVC_OK) result = decode_again(group, error);
    return result;
}

/* --------------------------------------------------------------------------------------- write */

void gvc_group_plane(const gvc_group *group, size_t index, gvc_code_source from, uint16_t *plane) {
    const gvc_group_frame *frame = &group->frame[index];
    uint32_t size = group->segment->weld.size;
    if (from == GVC_CODES_EXACT) {
        memcpy(plane, frame->codes, (size_t)3 * size * size * sizeof *plane);
    } else {
        gvc_picture_cut(group->layout, frame->decoded, 0, 0, size, GVC_CODE_SHIFT, plane);
    }
}

/* Digest of the frame that a decoder will rebuild. */
static gvc_result digest_frame(const gvc_group *group, size_t index, gvc_code_source from,
                               uint8_t digest[8], gvc_error *error) {
    const gvc_weld *weld = &group->segment->weld;
    size_t samples = (size_t)weld->size * weld->size;
    uint8_t full[32];
    uint16_t *plane = gvc_alloc(3 * samples, sizeof *plane);
    uint16_t *code = gvc_alloc((size_t)3 * weld->vertex_count, sizeof *code);
    uint32_t *face = gvc_alloc(3 * gvc_rebuild_face_count(weld), sizeof *face);
    gvc_sha256 *state = gvc_sha256_begin();
    gvc_result result = plane && code && face && state ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        gvc_group_plane(group, index, from, plane);
        gvc_weld_codes(weld, plane, code);
        gvc_rebuild_faces(weld, code, face);
        result = gvc_rebuild_digest_update(state, weld, code, face, error);
    }
    gvc_sha256_end(state, full);
    memcpy(digest, full, 8);
    free(plane);
    free(code);
    free(face);
    return result;
}

/* Last part of a frame's name; of a very long one, the end. */
static void name_frame(const gvc_source *source, uint64_t frame, char *text, size_t size) {
    const char *name = source->name ? source->name(source->user, frame) : NULL;
    if (!name) return;
    const char *slash = strrchr(name, '/');
    if (slash) name = slash + 1;
    size_t length = strlen(name);
    snprintf(text, size, "%s", length < size ? name : name + (length - size + 1));
}

/* All shape records, one after the other in `bytes`; samples[i] gets the size of record i. The
 * first names the frame it was made from: enough to find the others in a numbered series, and no
 * bytes for each of them. */
static gvc_result write_records(const gvc_group *group, const gvc_source *source, gvc_buffer *bytes,
                                gvc_sample *samples, gvc_error *error) {
    for (size_t i = 0; i < group->count; i++) {
        gvc_shape_frame facts = {.same = i > 0, .has_preview = group->exact && group->video};
        size_t before = bytes->size;
        gvc_code_source from = group->exact ? GVC_CODES_EXACT : GVC_CODES_VIDEO;
        GVC_TRY(digest_frame(group, i, from, facts.digest, error));
        if (facts.has_preview) {
            GVC_TRY(digest_frame(group, i, GVC_CODES_VIDEO, facts.preview_digest, error));
        }
        if (i == 0) name_frame(source, group->first_frame, facts.source, sizeof facts.source);
        GVC_TRY(gvc_shape_record_write(&group->shape, &facts, bytes, error));
        samples[i].size = bytes->size - before;
        samples[i].sync = i == 0;
    }
    return bytes->failed ? gvc_fail_memory(error) : GVC_OK;
}

static gvc_sample video_sample(const gvc_group *group, size_t i) {
    const gvc_packet *packet = &group->coded.packet[i];
    int32_t offset = (int32_t)((int64_t)packet->presentation - (int64_t)i);
    return (gvc_sample){packet->data, packet->size, offset, packet->keyframe};
}

gvc_result gvc_group_write(gvc_group *group, const gvc_source *source, gvc_writer *writer,
                           gvc_error *error) {
    gvc_buffer bytes = {0};
    gvc_sample *video = gvc_alloc(group->count, sizeof *video);
    gvc_sample *shape = gvc_alloc(group->count, sizeof *shape);
    gvc_sample *exact = gvc_alloc(group->count, sizeof *exact);
    gvc_result result = video && shape && exact ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = write_records(group, source, &bytes, shape, error);
    if (result == GVC_OK) {
        size_t at = 0;
        for (size_t i = 0; i < group->count; i++) {
            const gvc_buffer *image = &group->frame[i].exact;
            if (group->video) video[i] = video_sample(group, i);
            if (group->exact) exact[i] = (gvc_sample){image->data, image->size, 0, i == 0};
            shape[i].data = bytes.data + at;
            at += shape[i].size;
        }
        gvc_fragment fragment = {.first_frame = group->first_frame,
                                 .frame_count = group->count,
                                 .geometry = group->video ? video : NULL,
                                 .shape = shape,
                                 .exact = group->exact ? exact : NULL};
        result = gvc_writer_fragment(writer, &fragment, error);
    }
    free(video);
    free(shape);
    free(exact);
    gvc_buffer_free(&bytes);
    return result;
}
