/* SPDX-License-Identifier: MIT */
/** @file compare_zip.c  Zipped OFF files: text of a mesh, and what an archive of them costs. */
#include "compare_zip.h"
#include "base/result.h"
#include "base/text.h"
#include "compare_clock.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <zip.h>

#define DEFLATE_LEVEL 9

/* --------------------------------------------------------------------------------- OFF text */

static void append_text(gvc_buffer *text, const char *added) {
    gvc_write_bytes(text, added, strlen(added));
}

static void append_uint(gvc_buffer *text, uint64_t value, char after) {
    char digits[32];
    size_t length = gvc_format_uint(digits, value);
    digits[length] = after;
    gvc_write_bytes(text, digits, length + 1);
}

static void append_double(gvc_buffer *text, double value, char after) {
    char digits[33];
    size_t length = gvc_format_double(digits, value);
    digits[length] = after;
    gvc_write_bytes(text, digits, length + 1);
}

void compare_off_text(const gvc_mesh *mesh, gvc_buffer *text) {
    size_t vertices = gvc_mesh_vertex_count(mesh), faces = gvc_mesh_face_count(mesh);
    const double *position = gvc_mesh_positions(mesh);
    const uint32_t *face = gvc_mesh_faces(mesh);
    append_text(text, "OFF\n");
    append_uint(text, vertices, ' ');
    append_uint(text, faces, ' ');
    append_text(text, "0\n");
    for (size_t i = 0; i < 3 * vertices; i++) {
        append_double(text, position[i], i % 3 == 2 ? '\n' : ' ');
    }
    for (size_t h = 0; h < 3 * faces; h++) {
        if (h % 3 == 0) append_text(text, "3 ");
        append_uint(text, face[h], h % 3 == 2 ? '\n' : ' ');
    }
}

/* ---------------------------------------------------------------------------------- writing */

/* State of one archive being written. libzip reads its entries one after the other when the archive
 * is closed; an entry is fetched when libzip first asks for it and freed when it has been read. */
typedef struct archive {
    const compare_zip_entries *entries;
    double fetch_seconds;
    gvc_result result; /* of the first entry that could not be fetched */
    gvc_error error;
} archive;

typedef struct entry {
    archive *owner;
    uint64_t index;
    bool fetched;
    size_t position;
    gvc_buffer bytes;
} entry;

static bool fetch(entry *e) {
    archive *owner = e->owner;
    if (e->fetched) return true;
    if (owner->result != GVC_OK) return false;
    double begin = compare_thread_seconds();
    owner->result = owner->entries->read(owner->entries->user, e->index, &e->bytes, &owner->error);
    if (owner->result == GVC_OK && e->bytes.failed) owner->result = gvc_fail_memory(&owner->error);
    owner->fetch_seconds += compare_thread_seconds() - begin;
    e->fetched = owner->result == GVC_OK;
    return e->fetched;
}

static void drop(entry *e) {
    gvc_buffer_free(&e->bytes);
    e->fetched = false;
    e->position = 0;
}

static zip_int64_t report_size(entry *e, void *data, zip_uint64_t size) {
    if (size < sizeof(zip_stat_t) || !fetch(e)) return -1;
    zip_stat_t *facts = data;
    zip_stat_init(facts);
    facts->size = e->bytes.size;
    facts->mtime = 0; /* the same archive every time */
    facts->valid = ZIP_STAT_SIZE | ZIP_STAT_MTIME;
    return sizeof *facts;
}

static zip_int64_t read_some(entry *e, void *data, zip_uint64_t size) {
    size_t left = e->bytes.size - e->position;
    size_t taken = size < left ? (size_t)size : left;
    if (taken > 0) memcpy(data, e->bytes.data + e->position, taken);
    e->position += taken;
    return (zip_int64_t)taken;
}

/* The callback behind one entry, see zip_source_function(3). */
static zip_int64_t serve(void *user, void *data, zip_uint64_t size, zip_source_cmd_t command) {
    entry *e = user;
    switch (command) {
    case ZIP_SOURCE_OPEN:
        e->position = 0;
        return fetch(e) ? 0 : -1;
    case ZIP_SOURCE_READ:
        return read_some(e, data, size);
    case ZIP_SOURCE_CLOSE:
        drop(e);
        return 0;
    case ZIP_SOURCE_STAT:
        return report_size(e, data, size);
    case ZIP_SOURCE_ERROR: {
        zip_error_t error;
        zip_error_init_with_code(&error, ZIP_ER_READ);
        return zip_error_to_data(&error, data, size);
    }
    case ZIP_SOURCE_FREE:
        drop(e);
        free(e);
        return 0;
    case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                              ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_FREE,
                                              -1);
    default:
        return -1;
    }
}

static gvc_result add_entry(zip_t *zip, archive *owner, uint64_t index, gvc_error *error) {
    entry *e = calloc(1, sizeof *e);
    if (!e) return gvc_fail_memory(error);
    e->owner = owner;
    e->index = index;
    zip_source_t *source = zip_source_function(zip, serve, e);
    if (!source) {
        free(e);
        return gvc_fail_memory(error);
    }
    char name[48];
    snprintf(name, sizeof name, "%06llu.off", (unsigned long long)index);
    zip_int64_t place = zip_file_add(zip, name, source, ZIP_FL_ENC_UTF_8);
    if (place < 0) {
        zip_source_free(source);
    } else if (zip_set_file_compression(zip, (zip_uint64_t)place, ZIP_CM_DEFLATE, DEFLATE_LEVEL) ==
               0) {
        return GVC_OK;
    }
    return gvc_fail(error, GVC_ERROR_IO, "cannot add %s to a zip archive: %s", name,
                    zip_strerror(zip));
}

static gvc_result fail_open(const char *path, int code, gvc_error *error) {
    zip_error_t reason;
    zip_error_init_with_code(&reason, code);
    gvc_fail(error, GVC_ERROR_IO, "cannot open the zip archive %s: %s", path,
             zip_error_strerror(&reason));
    zip_error_fini(&reason);
    return GVC_ERROR_IO;
}

static gvc_result write_archive(const char *path, const compare_zip_entries *entries,
                                double *seconds, gvc_error *error) {
    int code = 0;
    zip_t *zip = zip_open(path, ZIP_CREATE | ZIP_TRUNCATE, &code);
    if (!zip) return fail_open(path, code, error);
    archive owner = {.entries = entries};
    gvc_error_init(&owner.error);
    gvc_result result = GVC_OK;
    for (uint64_t i = 0; i < entries->count && result == GVC_OK; i++) {
        result = add_entry(zip, &owner, i, error);
    }
    double begin = compare_thread_seconds();
    if (result == GVC_OK && zip_close(zip) == 0) {
        *seconds = compare_thread_seconds() - begin - owner.fetch_seconds;
        return GVC_OK;
    }
    if (owner.result != GVC_OK) {
        result = owner.result;
        if (error) *error = owner.error;
    } else if (result == GVC_OK) {
        result = gvc_fail(error, GVC_ERROR_IO, "cannot write the zip archive %s: %s", path,
                          zip_strerror(zip));
    }
    zip_discard(zip);
    return result;
}

/* ---------------------------------------------------------------------------- reading again */

static gvc_result read_entry(zip_t *zip, uint64_t index, gvc_buffer *bytes, gvc_error *error) {
    zip_file_t *file = zip_fopen_index(zip, index, 0);
    if (!file) {
        return gvc_fail(error, GVC_ERROR_IO, "cannot read the zip archive: %s", zip_strerror(zip));
    }
    uint8_t chunk[16384];
    zip_int64_t got;
    while ((got = zip_fread(file, chunk, sizeof chunk)) > 0) {
        gvc_write_bytes(bytes, chunk, (size_t)got);
    }
    /* Closing is where libzip reports a wrong checksum. */
    int closed = zip_fclose(file);
    if (bytes->failed) return gvc_fail_memory(error);
    if (got < 0 || closed != 0) {
        return gvc_fail(error, GVC_ERROR_IO, "entry %llu of the zip archive does not read back",
                        (unsigned long long)index);
    }
    return GVC_OK;
}

static gvc_result read_archive(const char *path, uint64_t count, double *seconds,
                               gvc_error *error) {
    int code = 0;
    double begin = compare_thread_seconds();
    zip_t *zip = zip_open(path, ZIP_RDONLY, &code);
    if (!zip) return fail_open(path, code, error);
    gvc_result result = GVC_OK;
    gvc_buffer bytes = {.data = NULL};
    for (uint64_t i = 0; i < count; i++) {
        gvc_mesh *mesh = NULL;
        gvc_buffer_clear(&bytes);
        GVC_CHECK(read_entry(zip, i, &bytes, error));
        GVC_CHECK(
            gvc_mesh_read_memory(bytes.data, bytes.size, GVC_MESH_OFF, "zipped OFF", &mesh, error));
        gvc_mesh_destroy(&mesh);
    }
    *seconds = compare_thread_seconds() - begin;

cleanup:
    gvc_buffer_free(&bytes);
    zip_discard(zip);
    return result;
}

/* --------------------------------------------------------------------------------- together */

/* Makes an empty file with a name of its own; `path` has room for `size` bytes. */
static gvc_result make_temporary(char *path, size_t size, gvc_error *error) {
    const char *folder = getenv("TMPDIR");
    if (!folder || !*folder) folder = "/tmp";
    int length = snprintf(path, size, "%s/gvc-compare-XXXXXX", folder);
    if (length < 0 || (size_t)length >= size) {
        return gvc_fail(error, GVC_ERROR_IO, "the name of the folder $TMPDIR is too long");
    }
    int file = mkstemp(path);
    if (file < 0) {
        return gvc_fail(error, GVC_ERROR_IO, "cannot make a temporary file in %s: %s", folder,
                        strerror(errno));
    }
    close(file);
    return GVC_OK;
}

gvc_result compare_zip_measure(const compare_zip_entries *entries, compare_zip_cost *cost,
                               gvc_error *error) {
    char path[1024];
    *cost = (compare_zip_cost){.size = 0};
    /* libzip makes no file for an archive without entries. */
    if (entries->count == 0) return gvc_fail(error, GVC_ERROR_ARGUMENT, "there is nothing to zip");
    GVC_TRY(make_temporary(path, sizeof path, error));
    gvc_result result;
    compare_zip_cost measured = {.size = 0};
    struct stat status;
    GVC_CHECK(write_archive(path, entries, &measured.deflate_seconds, error));
    if (stat(path, &status) != 0) {
        result = gvc_fail(error, GVC_ERROR_IO, "cannot find %s: %s", path, strerror(errno));
        goto cleanup;
    }
    measured.size = (uint64_t)status.st_size;
    GVC_CHECK(read_archive(path, entries->count, &measured.inflate_seconds, error));
    *cost = measured;

cleanup:
    unlink(path);
    return result;
}
