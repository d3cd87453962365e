/* SPDX-License-Identifier: MIT */
/** @file encoding.c  Encodes a few small meshes and checks the file. */
#include "encoding.h"

#include "decoding.h"
#include "memory_file.h"
#include "require.h"

void small_capture_free(small_capture *capture) {
    for (size_t i = 0; i < capture->count; i++) gvc_mesh_destroy(&capture->mesh[i]);
    capture->count = 0;
}

static gvc_result read_mesh(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    const gvc_mesh *kept = ((const small_capture *)user)->mesh[frame];
    return gvc_mesh_create(gvc_mesh_positions(kept), gvc_mesh_vertex_count(kept),
                           gvc_mesh_faces(kept), gvc_mesh_face_count(kept), mesh, error);
}

static void check_closed(const gvc_reader *reader, uint64_t frame) {
    gvc_decoder *decoder;
    gvc_mesh *mesh;
    gvc_topology topology;
    gvc_error error;
    gvc_error_init(&error);
    REQUIRE(succeeded(gvc_decoder_create(reader, &decoder, &error), &error));
    REQUIRE(succeeded(gvc_decoder_frame(decoder, frame, &mesh, &error), &error));
    REQUIRE(succeeded(gvc_mesh_topology(mesh, &topology, &error), &error));
    REQUIRE(topology.closed_manifold);
    gvc_mesh_destroy(&mesh);
    gvc_decoder_destroy(&decoder);
}

static void check_file(const gvc_buffer *file, size_t frame_count) {
    gvc_reader *reader;
    gvc_info info;
    gvc_error error;
    gvc_error_init(&error);
    REQUIRE(
        succeeded(gvc_reader_open_memory(file->data, file->size, NULL, &reader, &error), &error));
    gvc_reader_info(reader, &info);
    REQUIRE(info.frame_count == frame_count && info.declared_count == frame_count);
    decoded frames = decode_frames(reader);
    REQUIRE(frames.count == frame_count);
    for (size_t i = 0; i < frames.count; i++) REQUIRE(frames.frame[i].result == GVC_OK);
    check_closed(reader, frame_count - 1);
    gvc_reader_close(&reader);
}

bool encode_and_check(const small_capture *capture, const gvc_encode_options *options,
                      gvc_buffer *file) {
    gvc_source source = {
        .user = (void *)(uintptr_t)capture, .frame_count = capture->count, .read = read_mesh};
    gvc_sink sink = {file, sink_write};
    gvc_encode_report report;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_encode(&source, &sink, options, &report, &error);
    if (succeeded(result, &error)) {
        REQUIRE(!file->failed && report.byte_count == file->size);
        check_file(file, capture->count);
        return true;
    }
    if (result != GVC_ERROR_MESH && result != GVC_ERROR_QUALITY) {
        fprintf(stderr, "%s\n", gvc_result_string(result));
    }
    REQUIRE(result == GVC_ERROR_MESH || result == GVC_ERROR_QUALITY);
    gvc_buffer_free(file);
    return false;
}
