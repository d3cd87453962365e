/* SPDX-License-Identifier: MIT */
/** @file tracking_state.c  What a tracker remembers, to bytes and back. */
#include "descriptor/tracked.h"

static void transfer_doubles(gvc_state *state, double **array, size_t count) {
    void *bytes = *array;
    gvc_state_array(state, &bytes, count, sizeof **array);
    if (state->loading) *array = bytes;
}

static void transfer_link(gvc_state *state, gvc_link *link) {
    size_t n = link->prior.dimensions;
    gvc_state_plain(state, &link->tip, sizeof link->tip);
    gvc_state_plain(state, &link->parent, sizeof link->parent);
    gvc_state_plain(state, link->node, sizeof link->node);
    gvc_state_plain(state, link->after, sizeof link->after);
    gvc_state_plain(state, &link->deviation, sizeof link->deviation);
    gvc_state_plain(state, &link->length, sizeof link->length);
    gvc_state_plain(state, &n, sizeof n);
    link->prior.dimensions = n;
    transfer_doubles(state, &link->junction, n);
    transfer_doubles(state, &link->prior.sample, n * (GVC_PRIOR_SEGMENTS + 1));
    transfer_doubles(state, &link->prior.box, n * 4 * GVC_PRIOR_SEGMENTS);
}

static void transfer_handle(gvc_state *state, gvc_handle_link *handle) {
    gvc_state_plain(state, &handle->joined, sizeof handle->joined);
    gvc_state_plain(state, &handle->open, sizeof handle->open);
    gvc_state_plain(state, &handle->since, sizeof handle->since);
    for (int i = 0; i < GVC_HANDLE_LINKS; i++) transfer_link(state, &handle->link[i]);
    size_t n = handle->link[0].prior.dimensions;
    for (int i = 0; i < GVC_HANDLE_POINTS; i++) transfer_doubles(state, &handle->point[i], n);
}

static void transfer_tracked(gvc_state *state, gvc_tracked *t) {
    gvc_state_plain(state, &t->started, sizeof t->started);
    gvc_state_plain(state, &t->single, sizeof t->single);
    gvc_state_plain(state, &t->genus, sizeof t->genus);
    gvc_state_plain(state, &t->wanted, sizeof t->wanted);
    gvc_state_plain(state, &t->search, sizeof t->search);
    gvc_state_plain(state, &t->diagonal, sizeof t->diagonal);
    gvc_state_plain(state, &t->scale, sizeof t->scale);
    gvc_state_plain(state, &t->tip_count, sizeof t->tip_count);
    gvc_state_plain(state, &t->matched_count, sizeof t->matched_count);
    gvc_state_plain(state, &t->side_count, sizeof t->side_count);
    if (state->failed) return;
    size_t n = t->tip_count + 4; /* dimension of coordinates: root, tips, position */
    void *tip = t->tip, *side = t->side, *link = t->link, *handle = t->handle;
    gvc_state_array(state, &tip, t->tip_count, sizeof *t->tip);
    transfer_doubles(state, &t->tip_point, t->tip_count * n);
    transfer_doubles(state, &t->root_point, n);
    gvc_state_array(state, &side, t->side_count, sizeof *t->side);
    t->tip = tip;
    t->side = side;
    gvc_state_structs(state, &link, &t->link_count, sizeof *t->link);
    t->link = link;
    for (size_t i = 0; i < t->link_count; i++) transfer_link(state, &t->link[i]);
    gvc_state_structs(state, &handle, &t->handle_count, sizeof *t->handle);
    t->handle = handle;
    for (size_t i = 0; i < t->handle_count; i++) transfer_handle(state, &t->handle[i]);
}

void gvc_tracker_state(gvc_tracker *tracker, gvc_state *state) {
    gvc_state_plain(state, &tracker->lost, sizeof tracker->lost);
    transfer_tracked(state, &tracker->known);
}
