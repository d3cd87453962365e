/* SPDX-License-Identifier: MIT */
/**
 * @file resume.h
 * Going on with an encode that ended early (docs/adr/0018). The encoder keeps a journal: a first
 * line that says what is encoded and how, and a line for each group that it has written, with what
 * the next group's coding depends on and the file does not tell. To resume, the frames of finished
 * groups are analysed again, so that the tracker and the segment are as they were; their coding is
 * skipped, and their fragments are copied. A checkpoint spares the analysis of what was before it.
 */
#ifndef GVC_RESUME_H
#define GVC_RESUME_H

#include "container/writer.h"
#include "encode/group.h"
#include "file.h"

/** What is known of a finished group. */
typedef struct gvc_finished_group {
    uint64_t first_frame, frame_count, end; /**< end: offset behind its fragment */
    double crf, rms, preview_rms;
} gvc_finished_group;

/** Zero-initialise; free with gvc_resume_free. */
typedef struct gvc_resume {
    const gvc_reader *file; /**< the partial file, borrowed; NULL: nothing to resume */
    gvc_finished_group *group;
    size_t count, next;
    uint64_t end_frame; /**< frames before it are finished */
} gvc_resume;

/** Writes the first line of a journal for this source and these options, and with `partial` finds
 * out what of it can be used: groups that are in its journal and, whole, in its file.
 * GVC_ERROR_ARGUMENT, before anything is written, if it is of other options or another source. */
gvc_result gvc_resume_begin(gvc_resume *resume, const gvc_partial *partial,
                            const gvc_source *source, const gvc_scan_frame *facts,
                            const gvc_encode_options *options, gvc_error *error);
void gvc_resume_free(gvc_resume *resume);

/** Whether the group that begins with this frame is finished. */
static inline bool gvc_resume_holds(const gvc_resume *resume, uint64_t first_frame) {
    return first_frame < resume->end_frame;
}

/** Takes the next finished group over into `writer`, which is made if it is NULL. The group's
 * frames must have been analysed, and `config` is what the head must say; GVC_ERROR_ARGUMENT if
 * they are not what the file holds. */
gvc_result gvc_resume_take(gvc_resume *resume, const gvc_group *group, const gvc_config *config,
                           const gvc_sink *sink, gvc_writer **writer, gvc_finished_group *finished,
                           gvc_error *error);

/** Takes the groups before a frame over as they are; gvc_resume_can_skip must be true of it. */
gvc_result gvc_resume_skip(gvc_resume *resume, uint64_t frame, const gvc_config *config,
                           const gvc_encode_options *options, const gvc_sink *sink,
                           gvc_writer **writer, gvc_error *error);
/** Whether that can be done. */
bool gvc_resume_can_skip(const gvc_resume *resume, uint64_t frame);

/** Parameter sets of groups coded now must be those of the file. */
gvc_result gvc_resume_check_coded(const gvc_resume *resume, const gvc_coded_group *coded,
                                  gvc_error *error);

/** Writes the line of a group that has been written or taken over. */
gvc_result gvc_resume_note(const gvc_encode_options *options, const gvc_finished_group *group,
                           gvc_error *error);

#endif
