/* SPDX-License-Identifier: MIT */
/** @file segment_state.h  A segment to bytes and back. */
#ifndef GVC_ENCODE_SEGMENT_STATE_H
#define GVC_ENCODE_SEGMENT_STATE_H

#include "base/state.h"
#include "encode/segment.h"

/** Saves a segment, or loads it into one that is all zero. */
gvc_result gvc_segment_state(gvc_segment *segment, gvc_state *state, gvc_error *error);

#endif
