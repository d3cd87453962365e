/* SPDX-License-Identifier: MIT */
/** @file from_exr.c  Encoding from OpenEXR files of frames. */
#include "from_exr.h"

#include "base/result.h"
#include "encoder_exr.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static gvc_result read_file(void *user, uint64_t frame, gvc_buffer *bytes, gvc_error *error) {
    const frame_list *list = user;
    uint8_t chunk[16384];
    size_t got;
    FILE *file = fopen(list->path[frame], "rb");
    if (!file) return gvc_fail(error, GVC_ERROR_IO, "cannot open: %s", strerror(errno));
    while ((got = fread(chunk, 1, sizeof chunk, file)) > 0) gvc_write_bytes(bytes, chunk, got);
    bool failed = ferror(file);
    fclose(file);
    if (failed) return gvc_fail(error, GVC_ERROR_IO, "cannot read");
    return bytes->failed ? gvc_fail_memory(error) : GVC_OK;
}

gvc_result encode_from_exr(const frame_list *list, const gvc_sink *sink,
                           const gvc_encode_options *options, gvc_encode_report *report,
                           gvc_error *error) {
    gvc_exr_source source = {
        .user = (void *)(uintptr_t)list, .frame_count = list->count, .read = read_file};
    gvc_result result = gvc_encode_exr(&source, sink, options, report, error);
    if (result == GVC_OK || error->frame < 0 || error->frame >= (int64_t)list->count) return result;
    return gvc_fail_in(error, result, list->path[error->frame]);
}
