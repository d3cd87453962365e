/* SPDX-License-Identifier: MIT */
/** @file read_off.c  Object File Format (Geomview's OFF, ASCII, three dimensions). */
#include "mesh/read.h"

#include <string.h>

bool gvc_is_off_keyword(const char *word, size_t length) {
    const char *end = word + length;
    if (length >= 2 && memcmp(word, "ST", 2) == 0) word += 2;
    if (word < end && *word == 'C') word++;
    if (word < end && *word == 'N') word++;
    if (word < end && *word == '4') word++;
    if (word < end && *word == 'n') word++;
    return gvc_word_is(word, (size_t)(end - word), "OFF");
}

static gvc_place here(const gvc_text *text) { return (gvc_place){.number = text->line}; }

static gvc_result read_count(gvc_text *text, const char *of, size_t *count, gvc_error *error) {
    int64_t value;
    if (!gvc_text_skip_space(text, '#') || !gvc_text_int(text, &value) || value < 0)
        return gvc_fail_at(error, here(text), "the number of %s should be here", of);
    *count = (size_t)value;
    return GVC_OK;
}

/** The keyword, which Geomview lets one leave out, and the counts. The number of edges, and
 * whatever else is on the line, is ignored. */
static gvc_result read_header(gvc_text *text, size_t *vertex_count, size_t *face_count,
                              gvc_error *error) {
    gvc_text_skip_space(text, '#');
    gvc_text after = *text;
    size_t length;
    const char *word = gvc_text_word(&after, &length);
    if (gvc_is_off_keyword(word, length)) {
        if (memchr(word, '4', length) || memchr(word, 'n', length))
            return gvc_fail_at(error, here(text), "only three-dimensional OFF files can be read");
        *text = after;
        gvc_text_skip_blanks(&after);
        word = gvc_text_word(&after, &length);
        if (gvc_word_is(word, length, "BINARY"))
            return gvc_fail_at(error, here(text), "binary OFF files cannot be read");
    }
    GVC_TRY(read_count(text, "vertices", vertex_count, error));
    GVC_TRY(read_count(text, "faces", face_count, error));
    gvc_text_skip_line(text);
    /* At least "0 0 0\n" and "3 0 0 0\n", the very last newline left out. */
    size_t left = gvc_text_left(text) + 1;
    if (*vertex_count > left / 6 || *face_count > (left - 6 * *vertex_count) / 8)
        return gvc_fail_at(error, here(text),
                           "%zu vertices and %zu faces do not fit into the %zu bytes that follow",
                           *vertex_count, *face_count, left - 1);
    return GVC_OK;
}

/** Colours, normals and texture coordinates after the three coordinates are ignored. */
static gvc_result read_vertex(gvc_text *text, size_t number, size_t count, gvc_builder *builder,
                              gvc_error *error) {
    double position[3];
    gvc_place place = here(text);
    for (int k = 0; k < 3; k++) {
        if (!gvc_text_skip_space(text, '#'))
            return gvc_fail_at(error, here(text), "the file ends after %zu of %zu vertices", number,
                               count);
        if (k == 0) place = here(text);
        if (!gvc_text_double(text, &position[k]))
            return gvc_fail_at(error, here(text), "a coordinate should be here");
    }
    gvc_text_skip_line(text);
    return gvc_builder_vertex(builder, position, place, error);
}

/** A colour after the indices is ignored. */
static gvc_result read_face(gvc_text *text, size_t number, size_t count, gvc_builder *builder,
                            gvc_error *error) {
    int64_t corners = 0;
    gvc_polygon polygon = {0};
    for (int64_t k = -1; k < corners; k++) {
        int64_t value;
        if (!gvc_text_skip_space(text, '#'))
            return gvc_fail_at(error, here(text), "the file ends after %zu of %zu faces", number,
                               count);
        if (!gvc_text_int(text, &value))
            return gvc_fail_at(error, here(text), "a whole number should be here");
        if (k >= 0) {
            GVC_TRY(gvc_builder_corner(builder, &polygon, value, here(text), error));
            continue;
        }
        corners = value;
        if (corners < 3)
            return gvc_fail_at(error, here(text), "a face has %lld corners", (long long)corners);
    }
    gvc_text_skip_line(text);
    return GVC_OK;
}

gvc_result gvc_read_off(const char *data, size_t size, gvc_builder *builder, gvc_error *error) {
    gvc_text text = gvc_text_make(data, size);
    size_t vertex_count = 0, face_count = 0;
    GVC_TRY(read_header(&text, &vertex_count, &face_count, error));
    GVC_TRY(gvc_builder_reserve(builder, vertex_count, face_count, error));
    for (size_t v = 0; v < vertex_count; v++)
        GVC_TRY(read_vertex(&text, v, vertex_count, builder, error));
    for (size_t f = 0; f < face_count; f++)
        GVC_TRY(read_face(&text, f, face_count, builder, error));
    return GVC_OK;
}
