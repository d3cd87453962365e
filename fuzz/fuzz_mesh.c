/* SPDX-License-Identifier: MIT */
/** @file fuzz_mesh.c  Fuzzes the readers of OFF, OBJ and PLY, and the writers with what they read.
 *
 * The input is a mesh file, told by its content. What is read is written in each format and must
 * come back the same, to the bit. */
#include "live_memory.h"
#include "require.h"

#include <float.h>
#include <math.h>
#include <unistd.h>

#define FACTOR 64u                      /* bytes held for each of the input, at most */
#define MEMORY_BASE (UINT64_C(1) << 18) /* besides these */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/** Coordinates that are float32 exactly are written as such: with fewer digits in text. */
static bool same_coordinate(double a, double b) {
    if (memcmp(&a, &b, sizeof a) == 0) return true;
    return fabs(a) <= FLT_MAX && (double)(float)a == a && fabs(b) <= FLT_MAX &&
           (float)a == (float)b && signbit(a) == signbit(b);
}

static void require_equal(const gvc_mesh *a, const gvc_mesh *b) {
    size_t vertices = gvc_mesh_vertex_count(a), faces = gvc_mesh_face_count(a);
    REQUIRE(vertices == gvc_mesh_vertex_count(b) && faces == gvc_mesh_face_count(b));
    for (size_t i = 0; i < 3 * vertices; i++) {
        REQUIRE(same_coordinate(gvc_mesh_positions(a)[i], gvc_mesh_positions(b)[i]));
    }
    REQUIRE(memcmp(gvc_mesh_faces(a), gvc_mesh_faces(b), 3 * faces * sizeof(uint32_t)) == 0);
}

static void write_and_read(const gvc_mesh *mesh, gvc_mesh_format format) {
    const char *folder = getenv("TMPDIR");
    char path[512];
    gvc_error error;
    gvc_mesh *back;
    gvc_error_init(&error);
    snprintf(path, sizeof path, "%s/fuzz_mesh_%ld", folder ? folder : "/tmp", (long)getpid());
    REQUIRE(succeeded(gvc_mesh_write_file(mesh, path, format, true, &error), &error));
    gvc_result result = gvc_mesh_read_file(path, GVC_MESH_AUTO, &back, &error);
    unlink(path);
    REQUIRE(succeeded(result, &error));
    require_equal(mesh, back);
    gvc_mesh_destroy(&back);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    gvc_error error;
    gvc_mesh *mesh;
    gvc_error_init(&error);
    memory_begin();
    gvc_result result = gvc_mesh_read_memory(data, size, GVC_MESH_AUTO, "input", &mesh, &error);
    REQUIRE(memory_peak() <= FACTOR * size + MEMORY_BASE);
    if (!succeeded(result, &error)) {
        REQUIRE(!mesh && result == GVC_ERROR_MESH);
        return 0;
    }
    for (int format = GVC_MESH_OFF; format <= GVC_MESH_PLY_BIG_ENDIAN; format++) {
        write_and_read(mesh, (gvc_mesh_format)format);
    }
    gvc_mesh_destroy(&mesh);
    return 0;
}
