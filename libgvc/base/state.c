/* SPDX-License-Identifier: MIT */
/** @file state.c  Memory to bytes and back. */
#include "base/state.h"

#include "base/memory.h"

#include <string.h>

void gvc_state_plain(gvc_state *state, void *data, size_t size) {
    if (!state->loading) {
        gvc_write_bytes(state->out, data, size);
        state->failed = state->failed || state->out->failed;
        return;
    }
    const uint8_t *bytes = gvc_read_bytes(&state->in, size);
    if (bytes && size > 0) memcpy(data, bytes, size);
    state->failed = state->failed || state->in.failed;
}

void gvc_state_array(gvc_state *state, void **array, size_t count, size_t size) {
    size_t bytes = 0;
    uint8_t there = *array != NULL;
    gvc_state_plain(state, &there, 1);
    if (!there || state->failed) return;
    bool fits = gvc_multiply(count, size, &bytes) &&
                (!state->loading || bytes <= gvc_cursor_left(&state->in));
    if (fits && state->loading) *array = gvc_alloc(count, size);
    if (!fits || !*array) {
        state->failed = true;
        return;
    }
    gvc_state_plain(state, *array, bytes);
}

void gvc_state_structs(gvc_state *state, void **array, size_t *count, size_t size) {
    uint8_t there = *array != NULL;
    gvc_state_plain(state, &there, 1);
    gvc_state_plain(state, count, sizeof *count);
    if (!state->loading || state->failed) {
        if (state->loading) *count = 0;
        return;
    }
    /* each element takes at least one byte */
    if (there && *count <= gvc_cursor_left(&state->in)) *array = gvc_alloc(*count, size);
    if (*array || (!there && *count == 0)) return;
    *count = 0;
    state->failed = true;
}
