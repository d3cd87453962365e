/* SPDX-License-Identifier: MIT */
/**
 * @file rebuild.h
 * From the samples of a geometry image to a closed mesh, in integers up to the last affine map.
 * A code is an unsigned 16-bit number per component; three planes x, y, z of size * size each.
 */
#ifndef GVC_CHART_REBUILD_H
#define GVC_CHART_REBUILD_H

#include "base/digest.h"
#include "chart/side_table.h"
#include "mesh/mesh.h"

/** Welded codes: 3 per vertex. For a vertex made of k samples with sum s per component:
 *  (2 s + k) / (2 k), rounded down. `plane` points at 3 * size * size codes, x plane first; `code`
 * has room for 3 * weld->vertex_count. */
void gvc_weld_codes(const gvc_weld *weld, const uint16_t *plane, uint16_t *code);

/** Faces of the welded surface. Quads in raster order, each a=(x,y) b=(x+1,y) c=(x+1,y+1)
 * d=(x,y+1), two triangles abc,acd or abd,bcd. The diagonal runs: through the square's corner in
 * the four corner quads; else through a fold sample that is a corner of the quad; else along the
 * shorter of ac and bd in squared code distance (ac when equal). Exactly 2 * (size-1)^2 faces,
 * `face` has room for 3 indices each. */
void gvc_rebuild_faces(const gvc_weld *weld, const uint16_t *code, uint32_t *face);

/** Position = origin + step * code in IEEE double, rounded once to float32. */
void gvc_rebuild_positions(const gvc_weld *weld, const uint16_t *code, const double origin[3],
                           double step, double *position);

/** The three above in one: a new mesh. GVC_ERROR_CORRUPT if a code could be mapped beyond float32,
 * i.e. if origin or origin + 65535 * step, in any component, is not finite in float32. */
gvc_result gvc_rebuild_mesh(const gvc_weld *weld, const uint16_t *plane, const double origin[3],
                            double step, gvc_mesh **mesh, gvc_error *error);

/** Number of faces of the welded surface: 2 * (size - 1)^2. */
size_t gvc_rebuild_face_count(const gvc_weld *weld);

/** Adds a chart to the digest of its frame. The digest of a frame is the first eight bytes of
 * SHA-256 over, for each chart in turn: vertex count and face count (u32), all welded codes in
 * vertex order (x, y, z as u16), all face indices within the chart (u32), everything big-endian. */
gvc_result gvc_rebuild_digest_update(gvc_sha256 *digest, const gvc_weld *weld, const uint16_t *code,
                                     const uint32_t *face, gvc_error *error);

#endif
