/* SPDX-License-Identifier: MIT */
/** @file synth.c  Polygonises the moving figure by surface nets (Gibson 1998) on a grid that lies
 *  elsewhere in every frame. */
#include "synth.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "synth_figure.h"

#include <stdlib.h>

#define MAX_ATTEMPTS 40
#define LEAST_VERTICES 1500u
#define LEAST_RING_VERTICES 500u
#define MAX_VERTICES 1000000u
#define MAX_MENDS 10
#define BLOCK 6 /* nodes per side of a block that is skipped if the surface is far from it */
/* Vertices of a surface net per square of the grid's step, and the area of the figure. */
#define VERTICES_PER_SQUARE 1.5
#define FIGURE_AREA 1.83
#define RING_AREA 0.09

void synth_options_init(synth_options *options) {
    *options = (synth_options){
        .frame_count = 60, .genus = 0, .vertex_count = 6000, .seed = 1, .frame_rate = 30};
}

/* A regular grid in rotated axes: node (i,j,k) is at axes * (origin + step * (i,j,k)). */
typedef struct grid {
    frame3 axes;
    vec3 origin;
    double step;
    size_t size[3], stride[3]; /* nodes per axis; index distance of neighbours */
    float *value;              /* per node: figure_value, or just its sign far from the surface */
    uint32_t *vertex;          /* per node: vertex of the cell whose lowest corner it is */
} grid;

typedef struct net {
    size_t vertex_count, vertex_capacity, quad_count, quad_capacity;
    vec3 *vertex;
    uint32_t (*quad)[4];
} net;

static vec3 node_position(const grid *g, double i, double j, double k) {
    return frame3_apply(&g->axes, vec3_add(g->origin, vec3_scale(vec3_make(i, j, k), g->step)));
}

static gvc_result place_grid(grid *g, const figure *f, const synth_options *options, uint64_t frame,
                             unsigned attempt, gvc_error *error) {
    uint64_t stream = frame * MAX_ATTEMPTS + attempt + 100;
    frame3 axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    axes = frame3_turn_x(axes, 0.8 * (figure_random(options->seed, stream, 0) - 0.5));
    axes = frame3_turn_y(axes, 0.8 * (figure_random(options->seed, stream, 1) - 0.5));
    axes = frame3_turn_z(axes, 0.8 * (figure_random(options->seed, stream, 2) - 0.5));
    g->axes = axes;
    double area = FIGURE_AREA + RING_AREA * options->genus;
    g->step = sqrt(VERTICES_PER_SQUARE * area / (double)options->vertex_count);
    vec3 minimum, maximum;
    figure_bounds(f, &g->axes, &minimum, &maximum);
    vec3 shift =
        vec3_make(figure_random(options->seed, stream, 3), figure_random(options->seed, stream, 4),
                  figure_random(options->seed, stream, 5));
    g->origin = vec3_sub(minimum, vec3_scale(shift, g->step));
    vec3 extent = vec3_scale(vec3_sub(maximum, g->origin), 1 / g->step);
    g->size[0] = (size_t)extent.x + 2;
    g->size[1] = (size_t)extent.y + 2;
    g->size[2] = (size_t)extent.z + 2;
    g->stride[0] = 1;
    g->stride[1] = g->size[0];
    g->stride[2] = g->size[0] * g->size[1];
    size_t count = g->stride[2] * g->size[2];
    g->value = gvc_alloc(count, sizeof *g->value);
    g->vertex = gvc_alloc(count, sizeof *g->vertex);
    return g->value && g->vertex ? GVC_OK : gvc_fail_memory(error);
}

static size_t least_size(size_t a, size_t b) { return a < b ? a : b; }

/* Evaluates the nodes of one block, or only its centre if the surface cannot come near. */
static void fill_block(grid *g, const figure *f, const size_t low[3]) {
    size_t high[3];
    for (int a = 0; a < 3; a++) high[a] = least_size(low[a] + BLOCK, g->size[a]);
    double middle = (BLOCK - 1) / 2.0;
    vec3 centre =
        node_position(g, (double)low[0] + middle, (double)low[1] + middle, (double)low[2] + middle);
    double value = figure_value(f, centre);
    /* Half a block's diagonal, and one step to the nodes of the next block. */
    bool far = fabs(value) > FIGURE_LIPSCHITZ * g->step * (sqrt(3) * middle + 2);
    for (size_t k = low[2]; k < high[2]; k++) {
        for (size_t j = low[1]; j < high[1]; j++) {
            for (size_t i = low[0]; i < high[0]; i++) {
                double v = far ? value
                               : figure_value(f, node_position(g, (double)i, (double)j, (double)k));
                g->value[i + j * g->stride[1] + k * g->stride[2]] = (float)v;
            }
        }
    }
}

static void fill_grid(grid *g, const figure *f) {
    size_t low[3];
    for (low[2] = 0; low[2] < g->size[2]; low[2] += BLOCK) {
        for (low[1] = 0; low[1] < g->size[1]; low[1] += BLOCK) {
            for (low[0] = 0; low[0] < g->size[0]; low[0] += BLOCK) fill_block(g, f, low);
        }
    }
}

/* Flips the least certain of four nodes round a grid face (or of two, if `count` is 2). */
static void flip_least(grid *g, const size_t *node, unsigned count) {
    unsigned least = 0;
    for (unsigned c = 1; c < count; c++) {
        if (fabsf(g->value[node[c]]) < fabsf(g->value[node[least]])) least = c;
    }
    g->value[node[least]] = -g->value[node[least]];
}

/* True if the signs round a face alternate, so that two sheets of the net would share an edge. */
static bool mend_face(grid *g, size_t node, size_t u, size_t v) {
    const size_t face[4] = {node, node + u, node + u + v, node + v};
    bool sign[4];
    for (unsigned c = 0; c < 4; c++) sign[c] = g->value[face[c]] < 0;
    if (sign[0] != sign[2] || sign[1] != sign[3] || sign[0] == sign[1]) return false;
    flip_least(g, face, 4);
    return true;
}

/* True if two opposite corners of a cell differ from all others: two sheets would share a vertex.
 */
static bool mend_cell(grid *g, size_t node) {
    size_t corner[8];
    unsigned inside = 0;
    for (unsigned c = 0; c < 8; c++) {
        corner[c] =
            node + (c & 1) * g->stride[0] + (c >> 1 & 1) * g->stride[1] + (c >> 2) * g->stride[2];
        inside |= (g->value[corner[c]] < 0 ? 1u : 0u) << c;
    }
    for (unsigned c = 0; c < 4; c++) {
        unsigned pair = 1u << c | 1u << (7 - c);
        if (inside != pair && inside != (pair ^ 0xffu)) continue;
        const size_t node_pair[2] = {corner[c], corner[7 - c]};
        flip_least(g, node_pair, 2);
        return true;
    }
    return false;
}

/* Makes the signs well-composed (Latecki 1997), which makes the net a manifold: where they are not,
 * the surface is finer than the grid. */
static bool mend_grid(grid *g) {
    bool changed = false;
    for (size_t k = 0; k + 1 < g->size[2]; k++) {
        for (size_t j = 0; j + 1 < g->size[1]; j++) {
            for (size_t i = 0; i + 1 < g->size[0]; i++) {
                size_t node = i + j * g->stride[1] + k * g->stride[2];
                if (fabsf(g->value[node]) > 3 * (float)g->step) continue;
                changed |= mend_face(g, node, g->stride[0], g->stride[1]);
                changed |= mend_face(g, node, g->stride[1], g->stride[2]);
                changed |= mend_face(g, node, g->stride[2], g->stride[0]);
                changed |= mend_cell(g, node);
            }
        }
    }
    return changed;
}

/* Mean of the points where the surface crosses the cell's edges; false if it does not. Corner c of
 * a cell has coordinates (c & 1, c >> 1 & 1, c >> 2). */
static bool cell_vertex(const grid *g, size_t node, double mean[3]) {
    float corner[8];
    unsigned inside = 0;
    for (unsigned c = 0; c < 8; c++) {
        corner[c] = g->value[node + (c & 1) * g->stride[0] + (c >> 1 & 1) * g->stride[1] +
                             (c >> 2) * g->stride[2]];
        inside += corner[c] < 0;
    }
    if (inside == 0 || inside == 8) return false;
    unsigned crossings = 0;
    mean[0] = mean[1] = mean[2] = 0;
    for (unsigned c = 0; c < 8; c++) {
        for (unsigned axis = 0; axis < 3; axis++) {
            unsigned end = c | 1u << axis;
            if (end == c || (corner[c] < 0) == (corner[end] < 0)) continue;
            double t = (double)corner[c] / ((double)corner[c] - (double)corner[end]);
            for (unsigned a = 0; a < 3; a++) mean[a] += (c >> a & 1) + (a == axis ? t : 0);
            crossings++;
        }
    }
    for (unsigned a = 0; a < 3; a++) mean[a] /= crossings;
    return true;
}

static gvc_result make_vertices(grid *g, net *n, gvc_error *error) {
    for (size_t k = 0; k + 1 < g->size[2]; k++) {
        for (size_t j = 0; j + 1 < g->size[1]; j++) {
            for (size_t i = 0; i + 1 < g->size[0]; i++) {
                size_t node = i + j * g->stride[1] + k * g->stride[2];
                double mean[3];
                if (!cell_vertex(g, node, mean)) continue;
                if (!gvc_grow((void **)&n->vertex, &n->vertex_capacity, n->vertex_count + 1,
                              sizeof *n->vertex)) {
                    return gvc_fail_memory(error);
                }
                g->vertex[node] = (uint32_t)n->vertex_count;
                n->vertex[n->vertex_count++] =
                    node_position(g, (double)i + mean[0], (double)j + mean[1], (double)k + mean[2]);
            }
        }
    }
    return GVC_OK;
}

/* Every grid edge that crosses the surface gives a quad of the four cells around it. The outermost
 * nodes are outside the figure, so those cells exist. */
static gvc_result make_quads(const grid *g, net *n, gvc_error *error) {
    size_t position[3];
    for (position[2] = 1; position[2] + 1 < g->size[2]; position[2]++) {
        for (position[1] = 1; position[1] + 1 < g->size[1]; position[1]++) {
            for (position[0] = 1; position[0] + 1 < g->size[0]; position[0]++) {
                size_t node = position[0] + position[1] * g->stride[1] + position[2] * g->stride[2];
                for (unsigned axis = 0; axis < 3; axis++) {
                    bool inside = g->value[node] < 0;
                    if (inside == (g->value[node + g->stride[axis]] < 0)) continue;
                    if (!gvc_grow((void **)&n->quad, &n->quad_capacity, n->quad_count + 1,
                                  sizeof *n->quad)) {
                        return gvc_fail_memory(error);
                    }
                    size_t u = g->stride[(axis + 1) % 3], v = g->stride[(axis + 2) % 3];
                    if (!inside) { /* seen from outside, the quad must run counter-clockwise */
                        size_t swap = u;
                        u = v;
                        v = swap;
                    }
                    uint32_t *quad = n->quad[n->quad_count++];
                    quad[0] = g->vertex[node - u - v];
                    quad[1] = g->vertex[node - v];
                    quad[2] = g->vertex[node];
                    quad[3] = g->vertex[node - u];
                }
            }
        }
    }
    return GVC_OK;
}

/* Evens out the net: each vertex goes halfway to the mean of its neighbours, then onto the surface.
 */
static gvc_result relax(net *n, const figure *f, gvc_error *error) {
    vec3 *sum = gvc_alloc(n->vertex_count, sizeof *sum);
    uint32_t *count = gvc_alloc(n->vertex_count, sizeof *count);
    if (!sum || !count) {
        free(sum);
        free(count);
        return gvc_fail_memory(error);
    }
    for (size_t q = 0; q < n->quad_count; q++) {
        for (unsigned c = 0; c < 4; c++) {
            uint32_t a = n->quad[q][c], b = n->quad[q][(c + 1) % 4];
            sum[a] = vec3_add(sum[a], n->vertex[b]);
            count[a]++;
        }
    }
    for (size_t v = 0; v < n->vertex_count; v++) {
        vec3 mean = count[v] ? vec3_scale(sum[v], 1.0 / count[v]) : n->vertex[v];
        n->vertex[v] = figure_project(f, vec3_scale(vec3_add(n->vertex[v], mean), 0.5));
    }
    free(sum);
    free(count);
    return GVC_OK;
}

/* Splits each quad along its shorter diagonal. */
static gvc_result make_mesh(const net *n, gvc_mesh **mesh, gvc_error *error) {
    GVC_TRY(gvc_mesh_allocate(n->vertex_count, 2 * n->quad_count, mesh, error));
    for (size_t v = 0; v < n->vertex_count; v++) {
        (*mesh)->position[3 * v] = n->vertex[v].x;
        (*mesh)->position[3 * v + 1] = n->vertex[v].y;
        (*mesh)->position[3 * v + 2] = n->vertex[v].z;
    }
    for (size_t q = 0; q < n->quad_count; q++) {
        const uint32_t *quad = n->quad[q];
        vec3 ac = vec3_sub(n->vertex[quad[2]], n->vertex[quad[0]]);
        vec3 bd = vec3_sub(n->vertex[quad[3]], n->vertex[quad[1]]);
        unsigned first = vec3_dot(ac, ac) <= vec3_dot(bd, bd) ? 0 : 1;
        uint32_t *face = &(*mesh)->face[6 * q];
        for (unsigned c = 0; c < 3; c++) {
            face[c] = quad[(first + c) % 4];
            face[3 + c] = quad[(first + (c ? c + 1 : 0)) % 4];
        }
    }
    return GVC_OK;
}

static gvc_result polygonise(const figure *f, const synth_options *options, uint64_t frame,
                             unsigned attempt, gvc_mesh **mesh, gvc_error *error) {
    grid g = {.value = NULL};
    net n = {.vertex = NULL};
    gvc_result result;
    GVC_CHECK(place_grid(&g, f, options, frame, attempt, error));
    fill_grid(&g, f);
    for (unsigned pass = 0; pass < MAX_MENDS && mend_grid(&g); pass++) {
    }
    GVC_CHECK(make_vertices(&g, &n, error));
    GVC_CHECK(make_quads(&g, &n, error));
    GVC_CHECK(relax(&n, f, error));
    GVC_CHECK(relax(&n, f, error));
    GVC_CHECK(make_mesh(&n, mesh, error));
cleanup:
    free(g.value);
    free(g.vertex);
    free(n.vertex);
    free(n.quad);
    return result;
}

static gvc_result check_options(const synth_options *options, uint64_t frame, gvc_error *error) {
    if (options->genus > SYNTH_MAX_GENUS) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "the figure has no genus %u, at most %u",
                        options->genus, SYNTH_MAX_GENUS);
    }
    size_t least = LEAST_VERTICES + LEAST_RING_VERTICES * options->genus;
    if (options->vertex_count < least || options->vertex_count > MAX_VERTICES) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT,
                        "%zu vertices asked for; with genus %u between %zu and %u are possible",
                        options->vertex_count, options->genus, least, MAX_VERTICES);
    }
    if (!(options->frame_rate > 0) || !isfinite(options->frame_rate)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "frame rate %g is not positive",
                        options->frame_rate);
    }
    if (frame >= options->frame_count) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "frame %llu of %llu does not exist",
                        (unsigned long long)frame, (unsigned long long)options->frame_count);
    }
    return GVC_OK;
}

gvc_result synth_frame(const synth_options *options, uint64_t frame, gvc_mesh **mesh,
                       gvc_error *error) {
    *mesh = NULL;
    GVC_TRY(check_options(options, frame, error));
    figure f;
    figure_pose(&f, (double)frame / options->frame_rate, options->genus, options->seed);
    /* Where the surface is finer than the grid, mending may have changed its topology: then the
     * grid moves. */
    for (unsigned attempt = 0; attempt < MAX_ATTEMPTS; attempt++) {
        gvc_mesh *trial = NULL;
        gvc_topology topology;
        gvc_result result = polygonise(&f, options, frame, attempt, &trial, error);
        if (result == GVC_OK) result = gvc_mesh_topology(trial, &topology, error);
        bool good = result == GVC_OK && topology.closed_manifold && topology.component_count == 1 &&
                    topology.genus == (int64_t)options->genus;
        if (good) {
            *mesh = trial;
            return GVC_OK;
        }
        gvc_mesh_destroy(&trial);
        if (result != GVC_OK) return result;
    }
    return gvc_at_frame(error,
                        gvc_fail(error, GVC_ERROR_MESH,
                                 "%zu vertices are too few for a figure of genus %u",
                                 options->vertex_count, options->genus),
                        (int64_t)frame);
}
