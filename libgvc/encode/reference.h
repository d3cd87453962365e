/* SPDX-License-Identifier: MIT */
/**
 * @file reference.h
 * The method this one is measured against: every frame cut and laid out by itself, without regard
 * to the frames around it, after X. Gu, S. J. Gortler and H. Hoppe, "Geometry Images", SIGGRAPH
 * 2002. (The paper calls it GIS.) It is not used to make files.
 *
 * A frame's cut begins with the handle graph, or on a surface without handles with two adjacent
 * edges as far as can be from an arbitrary seed face (Sect. 3.1). Then (Sect. 3.2) the opened
 * surface is mapped to the square by mean value coordinates, the shortest path from the vertex
 * where that map stretches most joins the cut, and so on while the stretch of the final map falls.
 * Border layout, place of the corners, interior and sampling are those of a frame of this encoder,
 * so that nothing but the choice of the cut is compared.
 *
 * Where Gu et al. find extrema on a map to the disk and stop at the first path that is no gain,
 * this looks on for a few more, which can only lower the stretch.
 */
#ifndef GVC_ENCODE_REFERENCE_H
#define GVC_ENCODE_REFERENCE_H

#include "encode/segment.h"

typedef struct gvc_reference_report {
    size_t path_count; /**< paths added to the first cut */
    double stretch;    /**< L2 stretch of the map at the size of the trials, 1 for an isometry */
} gvc_reference_report;

/** Loads frame `work->number` and makes its geometry image: 3 planes of size * size coordinates
 * into `image`. `segment` holds the cube (origin, step) and image_options on entry, and gets number
 * and layout of the frame; `work` gets mesh and graph. Both are freed by the caller, on failure
 * too. `report` may be NULL. Thread-safe if the source is. GVC_ERROR_MESH, naming file or frame, if
 * the mesh cannot be coded or every cut gives charts that fold. */
gvc_result gvc_reference_frame(const gvc_source *source, bool weld, uint32_t size,
                               gvc_frame_work *work, gvc_segment *segment, double *image,
                               gvc_reference_report *report, gvc_error *error);

#endif
