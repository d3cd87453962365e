/* SPDX-License-Identifier: MIT */
/** @file compare_no_lossless.c  Stands in for the lossless comparison in decoder-only builds. */
#include "base/result.h"
#include "compare_lossless.h"

gvc_result compare_lossless(const gvc_source *source, const gvc_encode_options *encode,
                            const compare_options *options, compare_row *row, gvc_error *error) {
    (void)source, (void)encode, (void)options, (void)row;
    return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "this build of libgvc only decodes");
}
