/* SPDX-License-Identifier: MIT */
/** @file picture.h  A chart's place in the pictures of the geometry track. */
#ifndef GVC_CHART_PICTURE_H
#define GVC_CHART_PICTURE_H

#include <stdint.h>

/** Shape of a picture: three planes, x above y above z, each plane_height rows of width samples. */
typedef struct gvc_picture_layout {
    uint32_t width, plane_height;
} gvc_picture_layout;

/** Copies the size * size samples at (x, y) of each plane, shifted left by `shift`, to `plane`
 * (three planes of 16-bit codes). The rectangle must lie inside the planes. */
void gvc_picture_cut(gvc_picture_layout layout, const uint16_t *luma, uint32_t x, uint32_t y,
                     uint32_t size, unsigned shift, uint16_t *plane);

#endif
