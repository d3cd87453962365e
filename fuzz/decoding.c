/* SPDX-License-Identifier: MIT */
/** @file decoding.c  Decodes a file in memory and keeps what came out. */
#include "decoding.h"

#include "base/digest.h"
#include "require.h"

gvc_read_options decoding_options(bool keep_going, bool preview) {
    gvc_read_options options;
    gvc_read_options_init(&options);
    options.max_memory = UINT64_C(64) << 20;
    options.max_image_size = 129;
    options.max_frames = 10000;
    options.keep_going = keep_going;
    options.preview = preview;
    return options;
}

uint32_t mesh_crc(const gvc_mesh *mesh) {
    size_t vertices = gvc_mesh_vertex_count(mesh), faces = gvc_mesh_face_count(mesh);
    uint32_t crc = gvc_crc32(0, gvc_mesh_positions(mesh), 3 * vertices * sizeof(double));
    return gvc_crc32(crc, gvc_mesh_faces(mesh), 3 * faces * sizeof(uint32_t));
}

static decoded_frame decode(gvc_decoder *decoder, uint64_t frame) {
    decoded_frame out = {.frame = frame};
    gvc_error error;
    gvc_error_init(&error);
    gvc_mesh *mesh = NULL;
    out.result = gvc_decoder_frame(decoder, frame, &mesh, &error);
    if (out.result != GVC_OK) REQUIRE(error.frame == (int64_t)frame);
    if (succeeded(out.result, &error)) {
        out.crc = mesh_crc(mesh);
    } else {
        REQUIRE(!mesh && (blames_input(out.result) || out.result == GVC_ERROR_IO));
    }
    gvc_mesh_destroy(&mesh);
    return out;
}

decoded decode_frames(const gvc_reader *reader) {
    decoded out = {0};
    gvc_decoder *decoder;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_decoder_create(reader, &decoder, &error);
    if (!succeeded(result, &error)) {
        REQUIRE(!decoder && blames_input(result));
        return out;
    }
    const gvc_demux *demux = &reader->demux;
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *fragment = &demux->fragment[i];
        for (uint32_t f = 0; f < fragment->frame_count && out.count < DECODED_FRAMES; f++) {
            out.frame[out.count++] = decode(decoder, fragment->first_frame + f);
        }
    }
    for (size_t i = out.count; i-- > 0;) {
        decoded_frame again = decode(decoder, out.frame[i].frame);
        if (again.result == GVC_ERROR_IO || out.frame[i].result == GVC_ERROR_IO) continue;
        if (again.crc != out.frame[i].crc) {
            fprintf(stderr, "frame %llu: %s, then %s\n", (unsigned long long)again.frame,
                    gvc_result_string(out.frame[i].result), gvc_result_string(again.result));
        }
        REQUIRE(again.crc == out.frame[i].crc);
        REQUIRE((again.result == GVC_OK) == (out.frame[i].result == GVC_OK));
    }
    gvc_decoder_destroy(&decoder);
    return out;
}

void require_kept(const decoded *before, const decoded *after, bool all) {
    for (size_t i = 0; i < before->count; i++) {
        const decoded_frame *was = &before->frame[i], *is = NULL;
        if (was->result != GVC_OK) continue;
        for (size_t k = 0; k < after->count; k++) {
            if (after->frame[k].frame == was->frame) is = &after->frame[k];
        }
        if (is && is->result == GVC_OK) REQUIRE(is->crc == was->crc);
        if (all) REQUIRE(is && is->result == GVC_OK);
    }
}
