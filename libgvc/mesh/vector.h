/* SPDX-License-Identifier: MIT */
/** @file vector.h  Vectors in space. Results may not overlap operands. */
#ifndef GVC_MESH_VECTOR_H
#define GVC_MESH_VECTOR_H

static inline double gvc_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void gvc_subtract(const double a[3], const double b[3], double difference[3]) {
    for (int k = 0; k < 3; k++) difference[k] = a[k] - b[k];
}

static inline void gvc_cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
