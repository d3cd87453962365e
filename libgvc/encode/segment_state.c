/* SPDX-License-Identifier: MIT */
/** @file segment_state.c  A segment to bytes and back. */
#include "encode/segment_state.h"

#include "chart/rebuild.h"

gvc_result gvc_segment_state(gvc_segment *segment, gvc_state *state, gvc_error *error) {
    gvc_segment plain = *segment;
    plain.run = NULL;
    plain.sides.steps = NULL;
    plain.sides.side = NULL;
    plain.weld = (gvc_weld){0};
    gvc_state_plain(state, &plain, sizeof plain);
    if (state->failed) return GVC_OK;
    if (state->loading) *segment = plain;
    gvc_side_table *sides = &segment->sides;
    void *run = segment->run, *steps = sides->steps, *side = sides->side;
    gvc_state_array(state, &run, segment->run_count, sizeof *segment->run);
    gvc_state_array(state, &steps, sides->edge_count, sizeof *sides->steps);
    gvc_state_array(state, &side, sides->side_count, sizeof *sides->side);
    segment->run = run;
    sides->steps = steps;
    sides->side = side;
    if (!state->loading || state->failed || !sides->steps) return GVC_OK;
    return gvc_weld_build(sides, &segment->weld, error); /* follows from the sides */
}
