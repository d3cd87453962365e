/* SPDX-License-Identifier: MIT */
/** @file vector.h  Vectors in space. Results may not overlap operands. */
#ifndef GVC_MESH_VECTOR_H
#define GVC_MESH_VECTOR_H

#include <math.h>

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

/** Rodrigues' rotation about `turn` by its length, row-major. */
static inline void gvc_rotation_about(const double turn[3], double rotation[9]) {
    double angle = sqrt(gvc_dot(turn, turn));
    double s = angle > 1e-12 ? sin(angle) / angle : 1;
    double c = angle > 1e-12 ? (1 - cos(angle)) / (angle * angle) : 0.5;
    const double skew[9] = {0, -turn[2], turn[1], turn[2], 0, -turn[0], -turn[1], turn[0], 0};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double square = 0;
            for (int k = 0; k < 3; k++) square += skew[3 * i + k] * skew[3 * k + j];
            rotation[3 * i + j] = (i == j) + s * skew[3 * i + j] + c * square;
        }
    }
}

#endif
