/* SPDX-License-Identifier: MIT */
/** @file picture.c  Cuts a chart out of a picture. */
#include "chart/picture.h"

#include <stddef.h>

void gvc_picture_cut(gvc_picture_layout layout, const uint16_t *luma, uint32_t x, uint32_t y,
                     uint32_t size, unsigned shift, uint16_t *plane) {
    for (uint32_t p = 0; p < 3; p++) {
        for (uint32_t row = 0; row < size; row++) {
            size_t line = (size_t)p * layout.plane_height + y + row;
            const uint16_t *from = luma + line * layout.width + x;
            for (uint32_t i = 0; i < size; i++) *plane++ = (uint16_t)(from[i] << shift);
        }
    }
}
