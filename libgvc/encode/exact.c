/* SPDX-License-Identifier: MIT */
/** @file exact.c  The exact track of a group of frames. */
#include "encode/exact.h"

#include "base/parallel.h"
#include "codec/exr.h"
#include "codec/residual.h"
#include "container/label.h"

#include <math.h>
#include <string.h>

void gvc_exact_quantise(const gvc_segment *segment, const double *image, uint16_t *codes) {
    size_t samples = (size_t)segment->sides.size * segment->sides.size;
    for (size_t i = 0; i < 3 * samples; i++) {
        double code = (image[i] - segment->origin[i / samples]) / segment->step;
        codes[i] = (uint16_t)lrint(fmin(fmax(code, 0), UINT16_MAX));
    }
}

typedef struct code_context {
    gvc_group *group;
    const gvc_encode_options *options;
} code_context;

/* The unit as a label holds it: what may not stand in one is replaced. */
static gvc_result copy_unit(const gvc_encode_options *options, char unit[16], gvc_error *error) {
    gvc_buffer label = {0};
    gvc_write_label(&label, options->unit, sizeof options->unit);
    gvc_cursor cursor = gvc_cursor_make(label.data, label.size);
    bool whole = !label.failed && gvc_read_label(&cursor, unit, 16);
    gvc_buffer_free(&label);
    return whole ? GVC_OK : gvc_fail_memory(error);
}

static gvc_result code_keyframe(const code_context *context, gvc_error *error) {
    gvc_group *group = context->group;
    const gvc_encode_options *options = context->options;
    const gvc_segment *segment = group->segment;
    gvc_exr_facts facts = {.step = segment->step,
                           .time = (double)group->first_frame * options->frame_rate_den /
                                   options->frame_rate_num};
    memcpy(facts.origin, segment->origin, sizeof facts.origin);
    GVC_TRY(copy_unit(options, facts.unit, error));
    return gvc_exr_encode(segment->weld.size, group->frame[0].codes, &facts, &group->frame[0].exact,
                          error);
}

static gvc_result code_one(void *user, size_t index, gvc_error *error) {
    const code_context *context = user;
    gvc_group_frame *frame = &context->group->frame[index];
    gvc_buffer_clear(&frame->exact);
    if (index == 0) return code_keyframe(context, error);
    return gvc_residual_encode(context->group->segment->weld.size, frame->codes, frame[-1].codes,
                               GVC_PREDICTOR_SQUARES, &frame->exact, error);
}

gvc_result gvc_exact_code(gvc_group *group, const gvc_encode_options *options, gvc_error *error) {
    code_context context = {group, options};
    return gvc_parallel_for(options->threads, group->count, code_one, &context, error);
}
