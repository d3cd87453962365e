/* SPDX-License-Identifier: MIT */
/** @file first_frame.c  Smallest use of libgvc: writes the first frame of a .gvc file as a mesh. */
#include <gvc/gvc.h>

#include <stdio.h>

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: first_frame capture.gvc mesh.ply\n");
        return 2;
    }
    gvc_error error;
    gvc_reader *reader = NULL;
    gvc_decoder *decoder = NULL;
    gvc_mesh *mesh = NULL;
    gvc_error_init(&error);

    gvc_result result = gvc_reader_open_file(argv[1], NULL, &reader, &error);
    if (result == GVC_OK) result = gvc_decoder_create(reader, &decoder, &error);
    if (result == GVC_OK) result = gvc_decoder_frame(decoder, 0, &mesh, &error);
    if (result == GVC_OK) {
        printf("%zu vertices, %zu faces\n", gvc_mesh_vertex_count(mesh), gvc_mesh_face_count(mesh));
        result = gvc_mesh_write_file(mesh, argv[2], GVC_MESH_AUTO, true, &error);
    }
    if (result != GVC_OK) fprintf(stderr, "%s: %s\n", gvc_result_string(result), error.message);

    gvc_mesh_destroy(&mesh);
    gvc_decoder_destroy(&decoder);
    gvc_reader_close(&reader);
    return result == GVC_OK ? 0 : 1;
}
