/* SPDX-License-Identifier: MIT */
/** @file scan.h  Reads frames ready for coding, and the first pass over a capture: what each frame
 * is. */
#ifndef GVC_ENCODE_SCAN_H
#define GVC_ENCODE_SCAN_H

#include "mesh/mesh.h"

typedef struct gvc_scan_frame {
    double minimum[3], maximum[3];
    int64_t genus;
    uint64_t vertex_count, face_count;
    size_t welded;     /**< vertices merged along texture seams */
    uint8_t digest[8]; /**< of positions and faces, to know the frame again */
} gvc_scan_frame;

/** Reads and cleans one frame and makes sure that it is one closed, oriented manifold. The message
 * of a refusal names the defect and its count. `facts` may be NULL. Thread-safe if the source is.
 */
gvc_result gvc_load_frame(const gvc_source *source, uint64_t frame, bool weld, gvc_mesh **mesh,
                          gvc_scan_frame *facts, gvc_error *error);

/** Loads every frame once, in parallel, and fills `facts` (one per frame). */
gvc_result gvc_scan(const gvc_source *source, const gvc_encode_options *options,
                    gvc_scan_frame *facts, gvc_error *error);

#endif
