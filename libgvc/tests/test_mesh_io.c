/* SPDX-License-Identifier: MIT */
/** @file test_mesh_io.c  Reading and writing OFF, OBJ and PLY, good and bad. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh/mesh.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static gvc_mesh *read_bytes(const void *data, size_t size, const char *name) {
    gvc_mesh *mesh;
    gvc_error error;
    if (gvc_mesh_read_memory(data, size, GVC_MESH_AUTO, name, &mesh, &error) != GVC_OK)
        fail_msg("%s: %s", error.where, error.message);
    return mesh;
}

/** The text must give a unit square of two triangles, vertices in order. */
static void check_square(const char *text, const char *name) {
    gvc_mesh *mesh = read_bytes(text, strlen(text), name);
    const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const uint32_t faces[] = {0, 1, 2, 0, 2, 3};
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->face_count, 2);
    assert_memory_equal(mesh->position, positions, sizeof positions);
    assert_memory_equal(mesh->face, faces, sizeof faces);
    gvc_mesh_destroy(&mesh);
}

/** The bytes must be refused with these words in the message, and the name in `where`. */
static void check_refused(const void *data, size_t size, const char *name, const char *words) {
    gvc_mesh *mesh = (gvc_mesh *)&mesh;
    gvc_error error;
    assert_int_equal(gvc_mesh_read_memory(data, size, GVC_MESH_AUTO, name, &mesh, &error),
                     GVC_ERROR_MESH);
    assert_null(mesh);
    if (!strstr(error.message, words)) fail_msg("\"%s\" is not in: %s", words, error.message);
    assert_string_equal(error.where, name);
}

static void check_text_refused(const char *text, const char *name, const char *words) {
    check_refused(text, strlen(text), name, words);
}

static void reads_off(void **state) {
    (void)state;
    check_square("OFF\n4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n", "a.off");
    check_square("OFF 4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3", "a");
    check_square("# by hand\n\nOFF # keyword\n# counts\n4 1\n\n0 0 0 # first\n1 0 0\n1 1 0\n"
                 "0 1 0\n4 0 1 2 3\n",
                 "a");
    check_square("COFF\r\n4 1 0\r\n0 0 0 255 0 0 255\r\n1 0 0 1 1 1 1\r\n1 1 0 1 1 1 1\r\n"
                 "0 1 0 1 1 1 1\r\n4 0 1 2 3 0.5 0.5 0.5\r\n",
                 "a.obj");
    check_square("STCNOFF\n4 2 0\n\t0 0 0 9 9\n1 0 0 9 9\n1 1 0 9 9\n0 1 0 9 9\n"
                 "3 0 1 2 255 0 0\n3 0 2 3 7\ntrailing words",
                 "a");
    check_square("4 1 0\n0 0 0\n1 0 0\n1e0 1 0\n0 +1.0 0\n4 0 1 2 3\n", "keyword.OFF");
}

static void reads_obj(void **state) {
    (void)state;
    const char *vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const char *faces[] = {"f 1 2 3\nf 1 3 4\n",
                           "f 1 2 3 4",
                           "f 1/1 2/2 3/3 4/4\n",
                           "f 1//7 2//7 3//7 4//7\n",
                           "f 1/1/1 2/2/2 3/3/3 4/4/4 # quad\n",
                           "f -4 -3 -2 -1\n",
                           "f 1 2 \\\n 3 4\n",
                           "f 1 2\\\r\n3 4\r\n",
                           "g f\nusemtl v\nvt 0 0\nvn 0 0 1\nfoo 1 2\ns off\n\tf 1 2 3 4\nl 1 2\n"};
    for (size_t i = 0; i < sizeof faces / sizeof *faces; i++) {
        char text[512];
        snprintf(text, sizeof text, "# \\\n%s%s", vertices, faces[i]);
        check_square(text, "a.obj");
        check_square(text, "b.obj");
    }
    check_square("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nf 1 3 4\nv 0 1 0\n", "stdin");
    check_square("mtllib x\r\nv 0 0 0 1\r\nv 1 0 0 .5 .5 .5\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n",
                 "stdin");
}

static void reads_ascii_ply(void **state) {
    (void)state;
    check_square("ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n"
                 "property float y\nproperty float z\nelement face 1\n"
                 "property list uchar int vertex_indices\nend_header\n"
                 "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
                 "a.ply");
    /* Faces first, unknown elements and properties, other orders of coordinates. */
    check_square("ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement nothing 4000000000\r\n"
                 "element face 2\r\nproperty uchar flag\r\n"
                 "property list uint8 uint32 vertex_index\r\nproperty list int float weights\r\n"
                 "element camera 1\r\nproperty list uchar double matrix\r\n"
                 "element vertex 4\r\nproperty list char char tags\r\nproperty double z\r\n"
                 "property int8 y\r\nproperty short x\r\nproperty uchar red\r\nend_header\r\n"
                 "7 3 0 1 2 0\r\n7 3 0 2 3 2 .5 .5\r\n2 1.5 nan\r\n"
                 "0 0 0 0 9\r\n0 0 0 1 9\r\n2 5 5 0 1 1 9\r\n0 0 1 0 9",
                 "a.ply");
}

/** Appends a number in the byte order wanted. */
static void put(uint8_t *data, size_t *size, uint64_t bits, size_t bytes, bool big) {
    for (size_t i = 0; i < bytes; i++)
        data[(*size)++] = (uint8_t)(bits >> 8 * (big ? bytes - 1 - i : i));
}

static uint64_t bits_of(double value, size_t bytes) {
    float narrow = (float)value;
    uint32_t narrow_bits;
    uint64_t bits;
    memcpy(&narrow_bits, &narrow, sizeof narrow_bits);
    memcpy(&bits, &value, sizeof bits);
    return bytes == 4 ? narrow_bits : bits;
}

/** A binary PLY of a square: a list to skip before the coordinates, z as short, a quad, and an
 *  element of fixed size between. */
static size_t make_binary_ply(uint8_t *data, bool big, size_t real) {
    const double positions[] = {0.25, -1e-3, -7, 1, 0, 300, 1, 1, 0, 0, 1, -32768};
    size_t size = (size_t)sprintf((char *)data,
                                  "ply\nformat binary_%s_endian 1.0\nelement vertex 4\n"
                                  "property list ushort uchar tags\nproperty %s x\nproperty %s y\n"
                                  "property short z\nelement extra 3\nproperty uint a\n"
                                  "element face 1\nproperty list uint ushort vertex_indices\n"
                                  "end_header\n",
                                  big ? "big" : "little", real == 4 ? "float" : "double",
                                  real == 4 ? "float32" : "float64");
    for (size_t v = 0; v < 4; v++) {
        put(data, &size, v, 2, big);
        for (size_t i = 0; i < v; i++) put(data, &size, 0xee, 1, big);
        put(data, &size, bits_of(positions[3 * v], real), real, big);
        put(data, &size, bits_of(positions[3 * v + 1], real), real, big);
        put(data, &size, (uint16_t)(int16_t)positions[3 * v + 2], 2, big);
    }
    for (size_t i = 0; i < 3; i++) put(data, &size, 0x0a0a0a0a, 4, big);
    put(data, &size, 4, 4, big);
    for (size_t i = 0; i < 4; i++) put(data, &size, 3 - i, 2, big);
    return size;
}

static void reads_binary_ply(void **state) {
    (void)state;
    uint8_t data[1024];
    for (int variant = 0; variant < 4; variant++) {
        size_t real = variant & 2 ? 8 : 4, size = make_binary_ply(data, variant & 1, real);
        gvc_mesh *mesh = read_bytes(data, size, "x");
        assert_int_equal(mesh->vertex_count, 4);
        assert_int_equal(mesh->face_count, 2);
        assert_true(mesh->position[0] == 0.25);
        assert_true(mesh->position[1] == (real == 4 ? (double)-1e-3f : -1e-3));
        assert_true(mesh->position[2] == -7 && mesh->position[5] == 300);
        assert_true(mesh->position[11] == -32768);
        const uint32_t faces[] = {3, 2, 1, 3, 1, 0};
        assert_memory_equal(mesh->face, faces, sizeof faces);
        gvc_mesh_destroy(&mesh);
        /* Cut anywhere, it must be refused. Copied, so that a sanitizer sees any step too far. */
        for (size_t cut = 0; cut < size; cut++) {
            uint8_t *part = malloc(cut ? cut : 1);
            assert_non_null(part);
            memcpy(part, data, cut);
            check_refused(part, cut, "cut.ply", "");
            free(part);
        }
    }
}

static void refuses_bad_text(void **state) {
    (void)state;
    check_text_refused("", "a.off", "empty");
    check_text_refused("Hello, world\n", "a.txt", "not an OFF, OBJ or PLY");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "a",
                       "line 4: a coordinate is");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", "a", "not finite");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 1e999 0\n0 1 0\n3 0 1 2\n", "a", "not finite");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", "a",
                       "line 4: a coordinate should");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a",
                       "line 6: a face uses vertex 3");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "a",
                       "line 6: vertex index -1");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1 2 #\n", "a", "line 6: a face has 2");
    check_text_refused("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "a", "no faces");
    check_text_refused("OFF\n3 1 0\n0 0 0            \n1 0 0     \n", "a",
                       "ends after 2 of 3 vertices");
    check_text_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0 0000\n3 0 1", "a",
                       "ends after 0 of 1 faces");
    check_text_refused("OFF\n4000000000 1 0\n0 0 0\n", "a", "do not fit");
    check_text_refused("OFF\n1 4000000000 0\n0 0 0\n", "a", "do not fit");
    check_text_refused("OFF\n9223372036854775807 9223372036854775807 0\n0 0 0\n", "a",
                       "do not fit");
    check_text_refused("OFF\n-1 1 0\n0 0 0\n", "a", "number of vertices");
    check_text_refused("OFF BINARY\n....", "a", "binary OFF");
    check_text_refused("4OFF\n1 1 1\n", "a", "three-dimensional");
    check_text_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "a.obj",
                       "line 4: a face uses vertex 3");
    check_text_refused("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "a.obj", "line 4: vertices are");
    check_text_refused("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n", "a.obj", "line 3: vertex -3");
    check_text_refused("v 0 0 0\nv 1 0\n", "a.obj", "line 2: a vertex needs");
    check_text_refused("v 0 0 0\n\\\nv 1 0 0x\n", "a.obj", "line 3: this is not a number");
    check_text_refused("v 0 0 0\nf 1 1\n", "a.obj", "line 2: a face has 2");
    check_text_refused("v 0 0 0\nf 1 1 1a\n", "a.obj", "not a vertex number");
    check_text_refused("v 0 0 0\nf 1 1 9999999999\n", "a.obj", "out of range");
    check_text_refused("# nothing\n", "a.obj", "no vertices");
    check_text_refused("f 1 2 3\n", "a.obj", "no vertices");
}

static void refuses_bad_ply(void **state) {
    (void)state;
    check_text_refused("ply\n", "a", "within its header");
    check_text_refused("ply\nformat ascii2 1.0\n\n", "a", "line 2: unknown PLY format");
    check_text_refused("ply\nelement vertex 1\nend_header\n", "a", "no format");
    check_text_refused("ply\nproperty int x\n\n", "a", "line 2: a property before");
    check_text_refused("ply\nelement vertex -1\n\n", "a", "line 2: an element needs");
    check_text_refused("ply\nelement v 1\nproperty complex x\n\n", "a", "line 3: a property needs");
    check_text_refused("ply\nelement v 1\nproperty list float int x\n\n", "a", "whole type");
    check_text_refused("ply\nwhatever\n\n", "a", "line 2: unknown statement");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n", "a",
                       "one x, one y and one z");
    check_text_refused("no\n", "a.ply", "not a PLY");
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define LIST "property list uchar int vertex_indices\n"
    check_text_refused("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n" XYZ
                       "end_header\n1234",
                       "a", "4000000000 vertices do not fit into the 4 bytes");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 4000000000\n" XYZ "end_header\n0 0 0",
                       "a", "do not fit");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 9\n" LIST
                       "end_header\n0 0 0\n",
                       "a", "9 faces do not fit");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" LIST
                       "end_header\n0 0 0\n3 0 0 7\n",
                       "a", "uses vertex 7");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" LIST
                       "end_header\n0 0 0\n3 0 0 .5\n",
                       "a", "not a whole number");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "element face 1\n" LIST
                       "end_header\n0 0 0\n-3 0 0 0\n",
                       "a", "-3 entries");
    check_text_refused("ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n0 nan 0\n", "a",
                       "line 8: a coordinate is not finite");
    const char *header = "ply\nformat binary_big_endian 1.0\nelement vertex 1\n" XYZ "end_header\n";
    uint8_t data[256];
    size_t size = (size_t)sprintf((char *)data, "%s", header), body = size;
    put(data, &size, 0, 4, true);
    put(data, &size, 0x7f800000, 4, true);
    put(data, &size, 0, 4, true);
    char words[64];
    snprintf(words, sizeof words, "byte %zu: a coordinate is not finite", body);
    check_refused(data, size, "a", words);
}

/** Whatever bytes: a mesh within its bounds or an error, no crash. */
static void survives_damage(void **state) {
    (void)state;
    const char *texts[] = {"OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 -2 \\\n 3\n",
                           "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ "element face 1\n" LIST
                           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"};
    uint8_t original[1024], damaged[1024];
    uint64_t seed = 7;
    for (int round = 0; round < 40000; round++) {
        size_t size;
        int which = round % 5;
        if (which < 3) {
            size = strlen(texts[which]);
            memcpy(original, texts[which], size);
        } else {
            size = make_binary_ply(original, which == 3, 4);
        }
        memcpy(damaged, original, size);
        for (int change = 0; change < 1 + round % 3; change++) {
            seed = seed * 6364136223846793005u + 1442695040888963407u;
            damaged[(seed >> 33) % size] = "0123456789-. \n\r\\/#evf\xff\0x"[(seed >> 20) % 24];
        }
        gvc_mesh *mesh;
        const char *names[] = {"a.off", "a.obj", "a.ply", "a.ply", "a.ply"};
        gvc_result result =
            gvc_mesh_read_memory(damaged, size, GVC_MESH_AUTO, names[which], &mesh, NULL);
        assert_true(result == GVC_OK || result == GVC_ERROR_MESH);
        for (size_t i = 0; mesh && i < 3 * mesh->face_count; i++)
            assert_true(mesh->face[i] < mesh->vertex_count);
        gvc_mesh_destroy(&mesh);
    }
}

/* -------------------------------------------------------------------------------------- writing */

typedef struct folder {
    char path[64], file[128];
} folder;

static int set_up(void **state) {
    folder *f = calloc(1, sizeof *f);
    if (!f) return -1;
    strcpy(f->path, "/tmp/gvc-test-XXXXXX");
    *state = f;
    return mkdtemp(f->path) ? 0 : -1;
}

/** Fails if anything, such as a temporary file, is left in the folder. */
static int tear_down(void **state) {
    folder *f = *state;
    unlink(f->file);
    int result = rmdir(f->path);
    free(f);
    return result;
}

static const char *in_folder(folder *f, const char *name) {
    snprintf(f->file, sizeof f->file, "%s/%s", f->path, name);
    return f->file;
}

static gvc_mesh *make_tetrahedron(bool single) {
    const double positions[] = {0.1, -0.0, 1e-7, 1e6, 1.0 / 3, 12345678.9, -2.5e10, 7, 1, 0, 3, 2};
    const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_create(positions, 4, faces, 4, &mesh, NULL), GVC_OK);
    for (size_t i = 0; single && i < 12; i++) mesh->position[i] = (double)(float)positions[i];
    return mesh;
}

static void writes_what_it_reads(void **state) {
    folder *f = *state;
    const struct {
        const char *name;
        gvc_mesh_format format;
    } cases[] = {{"a.off", GVC_MESH_AUTO},
                 {"a.OBJ", GVC_MESH_AUTO},
                 {"a.ply", GVC_MESH_AUTO},
                 {"a", GVC_MESH_PLY_ASCII},
                 {"b", GVC_MESH_PLY_BIG_ENDIAN}};
    for (size_t i = 0; i < 10; i++) {
        bool single = i >= 5;
        const char *path = in_folder(f, cases[i % 5].name);
        gvc_mesh *mesh = make_tetrahedron(single), *again;
        gvc_error error;
        if (gvc_mesh_write_file(mesh, path, cases[i % 5].format, false, &error) != GVC_OK)
            fail_msg("%s: %s", error.where, error.message);
        if (gvc_mesh_read_file(path, GVC_MESH_AUTO, &again, &error) != GVC_OK)
            fail_msg("%s: %s", error.where, error.message);
        assert_int_equal(again->vertex_count, 4);
        assert_int_equal(again->face_count, 4);
        assert_memory_equal(again->face, mesh->face, 12 * sizeof(uint32_t));
        for (size_t k = 0; k < 12; k++) {
            if (single)
                assert_true((float)again->position[k] == (float)mesh->position[k]);
            else
                assert_true(again->position[k] == mesh->position[k]);
        }
        gvc_mesh_destroy(&mesh);
        gvc_mesh_destroy(&again);
        assert_int_equal(unlink(path), 0);
    }
}

static size_t file_size(const char *path) {
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

static void writes_floats_in_four_bytes(void **state) {
    folder *f = *state;
    const char *path = in_folder(f, "a.ply");
    gvc_mesh *mesh = make_tetrahedron(true), *other = make_tetrahedron(false);
    assert_int_equal(gvc_mesh_write_file(mesh, path, GVC_MESH_PLY, true, NULL), GVC_OK);
    size_t single = file_size(path);
    assert_int_equal(gvc_mesh_write_file(other, path, GVC_MESH_PLY, true, NULL), GVC_OK);
    assert_int_equal(file_size(path), single + 12 * 4 + 3);
    gvc_mesh_destroy(&mesh);
    gvc_mesh_destroy(&other);
}

static void keeps_existing_files(void **state) {
    folder *f = *state;
    const char *path = in_folder(f, "a.off");
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("precious", file);
    fclose(file);
    gvc_mesh *mesh = make_tetrahedron(true);
    gvc_error error;
    assert_int_equal(gvc_mesh_write_file(mesh, path, GVC_MESH_AUTO, false, &error), GVC_ERROR_IO);
    assert_non_null(strstr(error.message, "exists"));
    assert_string_equal(error.where, path);
    assert_int_equal(file_size(path), 8);
    assert_int_equal(gvc_mesh_write_file(mesh, path, GVC_MESH_AUTO, true, &error), GVC_OK);
    assert_int_not_equal(file_size(path), 8);
    gvc_mesh_destroy(&mesh);
}

static void reports_failures_of_files(void **state) {
    folder *f = *state;
    gvc_mesh *mesh = make_tetrahedron(true), *none;
    gvc_error error;
    const char *path = in_folder(f, "none/a.off");
    assert_int_equal(gvc_mesh_read_file(path, GVC_MESH_AUTO, &none, &error), GVC_ERROR_IO);
    assert_non_null(strstr(error.message, "No such file"));
    assert_string_equal(error.where, path);
    assert_int_equal(gvc_mesh_write_file(mesh, path, GVC_MESH_AUTO, true, &error), GVC_ERROR_IO);
    assert_int_equal(gvc_mesh_read_file(f->path, GVC_MESH_AUTO, &none, &error), GVC_ERROR_IO);
    assert_non_null(strstr(error.message, "irectory"));
    assert_int_equal(gvc_mesh_write_file(mesh, f->path, GVC_MESH_OFF, true, &error), GVC_ERROR_IO);
    assert_int_equal(gvc_mesh_write_file(mesh, "a.xyz", GVC_MESH_AUTO, true, &error),
                     GVC_ERROR_ARGUMENT);
    if (access("/dev/full", W_OK) == 0) {
        assert_int_equal(gvc_mesh_write_file(mesh, "/dev/full", GVC_MESH_OFF, true, &error),
                         GVC_ERROR_IO);
        assert_non_null(strstr(error.message, "space"));
        assert_string_equal(error.where, "/dev/full");
    }
    gvc_mesh_destroy(&mesh);
    f->file[0] = 0;
}

static void keeps_the_end_of_long_names(void **state) {
    (void)state;
    char name[301];
    memset(name, 'd', 300);
    strcpy(name + 290, "/mesh.off");
    gvc_mesh *mesh;
    gvc_error error;
    assert_int_equal(gvc_mesh_read_memory("OFF", 3, GVC_MESH_AUTO, name, &mesh, &error),
                     GVC_ERROR_MESH);
    assert_int_equal(strlen(error.where), sizeof error.where - 1);
    assert_memory_equal(error.where, "...ddd", 6);
    assert_string_equal(error.where + strlen(error.where) - 9, "/mesh.off");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_off),
        cmocka_unit_test(reads_obj),
        cmocka_unit_test(reads_ascii_ply),
        cmocka_unit_test(reads_binary_ply),
        cmocka_unit_test(refuses_bad_text),
        cmocka_unit_test(refuses_bad_ply),
        cmocka_unit_test(survives_damage),
        cmocka_unit_test_setup_teardown(writes_what_it_reads, set_up, tear_down),
        cmocka_unit_test_setup_teardown(writes_floats_in_four_bytes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(keeps_existing_files, set_up, tear_down),
        cmocka_unit_test_setup_teardown(reports_failures_of_files, set_up, tear_down),
        cmocka_unit_test(keeps_the_end_of_long_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
