/* SPDX-License-Identifier: MIT */
/** @file vec3.h  Three numbers by value, for the drawing and synthesis tools. */
#ifndef GVC_TOOLS_VEC3_H
#define GVC_TOOLS_VEC3_H

#include <math.h>

typedef struct vec3 {
    double x, y, z;
} vec3;

static inline vec3 vec3_make(double x, double y, double z) { return (vec3){x, y, z}; }
static inline vec3 vec3_load(const double *v) { return (vec3){v[0], v[1], v[2]}; }
static inline vec3 vec3_add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec3 vec3_sub(vec3 a, vec3 b) { return (vec3){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec3 vec3_scale(vec3 a, double s) { return (vec3){s * a.x, s * a.y, s * a.z}; }
static inline double vec3_dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 vec3_cross(vec3 a, vec3 b) {
    return (vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double vec3_length(vec3 a) { return sqrt(vec3_dot(a, a)); }
/** `a` made one long; the zero vector stays. */
static inline vec3 vec3_unit(vec3 a) {
    double length = vec3_length(a);
    return length > 0 ? vec3_scale(a, 1 / length) : a;
}

/** Three orthonormal axes: the rotation that takes the coordinate axes there. */
typedef struct frame3 {
    vec3 x, y, z;
} frame3;

static inline vec3 frame3_apply(const frame3 *f, vec3 v) {
    return vec3_add(vec3_add(vec3_scale(f->x, v.x), vec3_scale(f->y, v.y)), vec3_scale(f->z, v.z));
}
/** Coordinates of `v` along the axes (the inverse of frame3_apply). */
static inline vec3 frame3_coordinates(const frame3 *f, vec3 v) {
    return (vec3){vec3_dot(f->x, v), vec3_dot(f->y, v), vec3_dot(f->z, v)};
}
/** Rotations about the frame's own axes, right-handed, radians. */
static inline frame3 frame3_turn_x(frame3 f, double angle) {
    double c = cos(angle), s = sin(angle);
    return (frame3){f.x, vec3_add(vec3_scale(f.y, c), vec3_scale(f.z, s)),
                    vec3_sub(vec3_scale(f.z, c), vec3_scale(f.y, s))};
}
static inline frame3 frame3_turn_y(frame3 f, double angle) {
    double c = cos(angle), s = sin(angle);
    return (frame3){vec3_sub(vec3_scale(f.x, c), vec3_scale(f.z, s)), f.y,
                    vec3_add(vec3_scale(f.z, c), vec3_scale(f.x, s))};
}
static inline frame3 frame3_turn_z(frame3 f, double angle) {
    double c = cos(angle), s = sin(angle);
    return (frame3){vec3_add(vec3_scale(f.x, c), vec3_scale(f.y, s)),
                    vec3_sub(vec3_scale(f.y, c), vec3_scale(f.x, s)), f.z};
}

#endif
