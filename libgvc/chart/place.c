/* SPDX-License-Identifier: MIT */
/** @file place.c  The border of the disk on the border of the square. */
#include "chart/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/** Border vertices this near to a corner of the square, in pixels, are moved onto it. */
#define SNAP 1e-3

/** Border edges shorter than this fraction of their run's mean take that much room on the border
 * all the same: edges of no length would give flat triangles. */
#define LEAST_EDGE 1e-4

/** The disk, and the loop coordinates of its border vertices: steps from the beginning of run 0,
 * ascending, within 0 .. P. */
typedef struct placement {
    gvc_disk *disk;
    const gvc_side_table *table;
    double *coordinate;
} placement;

static gvc_result check_table(const gvc_disk *disk, const gvc_side_table *table, gvc_error *error) {
    if (table->size < GVC_MIN_IMAGE_SIZE || table->size > GVC_MAX_IMAGE_SIZE ||
        table->start >= gvc_border_length(table->size))
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "bad image size %u or start %u", table->size,
                        table->start);
    bool same = table->side_count == disk->run_count;
    uint64_t steps = 0;
    for (size_t i = 0; same && i < disk->run_count; i++) {
        same = table->side[i].edge == disk->run[i].edge &&
               table->side[i].reversed == disk->run[i].reversed &&
               table->side[i].edge < table->edge_count;
        if (same) steps += table->steps[table->side[i].edge];
    }
    if (!same || steps != gvc_border_length(table->size))
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the side table is not one of this disk's");
    return GVC_OK;
}

static double border_edge_length(const gvc_disk *disk, size_t i) {
    return gvc_halfedge_length(&disk->mesh, disk->mesh.outgoing[disk->border[i]]);
}

/** Loop coordinates of one run that begins at `begin`, by arc length. */
static void spread_run(const placement *p, const gvc_border_run *run, uint32_t begin,
                       uint32_t steps) {
    double length = 0, least, sum = 0, along = 0;
    for (size_t i = run->first; i < run->first + run->count; i++)
        length += border_edge_length(p->disk, i);
    least = length > 0 ? LEAST_EDGE * length / (double)run->count : 1;
    for (size_t i = run->first; i < run->first + run->count; i++)
        sum += fmax(border_edge_length(p->disk, i), least);
    for (size_t i = run->first; i < run->first + run->count; i++) {
        p->coordinate[i] = begin + steps * (along / sum);
        along += fmax(border_edge_length(p->disk, i), least);
    }
}

static void spread_runs(const placement *p) {
    uint32_t begin = 0;
    for (size_t r = 0; r < p->disk->run_count; r++) {
        uint32_t steps = p->table->steps[p->disk->run[r].edge];
        spread_run(p, &p->disk->run[r], begin, steps);
        begin += steps;
    }
}

/** Splits an edge of the disk; a vertex that is not of the uncut mesh. */
static gvc_result split(gvc_disk *disk, uint32_t h, double t, uint32_t *vertex, gvc_error *error) {
    void *original = disk->original;
    if (!gvc_grow(&original, &disk->original_capacity, disk->mesh.vertex_count + 1,
                  sizeof *disk->original))
        return gvc_fail_memory(error);
    disk->original = original;
    GVC_TRY(gvc_halfedges_split(&disk->mesh, h, t, vertex, error));
    disk->original[*vertex] = GVC_NONE;
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- corners */

/** Makes room for one more border vertex in all arrays that go along the border. */
static bool reserve_border(placement *p) {
    size_t count = p->disk->border_count + 1;
    void *border = realloc(p->disk->border, count * sizeof *p->disk->border);
    if (border) p->disk->border = border;
    void *length = realloc(p->disk->border_length, count * sizeof *p->disk->border_length);
    if (length) p->disk->border_length = length;
    void *coordinate = realloc(p->coordinate, count * sizeof *p->coordinate);
    if (coordinate) p->coordinate = coordinate;
    return border && length && coordinate;
}

/** Inserts a border vertex at loop coordinate `at` on border edge `i`, a fraction `t` along it. */
static gvc_result insert_border_vertex(placement *p, size_t i, double t, double at,
                                       gvc_error *error) {
    gvc_disk *disk = p->disk;
    if (!reserve_border(p)) return gvc_fail_memory(error);
    double length = disk->border_length[i] + t * border_edge_length(disk, i);
    uint32_t vertex;
    GVC_TRY(split(disk, disk->mesh.outgoing[disk->border[i]], t, &vertex, error));

    size_t behind = disk->border_count - (i + 1);
    memmove(disk->border + i + 2, disk->border + i + 1, behind * sizeof *disk->border);
    memmove(disk->border_length + i + 2, disk->border_length + i + 1,
            behind * sizeof *disk->border_length);
    memmove(p->coordinate + i + 2, p->coordinate + i + 1, behind * sizeof *p->coordinate);
    disk->border[i + 1] = vertex;
    disk->border_length[i + 1] = length;
    p->coordinate[i + 1] = at;
    disk->border_count++;
    for (size_t r = 0; r < disk->run_count; r++) {
        gvc_border_run *run = &disk->run[r];
        if (run->first > i)
            run->first++;
        else if (i < run->first + run->count)
            run->count++;
    }
    return GVC_OK;
}

/** Sees to it that a border vertex lies exactly at loop coordinate `corner`. Nodes lie at whole
 *  coordinates, so no node is ever near enough to a corner to be moved. */
static gvc_result place_corner(placement *p, double corner, gvc_error *error) {
    size_t i = 0, count = p->disk->border_count;
    while (i + 1 < count && p->coordinate[i + 1] <= corner) i++;
    double end = i + 1 < count ? p->coordinate[i + 1] : gvc_border_length(p->table->size);
    double before = corner - p->coordinate[i], after = end - corner;
    if (before == 0) return GVC_OK;
    if (before < SNAP && before <= after) {
        p->coordinate[i] = corner;
        return GVC_OK;
    }
    if (after < SNAP && i + 1 < count) {
        p->coordinate[i + 1] = corner;
        return GVC_OK;
    }
    return insert_border_vertex(p, i, before / (before + after), corner, error);
}

static gvc_result place_corners(placement *p, gvc_error *error) {
    uint32_t last = p->table->size - 1, length = gvc_border_length(p->table->size);
    for (uint32_t k = 0; k < 4; k++)
        GVC_TRY(place_corner(p, (k * last + length - p->table->start) % length, error));
    return GVC_OK;
}

/* --------------------------------------------------------------------------------------- chords */

/** Splits every inner edge that joins two border vertices. The new vertices are inner ones, so this
 *  makes no new chord; halfedges that move to an appended face are met there. */
static gvc_result split_chords(gvc_disk *disk, gvc_error *error) {
    const gvc_halfedges *m = &disk->mesh;
    size_t old_count = m->vertex_count;
    uint8_t *on_border = gvc_alloc(old_count, sizeof *on_border);
    if (!on_border) return gvc_fail_memory(error);
    for (size_t i = 0; i < disk->border_count; i++) on_border[disk->border[i]] = 1;
    gvc_result result = GVC_OK;
    for (uint32_t h = 0; h < 3 * m->face_count; h++) {
        uint32_t from = m->vertex[h], to = m->vertex[gvc_next(h)], middle;
        if (m->twin[h] == GVC_NONE || from >= old_count || to >= old_count) continue;
        if (!on_border[from] || !on_border[to]) continue;
        GVC_CHECK(split(disk, h, 0.5, &middle, error));
    }
cleanup:
    free(on_border);
    return result;
}

/* --------------------------------------------------------------------------------------- square */

/** The point of the square's border at a border position 0 <= p < P (side_table.h). */
static void border_point(uint32_t size, double p, double uv[2]) {
    double last = size - 1;
    int side = (int)(p / last);
    double along = p - side * last;
    switch (side) {
    case 0:
        uv[0] = along, uv[1] = 0;
        break;
    case 1:
        uv[0] = last, uv[1] = along;
        break;
    case 2:
        uv[0] = last - along, uv[1] = last;
        break;
    default:
        uv[0] = 0, uv[1] = last - along;
        break;
    }
}

static gvc_result fill_uv(const placement *p, double **uv, gvc_error *error) {
    double length = gvc_border_length(p->table->size);
    *uv = gvc_alloc(p->disk->mesh.vertex_count, 2 * sizeof **uv);
    if (!*uv) return gvc_fail_memory(error);
    for (size_t i = 0; i < p->disk->border_count; i++) {
        double position = p->coordinate[i] + p->table->start;
        if (position >= length) position -= length;
        border_point(p->table->size, position, *uv + 2 * (size_t)p->disk->border[i]);
    }
    return GVC_OK;
}

gvc_result gvc_layout_place(gvc_disk *disk, const gvc_side_table *table, double **uv,
                            gvc_error *error) {
    *uv = NULL;
    GVC_TRY(check_table(disk, table, error));
    placement p = {.disk = disk, .table = table};
    p.coordinate = gvc_alloc(disk->border_count, sizeof *p.coordinate);
    if (!p.coordinate) return gvc_fail_memory(error);
    spread_runs(&p);
    gvc_result result;
    GVC_CHECK(place_corners(&p, error));
    GVC_CHECK(split_chords(disk, error));
    GVC_CHECK(fill_uv(&p, uv, error));
cleanup:
    free(p.coordinate);
    return result;
}
