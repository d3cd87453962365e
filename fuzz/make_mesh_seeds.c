/* SPDX-License-Identifier: MIT */
/** @file make_mesh_seeds.c  Writes seeds for fuzz_mesh into a folder: a surface in each format as
 * the library writes it, and what other programs write. */
#include "gvc/gvc.h"
#include "seed.h"
#include "soup.h"

#include <string.h>

/* Things that only readers know. */
static const struct {
    const char *name, *text;
} odd[] = {
    {"quads.off", "OFF # box\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 2 1 0\n"},
    {"normals.off", "STCNOFF\n3 1 3\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n"
                    "0 1e-3 -2.5E1 0 0 1 1 1 1 1 0 0\n3 0 1 2\n"},
    {"face.obj", "# a\nmtllib a.mtl\no a\nv 0 0 0 1\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ns off\n"
                 "usemtl a\nf 1/1/1 2//1 3/1\nf -3 -1 -2\n"},
    {"extra.ply", "ply\r\nformat ascii 1.0\r\ncomment a\r\nobj_info b\r\nelement vertex 3\r\n"
                  "property double x\r\nproperty double y\r\nproperty double z\r\n"
                  "property uchar red\r\nproperty list uchar short w\r\nelement edge 1\r\n"
                  "property int a\r\nelement face 1\r\nproperty list uchar uint vertex_index\r\n"
                  "property float q\r\nend_header\r\n0 0 0 1 2 3 4\r\n1 0 0 1 0\r\n0 1 0 1 1 5\r\n"
                  "7\r\n3 0 1 2 0.5\r\n"},
    {"types.ply", "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty char a\n"
                  "property int8 b\nproperty uint8 c\nproperty int16 d\nproperty ushort e\n"
                  "property int32 f\nproperty float32 x\nproperty float64 y\nproperty float z\n"
                  "element face 1\nproperty list uint16 int vertex_indices\nend_header\n"
                  "abcddeeffffxxxxyyyyyyyyzzzz"},
};

/* The face of types.ply: a count of two bytes, three indices of four. */
static const uint8_t binary_face[14] = {0, 3};

int main(int argc, char **argv) {
    static const char *const extension[] = {"", "off", "obj", "ply", "ascii.ply", "big.ply"};
    if (argc != 2) {
        fprintf(stderr, "usage: make_mesh_seeds FOLDER\n");
        return 2;
    }
    soup s = {0};
    gvc_mesh *mesh;
    soup_octahedron(&s);
    s.position[0] = 0.1; /* not a float */
    int failed =
        gvc_mesh_create(s.position, s.vertex_count, s.face, s.face_count, &mesh, NULL) != GVC_OK;
    for (int format = GVC_MESH_OFF; !failed && format <= GVC_MESH_PLY_BIG_ENDIAN; format++) {
        char path[4096];
        snprintf(path, sizeof path, "%s/octahedron.%s", argv[1], extension[format]);
        failed |= gvc_mesh_write_file(mesh, path, (gvc_mesh_format)format, true, NULL) != GVC_OK;
    }
    gvc_mesh_destroy(&mesh);
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++) {
        gvc_buffer text = {0};
        gvc_write_bytes(&text, odd[i].text, strlen(odd[i].text));
        if (strcmp(odd[i].name, "types.ply") == 0) gvc_write_bytes(&text, binary_face, 14);
        failed |= seed_save(argv[1], odd[i].name, SEED_PLAIN, &text);
        gvc_buffer_free(&text);
    }
    if (failed) fprintf(stderr, "make_mesh_seeds: cannot write to %s\n", argv[1]);
    return failed;
}
