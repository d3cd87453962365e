/* SPDX-License-Identifier: MIT */
/** @file predict.c  The gradient predictor, and which predictor an image gets. */
#include "codec/predict.h"

#include "base/memory.h"
#include "codec/predict_squares.h"

#include <stdlib.h>

struct gvc_predictor {
    uint32_t size;
    const uint16_t *codes, *previous;
    gvc_squares *squares; /* NULL: gradient */
};

gvc_result gvc_predictor_create(gvc_predictor_kind kind, uint32_t size, const uint16_t *codes,
                                const uint16_t *previous, gvc_predictor **predictor,
                                gvc_error *error) {
    gvc_predictor *p = gvc_alloc(1, sizeof *p);
    *predictor = p;
    if (!p) return gvc_fail_memory(error);
    *p = (gvc_predictor){.size = size, .codes = codes, .previous = previous};
    if (kind == GVC_PREDICTOR_SQUARES) p->squares = gvc_squares_create(size, codes, previous);
    if (kind == GVC_PREDICTOR_SQUARES && !p->squares) {
        gvc_predictor_destroy(predictor);
        return gvc_fail_memory(error);
    }
    return GVC_OK;
}

void gvc_predictor_destroy(gvc_predictor **predictor) {
    if (*predictor) gvc_squares_destroy((*predictor)->squares);
    free(*predictor);
    *predictor = NULL;
}

static int32_t median_gradient(int32_t left, int32_t above, int32_t corner) {
    int32_t least = left < above ? left : above, most = left < above ? above : left;
    if (corner >= most) return least;
    return corner <= least ? most : left + above - corner;
}

static int32_t difference(const gvc_predictor *p, size_t at) {
    return (int32_t)p->codes[at] - p->previous[at];
}

/* In the first row and column the one neighbour there is stands for the others. */
static int32_t expected_difference(const gvc_predictor *p, size_t at, uint32_t x, uint32_t y) {
    if (x == 0 && y == 0) return 0;
    if (y == 0) return difference(p, at - 1);
    if (x == 0) return difference(p, at - p->size);
    return median_gradient(difference(p, at - 1), difference(p, at - p->size),
                           difference(p, at - p->size - 1));
}

void gvc_predict(gvc_predictor *p, uint32_t x, uint32_t y, int32_t expected[3]) {
    if (p->squares) {
        gvc_squares_predict(p->squares, x, y, expected);
        return;
    }
    size_t plane = (size_t)p->size * p->size, at = (size_t)y * p->size + x;
    for (unsigned k = 0; k < 3; k++, at += plane) {
        int32_t code = p->previous[at] + expected_difference(p, at, x, y);
        expected[k] = code < 0 ? 0 : code > UINT16_MAX ? UINT16_MAX : code;
    }
}

void gvc_predict_learn(gvc_predictor *p, uint32_t x, uint32_t y) {
    if (p->squares) gvc_squares_learn(p->squares, x, y);
}
