/* SPDX-License-Identifier: MIT */
/** @file render_no_track.c  Stands for render_track.c in builds without encoder. */
#include "base/result.h"
#include "render_track.h"

gvc_result render_track(const gvc_source *source, bool weld, unsigned threads,
                        const uint64_t *frame, size_t count, const render_track_hooks *hooks,
                        gvc_error *error) {
    (void)source, (void)weld, (void)threads, (void)frame, (void)count, (void)hooks;
    return gvc_fail(error, GVC_ERROR_UNSUPPORTED,
                    "this build has no encoder and finds no cut graphs");
}
