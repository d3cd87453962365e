/* SPDX-License-Identifier: MIT */
/** @file read.c  Reading mesh files: finding out the format, and what the readers share. */
#include "mesh/read.h"

#include "base/memory.h"
#include "base/text.h"
#include "mesh/file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ----------------------------------------------------------------------------------------- text */

gvc_text gvc_text_make(const char *data, size_t size) {
    return (gvc_text){.begin = data, .position = data, .end = data + size, .line = 1};
}

void gvc_text_skip_line(gvc_text *text) {
    const char *newline = memchr(text->position, '\n', gvc_text_left(text));
    text->position = newline ? newline + 1 : text->end;
    text->line += newline != NULL;
}

bool gvc_text_skip_space(gvc_text *text, char comment) {
    while (text->position < text->end) {
        char c = *text->position;
        if (c == '\n' || (comment && c == comment))
            gvc_text_skip_line(text);
        else if (gvc_is_blank(c))
            text->position++;
        else
            return true;
    }
    return false;
}

const char *gvc_text_word(gvc_text *text, size_t *length) {
    const char *word = text->position;
    while (text->position < text->end && !gvc_is_blank(*text->position) && *text->position != '\n')
        text->position++;
    *length = (size_t)(text->position - word);
    return word;
}

static bool accept_number(gvc_text *text, const char *after) {
    if (!after || (after < text->end && !gvc_is_blank(*after) && *after != '\n')) return false;
    text->position = after;
    return true;
}

bool gvc_text_double(gvc_text *text, double *value) {
    return accept_number(text, gvc_parse_double(text->position, text->end, value));
}

bool gvc_text_int(gvc_text *text, int64_t *value) {
    return accept_number(text, gvc_parse_int(text->position, text->end, value));
}

bool gvc_word_is(const char *word, size_t length, const char *expected) {
    return strlen(expected) == length && memcmp(word, expected, length) == 0;
}

/* --------------------------------------------------------------------------------------- errors */

gvc_result gvc_fail_at(gvc_error *error, gvc_place place, const char *format, ...) {
    char message[240];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    gvc_fail(error, GVC_ERROR_MESH, "%s %llu: %s", place.binary ? "byte" : "line",
             (unsigned long long)place.number, message);
    if (error && place.binary) error->offset = place.number;
    return GVC_ERROR_MESH;
}

/* -------------------------------------------------------------------------------------- builder */

/** Room for `needed` elements of three values, exactly if nothing is there yet. */
static bool reserve(void **data, size_t *capacity, size_t needed, size_t size) {
    if (*data) return gvc_grow(data, capacity, needed, size);
    *data = gvc_alloc(needed, size);
    *capacity = *data ? needed : 0;
    return *data != NULL;
}

static bool reserve_vertices(gvc_builder *b, size_t needed) {
    void *position = b->position;
    bool done = reserve(&position, &b->vertex_capacity, needed, 3 * sizeof *b->position);
    b->position = position;
    return done;
}

static bool reserve_faces(gvc_builder *b, size_t needed) {
    void *face = b->face;
    bool done = reserve(&face, &b->face_capacity, needed, 3 * sizeof *b->face);
    b->face = face;
    return done;
}

gvc_result gvc_builder_reserve(gvc_builder *b, size_t vertex_count, size_t face_count,
                               gvc_error *error) {
    if (reserve_vertices(b, vertex_count) && reserve_faces(b, face_count)) return GVC_OK;
    return gvc_fail_memory(error);
}

gvc_result gvc_builder_vertex(gvc_builder *b, const double position[3], gvc_place place,
                              gvc_error *error) {
    if (b->vertex_count == b->vertex_capacity && !reserve_vertices(b, b->vertex_count + 1))
        return gvc_fail_memory(error);
    for (int k = 0; k < 3; k++) {
        if (!isfinite(position[k])) return gvc_fail_at(error, place, "a coordinate is not finite");
        b->position[3 * b->vertex_count + (size_t)k] = position[k];
    }
    b->vertex_count++;
    return GVC_OK;
}

gvc_result gvc_builder_corner(gvc_builder *b, gvc_polygon *polygon, int64_t index, gvc_place place,
                              gvc_error *error) {
    /* UINT32_MAX is left free as a mark. */
    if (index < 0 || index >= (int64_t)UINT32_MAX)
        return gvc_fail_at(error, place, "vertex index %lld is out of range", (long long)index);
    uint32_t vertex = (uint32_t)index;
    if (vertex > b->greatest || (b->used_at.number == 0 && !b->used_at.binary)) {
        b->greatest = vertex;
        b->used_at = place;
    }
    if (polygon->corners == 0) polygon->first = vertex;
    if (polygon->corners >= 2) {
        if (b->face_count == b->face_capacity && !reserve_faces(b, b->face_count + 1))
            return gvc_fail_memory(error);
        uint32_t *corner = b->face + 3 * b->face_count++;
        corner[0] = polygon->first;
        corner[1] = polygon->last;
        corner[2] = vertex;
    }
    polygon->last = vertex;
    polygon->corners++;
    return GVC_OK;
}

/** Hands the arrays over to a mesh. */
static gvc_result finish(gvc_builder *b, gvc_mesh **mesh, gvc_error *error) {
    if (b->vertex_count == 0) return gvc_fail(error, GVC_ERROR_MESH, "the mesh has no vertices");
    if (b->face_count == 0) return gvc_fail(error, GVC_ERROR_MESH, "the mesh has no faces");
    if (b->greatest >= b->vertex_count)
        return gvc_fail_at(error, b->used_at,
                           "a face uses vertex %lu (counting from 0) of %zu vertices",
                           (unsigned long)b->greatest, b->vertex_count);
    gvc_mesh *made = gvc_alloc(1, sizeof *made);
    if (!made) return gvc_fail_memory(error);
    *made = (gvc_mesh){.vertex_count = b->vertex_count,
                       .face_count = b->face_count,
                       .position = b->position,
                       .face = b->face};
    b->position = NULL;
    b->face = NULL;
    *mesh = made;
    return GVC_OK;
}

/* --------------------------------------------------------------------------------------- format */

static bool has_extension(const char *name, const char *extension) {
    size_t length = strlen(name), wanted = strlen(extension);
    return length > wanted && strcasecmp(name + length - wanted, extension) == 0;
}

/** By the first word, then by name, then by whether the first word is an OBJ statement. */
static gvc_mesh_format detect(const char *data, size_t size, const char *name) {
    gvc_text text = gvc_text_make(data, size);
    size_t length = 0;
    const char *word = data;
    if (gvc_text_skip_space(&text, '#')) word = gvc_text_word(&text, &length);
    if (size >= 3 && memcmp(data, "ply", 3) == 0 && gvc_word_is(word, length, "ply"))
        return GVC_MESH_PLY;
    if (gvc_is_off_keyword(word, length)) return GVC_MESH_OFF;
    if (name && has_extension(name, ".off")) return GVC_MESH_OFF;
    if (name && has_extension(name, ".obj")) return GVC_MESH_OBJ;
    if (name && has_extension(name, ".ply")) return GVC_MESH_PLY;
    return gvc_is_obj_keyword(word, length) ? GVC_MESH_OBJ : GVC_MESH_AUTO;
}

static gvc_result read_format(const char *data, size_t size, gvc_mesh_format format,
                              const char *name, gvc_builder *builder, gvc_error *error) {
    if (size == 0) return gvc_fail(error, GVC_ERROR_MESH, "the file is empty");
    if (format == GVC_MESH_AUTO) format = detect(data, size, name);
    switch (format) {
    case GVC_MESH_OFF:
        return gvc_read_off(data, size, builder, error);
    case GVC_MESH_OBJ:
        return gvc_read_obj(data, size, builder, error);
    case GVC_MESH_PLY:
    case GVC_MESH_PLY_ASCII:
    case GVC_MESH_PLY_BIG_ENDIAN:
        return gvc_read_ply(data, size, builder, error);
    case GVC_MESH_AUTO:
        break;
    }
    return gvc_fail(error, GVC_ERROR_MESH, "this is not an OFF, OBJ or PLY file");
}

gvc_result gvc_mesh_read_memory(const void *data, size_t size, gvc_mesh_format format,
                                const char *name, gvc_mesh **mesh, gvc_error *error) {
    if (!mesh) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no place for the mesh");
    *mesh = NULL;
    if (!data && size) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no data");
    if ((int)format < GVC_MESH_AUTO || (int)format > GVC_MESH_PLY_BIG_ENDIAN)
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "unknown mesh format %d", (int)format);
    gvc_builder builder = {0};
    gvc_result result = read_format(data, size, format, name, &builder, error);
    if (result == GVC_OK) result = finish(&builder, mesh, error);
    free(builder.position);
    free(builder.face);
    return result == GVC_OK ? GVC_OK : gvc_fail_in(error, result, name);
}

gvc_result gvc_mesh_read_file(const char *path, gvc_mesh_format format, gvc_mesh **mesh,
                              gvc_error *error) {
    if (!mesh) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no place for the mesh");
    *mesh = NULL;
    if (!path) return gvc_fail(error, GVC_ERROR_ARGUMENT, "no file name");
    char *data;
    size_t size;
    GVC_TRY(gvc_file_load(path, &data, &size, error));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    gvc_result result = gvc_mesh_read_memory(data, size, format, name, mesh, error);
    free(data);
    return result;
}
