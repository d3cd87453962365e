/* SPDX-License-Identifier: MIT */
/** @file read_ply.c  Polygon File Format (PLY 1.0): ASCII and both binary byte orders. */
#include "mesh/read.h"

#include <math.h>
#include <string.h>

enum { MAX_ELEMENTS = 64, MAX_PROPERTIES = 1024 };

typedef enum scalar { NO_TYPE, INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64 } scalar;
typedef enum role { OTHER, X, Y, Z, CORNERS } role;
typedef enum encoding { UNKNOWN, ASCII, LITTLE, BIG } encoding;

typedef struct property {
    scalar count_type; /**< NO_TYPE unless it is a list */
    scalar type;
    role role;
} property;

typedef struct element {
    bool is_vertex, is_face;
    uint64_t count;
    size_t first_property, property_count;
} element;

typedef struct ply {
    gvc_text text;
    encoding encoding;
    size_t element_count, property_count;
    element element[MAX_ELEMENTS];
    property property[MAX_PROPERTIES];
} ply;

static gvc_place here(const ply *p) {
    if (p->encoding == ASCII || p->encoding == UNKNOWN) return (gvc_place){.number = p->text.line};
    return (gvc_place){.binary = true, .number = (uint64_t)(p->text.position - p->text.begin)};
}

/* -------------------------------------------------------------------------------------- header */

/** Errors in the header have lines, even if the body is binary. */
static gvc_place header_line(const ply *p) { return (gvc_place){.number = p->text.line}; }

static scalar parse_type(gvc_text *text) {
    static const struct {
        const char *name;
        scalar type;
    } types[] = {
        {"char", INT8},     {"int8", INT8},       {"uchar", UINT8},    {"uint8", UINT8},
        {"short", INT16},   {"int16", INT16},     {"ushort", UINT16},  {"uint16", UINT16},
        {"int", INT32},     {"int32", INT32},     {"uint", UINT32},    {"uint32", UINT32},
        {"float", FLOAT32}, {"float32", FLOAT32}, {"double", FLOAT64}, {"float64", FLOAT64}};
    size_t length;
    gvc_text_skip_blanks(text);
    const char *word = gvc_text_word(text, &length);
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        if (gvc_word_is(word, length, types[i].name)) return types[i].type;
    }
    return NO_TYPE;
}

static gvc_result parse_encoding(ply *p, gvc_error *error) {
    size_t length;
    gvc_text_skip_blanks(&p->text);
    const char *word = gvc_text_word(&p->text, &length);
    if (gvc_word_is(word, length, "ascii"))
        p->encoding = ASCII;
    else if (gvc_word_is(word, length, "binary_little_endian"))
        p->encoding = LITTLE;
    else if (gvc_word_is(word, length, "binary_big_endian"))
        p->encoding = BIG;
    else
        return gvc_fail_at(error, header_line(p), "unknown PLY format");
    return GVC_OK;
}

static gvc_result parse_element(ply *p, gvc_error *error) {
    size_t length;
    int64_t count;
    gvc_text_skip_blanks(&p->text);
    const char *name = gvc_text_word(&p->text, &length);
    gvc_text_skip_blanks(&p->text);
    if (!gvc_text_int(&p->text, &count) || count < 0)
        return gvc_fail_at(error, header_line(p), "an element needs a name and a count");
    if (p->element_count == MAX_ELEMENTS)
        return gvc_fail_at(error, header_line(p), "more than %d elements", MAX_ELEMENTS);
    element made = {.is_vertex = gvc_word_is(name, length, "vertex"),
                    .is_face = gvc_word_is(name, length, "face"),
                    .count = (uint64_t)count,
                    .first_property = p->property_count};
    for (size_t i = 0; i < p->element_count; i++) {
        if (made.is_vertex && p->element[i].is_vertex)
            return gvc_fail_at(error, header_line(p), "a second element \"vertex\"");
    }
    p->element[p->element_count++] = made;
    return GVC_OK;
}

static role role_of(const element *owner, bool list, const char *name, size_t length) {
    if (owner->is_vertex && !list && length == 1 && name[0] >= 'x' && name[0] <= 'z')
        return (role)(X + (name[0] - 'x'));
    bool corners =
        gvc_word_is(name, length, "vertex_indices") || gvc_word_is(name, length, "vertex_index");
    return owner->is_face && list && corners ? CORNERS : OTHER;
}

static gvc_result parse_property(ply *p, gvc_error *error) {
    if (p->element_count == 0)
        return gvc_fail_at(error, header_line(p), "a property before any element");
    if (p->property_count == MAX_PROPERTIES)
        return gvc_fail_at(error, header_line(p), "more than %d properties", MAX_PROPERTIES);
    property made = {0};
    gvc_text after = p->text;
    size_t length;
    gvc_text_skip_blanks(&after);
    const char *word = gvc_text_word(&after, &length);
    bool list = gvc_word_is(word, length, "list");
    if (list) {
        p->text = after;
        made.count_type = parse_type(&p->text);
        if (made.count_type == NO_TYPE || made.count_type >= FLOAT32)
            return gvc_fail_at(error, header_line(p), "a list needs a whole type for its length");
    }
    made.type = parse_type(&p->text);
    gvc_text_skip_blanks(&p->text);
    const char *name = gvc_text_word(&p->text, &length);
    if (made.type == NO_TYPE || length == 0)
        return gvc_fail_at(error, header_line(p), "a property needs a known type and a name");
    element *owner = &p->element[p->element_count - 1];
    made.role = role_of(owner, list, name, length);
    owner->property_count++;
    p->property[p->property_count++] = made;
    return GVC_OK;
}

static gvc_result check_vertex(const ply *p, const element *e, gvc_error *error) {
    int met[CORNERS + 1] = {0};
    for (size_t i = 0; i < e->property_count; i++) met[p->property[e->first_property + i].role]++;
    if (met[X] != 1 || met[Y] != 1 || met[Z] != 1)
        return gvc_fail_at(error, header_line(p), "vertices need one x, one y and one z each");
    return GVC_OK;
}

static gvc_result finish_header(ply *p, gvc_error *error) {
    if (p->encoding == UNKNOWN)
        return gvc_fail_at(error, header_line(p), "no format in the header");
    for (size_t i = 0; i < p->element_count; i++) {
        if (p->element[i].is_vertex) GVC_TRY(check_vertex(p, &p->element[i], error));
    }
    gvc_text_skip_line(&p->text);
    return GVC_OK;
}

static gvc_result read_header(ply *p, gvc_error *error) {
    gvc_text *text = &p->text;
    size_t length;
    const char *word = gvc_text_word(text, &length);
    if (!gvc_word_is(word, length, "ply"))
        return gvc_fail_at(error, header_line(p), "this is not a PLY file");
    for (;;) {
        gvc_text_skip_line(text);
        if (gvc_text_left(text) == 0)
            return gvc_fail_at(error, header_line(p), "the file ends within its header");
        gvc_text_skip_blanks(text);
        word = gvc_text_word(text, &length);
        if (gvc_word_is(word, length, "format"))
            GVC_TRY(parse_encoding(p, error));
        else if (gvc_word_is(word, length, "element"))
            GVC_TRY(parse_element(p, error));
        else if (gvc_word_is(word, length, "property"))
            GVC_TRY(parse_property(p, error));
        else if (gvc_word_is(word, length, "end_header"))
            return finish_header(p, error);
        else if (length && !gvc_word_is(word, length, "comment") &&
                 !gvc_word_is(word, length, "obj_info"))
            return gvc_fail_at(error, header_line(p), "unknown statement in the PLY header");
    }
}

/* ---------------------------------------------------------------------------------------- body */

static size_t size_of(scalar type) {
    static const size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[type];
}

static double decode(uint64_t bits, scalar type) {
    float single;
    double value;
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case INT8:
        return (double)(bits & 0x7f) - (double)(bits & 0x80);
    case INT16:
        return (double)(bits & 0x7fff) - (double)(bits & 0x8000);
    case INT32:
        return (double)(bits & 0x7fffffff) - (double)(bits & 0x80000000);
    case FLOAT32:
        memcpy(&single, &low, sizeof single);
        return (double)single;
    case FLOAT64:
        memcpy(&value, &bits, sizeof value);
        return value;
    case NO_TYPE:
    case UINT8:
    case UINT16:
    case UINT32:
        break;
    }
    return (double)bits;
}

static gvc_result read_scalar(ply *p, scalar type, double *value, gvc_error *error) {
    gvc_text *text = &p->text;
    if (p->encoding == ASCII) {
        if (!gvc_text_skip_space(text, 0))
            return gvc_fail_at(error, here(p), "the file ends too early");
        if (!gvc_text_double(text, value))
            return gvc_fail_at(error, here(p), "this is not a number");
        return GVC_OK;
    }
    size_t size = size_of(type);
    if (gvc_text_left(text) < size) return gvc_fail_at(error, here(p), "the file ends too early");
    const unsigned char *bytes = (const unsigned char *)text->position;
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits = bits << 8 | bytes[p->encoding == LITTLE ? size - 1 - i : i];
    text->position += size;
    *value = decode(bits, type);
    return GVC_OK;
}

static gvc_result read_whole(ply *p, scalar type, int64_t *whole, gvc_error *error) {
    double value;
    gvc_place place = here(p);
    GVC_TRY(read_scalar(p, type, &value, error));
    if (!(fabs(value) < 0x1p53) || value != floor(value))
        return gvc_fail_at(error, place, "this is not a whole number");
    *whole = (int64_t)value;
    return GVC_OK;
}

static gvc_result read_list(ply *p, const property *list, gvc_builder *builder, gvc_error *error) {
    int64_t count = 0, index = 0;
    double ignored;
    gvc_place place = here(p);
    GVC_TRY(read_whole(p, list->count_type, &count, error));
    if (count < 0) return gvc_fail_at(error, place, "a list has %lld entries", (long long)count);
    if (list->role != CORNERS) {
        for (int64_t i = 0; i < count; i++) GVC_TRY(read_scalar(p, list->type, &ignored, error));
        return GVC_OK;
    }
    if (count < 3) return gvc_fail_at(error, place, "a face has %lld corners", (long long)count);
    gvc_polygon polygon = {0};
    for (int64_t i = 0; i < count; i++) {
        place = here(p);
        GVC_TRY(read_whole(p, list->type, &index, error));
        GVC_TRY(gvc_builder_corner(builder, &polygon, index, place, error));
    }
    return GVC_OK;
}

/** The bytes that each entry of the element has at least. In ASCII a digit and a blank a value. */
static size_t least_size(const ply *p, const element *e) {
    size_t size = 0;
    for (size_t i = 0; i < e->property_count; i++) {
        const property *q = &p->property[e->first_property + i];
        size +=
            p->encoding == ASCII ? 2 : size_of(q->count_type != NO_TYPE ? q->count_type : q->type);
    }
    return size;
}

static gvc_result read_entry(ply *p, const element *e, gvc_builder *builder, gvc_error *error) {
    double position[3] = {0}, value = 0;
    gvc_place place = here(p);
    for (size_t i = 0; i < e->property_count; i++) {
        const property *q = &p->property[e->first_property + i];
        if (q->count_type != NO_TYPE) {
            GVC_TRY(read_list(p, q, builder, error));
            continue;
        }
        GVC_TRY(read_scalar(p, q->type, &value, error));
        if (q->role != OTHER) position[q->role - X] = value;
    }
    if (p->encoding == ASCII) place = here(p); /* the entry may have begun after a line's end */
    return e->is_vertex ? gvc_builder_vertex(builder, position, place, error) : GVC_OK;
}

static gvc_result read_element(ply *p, const element *e, gvc_builder *builder, gvc_error *error) {
    size_t least = least_size(p, e);
    if (least == 0) return GVC_OK;
    size_t left = gvc_text_left(&p->text) + (p->encoding == ASCII); /* no newline at the very end */
    if (e->count > left / least)
        return gvc_fail_at(error, here(p), "%llu %s do not fit into the %zu bytes that are left",
                           (unsigned long long)e->count,
                           e->is_vertex ? "vertices"
                           : e->is_face ? "faces"
                                        : "elements",
                           gvc_text_left(&p->text));
    size_t count = (size_t)e->count;
    if (e->is_vertex || e->is_face)
        GVC_TRY(gvc_builder_reserve(builder, e->is_vertex ? count : builder->vertex_count,
                                    e->is_face ? count : 0, error));
    for (size_t i = 0; i < count; i++) GVC_TRY(read_entry(p, e, builder, error));
    return GVC_OK;
}

gvc_result gvc_read_ply(const char *data, size_t size, gvc_builder *builder, gvc_error *error) {
    ply p = {.text = gvc_text_make(data, size)};
    GVC_TRY(read_header(&p, error));
    for (size_t i = 0; i < p.element_count; i++)
        GVC_TRY(read_element(&p, &p.element[i], builder, error));
    return GVC_OK;
}
