/* SPDX-License-Identifier: MIT */
/** @file from_exr.h  Encoding from OpenEXR files of frames. */
#ifndef GVC_TOOLS_FROM_EXR_H
#define GVC_TOOLS_FROM_EXR_H

#include "frames.h"

/** Encodes the files of a list of frame_list_make_exr; an error names the file. */
gvc_result encode_from_exr(const frame_list *list, const gvc_sink *sink,
                           const gvc_encode_options *options, gvc_encode_report *report,
                           gvc_error *error);

#endif
