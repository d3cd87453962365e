/* SPDX-License-Identifier: MIT */
/** @file result.c  Reporting failures. */
#include "base/result.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define STRINGIZE(x) #x
#define VERSION_TEXT(major, minor, patch) STRINGIZE(major) "." STRINGIZE(minor) "." STRINGIZE(patch)

const char *gvc_version(void) {
    return VERSION_TEXT(GVC_VERSION_MAJOR, GVC_VERSION_MINOR, GVC_VERSION_PATCH);
}

const char *gvc_result_string(gvc_result result) {
    switch (result) {
    case GVC_OK:
        return "ok";
    case GVC_ERROR_ARGUMENT:
        return "bad argument";
    case GVC_ERROR_MEMORY:
        return "out of memory";
    case GVC_ERROR_IO:
        return "input/output error";
    case GVC_ERROR_CANCELLED:
        return "cancelled";
    case GVC_ERROR_CORRUPT:
        return "corrupt file";
    case GVC_ERROR_TRUNCATED:
        return "truncated file";
    case GVC_ERROR_UNSUPPORTED:
        return "unsupported";
    case GVC_ERROR_LIMIT:
        return "limit exceeded";
    case GVC_ERROR_LOST:
        return "lost before";
    case GVC_ERROR_MESH:
        return "unsuitable mesh";
    case GVC_ERROR_QUALITY:
        return "quality out of reach";
    case GVC_ERROR_INTERNAL:
        return "internal error";
    }
    return "unknown result";
}

void gvc_error_init(gvc_error *error) {
    if (!error) return;
    *error = (gvc_error){.code = GVC_OK, .frame = GVC_NO_FRAME, .offset = GVC_NO_OFFSET};
}

gvc_result gvc_fail(gvc_error *error, gvc_result code, const char *format, ...) {
    if (error) {
        gvc_error_init(error);
        error->code = code;
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
    }
    return code;
}

gvc_result gvc_fail_memory(gvc_error *error) {
    return gvc_fail(error, GVC_ERROR_MEMORY, "out of memory");
}

gvc_result gvc_at_frame(gvc_error *error, gvc_result result, int64_t frame) {
    if (result != GVC_OK && error && error->frame == GVC_NO_FRAME) error->frame = frame;
    return result;
}

gvc_result gvc_fail_in(gvc_error *error, gvc_result result, const char *name) {
    if (!error || !name) return result;
    size_t length = strlen(name), room = sizeof error->where - 1;
    if (length <= room) {
        memcpy(error->where, name, length + 1);
        return result;
    }
    /* The end of a path says more than its beginning; do not begin inside a UTF-8 sequence. */
    const char *tail = name + length - (room - 3);
    while (((unsigned char)*tail & 0xc0) == 0x80) tail++;
    snprintf(error->where, sizeof error->where, "...%s", tail);
    return result;
}

gvc_result gvc_fail_errno(gvc_error *error, const char *action, int number, const char *name) {
    char text[128];
    if (strerror_r(number, text, sizeof text) != 0) snprintf(text, sizeof text, "error %d", number);
    gvc_fail(error, GVC_ERROR_IO, "cannot %s: %s", action, text);
    return gvc_fail_in(error, GVC_ERROR_IO, name);
}

gvc_result gvc_explain(gvc_error *error, gvc_result result) {
    if (result == GVC_OK || !error) return result;
    error->code = result;
    if (error->message[0] == '\0') {
        snprintf(error->message, sizeof error->message, "%s", gvc_result_string(result));
    }
    return result;
}

gvc_result gvc_hand_on(gvc_error *error, gvc_result result, const gvc_error *trouble) {
    if (result != GVC_OK && error) *error = *trouble;
    return result;
}
