/* SPDX-License-Identifier: MIT */
/** @file checkpoint.c  The state of an encode between two groups, to bytes and back. */
#include "checkpoint.h"

#include "base/digest.h"
#include "encode/segment_state.h"

#include <stdlib.h>
#include <string.h>

/* Of the same version, and of a machine with the same types. */
static uint32_t layout_mark(void) {
    const size_t sizes[] = {sizeof(size_t), sizeof(gvc_segment), sizeof(gvc_extremum),
                            sizeof(gvc_encode_report)};
    const uint32_t order = 1;
    uint32_t crc = gvc_crc32(0, sizes, sizeof sizes);
    crc = gvc_crc32(crc, &order, sizeof order);
    return gvc_crc32(crc, gvc_version(), strlen(gvc_version()));
}

static gvc_result transfer(const gvc_checkpoint *c, gvc_state *state, gvc_error *error) {
    gvc_state_plain(state, c->next_frame, sizeof *c->next_frame);
    gvc_state_plain(state, c->size, sizeof *c->size);
    gvc_state_plain(state, c->crf, sizeof *c->crf);
    gvc_state_plain(state, c->report, sizeof *c->report);
    void *followed = *c->followed;
    gvc_state_array(state, &followed, (size_t)3 * *c->size * *c->size, sizeof(double));
    *c->followed = followed;
    gvc_tracker_state(c->tracker, state);
    return gvc_segment_state(c->segment, state, error);
}

gvc_result gvc_checkpoint_save(const gvc_checkpoint *checkpoint, const gvc_encode_options *options,
                               gvc_error *error) {
    if (!options->checkpoint) return GVC_OK;
    gvc_buffer bytes = {0};
    gvc_state state = {.out = &bytes};
    gvc_write_u32(&bytes, layout_mark());
    gvc_result result = transfer(checkpoint, &state, error);
    if (result == GVC_OK && !bytes.failed) {
        gvc_write_u32(&bytes, gvc_crc32(0, bytes.data, bytes.size));
    }
    if (result == GVC_OK && (bytes.failed || state.failed)) result = gvc_fail_memory(error);
    if (result == GVC_OK) {
        result = options->checkpoint(options->user, bytes.data, bytes.size, error);
    }
    gvc_buffer_free(&bytes);
    return result;
}

/* Whether the bytes are whole and of this build; then `cursor` is behind the mark. */
static bool is_whole(const void *data, size_t size, gvc_cursor *cursor) {
    if (size < 8) return false;
    gvc_cursor tail = gvc_cursor_make((const uint8_t *)data + size - 4, 4);
    *cursor = gvc_cursor_make(data, size - 4);
    return gvc_read_u32(&tail) == gvc_crc32(0, data, size - 4) &&
           gvc_read_u32(cursor) == layout_mark();
}

bool gvc_checkpoint_frame(const void *data, size_t size, uint64_t *frame) {
    gvc_state state = {.loading = true};
    if (!is_whole(data, size, &state.in)) return false;
    gvc_state_plain(&state, frame, sizeof *frame);
    return !state.failed;
}

gvc_result gvc_checkpoint_load(const gvc_checkpoint *checkpoint, const void *data, size_t size,
                               bool *loaded, gvc_error *error) {
    gvc_state state = {.loading = true};
    *loaded = false;
    if (!is_whole(data, size, &state.in)) return GVC_OK;
    gvc_result result = transfer(checkpoint, &state, error);
    if (result != GVC_OK) return result;
    if (state.failed || gvc_cursor_left(&state.in)) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "a checkpoint of this build cannot be read");
    }
    *loaded = true;
    return GVC_OK;
}
