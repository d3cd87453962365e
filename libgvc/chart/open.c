/* SPDX-License-Identifier: MIT */
/** @file open.c  Cutting: every fan of faces between cut edges gets a vertex of its own. */
#include "chart/open.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/** What a halfedge is to the cut. `edge` is GVC_NONE off the cut. */
typedef struct cut_label {
    uint32_t edge;
    bool reversed;
} cut_label;

static gvc_result broken(gvc_error *error, const char *what) {
    return gvc_fail(error, GVC_ERROR_INTERNAL, "the cut graph does not open the mesh: %s", what);
}

/* ------------------------------------------------------------------------------------ labelling */

static gvc_result label_edge(const gvc_halfedges *mesh, const gvc_cut_graph *graph, uint32_t e,
                             cut_label *label, gvc_error *error) {
    const gvc_cut_edge *edge = &graph->edge[e];
    if (edge->vertex_count < 2) return broken(error, "an edge has fewer than two vertices");
    for (size_t i = 0; i < edge->vertex_count; i++)
        if (edge->vertex[i] >= mesh->vertex_count) return broken(error, "an edge leaves the mesh");
    for (size_t i = 0; i + 1 < edge->vertex_count; i++) {
        uint32_t h = gvc_halfedge_between(mesh, edge->vertex[i], edge->vertex[i + 1]);
        if (h == GVC_NONE) return broken(error, "an edge does not follow edges of the mesh");
        if (label[h].edge != GVC_NONE) return broken(error, "two edges share an edge of the mesh");
        label[h] = (cut_label){e, false};
        label[mesh->twin[h]] = (cut_label){e, true};
    }
    return GVC_OK;
}

/** Labels all halfedges; `*cut_count` is the number of those on the cut. */
static gvc_result label_cut(const gvc_halfedges *mesh, const gvc_cut_graph *graph, cut_label *label,
                            size_t *cut_count, gvc_error *error) {
    size_t halfedge_count = 3 * mesh->face_count;
    for (size_t h = 0; h < halfedge_count; h++) {
        if (mesh->twin[h] == GVC_NONE) return broken(error, "the mesh has a border");
        label[h] = (cut_label){GVC_NONE, false};
    }
    *cut_count = 0;
    if (graph->edge_count == 0) return broken(error, "it has no edge");
    for (uint32_t e = 0; e < graph->edge_count; e++) {
        GVC_TRY(label_edge(mesh, graph, e, label, error));
        *cut_count += 2 * (graph->edge[e].vertex_count - 1);
    }
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- cutting */

/** Vertices of the opened mesh: a vertex where k cut edges end becomes max(1, k). */
static size_t count_disk_vertices(const gvc_halfedges *mesh, const cut_label *label,
                                  size_t cut_count, uint8_t *on_cut) {
    size_t touched = 0;
    for (size_t h = 0; h < 3 * mesh->face_count; h++) {
        uint32_t v = mesh->vertex[h];
        if (label[h].edge == GVC_NONE || on_cut[v]) continue;
        on_cut[v] = 1;
        touched++;
    }
    return mesh->vertex_count + cut_count - touched; /* each cut edge's end starts one halfedge */
}

/** Empty arrays for a disk with the faces of `mesh`. On failure the caller frees the disk. */
static gvc_result allocate_disk(const gvc_halfedges *mesh, size_t vertex_count, size_t border_count,
                                size_t run_count, gvc_disk *disk, gvc_error *error) {
    gvc_halfedges *m = &disk->mesh;
    if (vertex_count >= GVC_NONE)
        return gvc_fail(error, GVC_ERROR_LIMIT, "too many vertices to cut the mesh open");
    m->vertex_capacity = vertex_count;
    m->face_count = m->face_capacity = mesh->face_count;
    m->attribute_count = mesh->attribute_count;
    m->position = gvc_alloc(vertex_count, 3 * sizeof *m->position);
    m->outgoing = gvc_alloc(vertex_count, sizeof *m->outgoing);
    m->vertex = gvc_alloc(mesh->face_count, 3 * sizeof *m->vertex);
    m->twin = gvc_alloc(mesh->face_count, 3 * sizeof *m->twin);
    if (m->attribute_count)
        m->attribute = gvc_alloc(vertex_count, m->attribute_count * sizeof *m->attribute);
    disk->original_capacity = vertex_count;
    disk->original = gvc_alloc(vertex_count, sizeof *disk->original);
    disk->border_count = border_count;
    disk->border = gvc_alloc(border_count, sizeof *disk->border);
    disk->border_length = gvc_alloc(border_count, sizeof *disk->border_length);
    disk->run_count = run_count;
    disk->run = gvc_alloc(run_count, sizeof *disk->run);
    bool done = m->position && m->outgoing && m->vertex && m->twin &&
                (m->attribute || !m->attribute_count) && disk->original && disk->border &&
                disk->border_length && disk->run;
    return done ? GVC_OK : gvc_fail_memory(error);
}

/** A new disk vertex for the fan of faces that begins with halfedge `first`. */
static void add_fan(const gvc_halfedges *mesh, const cut_label *label, uint32_t first, uint32_t id,
                    gvc_disk *disk) {
    gvc_halfedges *m = &disk->mesh;
    uint32_t v = mesh->vertex[first];
    memcpy(m->position + 3 * (size_t)id, mesh->position + 3 * (size_t)v, 3 * sizeof *m->position);
    if (m->attribute)
        memcpy(m->attribute + m->attribute_count * id, mesh->attribute + m->attribute_count * v,
               m->attribute_count * sizeof *m->attribute);
    disk->original[id] = v;
    m->outgoing[id] = first;
    uint32_t h = first;
    do {
        m->vertex[h] = id;
        h = gvc_turn(mesh, h);
    } while (h != GVC_NONE && h != first && label[h].edge == GVC_NONE);
}

/** Makes the vertices: 0 .. V-1 as in the uncut mesh, further fans of cut vertices after them. */
static void add_vertices(const gvc_halfedges *mesh, const cut_label *label, gvc_disk *disk) {
    size_t next = mesh->vertex_count;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t begin = mesh->outgoing[v], h = begin;
        bool first_fan = true;
        do {
            if (label[h].edge != GVC_NONE) {
                add_fan(mesh, label, h, (uint32_t)(first_fan ? v : next++), disk);
                first_fan = false;
            }
            h = gvc_turn(mesh, h);
        } while (h != GVC_NONE && h != begin);
        if (first_fan) add_fan(mesh, label, begin, (uint32_t)v, disk);
    }
    disk->mesh.vertex_count = next;
    for (size_t h = 0; h < 3 * mesh->face_count; h++)
        disk->mesh.twin[h] = label[h].edge == GVC_NONE ? mesh->twin[h] : GVC_NONE;
}

/* --------------------------------------------------------------------------------------- border */

/** The border halfedge that starts where border halfedge `h` ends. */
static uint32_t next_on_border(const gvc_halfedges *m, uint32_t h) {
    uint32_t g = gvc_next(h);
    while (m->twin[g] != GVC_NONE) g = gvc_next(m->twin[g]);
    return g;
}

/** Whether a run passes all vertices of its edge in order, but for the last one. */
static bool follows_edge(const gvc_disk *disk, const gvc_border_run *run,
                         const gvc_cut_edge *edge) {
    if (run->count != edge->vertex_count - 1) return false;
    for (size_t i = 0; i < run->count; i++) {
        uint32_t vertex = edge->vertex[run->reversed ? run->count - i : i];
        if (disk->original[disk->border[run->first + i]] != vertex) return false;
    }
    return true;
}

/** Walks the border from the beginning of edge 0 and divides it into runs. */
static gvc_result walk_border(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                              const cut_label *label, gvc_disk *disk, gvc_error *error) {
    const gvc_halfedges *m = &disk->mesh;
    uint32_t start = gvc_halfedge_between(mesh, graph->edge[0].vertex[0], graph->edge[0].vertex[1]);
    uint32_t h = start;
    size_t count = 0, runs = 0;
    double length = 0;
    do {
        bool same = count > 0 && label[h].edge == disk->run[runs - 1].edge &&
                    label[h].reversed == disk->run[runs - 1].reversed;
        if (!same) {
            if (runs == disk->run_count) return broken(error, "its edges cross");
            disk->run[runs++] = (gvc_border_run){label[h].edge, label[h].reversed, count, 0};
            length = 0;
        }
        disk->border[count] = m->vertex[h];
        disk->border_length[count] = length;
        disk->run[runs - 1].count++;
        length += gvc_halfedge_length(m, h);
        count++;
        h = next_on_border(m, h);
    } while (h != start && count < disk->border_count);
    if (h != start || count != disk->border_count)
        return broken(error, "the border is more than one loop");
    if (runs != disk->run_count) return broken(error, "its edges cross");
    for (size_t r = 0; r < runs; r++)
        if (!follows_edge(disk, &disk->run[r], &graph->edge[disk->run[r].edge]))
            return broken(error, "an edge meets another one, or itself, between its nodes");
    return GVC_OK;
}

/** Number of faces that can be reached from face 0 without crossing the border. */
static gvc_result count_reached(const gvc_halfedges *m, size_t *reached, gvc_error *error) {
    uint32_t *queue = gvc_alloc(m->face_count, sizeof *queue);
    uint8_t *seen = gvc_alloc(m->face_count, sizeof *seen);
    gvc_result result = queue && seen ? GVC_OK : gvc_fail_memory(error);
    size_t count = 0;
    if (result == GVC_OK) {
        seen[0] = 1;
        queue[count++] = 0;
        for (size_t i = 0; i < count; i++)
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t twin = m->twin[3 * queue[i] + k];
                if (twin == GVC_NONE || seen[twin / 3]) continue;
                seen[twin / 3] = 1;
                queue[count++] = twin / 3;
            }
    }
    *reached = count;
    free(queue);
    free(seen);
    return result;
}

/** A connected surface with one border loop is a disk if V - E + F is 1. */
static gvc_result check_disk(const gvc_disk *disk, gvc_error *error) {
    const gvc_halfedges *m = &disk->mesh;
    size_t reached;
    GVC_TRY(count_reached(m, &reached, error));
    if (reached != m->face_count) return broken(error, "it falls apart");
    int64_t edges = ((int64_t)(3 * m->face_count) + (int64_t)disk->border_count) / 2;
    if ((int64_t)m->vertex_count - edges + (int64_t)m->face_count != 1)
        return broken(error, "handles are left");
    return GVC_OK;
}

/* --------------------------------------------------------------------------------------- public */

static gvc_result open_labelled(const gvc_halfedges *mesh, const gvc_cut_graph *graph,
                                cut_label *label, uint8_t *on_cut, gvc_disk *disk,
                                gvc_error *error) {
    size_t cut_count;
    GVC_TRY(label_cut(mesh, graph, label, &cut_count, error));
    size_t vertex_count = count_disk_vertices(mesh, label, cut_count, on_cut);
    GVC_TRY(allocate_disk(mesh, vertex_count, cut_count, 2 * graph->edge_count, disk, error));
    add_vertices(mesh, label, disk);
    GVC_TRY(walk_border(mesh, graph, label, disk, error));
    return check_disk(disk, error);
}

gvc_result gvc_disk_open(const gvc_halfedges *mesh, const gvc_cut_graph *graph, gvc_disk *disk,
                         gvc_error *error) {
    *disk = (gvc_disk){0};
    cut_label *label = gvc_alloc(mesh->face_count, 3 * sizeof *label);
    uint8_t *on_cut = gvc_alloc(mesh->vertex_count, sizeof *on_cut);
    gvc_result result = label && on_cut ? open_labelled(mesh, graph, label, on_cut, disk, error)
                                        : gvc_fail_memory(error);
    if (result != GVC_OK) gvc_disk_free(disk);
    free(label);
    free(on_cut);
    return result;
}

void gvc_disk_free(gvc_disk *disk) {
    if (!disk) return;
    gvc_halfedges_free(&disk->mesh);
    free(disk->original);
    free(disk->border);
    free(disk->border_length);
    free(disk->run);
    *disk = (gvc_disk){0};
}

bool gvc_disk_same_runs(const gvc_disk *disk, const gvc_border_run *run, size_t run_count) {
    if (disk->run_count != run_count) return false;
    for (size_t i = 0; i < run_count; i++)
        if (disk->run[i].edge != run[i].edge || disk->run[i].reversed != run[i].reversed)
            return false;
    return true;
}
