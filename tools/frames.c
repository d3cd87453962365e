/* SPDX-License-Identifier: MIT */
/** @file frames.c  Which files are the frames, and in what order. */
#include "frames.h"

#include "base/memory.h"
#include "base/result.h"
#include "base/text.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* ------------------------------------------------------------------------------------- pattern */

/* Splits "before%04dafter" at its one conversion. */
static bool pattern_split(const char *pattern, size_t *before, unsigned *width,
                          const char **after) {
    const char *percent = strchr(pattern, '%');
    if (!percent) return false;
    const char *c = percent + 1;
    *width = 0;
    while (isdigit((unsigned char)*c)) {
        *width = *width * 10 + (unsigned)(*c++ - '0');
        if (*width > 20) return false;
    }
    if ((*c != 'd' && *c != 'u') || strchr(c, '%')) return false;
    *before = (size_t)(percent - pattern);
    *after = c + 1;
    return true;
}

bool pattern_fill(const char *pattern, uint64_t number, char **path) {
    size_t before;
    unsigned width;
    const char *after;
    if (!pattern_split(pattern, &before, &width, &after)) return false;
    size_t room = before + 24 + strlen(after);
    *path = malloc(room);
    if (!*path) return false;
    snprintf(*path, room, "%.*s%0*llu%s", (int)before, pattern, (int)width,
             (unsigned long long)number, after);
    return true;
}

/* ------------------------------------------------------------------------------- numbered names */

/* A file name cut at its last run of digits. */
typedef struct numbered {
    size_t prefix; /* length before the number */
    uint64_t number;
    const char *suffix;
    bool has_number;
} numbered;

static numbered parse_name(const char *name) {
    numbered parsed = {.prefix = strlen(name), .suffix = name + strlen(name)};
    const char *base = strrchr(name, '/');
    base = base ? base + 1 : name;
    const char *end = name + strlen(name);
    while (end > base && !isdigit((unsigned char)end[-1])) end--;
    const char *begin = end;
    while (begin > base && isdigit((unsigned char)begin[-1])) begin--;
    int64_t value;
    if (begin == end || gvc_parse_int(begin, end, &value) != end) return parsed;
    return (numbered){.prefix = (size_t)(begin - name),
                      .number = (uint64_t)value,
                      .suffix = end,
                      .has_number = true};
}

static bool same_series(const char *a, const char *b) {
    numbered x = parse_name(a), y = parse_name(b);
    return x.has_number && y.has_number && x.prefix == y.prefix && strncmp(a, b, x.prefix) == 0 &&
           strcmp(x.suffix, y.suffix) == 0;
}

static int compare_names(const void *a, const void *b) {
    const char *x = *(char *const *)a, *y = *(char *const *)b;
    if (!same_series(x, y)) return strcmp(x, y);
    uint64_t m = parse_name(x).number, n = parse_name(y).number;
    return m < n ? -1 : m > n;
}

static const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool is_mesh_name(const char *name) {
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot &&
           (strcasecmp(dot, ".obj") == 0 || strcasecmp(dot, ".off") == 0 ||
            strcasecmp(dot, ".ply") == 0);
}

static bool is_exr_name(const char *name) {
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot && strcasecmp(dot, ".exr") == 0;
}

static gvc_result at_file(gvc_error *error, gvc_result result, const char *path) {
    return gvc_fail_in(error, result, path);
}

/* Consecutive numbers from `first` on in the list. */
static gvc_result check_gaps(const frame_list *list, size_t first, const char *what,
                             gvc_error *error) {
    for (size_t i = first + 1; i < list->count; i++) {
        uint64_t before = parse_name(list->path[i - 1]).number;
        uint64_t after = parse_name(list->path[i]).number;
        if (after == before + 1) continue;
        gvc_result result =
            after == before
                ? gvc_fail(error, GVC_ERROR_IO, "frame number %llu is there twice: %s and %s",
                           (unsigned long long)after, base_name(list->path[i - 1]),
                           base_name(list->path[i]))
                : gvc_fail(error, GVC_ERROR_IO,
                           "frames are missing: number %llu is followed by %llu (--any-order to "
                           "take them as they are)",
                           (unsigned long long)before, (unsigned long long)after);
        return at_file(error, result, what);
    }
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- listing */

static gvc_result append(frame_list *list, const char *path, gvc_error *error) {
    char *copy = strdup(path);
    if (!copy ||
        !gvc_grow((void **)&list->path, &list->capacity, list->count + 1, sizeof *list->path)) {
        free(copy);
        return gvc_fail_memory(error);
    }
    list->path[list->count++] = copy;
    return GVC_OK;
}

typedef bool (*name_filter)(const char *name, const void *user);

/* Appends the files of `folder` that pass the filter, sorted. */
static gvc_result append_folder(frame_list *list, const char *folder, name_filter filter,
                                const void *user, gvc_error *error) {
    DIR *directory = opendir(folder);
    if (!directory) {
        gvc_result result = gvc_fail(error, GVC_ERROR_IO, "cannot open: %s", strerror(errno));
        return at_file(error, result, folder);
    }
    size_t first = list->count;
    gvc_result result = GVC_OK;
    const struct dirent *entry;
    while (result == GVC_OK && (entry = readdir(directory)) != NULL) {
        if (!filter(entry->d_name, user)) continue;
        size_t room = strlen(folder) + strlen(entry->d_name) + 2;
        char *path = malloc(room);
        if (!path) {
            result = gvc_fail_memory(error);
            break;
        }
        bool slash = folder[0] && folder[strlen(folder) - 1] == '/';
        snprintf(path, room, "%s%s%s", folder, slash ? "" : "/", entry->d_name);
        result = append(list, path, error);
        free(path);
    }
    closedir(directory);
    if (result == GVC_OK && list->count > first) {
        qsort(list->path + first, list->count - first, sizeof *list->path, compare_names);
    }
    return result;
}

static bool any_frame(const char *name, const void *user) {
    const frame_list *list = user;
    return list->exr ? is_exr_name(name) : is_mesh_name(name);
}

static gvc_result add_folder(frame_list *list, const char *folder, bool any_order,
                             gvc_error *error) {
    size_t first = list->count;
    GVC_TRY(append_folder(list, folder, any_frame, list, error));
    if (list->count == first) {
        gvc_result result = gvc_fail(error, GVC_ERROR_IO, "the folder holds no %s file",
                                     list->exr ? ".exr" : ".obj, .off or .ply");
        return at_file(error, result, folder);
    }
    if (any_order) return GVC_OK;
    for (size_t i = first + 1; i < list->count; i++) {
        if (same_series(list->path[first], list->path[i])) continue;
        gvc_result result =
            gvc_fail(error, GVC_ERROR_IO, "the folder holds more than one series: %s and %s",
                     base_name(list->path[first]), base_name(list->path[i]));
        return at_file(error, result, folder);
    }
    return check_gaps(list, first, folder, error);
}

typedef struct pattern_parts {
    const char *base, *after;
    size_t before;
    unsigned width;
} pattern_parts;

static bool matches_pattern(const char *name, const void *user) {
    const pattern_parts *p = user;
    size_t length = strlen(name), tail = strlen(p->after);
    if (length <= p->before + tail || strncmp(name, p->base, p->before) != 0 ||
        strcmp(name + length - tail, p->after) != 0) {
        return false;
    }
    size_t digits = length - tail - p->before;
    if (digits < p->width) return false;
    for (size_t i = 0; i < digits; i++) {
        if (!isdigit((unsigned char)name[p->before + i])) return false;
    }
    return digits == p->width || digits == 1 || name[p->before] != '0';
}

static gvc_result add_pattern(frame_list *list, const char *pattern, bool any_order,
                              gvc_error *error) {
    pattern_parts parts = {.base = base_name(pattern)};
    size_t first = list->count;
    if (!pattern_split(parts.base, &parts.before, &parts.width, &parts.after)) {
        gvc_result result =
            gvc_fail(error, GVC_ERROR_ARGUMENT,
                     "a pattern has one %%d in its last part, as in scan/%%04d.obj");
        return at_file(error, result, pattern);
    }
    char *folder = strdup(pattern);
    if (!folder) return gvc_fail_memory(error);
    folder[parts.base - pattern] = '\0';
    gvc_result result =
        append_folder(list, folder[0] ? folder : ".", matches_pattern, &parts, error);
    free(folder);
    if (result != GVC_OK) return result;
    if (list->count == first) {
        return at_file(error, gvc_fail(error, GVC_ERROR_IO, "no file matches the pattern"),
                       pattern);
    }
    return any_order ? GVC_OK : check_gaps(list, first, pattern, error);
}

static gvc_result add_argument(frame_list *list, const char *argument, bool any_order,
                               gvc_error *error) {
    struct stat status;
    if (strcmp(argument, "-") == 0 && !list->exr) {
        if (list->standard_input) {
            return gvc_fail(error, GVC_ERROR_ARGUMENT, "standard input can be only one frame");
        }
        GVC_TRY(gvc_mesh_read_file("-", GVC_MESH_AUTO, &list->standard_input, error));
        return append(list, argument, error);
    }
    if (stat(argument, &status) == 0) {
        return S_ISDIR(status.st_mode) ? add_folder(list, argument, any_order, error)
                                       : append(list, argument, error);
    }
    if (strchr(argument, '%')) return add_pattern(list, argument, any_order, error);
    return at_file(error, gvc_fail(error, GVC_ERROR_IO, "cannot open: %s", strerror(errno)),
                   argument);
}

/* Files of one series given one by one, or by a shell that sorts frame10 before frame9, must be in
 * order. */
static gvc_result check_order(const frame_list *list, gvc_error *error) {
    for (size_t i = 1; i < list->count; i++) {
        const char *before = list->path[i - 1], *after = list->path[i];
        if (!same_series(before, after)) continue;
        if (parse_name(before).number < parse_name(after).number) continue;
        gvc_result result = gvc_fail(error, GVC_ERROR_IO,
                                     "frames are out of order: it comes after %s "
                                     "(--any-order to take them as given, or name the folder)",
                                     base_name(before));
        return gvc_at_frame(error, at_file(error, result, after), (int64_t)i);
    }
    return GVC_OK;
}

static gvc_result make_list(char *const *argument, int count, bool any_order, frame_list *list,
                            gvc_error *error) {
    gvc_result result = GVC_OK;
    for (int i = 0; i < count && result == GVC_OK; i++) {
        result = add_argument(list, argument[i], any_order, error);
    }
    if (result == GVC_OK && !any_order) result = check_order(list, error);
    if (result != GVC_OK) frame_list_free(list);
    return result;
}

gvc_result frame_list_make(char *const *argument, int count, bool any_order, frame_list *list,
                           gvc_error *error) {
    *list = (frame_list){0};
    return make_list(argument, count, any_order, list, error);
}

gvc_result frame_list_make_exr(char *const *argument, int count, bool any_order, frame_list *list,
                               gvc_error *error) {
    *list = (frame_list){.exr = true};
    return make_list(argument, count, any_order, list, error);
}

void frame_list_free(frame_list *list) {
    for (size_t i = 0; i < list->count; i++) free(list->path[i]);
    free(list->path);
    gvc_mesh_destroy(&list->standard_input);
    *list = (frame_list){0};
}

/* -------------------------------------------------------------------------------------- source */

static gvc_result read_frame(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    const frame_list *list = user;
    const char *path = list->path[frame];
    if (strcmp(path, "-") != 0) return gvc_mesh_read_file(path, GVC_MESH_AUTO, mesh, error);
    const gvc_mesh *kept = list->standard_input;
    return gvc_mesh_create(gvc_mesh_positions(kept), gvc_mesh_vertex_count(kept),
                           gvc_mesh_faces(kept), gvc_mesh_face_count(kept), mesh, error);
}

/* Standard input has no name. */
static const char *frame_name(void *user, uint64_t frame) {
    const frame_list *list = user;
    return strcmp(list->path[frame], "-") == 0 ? NULL : list->path[frame];
}

gvc_source frame_list_source(frame_list *list) {
    return (gvc_source){
        .user = list, .frame_count = list->count, .read = read_frame, .name = frame_name};
}
