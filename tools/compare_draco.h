/* SPDX-License-Identifier: MIT */
/** @file compare_draco.h  The Draco mesh codec, as a peer for `gvc compare`, behind C functions. */
#ifndef GVC_TOOLS_COMPARE_DRACO_H
#define GVC_TOOLS_COMPARE_DRACO_H

#include "gvc/gvc.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Encodes connectivity and positions as `draco_encoder -qp BITS -cl 10` does: equal positions
 * merged, coordinates rounded to float32, edgebreaker, positions quantised to `bits` (1..30) per
 * coordinate, slowest speed. `*data` (free with free()) receives `*size` bytes. `*seconds` is the
 * CPU time of the calling thread, without the conversion from gvc_mesh. No exception leaves.
 * GVC_ERROR_MESH if Draco refuses the mesh. */
gvc_result compare_draco_encode(const gvc_mesh *mesh, int bits, unsigned char **data, size_t *size,
                                double *seconds, gvc_error *error);

/** Decodes to a new mesh, which the caller destroys. `*seconds` as above. GVC_ERROR_CORRUPT if
 * Draco cannot decode the bytes. */
gvc_result compare_draco_decode(const unsigned char *data, size_t size, gvc_mesh **mesh,
                                double *seconds, gvc_error *error);

#ifdef __cplusplus
}
#endif

#endif
