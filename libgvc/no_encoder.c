/* SPDX-License-Identifier: MIT */
/** @file no_encoder.c  Stands in for the encoder in decoder-only builds. */
#include "base/result.h"

gvc_result gvc_encode(const gvc_source *source, const gvc_sink *sink,
                      const gvc_encode_options *options, gvc_encode_report *report,
                      gvc_error *error) {
    return gvc_encode_resume(source, sink, options, NULL, report, error);
}

gvc_result gvc_encode_resume(const gvc_source *source, const gvc_sink *sink,
                             const gvc_encode_options *options, const gvc_partial *partial,
                             gvc_encode_report *report, gvc_error *error) {
    (void)partial;
    (void)source;
    (void)sink;
    (void)options;
    (void)report;
    return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "this build of libgvc only decodes");
}
