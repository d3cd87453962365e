/* SPDX-License-Identifier: MIT */
/** @file scan.c  First pass over a capture. */
#include "encode/scan.h"

#include "base/digest.h"
#include "base/parallel.h"
#include "mesh/file.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define CHUNK 64 /* frames between two progress reports */

/* Positions are decoded as float32, and so is every corner of the cube that holds a segment, with
 * its margin (spec 7.3.3): at most twice as far out as the farthest vertex, and as wide again. */
#define GREATEST_COORDINATE (FLT_MAX / 8.0)
/* Steps of 16-bit codes are normal float32 numbers. */
#define LEAST_DIAGONAL (FLT_MIN * 131072.0)

typedef unsigned long long ull;

static gvc_result refuse(const gvc_topology *t, gvc_error *error) {
    if (t->face_count == 0) return gvc_fail(error, GVC_ERROR_MESH, "the mesh has no faces");
    if (t->nonmanifold_edge_count > 0) {
        return gvc_fail(error, GVC_ERROR_MESH,
                        "the surface is not manifold: %llu edges have more than two faces",
                        (ull)t->nonmanifold_edge_count);
    }
    if (t->boundary_edge_count > 0) {
        return gvc_fail(error, GVC_ERROR_MESH,
                        "the surface is open: %llu boundary edges in %llu loops",
                        (ull)t->boundary_edge_count, (ull)t->boundary_loop_count);
    }
    if (t->nonmanifold_vertex_count > 0) {
        return gvc_fail(
            error, GVC_ERROR_MESH,
            "the surface is not manifold: %llu vertices join more than one fan of faces",
            (ull)t->nonmanifold_vertex_count);
    }
    if (t->misoriented_edge_count > 0) {
        return gvc_fail(
            error, GVC_ERROR_MESH,
            "the faces are not oriented alike: %llu edges run the same way in both faces",
            (ull)t->misoriented_edge_count);
    }
    if (t->component_count != 1) {
        return gvc_fail(error, GVC_ERROR_MESH,
                        "the surface has %llu components; this version codes one",
                        (ull)t->component_count);
    }
    return GVC_OK;
}

static gvc_result check_size(const gvc_mesh *mesh, gvc_error *error) {
    double minimum[3], maximum[3], diagonal = gvc_mesh_diagonal(mesh);
    gvc_mesh_bounds(mesh, minimum, maximum);
    for (int k = 0; k < 3; k++) {
        double farthest = -minimum[k] > maximum[k] ? minimum[k] : maximum[k];
        if (fabs(farthest) > GREATEST_COORDINATE) {
            return gvc_fail(error, GVC_ERROR_MESH,
                            "a vertex has the coordinate %g; a file holds up to %g", farthest,
                            GREATEST_COORDINATE);
        }
    }
    if (!(diagonal > 0)) return gvc_fail(error, GVC_ERROR_MESH, "all vertices are one point");
    if (diagonal < LEAST_DIAGONAL) {
        return gvc_fail(error, GVC_ERROR_MESH,
                        "the surface is %g across; a file holds surfaces from %g on", diagonal,
                        LEAST_DIAGONAL);
    }
    return GVC_OK;
}

/* The first eight bytes of SHA-256, as of decoded frames. */
static gvc_result digest_mesh(const gvc_mesh *mesh, uint8_t digest[8], gvc_error *error) {
    uint8_t full[32];
    uint64_t counts[2] = {mesh->vertex_count, mesh->face_count};
    gvc_sha256 *state = gvc_sha256_begin();
    if (!state) return gvc_fail_memory(error);
    gvc_sha256_update(state, counts, sizeof counts);
    gvc_sha256_update(state, mesh->position, 3 * mesh->vertex_count * sizeof *mesh->position);
    gvc_sha256_update(state, mesh->face, 3 * mesh->face_count * sizeof *mesh->face);
    gvc_sha256_end(state, full);
    memcpy(digest, full, 8);
    return GVC_OK;
}

gvc_result gvc_load_frame(const gvc_source *source, uint64_t frame, bool weld, gvc_mesh **mesh,
                          gvc_scan_frame *facts, gvc_error *error) {
    gvc_mesh *raw = NULL;
    gvc_topology topology;
    size_t welded = 0;
    *mesh = NULL;
    gvc_result result = source->read(source->user, frame, &raw, error);
    if (result == GVC_OK) result = gvc_mesh_clean(raw, weld, mesh, &welded, error);
    gvc_mesh_destroy(&raw);
    if (result == GVC_OK) result = gvc_mesh_topology(*mesh, &topology, error);
    if (result == GVC_OK && !topology.closed_manifold) result = refuse(&topology, error);
    if (result == GVC_OK && topology.component_count != 1) result = refuse(&topology, error);
    if (result == GVC_OK) result = check_size(*mesh, error);
    if (result != GVC_OK) {
        gvc_mesh_destroy(mesh);
        const char *name = source->name ? source->name(source->user, frame) : NULL;
        if (error && name && error->where[0] == '\0') {
            (void)gvc_fail_in(error, result, name);
        }
        return gvc_at_frame(error, result, (int64_t)frame);
    }
    if (facts) {
        gvc_mesh_bounds(*mesh, facts->minimum, facts->maximum);
        facts->genus = topology.genus;
        facts->vertex_count = topology.vertex_count;
        facts->face_count = topology.face_count;
        facts->welded = welded;
        return digest_mesh(*mesh, facts->digest, error);
    }
    return GVC_OK;
}

typedef struct scan_context {
    const gvc_source *source;
    bool weld;
    uint64_t first;
    gvc_scan_frame *facts;
} scan_context;

static gvc_result scan_one(void *user, size_t index, gvc_error *error) {
    scan_context *context = user;
    uint64_t frame = context->first + index;
    gvc_mesh *mesh;
    GVC_TRY(gvc_load_frame(context->source, frame, context->weld, &mesh, &context->facts[frame],
                           error));
    gvc_mesh_destroy(&mesh);
    return GVC_OK;
}

gvc_result gvc_scan(const gvc_source *source, const gvc_encode_options *options,
                    gvc_scan_frame *facts, gvc_error *error) {
    scan_context context = {.source = source, .weld = options->weld, .facts = facts};
    uint64_t total = source->frame_count;
    for (context.first = 0; context.first < total; context.first += CHUNK) {
        uint64_t count = total - context.first < CHUNK ? total - context.first : CHUNK;
        GVC_TRY(gvc_parallel_for(options->threads, (size_t)count, scan_one, &context, error));
        if (options->progress &&
            !options->progress(options->user, GVC_STAGE_SCAN, context.first + count, total)) {
            return gvc_fail(error, GVC_ERROR_CANCELLED, "cancelled");
        }
    }
    return GVC_OK;
}
