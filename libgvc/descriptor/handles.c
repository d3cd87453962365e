/* SPDX-License-Identifier: MIT */
/** @file handles.c  The two loops of one handle. */
#include "descriptor/handles.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>

void gvc_handle_free(gvc_handle *handle) {
    free(handle->loop[0]);
    free(handle->loop[1]);
    *handle = (gvc_handle){0};
}

void gvc_handle_turn(gvc_handle *handle) {
    uint32_t *first = handle->loop[0];
    size_t count = handle->count[0];
    for (size_t i = 0; i < count / 2; i++) {
        uint32_t v = first[i];
        first[i] = first[count - 1 - i];
        first[count - 1 - i] = v;
    }
    *handle = (gvc_handle){{handle->loop[1], first}, {handle->count[1], count}};
}

/* ------------------------------------------------------------------------------- the first loop */

typedef struct vertex_loop {
    uint32_t *vertex; /* count + 1: the first is also the last */
    size_t count;
    double length;
} vertex_loop;

/* The loop that halfedge `h` closes, without the way there and back from the root. */
static gvc_result take_loop(const gvc_loops *d, uint32_t h, vertex_loop *loop, gvc_error *error) {
    const gvc_halfedges *mesh = d->mesh;
    uint32_t end[2] = {mesh->vertex[h], mesh->vertex[gvc_next(h)]}, at[2] = {end[0], end[1]};
    size_t steps[2] = {0, 0};
    while (at[0] != at[1]) {
        int side = d->distance[at[0]] >= d->distance[at[1]] ? 0 : 1;
        at[side] = mesh->vertex[d->toward[at[side]]];
        steps[side]++;
    }
    *loop = (vertex_loop){.count = steps[0] + steps[1] + 1};
    loop->length = d->distance[end[0]] + d->distance[end[1]] + gvc_halfedge_length(mesh, h) -
                   2 * d->distance[at[0]];
    loop->vertex = gvc_alloc(loop->count + 1, sizeof *loop->vertex);
    if (!loop->vertex) return gvc_fail_memory(error);
    for (size_t i = 0, v = end[0]; i <= steps[0]; i++) {
        loop->vertex[steps[0] - i] = (uint32_t)v;
        if (i < steps[0]) v = mesh->vertex[d->toward[v]];
    }
    for (size_t i = 0, v = end[1]; i < steps[1]; i++) {
        loop->vertex[loop->count - steps[1] + i] = (uint32_t)v;
        v = mesh->vertex[d->toward[v]];
    }
    loop->vertex[loop->count] = loop->vertex[0];
    return GVC_OK;
}

enum { STARTS = 4, MOVES = 3 };
static const double worth_a_move = 0.98;

/* Replaces the loop by the shortest one through a point of it, for as long as that is shorter. */
static gvc_result move_loop(gvc_loops *d, uint32_t through, vertex_loop *loop, gvc_error *error) {
    for (int i = 0; i < MOVES; i++) {
        vertex_loop next;
        GVC_TRY(gvc_loops_find(d, through, error));
        if (d->edge_count == 0) return GVC_OK;
        uint32_t h = d->edge[d->edge_count - 1].h;
        GVC_TRY(take_loop(d, h, &next, error));
        bool shorter = next.length < worth_a_move * loop->length;
        if (next.length < loop->length) {
            free(loop->vertex);
            *loop = next;
            through = d->mesh->vertex[h];
        } else {
            free(next.vertex);
        }
        if (!shorter) return GVC_OK;
    }
    return GVC_OK;
}

/* The shortest of the loops to be had by moving the shortest ones that `d` found. */
static gvc_result move_loops(gvc_loops *d, vertex_loop *best, gvc_error *error) {
    size_t count = d->edge_count < STARTS ? d->edge_count : STARTS;
    uint32_t start[STARTS];
    for (size_t i = 0; i < count; i++) start[i] = d->edge[d->edge_count - 1 - i].h;
    for (size_t i = 0; i < count; i++) {
        vertex_loop loop = {.length = INFINITY};
        gvc_result result = move_loop(d, d->mesh->vertex[start[i]], &loop, error);
        if (result == GVC_OK && loop.length < best->length) {
            vertex_loop longer = *best;
            *best = loop;
            loop = longer;
        }
        free(loop.vertex);
        if (result != GVC_OK) return result;
    }
    return GVC_OK;
}

/* The free vertex nearest to a vertex. */
static uint32_t free_vertex(const gvc_loops *d, uint32_t from) {
    const gvc_halfedges *mesh = d->mesh;
    const double *p = mesh->position + 3 * (size_t)from;
    uint32_t nearest = GVC_NONE;
    double least = INFINITY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *q = mesh->position + 3 * (size_t)v;
        double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
        if (d->blocked[v] || !(away < least)) continue;
        least = away;
        nearest = v;
    }
    return nearest;
}

static gvc_result first_loop(gvc_halfedges *mesh, const gvc_obstacles *obstacles, uint32_t from,
                             bool near, vertex_loop *loop, gvc_error *error) {
    gvc_loops loops;
    *loop = (vertex_loop){0};
    GVC_TRY(gvc_loops_prepare(mesh, obstacles, &loops, error));
    gvc_result result = GVC_OK;
    uint32_t start = free_vertex(&loops, from);
    if (start != GVC_NONE) result = gvc_loops_find(&loops, start, error);
    if (result == GVC_OK && loops.edge_count > 0)
        result = take_loop(&loops, loops.edge[loops.edge_count - 1].h, loop, error);
    if (result == GVC_OK && loop->vertex && !near) result = move_loops(&loops, loop, error);
    if (result != GVC_OK) {
        free(loop->vertex);
        *loop = (vertex_loop){0};
    }
    gvc_loops_free(&loops);
    return result;
}

/* ------------------------------------------------------------------------------ the second loop */

/* Begins a search that must not touch the obstacles nor a loop along `chain`. */
static gvc_result begin(gvc_pathfinder *finder, const gvc_halfedges *mesh,
                        const gvc_obstacles *obstacles, const uint32_t *chain, size_t count,
                        gvc_error *error) {
    GVC_TRY(gvc_pathfinder_begin(finder, mesh, obstacles->graph, error));
    for (size_t i = 0; i < obstacles->vertex_count; i++)
        if (obstacles->vertex[i] != GVC_NONE)
            gvc_pathfinder_mark_vertex(finder, obstacles->vertex[i], GVC_CORNER_BLOCKED);
    return gvc_pathfinder_block(finder, chain, count, error);
}

/* Finds where the shortest path from the left of a loop to its right begins: a good base. */
static gvc_result find_base(gvc_pathfinder *finder, const gvc_halfedges *mesh,
                            const gvc_obstacles *obstacles, vertex_loop *loop, size_t *base,
                            gvc_error *error) {
    gvc_surface_path path = {0};
    size_t n = loop->count;
    gvc_result result = begin(finder, mesh, obstacles, loop->vertex, n + 1, error);
    if (result != GVC_OK) return result;
    for (size_t i = 0; i < n; i++) {
        const uint32_t *v = loop->vertex;
        uint32_t ahead = gvc_halfedge_between(mesh, v[i], v[(i + 1) % n]);
        uint32_t back = gvc_halfedge_between(mesh, v[i], v[(i + n - 1) % n]);
        gvc_pathfinder_mark_sector(finder, ahead, GVC_CORNER_SOURCE);
        gvc_pathfinder_mark_sector(finder, back, GVC_CORNER_TARGET);
    }
    result = gvc_pathfinder_find(finder, NULL, NULL, &path, error);
    *base = n;
    for (size_t i = 0; result == GVC_OK && path.count > 0 && i < n; i++)
        if (loop->vertex[i] == path.point[0].a) *base = i;
    gvc_surface_path_free(&path);
    if (result == GVC_OK && *base == n)
        result = gvc_fail(error, GVC_ERROR_INTERNAL,
                          "a loop of %zu vertices has no way round to its other side", n);
    return result;
}

/* Finds the shortest loop that crosses `wall` at its base, from the left of it to its right, or the
 * other way. Replaces `*loop`. */
static gvc_result cross(gvc_pathfinder *finder, gvc_halfedges *mesh, const gvc_obstacles *obstacles,
                        const uint32_t *wall, size_t wall_count, bool from_left, uint32_t **loop,
                        size_t *count, gvc_error *error) {
    gvc_surface_path path = {0};
    uint32_t *chain = NULL;
    size_t length = 0;
    gvc_result result = begin(finder, mesh, obstacles, wall, wall_count, error);
    if (result != GVC_OK) return result;
    uint32_t ahead = gvc_halfedge_between(mesh, wall[0], wall[1]);
    uint32_t back = gvc_halfedge_between(mesh, wall[0], wall[wall_count - 2]);
    gvc_pathfinder_mark_sector(finder, from_left ? ahead : back, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_sector(finder, from_left ? back : ahead, GVC_CORNER_TARGET);
    result = gvc_pathfinder_find(finder, NULL, NULL, &path, error);
    if (result == GVC_OK && path.count == 0)
        result = gvc_fail(error, GVC_ERROR_INTERNAL,
                          "a loop of %zu vertices cannot be crossed at its base", wall_count);
    if (result == GVC_OK) result = gvc_surface_path_insert(mesh, &path, &chain, &length, error);
    if (result == GVC_OK) {
        free(*loop);
        *loop = chain;
        *count = length;
    }
    gvc_surface_path_free(&path);
    return result;
}

/* Makes two loops of one, given with its base: the shortest loop that crosses it there, and, as it
 * follows the edges of the mesh, the shortest one that crosses that. */
static gvc_result straighten(gvc_pathfinder *finder, gvc_halfedges *mesh,
                             const gvc_obstacles *obstacles, gvc_handle *handle, gvc_error *error) {
    uint32_t **loop = handle->loop;
    size_t *count = handle->count;
    for (int i = 0; i < 3; i++) {
        bool second = i != 1;
        GVC_TRY(cross(finder, mesh, obstacles, loop[!second], count[!second], second, &loop[second],
                      &count[second], error));
    }
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------- the base */

/* The point of the loops nearest to the obstacles' graph and `from`: with the base there, the way
 * to it does not run along a loop, where it could get from one side of it to the other. */
static gvc_result nearest_to_graph(gvc_pathfinder *finder, const gvc_halfedges *mesh,
                                   const gvc_obstacles *obstacles, uint32_t from,
                                   const gvc_handle *handle, uint32_t *vertex, gvc_error *error) {
    gvc_surface_path path = {0};
    GVC_TRY(begin(finder, mesh, obstacles, NULL, 0, error));
    for (int k = 0; k < 2; k++)
        GVC_TRY(gvc_pathfinder_block(finder, handle->loop[k], handle->count[k], error));
    gvc_pathfinder_mark_graph(finder, GVC_CORNER_SOURCE);
    gvc_pathfinder_mark_vertex(finder, from, GVC_CORNER_SOURCE);
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < handle->count[k]; i++)
            gvc_pathfinder_mark_vertex(finder, handle->loop[k][i], GVC_CORNER_TARGET);
    gvc_result result = gvc_pathfinder_find(finder, NULL, NULL, &path, error);
    if (path.count > 0) *vertex = path.point[path.count - 1].a;
    gvc_surface_path_free(&path);
    return result;
}

/* Turns the loops so that the base is reached by the shortest way from the graph, or `from`,
 * between the second loop coming in and the first one going out. */
static gvc_result turn_to_graph(gvc_pathfinder *finder, const gvc_halfedges *mesh,
                                const gvc_obstacles *obstacles, uint32_t from, gvc_handle *handle,
                                gvc_error *error) {
    gvc_surface_path path = {0};
    double least = INFINITY;
    int best = 0;
    gvc_result result = GVC_OK;
    for (int turn = 0; turn < 4 && result == GVC_OK; turn++) {
        const uint32_t *second = handle->loop[1];
        result = begin(finder, mesh, obstacles, handle->loop[0], handle->count[0], error);
        if (result == GVC_OK)
            result = gvc_pathfinder_block(finder, second, handle->count[1], error);
        if (result != GVC_OK) break;
        gvc_pathfinder_mark_graph(finder, GVC_CORNER_SOURCE);
        gvc_pathfinder_mark_vertex(finder, from, GVC_CORNER_SOURCE);
        uint32_t in = gvc_halfedge_between(mesh, second[0], second[handle->count[1] - 2]);
        gvc_pathfinder_mark_sector(finder, in, GVC_CORNER_TARGET);
        result = gvc_pathfinder_find(finder, NULL, NULL, &path, error);
        if (result == GVC_OK && path.count > 0 && path.cost < least) {
            least = path.cost;
            best = turn;
        }
        gvc_handle_turn(handle);
    }
    gvc_surface_path_free(&path);
    for (int turn = 0; turn < best; turn++) gvc_handle_turn(handle);
    return result;
}

/* The point of the loops nearest to `from` in space. */
static void nearest_to_point(const gvc_halfedges *mesh, uint32_t from, const gvc_handle *handle,
                             uint32_t *vertex) {
    const double *p = mesh->position + 3 * (size_t)from;
    double least = INFINITY;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < handle->count[k]; i++) {
            const double *q = mesh->position + 3 * (size_t)handle->loop[k][i];
            double away = hypot(hypot(p[0] - q[0], p[1] - q[1]), p[2] - q[2]);
            if (!(away < least)) continue;
            least = away;
            *vertex = handle->loop[k][i];
        }
}

/* Moves the base along the loops to a vertex of one of them. */
static gvc_result move_base(gvc_pathfinder *finder, gvc_halfedges *mesh,
                            const gvc_obstacles *obstacles, uint32_t vertex, gvc_handle *handle,
                            gvc_error *error) {
    for (int turn = 0; turn < 2; turn++) {
        size_t n = handle->count[0] - 1, place = 0;
        while (place < n && handle->loop[0][place] != vertex) place++;
        if (place == 0) return GVC_OK; /* it is the base */
        if (place < n) {
            uint32_t *rotated = gvc_alloc(n + 1, sizeof *rotated);
            if (!rotated) return gvc_fail_memory(error);
            for (size_t i = 0; i <= n; i++) rotated[i] = handle->loop[0][(place + i) % n];
            free(handle->loop[0]);
            handle->loop[0] = rotated;
            return straighten(finder, mesh, obstacles, handle, error);
        }
        gvc_handle_turn(handle);
    }
    return GVC_OK;
}

gvc_result gvc_handle_find(gvc_pathfinder *finder, gvc_halfedges *mesh,
                           const gvc_obstacles *obstacles, uint32_t from, bool near,
                           gvc_handle *handle, gvc_error *error) {
    vertex_loop found;
    size_t base;
    *handle = (gvc_handle){0};
    for (size_t h = 0; h < 3 * mesh->face_count; h++)
        if (mesh->twin[h] == GVC_NONE)
            return gvc_fail(error, GVC_ERROR_MESH, "the surface is open: face %zu has a free edge",
                            h / 3);
    GVC_TRY(first_loop(mesh, obstacles, from, near, &found, error));
    if (!found.vertex) return GVC_OK;
    gvc_result result = find_base(finder, mesh, obstacles, &found, &base, error);
    uint32_t *const first = gvc_alloc(found.count + 1, sizeof *first);
    if (!first && result == GVC_OK) result = gvc_fail_memory(error);
    for (size_t i = 0; result == GVC_OK && i <= found.count; i++)
        first[i] = found.vertex[(base + i) % found.count];
    *handle = (gvc_handle){{first, NULL}, {found.count + 1, 0}};
    free(found.vertex);
    if (result == GVC_OK) result = straighten(finder, mesh, obstacles, handle, error);
    if (result != GVC_OK) gvc_handle_free(handle);
    return result;
}

gvc_result gvc_handle_face(gvc_pathfinder *finder, gvc_halfedges *mesh,
                           const gvc_obstacles *obstacles, uint32_t from, gvc_handle *handle,
                           gvc_error *error) {
    uint32_t vertex = handle->loop[0][0];
    GVC_TRY(nearest_to_graph(finder, mesh, obstacles, from, handle, &vertex, error));
    GVC_TRY(move_base(finder, mesh, obstacles, vertex, handle, error));
    return turn_to_graph(finder, mesh, obstacles, from, handle, error);
}

gvc_result gvc_handle_rebase(gvc_pathfinder *finder, gvc_halfedges *mesh,
                             const gvc_obstacles *obstacles, uint32_t near, gvc_handle *handle,
                             gvc_error *error) {
    uint32_t vertex = handle->loop[0][0];
    nearest_to_point(mesh, near, handle, &vertex);
    return move_base(finder, mesh, obstacles, vertex, handle, error);
}
