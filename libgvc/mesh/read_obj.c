/* SPDX-License-Identifier: MIT */
/** @file read_obj.c  Wavefront OBJ: vertices and faces; every other statement is passed over. */
#include "mesh/read.h"

#include "base/text.h"

bool gvc_is_obj_keyword(const char *word, size_t length) {
    static const char *const keywords[] = {"v", "vt", "vn", "vp",     "f",      "l",
                                           "p", "o",  "g",  "mtllib", "usemtl", "s"};
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
        if (gvc_word_is(word, length, keywords[i])) return true;
    }
    return false;
}

static gvc_place here(const gvc_text *text) { return (gvc_place){.number = text->line}; }

/** To the next argument of the statement, over line ends after a backslash. False at its end. */
static bool next_argument(gvc_text *text) {
    for (;;) {
        gvc_text_skip_blanks(text);
        const char *p = text->position;
        if (p == text->end || *p == '\n' || *p == '#') return false;
        if (*p != '\\') return true;
        const char *q = p + 1;
        while (q < text->end && *q == '\r') q++;
        if (q == text->end || *q != '\n') return true;
        text->position = q;
        gvc_text_skip_line(text);
    }
}

static bool at_argument_end(const gvc_text *text) {
    const char *p = text->position;
    return p == text->end || gvc_is_blank(*p) || *p == '\n' || *p == '\\' || *p == '#';
}

/** A weight or colour after the three coordinates is ignored. */
static gvc_result read_vertex(gvc_text *text, gvc_builder *builder, gvc_error *error) {
    double position[3];
    for (int k = 0; k < 3; k++) {
        const char *after = NULL;
        if (next_argument(text)) after = gvc_parse_double(text->position, text->end, &position[k]);
        if (!after) return gvc_fail_at(error, here(text), "a vertex needs three coordinates");
        text->position = after;
        if (!at_argument_end(text)) return gvc_fail_at(error, here(text), "this is not a number");
    }
    return gvc_builder_vertex(builder, position, here(text), error);
}

/** "v", "v/vt", "v//vn" or "v/vt/vn": only v counts. Negative ones count back from the last vertex
 *  so far. */
static gvc_result read_corner(gvc_text *text, gvc_builder *builder, gvc_polygon *polygon,
                              gvc_error *error) {
    int64_t index;
    const char *after = gvc_parse_int(text->position, text->end, &index);
    if (!after) return gvc_fail_at(error, here(text), "a face needs vertex numbers");
    text->position = after;
    if (after < text->end && *after == '/') {
        while (!at_argument_end(text)) text->position++;
    }
    if (!at_argument_end(text))
        return gvc_fail_at(error, here(text), "this is not a vertex number");
    if (index == 0) return gvc_fail_at(error, here(text), "vertices are numbered from 1, not 0");
    if (index < 0 && index < -(int64_t)builder->vertex_count)
        return gvc_fail_at(error, here(text), "vertex %lld is before the first of %zu",
                           (long long)index, builder->vertex_count);
    index = index < 0 ? (int64_t)builder->vertex_count + index : index - 1;
    return gvc_builder_corner(builder, polygon, index, here(text), error);
}

static gvc_result read_face(gvc_text *text, gvc_builder *builder, gvc_error *error) {
    gvc_polygon polygon = {0};
    while (next_argument(text)) GVC_TRY(read_corner(text, builder, &polygon, error));
    if (polygon.corners < 3)
        return gvc_fail_at(error, here(text), "a face has %d corners", (int)polygon.corners);
    return GVC_OK;
}

gvc_result gvc_read_obj(const char *data, size_t size, gvc_builder *builder, gvc_error *error) {
    gvc_text text = gvc_text_make(data, size);
    while (gvc_text_skip_space(&text, '#')) {
        char first = *text.position;
        bool alone = gvc_text_left(&text) > 1 && gvc_is_blank(text.position[1]);
        if (alone && (first == 'v' || first == 'f')) {
            text.position++;
            GVC_TRY(first == 'v' ? read_vertex(&text, builder, error)
                                 : read_face(&text, builder, error));
        }
        gvc_text_skip_line(&text);
    }
    return GVC_OK;
}
