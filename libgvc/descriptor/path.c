/* SPDX-License-Identifier: MIT */
/** @file path.c  Dijkstra and A* over the Steiner graph of a mesh, and insertion of what they find.
 */
#include "descriptor/path.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ARITY = 4 };

typedef struct heap_entry {
    double key;
    uint32_t node;
} heap_entry;

/* Steiner nodes are numbered: vertices, then STEINER points per edge from the start of the edge's
 * smaller halfedge, then one node that stands for "a target was reached". */
struct gvc_pathfinder {
    const gvc_halfedges *mesh; /* borrowed from begin to the end of the search */
    const gvc_cut_graph *graph;
    size_t vertex_count, edge_count;
    uint32_t *edge;    /* per halfedge: its edge */
    uint32_t *canon;   /* per edge: its smaller halfedge */
    uint8_t *role;     /* per halfedge: gvc_corner_role of the corner it starts at */
    uint8_t *special;  /* per vertex: some corner is not free */
    uint8_t *wall;     /* per edge: belongs to the graph */
    uint8_t *coarse;   /* per edge: too short to be split once more */
    uint32_t *last;    /* per face: scratch of straighten */
    double *position;  /* 3 per node */
    double *distance;  /* per node */
    double *weight;    /* per node; negative: not evaluated yet */
    uint32_t *parent;  /* per node */
    uint8_t *settled;  /* per node */
    double *attribute; /* one point's */
    size_t edge_capacity, canon_capacity, role_capacity, special_capacity, wall_capacity;
    size_t coarse_capacity, last_capacity, position_capacity, distance_capacity, weight_capacity;
    size_t parent_capacity, settled_capacity, attribute_capacity;
    heap_entry *heap;
    size_t heap_count, heap_capacity;
    bool failed; /* the heap could not grow */
    /* the search under way */
    gvc_path_weight weigh;
    const void *context;
    const double *goal; /* position of the only target vertex, or NULL */
    uint32_t target_vertex, target_parent;
    double target_distance;
};

void gvc_surface_path_free(gvc_surface_path *path) {
    free(path->point);
    *path = (gvc_surface_path){0};
}

gvc_result gvc_pathfinder_create(gvc_pathfinder **finder, gvc_error *error) {
    *finder = gvc_alloc(1, sizeof **finder);
    return *finder ? GVC_OK : gvc_fail_memory(error);
}

void gvc_pathfinder_destroy(gvc_pathfinder **finder) {
    if (!finder || !*finder) return;
    gvc_pathfinder *f = *finder;
    void *all[] = {f->edge,   f->canon,   f->role,      f->special,  f->wall,
                   f->coarse, f->last,    f->position,  f->distance, f->weight,
                   f->parent, f->settled, f->attribute, f->heap};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    free(f);
    *finder = NULL;
}

/* ---------------------------------------------------------------------------------- preparation */

static size_t node_count(const gvc_pathfinder *f) {
    return f->vertex_count + GVC_STEINER_POINTS * f->edge_count + 1;
}

static double distance_between(const double *a, const double *b) {
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

#define GROW(array, needed)                                                                        \
    gvc_grow((void **)&f->array, &f->array##_capacity, (needed), sizeof *f->array)

static bool make_room(gvc_pathfinder *f, const gvc_halfedges *mesh) {
    size_t halfedges = 3 * mesh->face_count;
    if (!GROW(edge, halfedges) || !GROW(canon, halfedges)) return false;
    f->vertex_count = mesh->vertex_count;
    f->edge_count = 0;
    for (size_t h = 0; h < halfedges; h++) {
        uint32_t twin = mesh->twin[h];
        if (twin < h) {
            f->edge[h] = f->edge[twin];
        } else {
            f->edge[h] = (uint32_t)f->edge_count;
            f->canon[f->edge_count++] = (uint32_t)h;
        }
    }
    size_t nodes = node_count(f);
    return GROW(role, halfedges) && GROW(special, f->vertex_count) && GROW(wall, f->edge_count) &&
           GROW(coarse, f->edge_count) && GROW(last, mesh->face_count) &&
           GROW(position, 3 * nodes) && GROW(distance, nodes) && GROW(weight, nodes) &&
           GROW(parent, nodes) && GROW(settled, nodes) &&
           GROW(attribute, mesh->attribute_count + 1);
}

/* Edges this much shorter than the mean are not split again, so that paths beside each other do not
 * cut the mesh to dust. */
static const double shortest_split = 0.05;

static void place_nodes(gvc_pathfinder *f) {
    const gvc_halfedges *m = f->mesh;
    memcpy(f->position, m->position, 3 * f->vertex_count * sizeof *f->position);
    double total = 0;
    for (size_t e = 0; e < f->edge_count; e++) {
        const double *a = m->position + 3 * (size_t)m->vertex[f->canon[e]];
        const double *b = m->position + 3 * (size_t)m->vertex[gvc_next(f->canon[e])];
        double *p = f->position + 3 * (f->vertex_count + GVC_STEINER_POINTS * e);
        for (int j = 1; j <= GVC_STEINER_POINTS; j++) {
            double t = j / (GVC_STEINER_POINTS + 1.0);
            for (int k = 0; k < 3; k++) *p++ = a[k] + t * (b[k] - a[k]);
        }
        total += distance_between(a, b);
    }
    double least = shortest_split * total / (double)(f->edge_count ? f->edge_count : 1);
    for (size_t e = 0; e < f->edge_count; e++)
        f->coarse[e] = gvc_halfedge_length(m, f->canon[e]) < least;
}

gvc_result gvc_pathfinder_begin(gvc_pathfinder *f, const gvc_halfedges *mesh,
                                const gvc_cut_graph *graph, gvc_error *error) {
    if (!make_room(f, mesh)) return gvc_fail_memory(error);
    f->mesh = mesh;
    f->graph = graph;
    place_nodes(f);
    memset(f->role, GVC_CORNER_FREE, 3 * mesh->face_count);
    memset(f->special, 0, f->vertex_count);
    memset(f->wall, 0, f->edge_count);
    for (size_t e = 0; e < graph->edge_count; e++)
        GVC_TRY(gvc_pathfinder_block(f, graph->edge[e].vertex, graph->edge[e].vertex_count, error));
    gvc_pathfinder_mark_graph(f, GVC_CORNER_BLOCKED);
    return GVC_OK;
}

gvc_result gvc_pathfinder_block(gvc_pathfinder *f, const uint32_t *chain, size_t count,
                                gvc_error *error) {
    for (size_t i = 0; i < count; i++) {
        gvc_pathfinder_mark_vertex(f, chain[i], GVC_CORNER_BLOCKED);
        if (i == 0) continue;
        uint32_t h = gvc_halfedge_between(f->mesh, chain[i - 1], chain[i]);
        if (h == GVC_NONE)
            return gvc_fail(error, GVC_ERROR_INTERNAL,
                            "a cut edge jumps from vertex %u to %u, which are not neighbours",
                            chain[i - 1], chain[i]);
        f->wall[f->edge[h]] = 1;
    }
    return GVC_OK;
}

void gvc_pathfinder_mark_vertex(gvc_pathfinder *f, uint32_t vertex, gvc_corner_role role) {
    const gvc_halfedges *m = f->mesh;
    uint32_t h = m->outgoing[vertex];
    do {
        f->role[h] = (uint8_t)role;
        h = gvc_turn(m, h);
    } while (h != GVC_NONE && h != m->outgoing[vertex]);
    f->special[vertex] = role != GVC_CORNER_FREE;
}

void gvc_pathfinder_mark_sector(gvc_pathfinder *f, uint32_t h, gvc_corner_role role) {
    uint32_t first = h;
    f->special[f->mesh->vertex[h]] = 1;
    do {
        f->role[h] = (uint8_t)role;
        h = gvc_turn(f->mesh, h);
    } while (h != GVC_NONE && h != first && !f->wall[f->edge[h]]);
}

void gvc_pathfinder_mark_graph(gvc_pathfinder *f, gvc_corner_role role) {
    for (size_t n = 0; n < f->graph->node_count; n++)
        gvc_pathfinder_mark_vertex(f, f->graph->node[n].vertex, role);
    for (size_t e = 0; e < f->graph->edge_count; e++)
        for (size_t i = 0; i < f->graph->edge[e].vertex_count; i++)
            gvc_pathfinder_mark_vertex(f, f->graph->edge[e].vertex[i], role);
}

bool gvc_pathfinder_on_graph(const gvc_pathfinder *f, uint32_t h) {
    return f->wall[f->edge[h]] != 0;
}

/* --------------------------------------------------------------------------------------- search */

static void heap_push(gvc_pathfinder *f, double key, uint32_t node) {
    if (f->heap_count == f->heap_capacity && !GROW(heap, f->heap_count + 1)) {
        f->failed = true;
        return;
    }
    size_t place = f->heap_count++;
    while (place > 0) {
        size_t up = (place - 1) / ARITY;
        if (f->heap[up].key <= key) break;
        f->heap[place] = f->heap[up];
        place = up;
    }
    f->heap[place] = (heap_entry){key, node};
}

static heap_entry heap_pop(gvc_pathfinder *f) {
    heap_entry top = f->heap[0], last = f->heap[--f->heap_count];
    size_t place = 0;
    for (;;) {
        size_t first = place * ARITY + 1, least = first;
        if (first >= f->heap_count) break;
        for (size_t c = first + 1; c < first + ARITY && c < f->heap_count; c++)
            if (f->heap[c].key < f->heap[least].key) least = c;
        if (f->heap[least].key >= last.key) break;
        f->heap[place] = f->heap[least];
        place = least;
    }
    f->heap[place] = last;
    return top;
}

static gvc_surface_point point_of(const gvc_pathfinder *f, uint32_t node) {
    if (node < f->vertex_count) return (gvc_surface_point){node, GVC_NONE, 0};
    uint32_t steiner = node - (uint32_t)f->vertex_count;
    uint32_t h = f->canon[steiner / GVC_STEINER_POINTS];
    double t = (steiner % GVC_STEINER_POINTS + 1) / (GVC_STEINER_POINTS + 1.0);
    return (gvc_surface_point){f->mesh->vertex[h], f->mesh->vertex[gvc_next(h)], t};
}

static double weight_of(gvc_pathfinder *f, uint32_t node) {
    if (!f->weigh) return 0;
    if (f->weight[node] >= 0) return f->weight[node];
    gvc_surface_point point = point_of(f, node);
    gvc_surface_point_get(f->mesh, &point, NULL, f->attribute);
    return f->weight[node] = f->weigh(f->context, f->position + 3 * (size_t)node, f->attribute);
}

/* Cost of the straight piece between two nodes, or INFINITY if its length alone is over `limit`. */
static double piece_cost(gvc_pathfinder *f, uint32_t from, uint32_t to, double limit) {
    double length = distance_between(f->position + 3 * (size_t)from, f->position + 3 * (size_t)to);
    if (!f->weigh) return length;
    if (!(length < limit)) return INFINITY;
    return length * (1 + 0.5 * (weight_of(f, from) + weight_of(f, to)));
}

static void relax(gvc_pathfinder *f, uint32_t from, uint32_t to) {
    if (f->settled[to]) return;
    double d = f->distance[from];
    d += piece_cost(f, from, to, f->distance[to] - d);
    if (!(d < f->distance[to])) return;
    f->distance[to] = d;
    f->parent[to] = from;
    double bound = f->goal ? distance_between(f->position + 3 * (size_t)to, f->goal) : 0;
    heap_push(f, d + bound, to);
}

/* The vertex that halfedge `corner` starts at, entered through that corner's face. */
static void relax_vertex(gvc_pathfinder *f, uint32_t from, uint32_t corner) {
    uint32_t vertex = f->mesh->vertex[corner];
    if (!f->special[vertex]) {
        relax(f, from, vertex);
        return;
    }
    if (f->role[corner] != GVC_CORNER_TARGET) return;
    double d = f->distance[from];
    d += piece_cost(f, from, vertex, f->target_distance - d);
    if (!(d < f->target_distance)) return;
    f->target_distance = d;
    f->target_vertex = vertex;
    f->target_parent = from;
    heap_push(f, d, (uint32_t)node_count(f) - 1);
}

static void relax_edge(gvc_pathfinder *f, uint32_t from, uint32_t h) {
    uint32_t e = f->edge[h];
    if (f->wall[e] || f->coarse[e]) return;
    uint32_t node = (uint32_t)f->vertex_count + GVC_STEINER_POINTS * e;
    for (uint32_t j = 0; j < GVC_STEINER_POINTS; j++) relax(f, from, node + j);
}

/* Leaves a vertex into the face of the corner `h`. */
static void expand_corner(gvc_pathfinder *f, uint32_t h) {
    uint32_t from = f->mesh->vertex[h];
    relax_edge(f, from, h);
    relax_edge(f, from, gvc_next(h));
    relax_edge(f, from, gvc_prev(h));
    if (!f->wall[f->edge[h]]) relax_vertex(f, from, gvc_next(h));
    if (!f->wall[f->edge[gvc_prev(h)]]) relax_vertex(f, from, gvc_prev(h));
}

static void expand_vertex(gvc_pathfinder *f, uint32_t vertex) {
    const gvc_halfedges *m = f->mesh;
    uint32_t h = m->outgoing[vertex];
    do {
        expand_corner(f, h);
        h = gvc_turn(m, h);
    } while (h != GVC_NONE && h != m->outgoing[vertex]);
}

static void expand_steiner(gvc_pathfinder *f, uint32_t node) {
    uint32_t steiner = node - (uint32_t)f->vertex_count, place = steiner % GVC_STEINER_POINTS;
    uint32_t h = f->canon[steiner / GVC_STEINER_POINTS], side[2] = {h, f->mesh->twin[h]};
    for (int s = 0; s < 2 && side[s] != GVC_NONE; s++) {
        relax_edge(f, node, gvc_next(side[s]));
        relax_edge(f, node, gvc_prev(side[s]));
        relax_vertex(f, node, gvc_prev(side[s]));
    }
    if (place > 0)
        relax(f, node, node - 1);
    else
        relax_vertex(f, node, h);
    if (place + 1 < GVC_STEINER_POINTS)
        relax(f, node, node + 1);
    else
        relax_vertex(f, node, gvc_next(h));
}

static void clear_search(gvc_pathfinder *f) {
    size_t nodes = node_count(f);
    for (size_t i = 0; i < nodes; i++) {
        f->distance[i] = INFINITY;
        f->weight[i] = -1;
    }
    memset(f->settled, 0, nodes);
    f->heap_count = 0;
    f->failed = false;
    f->target_vertex = f->target_parent = GVC_NONE;
    f->target_distance = INFINITY;
}

/* Finds the goal of A*: the only target vertex. */
static void find_goal(gvc_pathfinder *f) {
    uint32_t target = GVC_NONE;
    f->goal = NULL;
    for (size_t h = 0; h < 3 * f->mesh->face_count; h++) {
        if (f->role[h] != GVC_CORNER_TARGET) continue;
        if (target != GVC_NONE && target != f->mesh->vertex[h]) return;
        target = f->mesh->vertex[h];
    }
    if (target != GVC_NONE) f->goal = f->mesh->position + 3 * (size_t)target;
}

static void search(gvc_pathfinder *f) {
    uint32_t reached = (uint32_t)node_count(f) - 1;
    clear_search(f);
    for (size_t h = 0; h < 3 * f->mesh->face_count; h++) {
        if (f->role[h] != GVC_CORNER_SOURCE) continue;
        uint32_t vertex = f->mesh->vertex[h];
        f->distance[vertex] = 0;
        f->parent[vertex] = GVC_NONE;
        f->settled[vertex] = 1;
        expand_corner(f, (uint32_t)h);
    }
    while (f->heap_count > 0 && !f->failed) {
        uint32_t node = heap_pop(f).node;
        if (node == reached) break;
        if (f->settled[node]) continue;
        f->settled[node] = 1;
        if (node < f->vertex_count)
            expand_vertex(f, node);
        else
            expand_steiner(f, node);
    }
}

/* -------------------------------------------------------------------------------- straightening */

/* Calls `visit` for the faces through which a point of the path may be met: both of an edge, all of
 * a vertex, but of an end of the path only those whose corner has the right role. */
typedef void (*face_visitor)(gvc_pathfinder *f, uint32_t face, uint32_t *value);

static void note_last(gvc_pathfinder *f, uint32_t face, uint32_t *value) { f->last[face] = *value; }
static void take_last(gvc_pathfinder *f, uint32_t face, uint32_t *value) {
    if (f->last[face] != GVC_NONE && f->last[face] > *value) *value = f->last[face];
}

static void visit_faces(gvc_pathfinder *f, const gvc_surface_point *p, int role, face_visitor visit,
                        uint32_t *value) {
    const gvc_halfedges *m = f->mesh;
    if (p->b != GVC_NONE) {
        uint32_t h = gvc_halfedge_between(m, p->a, p->b);
        visit(f, h / 3, value);
        if (m->twin[h] != GVC_NONE) visit(f, m->twin[h] / 3, value);
        return;
    }
    uint32_t h = m->outgoing[p->a];
    do {
        if (f->role[h] == role) visit(f, h / 3, value);
        h = gvc_turn(m, h);
    } while (h != GVC_NONE && h != m->outgoing[p->a]);
}

static int role_at(const gvc_surface_path *path, size_t i) {
    return i == 0 ? GVC_CORNER_SOURCE : i + 1 == path->count ? GVC_CORNER_TARGET : GVC_CORNER_FREE;
}

static bool joined_by_wall(const gvc_pathfinder *f, uint32_t a, uint32_t b) {
    uint32_t h = a == b ? GVC_NONE : gvc_halfedge_between(f->mesh, a, b);
    return h != GVC_NONE && f->wall[f->edge[h]];
}

/* From each point goes straight to the last one that lies on a face with it. A weighted path may
 * come back to a face, even cross itself there; afterwards each face holds at most one piece of the
 * path, which is what insertion needs. */
static void straighten(gvc_pathfinder *f, gvc_surface_path *path) {
    uint32_t none = GVC_NONE;
    for (size_t i = 0; i < path->count; i++)
        visit_faces(f, &path->point[i], role_at(path, i), note_last, &none);
    /* Both ends may be joined by an edge of the graph: the path must not fall on it. */
    bool ends_joined = joined_by_wall(f, path->point[0].a, path->point[path->count - 1].a);
    size_t count = 0, total = path->count;
    uint32_t last = (uint32_t)total - 1;
    for (uint32_t i = 0; i < last; i++)
        visit_faces(f, &path->point[i], role_at(path, i), note_last, &i);
    if (!ends_joined) visit_faces(f, &path->point[last], GVC_CORNER_TARGET, note_last, &last);
    for (uint32_t i = 0;;) {
        uint32_t furthest = i;
        visit_faces(f, &path->point[i], role_at(path, i), take_last, &furthest);
        path->point[count++] = path->point[i];
        if (i == last) break;
        if (i == 0 && ends_joined)
            visit_faces(f, &path->point[last], GVC_CORNER_TARGET, note_last, &last);
        i = furthest > i ? furthest : i + 1;
    }
    path->count = count;
}

static bool trace(gvc_pathfinder *f, gvc_surface_path *path) {
    size_t count = 2;
    for (uint32_t n = f->target_parent; f->parent[n] != GVC_NONE; n = f->parent[n]) count++;
    if (!gvc_grow((void **)&path->point, &path->capacity, count, sizeof *path->point)) return false;
    path->count = count;
    path->cost = f->target_distance;
    path->point[--count] = point_of(f, f->target_vertex);
    for (uint32_t n = f->target_parent; n != GVC_NONE; n = f->parent[n])
        path->point[--count] = point_of(f, n);
    straighten(f, path);
    return true;
}

gvc_result gvc_pathfinder_find(gvc_pathfinder *f, gvc_path_weight weight, const void *context,
                               gvc_surface_path *path, gvc_error *error) {
    path->count = 0;
    path->cost = 0;
    f->weigh = weight;
    f->context = context;
    find_goal(f);
    search(f);
    if (f->target_parent == GVC_NONE && !f->failed) {
        /* The only way may lead between edges too short to be split: now they may be. */
        memset(f->coarse, 0, f->edge_count);
        search(f);
    }
    if (f->failed) return gvc_fail_memory(error);
    if (f->target_parent == GVC_NONE) return GVC_OK;
    return trace(f, path) ? GVC_OK : gvc_fail_memory(error);
}

/* ------------------------------------------------------------------------------------ insertion */

void gvc_surface_point_get(const gvc_halfedges *mesh, const gvc_surface_point *point,
                           double position[3], double *attribute) {
    size_t channels = mesh->attribute_count, a = point->a;
    size_t b = point->b == GVC_NONE ? a : point->b;
    double t = point->t;
    for (size_t k = 0; position && k < 3; k++) {
        double from = mesh->position[3 * a + k], to = mesh->position[3 * b + k];
        position[k] = from + t * (to - from);
    }
    for (size_t k = 0; attribute && k < channels; k++) {
        double from = mesh->attribute[channels * a + k], to = mesh->attribute[channels * b + k];
        attribute[k] = from + t * (to - from);
    }
}

gvc_result gvc_surface_path_insert(gvc_halfedges *mesh, const gvc_surface_path *path,
                                   uint32_t **vertex, size_t *count, gvc_error *error) {
    *vertex = NULL;
    *count = 0;
    uint32_t *chain = gvc_alloc(path->count, sizeof *chain);
    if (!chain) return gvc_fail_memory(error);
    gvc_result result = GVC_OK;
    for (size_t i = 0; i < path->count; i++) {
        const gvc_surface_point *p = &path->point[i];
        chain[i] = p->a;
        if (p->b != GVC_NONE) {
            uint32_t h = gvc_halfedge_between(mesh, p->a, p->b);
            if (h == GVC_NONE)
                result = gvc_fail(error, GVC_ERROR_INTERNAL, "a path crosses one mesh edge twice");
            GVC_CHECK(result);
            GVC_CHECK(gvc_halfedges_split(mesh, h, p->t, &chain[i], error));
        }
        if (i > 0 && gvc_halfedge_between(mesh, chain[i - 1], chain[i]) == GVC_NONE)
            result = gvc_fail(error, GVC_ERROR_INTERNAL, "a path leaves the faces it crosses");
        GVC_CHECK(result);
    }
    *vertex = chain;
    *count = path->count;
    return GVC_OK;
cleanup:
    free(chain);
    return result;
}
