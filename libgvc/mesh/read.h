/* SPDX-License-Identifier: MIT */
/** @file read.h  What the mesh readers share: lines of text, and a mesh that grows. */
#ifndef GVC_MESH_READ_H
#define GVC_MESH_READ_H

#include "mesh/mesh.h"

/** Cursor over text. Blanks are all white space but the newline. */
typedef struct gvc_text {
    const char *begin, *position, *end;
    size_t line; /**< of `position`, from 1 */
} gvc_text;

gvc_text gvc_text_make(const char *data, size_t size);
static inline size_t gvc_text_left(const gvc_text *text) {
    return (size_t)(text->end - text->position);
}
static inline bool gvc_is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}
static inline void gvc_text_skip_blanks(gvc_text *text) {
    while (text->position < text->end && gvc_is_blank(*text->position)) text->position++;
}
/** To the beginning of the next line, or to the end. */
void gvc_text_skip_line(gvc_text *text);
/** Over blanks, newlines and, if `comment` is not 0, comments from that character to the end of the
 *  line. False at the end of the text. */
bool gvc_text_skip_space(gvc_text *text, char comment);
/** The bytes up to the next blank or newline, which are passed; `*length` may be 0. */
const char *gvc_text_word(gvc_text *text, size_t *length);
/** A number that ends at a blank, a newline or the end; false, not moving, if there is none here.
 */
bool gvc_text_double(gvc_text *text, double *value);
bool gvc_text_int(gvc_text *text, int64_t *value);
bool gvc_word_is(const char *word, size_t length, const char *expected);

/** A place in the input for messages: a line, or a byte offset in binary files. */
typedef struct gvc_place {
    bool binary;
    uint64_t number;
} gvc_place;

/** GVC_ERROR_MESH at a place: "line 7: <message>" or "byte 90: <message>". */
gvc_result gvc_fail_at(gvc_error *error, gvc_place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/** A mesh that grows. Vertex indices are checked at the end, as faces may come before vertices. */
typedef struct gvc_builder {
    double *position;
    uint32_t *face;
    size_t vertex_count, vertex_capacity;
    size_t face_count, face_capacity;
    uint32_t greatest; /**< vertex index used by any face ... */
    gvc_place used_at; /**< ... and the first place where it is */
} gvc_builder;

/** Makes room for exactly these counts beforehand; callers have compared them with the bytes left.
 */
gvc_result gvc_builder_reserve(gvc_builder *builder, size_t vertex_count, size_t face_count,
                               gvc_error *error);
gvc_result gvc_builder_vertex(gvc_builder *builder, const double position[3], gvc_place place,
                              gvc_error *error);

/** A polygon arriving corner by corner, fanned from its first one. */
typedef struct gvc_polygon {
    uint32_t first, last;
    uint64_t corners;
} gvc_polygon;

/** `index` counts from 0 and may be anything. */
gvc_result gvc_builder_corner(gvc_builder *builder, gvc_polygon *polygon, int64_t index,
                              gvc_place place, gvc_error *error);

/* The formats. They fill `builder`, which the caller owns, and do not name the file in errors. */
gvc_result gvc_read_off(const char *data, size_t size, gvc_builder *builder, gvc_error *error);
gvc_result gvc_read_obj(const char *data, size_t size, gvc_builder *builder, gvc_error *error);
gvc_result gvc_read_ply(const char *data, size_t size, gvc_builder *builder, gvc_error *error);

/** Whether `word` is the keyword of an OFF file: [ST][C][N][4][n]OFF. */
bool gvc_is_off_keyword(const char *word, size_t length);
/** Whether `word` is a statement of an OBJ file. */
bool gvc_is_obj_keyword(const char *word, size_t length);

#endif
