/* SPDX-License-Identifier: MIT */
/** @file options.c  Defaults of the public option structs. */
#include "chart/side_table.h"
#include "mesh/refine.h"

#include <math.h>

void gvc_encode_options_init(gvc_encode_options *options) {
    *options = (gvc_encode_options){.struct_size = sizeof *options,
                                    .max_rms = 1e-3,
                                    .crf = NAN,
                                    .gop = 60,
                                    .frame_rate_num = 30,
                                    .frame_rate_den = 1,
                                    .weld = true,
                                    .persistence = 0.2,
                                    .curvature_weight = 0.25,
                                    .prior_weight = 1,
                                    .shortest_weight = 0.05,
                                    .lambda = 0.95,
                                    .interior_share = 0.8,
                                    .registration = true,
                                    .longest_edge = GVC_LONGEST_EDGE};
}

void gvc_read_options_init(gvc_read_options *options) {
    *options = (gvc_read_options){.struct_size = sizeof *options,
                                  .max_memory = UINT64_C(1) << 30,
                                  .max_image_size = GVC_MAX_IMAGE_SIZE,
                                  .max_frames = 10000000};
}
