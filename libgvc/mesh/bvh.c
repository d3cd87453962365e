/* SPDX-License-Identifier: MIT */
/** @file bvh.c  Bounding volume hierarchy over the faces of a mesh, for exact closest points. */
#include "base/memory.h"
#include "mesh/distance.h"
#include "mesh/vector.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define LEAF_FACES 4
#define BINS 16
/* Splits follow the surface area heuristic down to this depth. Below it a list of faces is cut into
 * halves as it lies, which at most 32 times leaves one face, so that no input makes the hierarchy
 * deeper than MAX_DEPTH. */
#define HEURISTIC_DEPTH 32
#define MAX_DEPTH 64
/* sin^2 of an angle below which a triangle counts as a segment, see gvc_closest_on_triangle. */
#define SLIVER 1e-14

typedef struct box {
    double minimum[3], maximum[3];
} box;

/* A leaf holds the faces at [first, first + count) of the leaf order; an inner node has count 0 and
 * the children `first` and `first + 1`, beside each other because they are tested together. */
typedef struct node {
    box bounds;
    uint32_t first, count;
} node;

struct gvc_bvh {
    size_t face_count;
    size_t node_count;
    node *nodes;
    uint32_t *face; /* leaf order -> face of the mesh */
    double *corner; /* nine coordinates per face, in leaf order */
};

/* ------------------------------------------------------------------------------------- boxes */

static box empty_box(void) {
    return (box){{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
}

static void box_add(box *bounds, const box *other) {
    for (int k = 0; k < 3; k++) {
        if (other->minimum[k] < bounds->minimum[k]) bounds->minimum[k] = other->minimum[k];
        if (other->maximum[k] > bounds->maximum[k]) bounds->maximum[k] = other->maximum[k];
    }
}

/* Half of the surface area. */
static double box_area(const box *bounds) {
    double e[3];
    gvc_subtract(bounds->maximum, bounds->minimum, e);
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

static double box_middle(const box *bounds, int axis) {
    return 0.5 * bounds->minimum[axis] + 0.5 * bounds->maximum[axis];
}

/* Squared distance of a point to the box, 0 inside. */
static double box_distance(const box *bounds, const double point[3]) {
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double below = bounds->minimum[k] - point[k], above = point[k] - bounds->maximum[k];
        double outside = below > above ? below : above;
        if (outside > 0) sum += outside * outside;
    }
    return sum;
}

/* --------------------------------------------------------------------------------- building */

typedef struct builder {
    gvc_bvh *bvh;
    const box *bounds; /* per face of the mesh */
} builder;

/* Equal slabs between the outermost middles of the faces along their longest axis. */
typedef struct slabs {
    int axis;
    double origin, scale;
} slabs;

static unsigned slab_of(const slabs *s, const box *bounds) {
    double t = (box_middle(bounds, s->axis) - s->origin) * s->scale;
    if (!(t > 0)) return 0;
    return t < BINS ? (unsigned)t : BINS - 1;
}

/* False if all middles coincide (or are too far apart to compute with). */
static bool choose_slabs(const builder *b, uint32_t first, uint32_t count, slabs *s) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (uint32_t i = first; i < first + count; i++) {
        const box *bounds = &b->bounds[b->bvh->face[i]];
        for (int k = 0; k < 3; k++) {
            double middle = box_middle(bounds, k);
            if (middle < low[k]) low[k] = middle;
            if (middle > high[k]) high[k] = middle;
        }
    }
    s->axis = 0;
    for (int k = 1; k < 3; k++) {
        if (high[k] - low[k] > high[s->axis] - low[s->axis]) s->axis = k;
    }
    s->origin = low[s->axis];
    s->scale = BINS / (high[s->axis] - low[s->axis]);
    return isfinite(s->scale) && s->scale > 0;
}

/* The number of slabs to put on the left so that the surface area heuristic, faces times area of
 * their box summed over both sides, is least. */
static unsigned choose_split(const builder *b, uint32_t first, uint32_t count, const slabs *s) {
    box bounds[BINS];
    uint32_t faces[BINS] = {0};
    for (int i = 0; i < BINS; i++) bounds[i] = empty_box();
    for (uint32_t i = first; i < first + count; i++) {
        const box *face = &b->bounds[b->bvh->face[i]];
        unsigned slab = slab_of(s, face);
        faces[slab]++;
        box_add(&bounds[slab], face);
    }
    double right_cost[BINS] = {0};
    box side = empty_box();
    uint32_t side_faces = 0;
    for (unsigned i = BINS; i-- > 1;) {
        box_add(&side, &bounds[i]);
        side_faces += faces[i];
        right_cost[i] = side_faces ? side_faces * box_area(&side) : 0;
    }
    unsigned best = BINS / 2;
    double best_cost = HUGE_VAL;
    side = empty_box();
    side_faces = 0;
    for (unsigned i = 1; i < BINS; i++) {
        box_add(&side, &bounds[i - 1]);
        side_faces += faces[i - 1];
        if (side_faces == 0 || side_faces == count) continue;
        double cost = side_faces * box_area(&side) + right_cost[i];
        if (cost < best_cost) best_cost = cost, best = i;
    }
    return best;
}

/* Reorders the faces so that those of the left child come first; returns how many they are, at
 * least one and less than `count`. */
static uint32_t partition(builder *b, uint32_t first, uint32_t count, unsigned depth) {
    slabs s;
    if (depth >= HEURISTIC_DEPTH || !choose_slabs(b, first, count, &s)) return count / 2;
    unsigned split = choose_split(b, first, count, &s);
    uint32_t *face = b->bvh->face, left = first, right = first + count;
    while (left < right) {
        if (slab_of(&s, &b->bounds[face[left]]) < split) {
            left++;
        } else {
            uint32_t moved = face[--right];
            face[right] = face[left];
            face[left] = moved;
        }
    }
    uint32_t taken = left - first;
    return taken == 0 || taken == count ? count / 2 : taken;
}

static void build(builder *b, uint32_t index, uint32_t first, uint32_t count, unsigned depth) {
    gvc_bvh *bvh = b->bvh;
    box bounds = empty_box();
    for (uint32_t i = first; i < first + count; i++) box_add(&bounds, &b->bounds[bvh->face[i]]);
    if (count <= LEAF_FACES) {
        bvh->nodes[index] = (node){bounds, first, count};
        return;
    }
    uint32_t taken = partition(b, first, count, depth);
    uint32_t child = (uint32_t)bvh->node_count;
    bvh->node_count += 2;
    bvh->nodes[index] = (node){bounds, child, 0};
    build(b, child, first, taken, depth + 1);
    build(b, child + 1, first + taken, count - taken, depth + 1);
}

static void copy_corners(gvc_bvh *bvh, const gvc_mesh *mesh) {
    for (size_t i = 0; i < bvh->face_count; i++) {
        const uint32_t *face = mesh->face + 3 * (size_t)bvh->face[i];
        for (int c = 0; c < 3; c++) {
            const double *position = mesh->position + 3 * (size_t)face[c];
            for (int k = 0; k < 3; k++) bvh->corner[9 * i + 3 * c + k] = position[k];
        }
    }
}

static void face_boxes(const gvc_mesh *mesh, box *bounds) {
    for (size_t f = 0; f < mesh->face_count; f++) {
        bounds[f] = empty_box();
        for (int c = 0; c < 3; c++) {
            const double *p = mesh->position + 3 * (size_t)mesh->face[3 * f + c];
            box corner = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
            box_add(&bounds[f], &corner);
        }
    }
}

gvc_result gvc_bvh_create(const gvc_mesh *mesh, gvc_bvh **bvh, gvc_error *error) {
    *bvh = NULL;
    size_t count = mesh->face_count;
    if (count > UINT32_MAX / 2) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "%zu faces are too many for closest points", count);
    }
    gvc_bvh *made = gvc_alloc(1, sizeof *made);
    box *bounds = gvc_alloc(count, sizeof *bounds);
    if (!made || !bounds) goto no_memory;
    made->face_count = count;
    /* Every leaf holds at least one face, so there are less than two nodes per face. */
    made->nodes = gvc_alloc(2 * count, sizeof *made->nodes);
    made->face = gvc_alloc(count, sizeof *made->face);
    made->corner = gvc_alloc(count, 9 * sizeof *made->corner);
    if (!made->nodes || !made->face || !made->corner) goto no_memory;

    face_boxes(mesh, bounds);
    for (size_t f = 0; f < count; f++) made->face[f] = (uint32_t)f;
    if (count > 0) {
        builder b = {made, bounds};
        made->node_count = 1;
        build(&b, 0, 0, (uint32_t)count, 0);
    }
    copy_corners(made, mesh);
    free(bounds);
    *bvh = made;
    return GVC_OK;

no_memory:
    free(bounds);
    gvc_bvh_destroy(&made);
    return gvc_fail_memory(error);
}

void gvc_bvh_destroy(gvc_bvh **bvh) {
    if (!bvh || !*bvh) return;
    free((*bvh)->nodes);
    free((*bvh)->face);
    free((*bvh)->corner);
    free(*bvh);
    *bvh = NULL;
}

/* ----------------------------------------------------------------------------- one triangle */

/* Moves `closest` to the closest point on the edge from corner i to corner i + 1 if that is
 * nearer. */
static void try_edge(const double point[3], const double *corner, int i, gvc_closest *closest,
                     double *squared) {
    int j = (i + 1) % 3;
    const double *a = corner + 3 * i, *b = corner + 3 * j;
    double along[3], to[3], at[3], off[3];
    gvc_subtract(b, a, along);
    gvc_subtract(point, a, to);
    double length = gvc_dot(along, along), t = length > 0 ? gvc_dot(along, to) / length : 0;
    t = t > 0 ? (t < 1 ? t : 1) : 0;
    /* t = 1 must give b itself, not a + (b - a), which may differ in the last place. */
    for (int k = 0; k < 3; k++) at[k] = t < 1 ? a[k] + t * along[k] : b[k];
    gvc_subtract(point, at, off);
    double found = gvc_dot(off, off);
    if (!(found < *squared)) return;
    *squared = found;
    for (int k = 0; k < 3; k++) closest->barycentric[k] = 0, closest->point[k] = at[k];
    closest->barycentric[i] = 1 - t;
    closest->barycentric[j] = t;
}

/* The point is inside if all three barycentric coordinates of its projection are positive;
 * otherwise it lies on an edge that the point can see, that is one whose opposite coordinate is
 * negative (compare Ericson, Real-Time Collision Detection, 5.1.5, whose products of four lengths
 * lose twice the digits on slivers). A triangle too thin for its normal to mean anything is its
 * edges, at an error of half its height. */
double gvc_closest_on_triangle(const double point[3], const double corner[9],
                               gvc_closest *closest) {
    double ab[3], ac[3], ap[3], normal[3], part[3], weight[3];
    gvc_subtract(corner + 3, corner, ab);
    gvc_subtract(corner + 6, corner, ac);
    gvc_subtract(point, corner, ap);
    gvc_cross(ab, ac, normal);
    double squared = HUGE_VAL, area = gvc_dot(normal, normal);
    bool sliver = !(area > SLIVER * gvc_dot(ab, ab) * gvc_dot(ac, ac));
    gvc_cross(ap, ac, part);
    weight[1] = gvc_dot(normal, part);
    gvc_cross(ab, ap, part);
    weight[2] = gvc_dot(normal, part);
    weight[0] = area - weight[1] - weight[2];

    if (!sliver && weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0) {
        double off[3];
        for (int k = 0; k < 3; k++) closest->barycentric[k] = weight[k] / area;
        for (int k = 0; k < 3; k++) {
            closest->point[k] =
                corner[k] + closest->barycentric[1] * ab[k] + closest->barycentric[2] * ac[k];
        }
        gvc_subtract(point, closest->point, off);
        return gvc_dot(off, off);
    }
    if (sliver || weight[2] < 0) try_edge(point, corner, 0, closest, &squared);
    if (sliver || weight[0] < 0) try_edge(point, corner, 1, closest, &squared);
    if (sliver || weight[1] < 0) try_edge(point, corner, 2, closest, &squared);
    return squared;
}

static bool faces_away(const double *corner, const double normal[3]) {
    double ab[3], ac[3], own[3];
    gvc_subtract(corner + 3, corner, ab);
    gvc_subtract(corner + 6, corner, ac);
    gvc_cross(ab, ac, own);
    return gvc_dot(own, normal) < 0;
}

/* ------------------------------------------------------------------------------------ search */

typedef struct search {
    const gvc_bvh *bvh;
    const double *point, *normal;
    double limit;
    double squared; /* nothing further is of interest; the best found so far once there is one */
    bool found;
    gvc_closest *closest;
} search;

static void search_leaf(search *s, const node *leaf) {
    for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
        const double *corner = s->bvh->corner + 9 * (size_t)i;
        if (s->normal && faces_away(corner, s->normal)) continue;
        gvc_closest candidate = {.face = s->bvh->face[i]};
        double squared = gvc_closest_on_triangle(s->point, corner, &candidate);
        if (!(squared < HUGE_VAL)) continue; /* the query is not a number, or overflowed */
        if (s->found ? squared >= s->squared : sqrt(squared) > s->limit) continue;
        *s->closest = candidate;
        s->squared = squared;
        s->found = true;
    }
}

bool gvc_bvh_closest(const gvc_bvh *bvh, const double point[3], const double *normal, double limit,
                     gvc_closest *closest) {
    if (bvh->node_count == 0 || !(limit >= 0)) return false;
    struct {
        uint32_t node;
        double squared;
    } waiting[MAX_DEPTH + 1]; /* at most one per level: the further child */
    unsigned count = 0;
    /* The square is rounded up so that a face exactly at the limit is not pruned. */
    search s = {.bvh = bvh,
                .point = point,
                .normal = normal,
                .limit = limit,
                .squared = limit * limit * (1 + 4 * DBL_EPSILON) + DBL_MIN,
                .closest = closest};
    waiting[count].node = 0;
    waiting[count++].squared = box_distance(&bvh->nodes[0].bounds, point);
    while (count > 0) {
        count--;
        if (waiting[count].squared > s.squared) continue;
        const node *at = &bvh->nodes[waiting[count].node];
        while (at->count == 0) {
            uint32_t near = at->first, far = at->first + 1;
            double near_squared = box_distance(&bvh->nodes[near].bounds, point);
            double far_squared = box_distance(&bvh->nodes[far].bounds, point);
            if (far_squared < near_squared) {
                double d = near_squared;
                near_squared = far_squared, far_squared = d;
                far = near++; /* the two are neighbours */
            }
            if (far_squared <= s.squared) {
                waiting[count].node = far;
                waiting[count++].squared = far_squared;
            }
            if (near_squared > s.squared) break;
            at = &bvh->nodes[near];
        }
        if (at->count > 0) search_leaf(&s, at);
    }
    if (s.found) closest->distance = sqrt(s.squared);
    return s.found;
}
