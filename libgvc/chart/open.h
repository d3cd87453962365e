/* SPDX-License-Identifier: MIT */
/** @file open.h  Cuts a closed mesh open along its cut graph to a disk with one border loop. */
#ifndef GVC_CHART_OPEN_H
#define GVC_CHART_OPEN_H

#include "descriptor/cut_graph.h"

/** Part of the border that runs along one side of a cut edge. */
typedef struct gvc_border_run {
    uint32_t edge;
    bool reversed; /**< walked from node[1] to node[0] */
    size_t first;  /**< index into border of its first vertex; it ends at the next run's first */
    size_t count;  /**< number of border halfedges */
} gvc_border_run;

/** The opened mesh. The border is listed in the order of its halfedges, which have the surface on
 *  their left; vertex border[i] starts border halfedge mesh.outgoing[border[i]]. */
typedef struct gvc_disk {
    gvc_halfedges mesh; /**< one border; faces in the order and orientation of the uncut mesh */
    uint32_t *original; /**< per vertex: vertex of the uncut mesh; GVC_NONE for later insertions */
    size_t original_capacity;
    size_t border_count;   /**< border vertices, as many as border halfedges */
    uint32_t *border;      /**< border vertices */
    double *border_length; /**< arc length of each border vertex from the start of its run */
    size_t run_count;      /**< 2 * edge_count */
    gvc_border_run *run;   /**< run[0] is the forward run of edge 0 */
} gvc_disk;

/** Cuts `mesh`, which must be closed. Vertices keep their numbers; where k > 1 cut edges end, k - 1
 *  copies are appended. Positions and attributes are copied. GVC_ERROR_INTERNAL if the graph does
 *  not cut the surface into one disk, or if its edges meet anywhere but in their ends. On failure
 *  `disk` is empty. Free with gvc_disk_free. */
gvc_result gvc_disk_open(const gvc_halfedges *mesh, const gvc_cut_graph *graph, gvc_disk *disk,
                         gvc_error *error);
void gvc_disk_free(gvc_disk *disk);

/** True if both disks have the same cyclic sequence of runs, i.e. share a side table. */
bool gvc_disk_same_runs(const gvc_disk *disk, const gvc_border_run *run, size_t run_count);

#endif
