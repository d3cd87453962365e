/* SPDX-License-Identifier: MIT */
/** @file rate.c  Search for the quantiser. */
#include "encode/rate.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "chart/rebuild.h"

#include <math.h>
#include <stdlib.h>

#define MEASURED 10           /* frames of a group whose error is measured */
#define MEASURE_SAMPLES 10000 /* surface samples for each, and each direction */
#define CRF_LEAST -12.0
#define CRF_MOST 45.0
#define CRF_STEP 3.0       /* first step away from the guess */
#define CRF_TOLERANCE 0.25 /* about 2 % of the bytes */

bool gvc_rate_measures(size_t index, size_t count) {
    if (count <= MEASURED) return true;
    /* evenly spread, first and last included */
    for (size_t i = 0; i < MEASURED; i++) {
        if (index == i * (count - 1) / (MEASURED - 1)) return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------- measure */

typedef struct measure_context {
    const gvc_group *group;
    double *relative, *diagonal; /* per frame; < 0: not measured */
} measure_context;

static gvc_result measure_one(void *user, size_t index, gvc_error *error) {
    measure_context *context = user;
    const gvc_group *group = context->group;
    const gvc_segment *segment = group->segment;
    const gvc_group_frame *frame = &group->frame[index];
    context->relative[index] = -1;
    if (!frame->original) return GVC_OK;

    gvc_mesh *rebuilt = NULL;
    uint16_t *plane = gvc_alloc((size_t)3 * segment->weld.size * segment->weld.size, sizeof *plane);
    if (!plane) return gvc_fail_memory(error);
    gvc_picture_cut(group->layout, frame->decoded, 0, 0, segment->weld.size, GVC_CODE_SHIFT, plane);
    gvc_result result =
        gvc_rebuild_mesh(&segment->weld, plane, segment->origin, segment->step, &rebuilt, error);
    free(plane);
    if (result == GVC_OK) {
        result = gvc_frame_rms(frame->original, rebuilt, MEASURE_SAMPLES, &context->relative[index],
                               error);
        context->diagonal[index] = gvc_mesh_diagonal(frame->original);
    }
    gvc_mesh_destroy(&rebuilt);
    return result;
}

/* RMS over the measured frames, and as a multiple of what was asked for. */
static gvc_result measure(const gvc_group *group, const gvc_encode_options *options, double *rms,
                          double *load, gvc_error *error) {
    measure_context context = {.group = group};
    context.relative = gvc_alloc(group->count, sizeof *context.relative);
    context.diagonal = gvc_alloc(group->count, sizeof *context.diagonal);
    gvc_result result = context.relative && context.diagonal ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        result = gvc_parallel_for(options->threads, group->count, measure_one, &context, error);
    }
    double sum = 0, load_sum = 0;
    size_t measured = 0;
    for (size_t i = 0; result == GVC_OK && i < group->count; i++) {
        double relative = context.relative[i];
        if (relative < 0) continue;
        double asked = options->max_rms_length > 0 ? options->max_rms_length / context.diagonal[i]
                                                   : options->max_rms;
        sum += relative * relative;
        load_sum += relative * relative / (asked * asked);
        measured++;
    }
    *rms = measured ? sqrt(sum / (double)measured) : 0;
    *load = measured ? sqrt(load_sum / (double)measured) : 0;
    free(context.relative);
    free(context.diagonal);
    return result;
}

/* -------------------------------------------------------------------------------------- search */

typedef struct search {
    gvc_group *group;
    const gvc_encode_options *options;
    double coded_crf; /* of group->coded as it stands */
    double rms, load; /* of it */
} search;

static gvc_result evaluate(search *s, double crf, gvc_error *error) {
    GVC_TRY(gvc_group_code(s->group, s->options, crf, error));
    s->coded_crf = crf;
    return measure(s->group, s->options, &s->rms, &s->load, error);
}

/* Greatest rate factor whose load is at most 1: bracket from the guess with growing steps, then
 * narrow. */
static gvc_result find_crf(search *s, double guess, double *found, gvc_error *error) {
    double holds = NAN, fails = NAN, crf = guess, step = CRF_STEP;
    while (isnan(holds) || isnan(fails)) {
        GVC_TRY(evaluate(s, crf, error));
        if (s->load <= 1) {
            holds = crf;
            if (crf >= CRF_MOST) break;
            crf = fmin(crf + step, CRF_MOST);
        } else {
            fails = crf;
            if (crf <= CRF_LEAST) break;
            crf = fmax(crf - step, CRF_LEAST);
        }
        step *= 1.5;
    }
    while (!isnan(holds) && !isnan(fails) && fails - holds > CRF_TOLERANCE) {
        crf = (holds + fails) / 2;
        GVC_TRY(evaluate(s, crf, error));
        if (s->load <= 1) {
            holds = crf;
        } else {
            fails = crf;
        }
    }
    *found = isnan(holds) ? CRF_LEAST : holds;
    return GVC_OK;
}

gvc_result gvc_rate_code(gvc_group *group, const gvc_encode_options *options, double *crf,
                         double *rms, bool *held, gvc_error *error) {
    search s = {.group = group, .options = options, .coded_crf = NAN};
    double wanted = options->crf;
    if (isnan(wanted)) GVC_TRY(find_crf(&s, *crf, &wanted, error));
    if (s.coded_crf != wanted) GVC_TRY(evaluate(&s, wanted, error));
    *crf = wanted;
    *rms = s.rms;
    *held = s.load <= 1;
    return GVC_OK;
}
