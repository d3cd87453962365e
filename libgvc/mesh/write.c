/* SPDX-License-Identifier: MIT */
/** @file write.c  Writing meshes as OFF, OBJ and PLY. */
#include "base/output.h"
#include "base/text.h"
#include "mesh/mesh.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { ROW = 128 }; /* more than three numbers of text, or one vertex or face of PLY, take */

static gvc_mesh_format format_of_name(const char *path) {
    const char *dot = strrchr(path, '.');
    if (!dot) return GVC_MESH_AUTO;
    if (strcasecmp(dot, ".off") == 0) return GVC_MESH_OFF;
    if (strcasecmp(dot, ".obj") == 0) return GVC_MESH_OBJ;
    return strcasecmp(dot, ".ply") == 0 ? GVC_MESH_PLY : GVC_MESH_AUTO;
}

/* ----------------------------------------------------------------------------------------- text */

/** `lead`, then three coordinates, then a newline. */
static void put_position(gvc_output *out, const char *lead, const double *position) {
    char *begin = gvc_output_room(out, ROW), *p = begin;
    while (*lead) *p++ = *lead++;
    for (int k = 0; k < 3; k++) {
        p += gvc_format_double(p, position[k]);
        *p++ = k < 2 ? ' ' : '\n';
    }
    gvc_output_advance(out, (size_t)(p - begin));
}

static void put_face(gvc_output *out, const char *lead, const uint32_t *face, uint64_t base) {
    char *begin = gvc_output_room(out, ROW), *p = begin;
    while (*lead) *p++ = *lead++;
    for (int k = 0; k < 3; k++) {
        p += gvc_format_uint(p, face[k] + base);
        *p++ = k < 2 ? ' ' : '\n';
    }
    gvc_output_advance(out, (size_t)(p - begin));
}

static void put_text(const gvc_mesh *mesh, gvc_output *out, const char *vertex_lead,
                     const char *face_lead, uint64_t base) {
    for (size_t v = 0; v < mesh->vertex_count; v++)
        put_position(out, vertex_lead, mesh->position + 3 * v);
    for (size_t f = 0; f < mesh->face_count; f++)
        put_face(out, face_lead, mesh->face + 3 * f, base);
}

static void write_off(const gvc_mesh *mesh, gvc_output *out) {
    int length = snprintf(gvc_output_room(out, ROW), ROW, "OFF\n%zu %zu 0\n", mesh->vertex_count,
                          mesh->face_count);
    gvc_output_advance(out, (size_t)length);
    put_text(mesh, out, "", "3 ", 0);
}

static void write_obj(const gvc_mesh *mesh, gvc_output *out) { put_text(mesh, out, "v ", "f ", 1); }

/* ------------------------------------------------------------------------------------------ PLY */

static bool is_single(const gvc_mesh *mesh) {
    for (size_t i = 0; i < 3 * mesh->vertex_count; i++) {
        double value = mesh->position[i];
        if (!(fabs(value) <= (double)FLT_MAX) || (double)(float)value != value) return false;
    }
    return true;
}

static char *put_bits(char *p, uint64_t bits, size_t size, bool big) {
    for (size_t i = 0; i < size; i++) p[i] = (char)(bits >> 8 * (big ? size - 1 - i : i) & 0xff);
    return p + size;
}

static void put_binary(const gvc_mesh *mesh, gvc_output *out, bool single, bool big) {
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        char *begin = gvc_output_room(out, ROW), *p = begin;
        for (size_t k = 0; k < 3; k++) {
            double value = mesh->position[3 * v + k];
            float narrow = single ? (float)value : 0;
            uint64_t bits;
            uint32_t narrow_bits;
            memcpy(&bits, &value, sizeof bits);
            memcpy(&narrow_bits, &narrow, sizeof narrow_bits);
            p = single ? put_bits(p, narrow_bits, 4, big) : put_bits(p, bits, 8, big);
        }
        gvc_output_advance(out, (size_t)(p - begin));
    }
    for (size_t f = 0; f < mesh->face_count; f++) {
        char *begin = gvc_output_room(out, ROW), *p = begin;
        *p++ = 3;
        for (size_t k = 0; k < 3; k++) p = put_bits(p, mesh->face[3 * f + k], 4, big);
        gvc_output_advance(out, (size_t)(p - begin));
    }
}

static void write_ply(const gvc_mesh *mesh, gvc_mesh_format format, gvc_output *out) {
    enum { HEADER = 512 };
    bool single = is_single(mesh);
    const char *encoding = format == GVC_MESH_PLY_ASCII        ? "ascii"
                           : format == GVC_MESH_PLY_BIG_ENDIAN ? "binary_big_endian"
                                                               : "binary_little_endian";
    const char *type = single ? "float" : "double";
    /* Readers know signed indices best. */
    const char *index = mesh->vertex_count <= INT32_MAX ? "int" : "uint";
    int length = snprintf(gvc_output_room(out, HEADER), HEADER,
                          "ply\nformat %s 1.0\nelement vertex %zu\n"
                          "property %s x\nproperty %s y\nproperty %s z\n"
                          "element face %zu\nproperty list uchar %s vertex_indices\nend_header\n",
                          encoding, mesh->vertex_count, type, type, type, mesh->face_count, index);
    gvc_output_advance(out, (size_t)length);
    if (format == GVC_MESH_PLY_ASCII)
        put_text(mesh, out, "", "3 ", 0);
    else
        put_binary(mesh, out, single, format == GVC_MESH_PLY_BIG_ENDIAN);
}

gvc_result gvc_mesh_write_file(const gvc_mesh *mesh, const char *path, gvc_mesh_format format,
                               bool overwrite, gvc_error *error) {
    if (!mesh || !path) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no mesh or no file name");
    if (format == GVC_MESH_AUTO) format = format_of_name(path);
    if ((int)format <= GVC_MESH_AUTO || (int)format > GVC_MESH_PLY_BIG_ENDIAN) {
        gvc_fail(error, GVC_ERROR_ARGUMENT,
                 "the name of a mesh file should end in .off, .obj or .ply");
        return gvc_fail_in(error, GVC_ERROR_ARGUMENT, path);
    }
    gvc_output out;
    GVC_TRY(gvc_output_begin(path, overwrite, &out, error));
    if (format == GVC_MESH_OFF)
        write_off(mesh, &out);
    else if (format == GVC_MESH_OBJ)
        write_obj(mesh, &out);
    else
        write_ply(mesh, format, &out);
    return gvc_output_end(&out, error);
}
