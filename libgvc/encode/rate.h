/* SPDX-License-Identifier: MIT */
/** @file rate.h  Finds the coarsest quantiser that holds the error asked for. */
#ifndef GVC_ENCODE_RATE_H
#define GVC_ENCODE_RATE_H

#include "encode/group.h"

/** Codes the group at options->crf or, if that is NaN, at the greatest rate factor whose measured
 * RMS error is within the one asked for, and leaves the result in group->coded. The error is
 * measured against the frames of `source`, which are read again. `*crf` is a first guess on entry
 * and what was used on return; `*rms` the measured error over all frames of the group as a fraction
 * of the diagonal; `*held` whether it is within the one asked for. The finest quantiser is used if
 * none holds it. */
gvc_result gvc_rate_code(gvc_group *group, const gvc_source *source,
                         const gvc_encode_options *options, double *crf, double *rms, bool *held,
                         gvc_error *error);

/** The same measure of the exact track, whose error is that of sampling and 16-bit codes alone. */
gvc_result gvc_rate_measure_exact(gvc_group *group, const gvc_source *source,
                                  const gvc_encode_options *options, double *rms, bool *held,
                                  gvc_error *error);

#endif
