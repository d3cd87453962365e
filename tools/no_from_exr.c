/* SPDX-License-Identifier: MIT */
/** @file no_from_exr.c  Stands in for encoding from OpenEXR files in decoder-only builds. */
#include "from_exr.h"

#include "base/result.h"

gvc_result encode_from_exr(const frame_list *list, const gvc_sink *sink,
                           const gvc_encode_options *options, gvc_encode_report *report,
                           gvc_error *error) {
    (void)list, (void)sink, (void)options, (void)report;
    return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "this build of libgvc only decodes");
}
