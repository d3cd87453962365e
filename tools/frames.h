/* SPDX-License-Identifier: MIT */
/** @file frames.h  FRAMES on the command line: files, a printf pattern, or a folder. */
#ifndef GVC_TOOLS_FRAMES_H
#define GVC_TOOLS_FRAMES_H

#include "gvc/gvc.h"

typedef struct frame_list {
    char **path;
    size_t count, capacity;
    gvc_mesh *standard_input; /**< the frame "-", read once */
    bool exr;                 /**< frames are OpenEXR files, not meshes */
} frame_list;

/** Lists the frames that `count` arguments name. A folder and a pattern ("scan/%04d.obj") stand for
 * one numbered series in order of number; gaps, two series in one folder, or files given out of
 * order are errors unless `any_order`. */
gvc_result frame_list_make(char *const *argument, int count, bool any_order, frame_list *list,
                           gvc_error *error);
/** The same for OpenEXR files of frames. */
gvc_result frame_list_make_exr(char *const *argument, int count, bool any_order, frame_list *list,
                               gvc_error *error);
void frame_list_free(frame_list *list);
/** A source of the frames; borrows the list. */
gvc_source frame_list_source(frame_list *list);

/** Fills a pattern with one %d conversion ("out/%04d.obj"); false if it has none, more than one, or
 * any other. The result is allocated. */
bool pattern_fill(const char *pattern, uint64_t number, char **path);

#endif
