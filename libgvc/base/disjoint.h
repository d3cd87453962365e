/* SPDX-License-Identifier: MIT */
/** @file disjoint.h  Disjoint sets of numbers 0, 1, 2, ...: a forest, as an array of parents in
 * which each number begins as its own. The smaller root stays a root, so the root of a set is its
 * least number; with path halving that is O(log n) amortised. */
#ifndef GVC_BASE_DISJOINT_H
#define GVC_BASE_DISJOINT_H

#include <stdint.h>

/** The least number of the set that `i` is in. */
static inline uint32_t gvc_disjoint_root(uint32_t *parent, uint32_t i) {
    while (parent[i] != i) {
        parent[i] = parent[parent[i]]; /* path halving */
        i = parent[i];
    }
    return i;
}

/** Makes the sets of `a` and `b` one. */
static inline void gvc_disjoint_unite(uint32_t *parent, uint32_t a, uint32_t b) {
    a = gvc_disjoint_root(parent, a);
    b = gvc_disjoint_root(parent, b);
    if (a < b) {
        parent[b] = a;
    } else {
        parent[a] = b;
    }
}

#endif
