/* SPDX-License-Identifier: MIT */
/**
 * @file state.h
 * Memory to bytes and back, for a state that the same program takes up again on the same machine:
 * one function names the parts of an object once, for both directions. Never for files that are
 * passed on: bytes are as the machine has them.
 */
#ifndef GVC_BASE_STATE_H
#define GVC_BASE_STATE_H

#include "base/bytes.h"

typedef struct gvc_state {
    bool loading;
    gvc_buffer *out; /**< while saving */
    gvc_cursor in;   /**< while loading */
    bool failed;     /**< out of memory, or bytes that cannot be this object */
} gvc_state;

/** Plain data without pointers. */
void gvc_state_plain(gvc_state *state, void *data, size_t size);
/** An allocated array of plain data, or NULL; `*array` must be NULL before loading, and is after a
 * failure. */
void gvc_state_array(gvc_state *state, void **array, size_t count, size_t size);
/** Number of elements of an array of structs that is transferred one by one: loading allocates
 * `*array`, zeroed; `*count` is 0 after a failure. */
void gvc_state_structs(gvc_state *state, void **array, size_t *count, size_t size);

#endif
