/* SPDX-License-Identifier: MIT */
/** @file rate.c  Search for the quantiser. */
#include "encode/rate.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "chart/rebuild.h"
#include "encode/scan.h"

#include <math.h>
#include <stdlib.h>

#define PROBES 12             /* frames of a group whose error is measured in the search */
#define MEASURE_SAMPLES 10000 /* surface samples for each, and each direction */
#define CRF_LEAST -12.0
#define CRF_MOST 45.0
#define CRF_STEP 3.0      /* first step away from the guess */
#define CRF_TOLERANCE 0.1 /* about 1 % of the bytes */
#define LOAD_TOLERANCE 0.01
#define CONFIRMATIONS 4
#define SETTLED_EXCESS 0.05 /* over the finest quantiser's error, where none holds */

/* ------------------------------------------------------------------------------------- measure */

typedef struct measure_context {
    const gvc_group *group;
    const gvc_source *source;
    gvc_code_source from;
    bool weld;
    size_t probes;               /* number of frames measured */
    double *relative, *diagonal; /* per probe */
} measure_context;

/* Frames spread by the golden ratio. Evenly spread ones would fall into step with the pattern of
 * picture types and see only the better or only the worse pictures. */
static size_t probe_frame(const measure_context *context, size_t probe) {
    size_t count = context->group->count;
    if (context->probes == count) return probe;
    double place = ((double)probe + 0.5) * 0.6180339887498949;
    return (size_t)((place - floor(place)) * (double)count);
}

static gvc_result rebuild(const measure_context *context, size_t index, gvc_mesh **rebuilt,
                          gvc_error *error) {
    const gvc_segment *segment = context->group->segment;
    uint32_t size = segment->weld.size;
    uint16_t *plane = gvc_alloc((size_t)3 * size * size, sizeof *plane);
    if (!plane) return gvc_fail_memory(error);
    gvc_group_plane(context->group, index, context->from, plane);
    gvc_result result =
        gvc_rebuild_mesh(&segment->weld, plane, segment->origin, segment->step, rebuilt, error);
    free(plane);
    return result;
}

static gvc_result measure_one(void *user, size_t probe, gvc_error *error) {
    measure_context *context = user;
    size_t index = probe_frame(context, probe);
    uint64_t number = context->group->first_frame + index;
    gvc_mesh *original = NULL, *rebuilt = NULL;
    gvc_result result =
        gvc_load_frame(context->source, number, context->weld, &original, NULL, error);
    if (result == GVC_OK) result = rebuild(context, index, &rebuilt, error);
    if (result == GVC_OK) {
        context->diagonal[probe] = gvc_mesh_diagonal(original);
        result =
            gvc_frame_rms(original, rebuilt, MEASURE_SAMPLES, &context->relative[probe], error);
    }
    gvc_mesh_destroy(&original);
    gvc_mesh_destroy(&rebuilt);
    return result;
}

typedef struct search {
    gvc_group *group;
    const gvc_source *source;
    const gvc_encode_options *options;
    gvc_code_source from; /* what is measured */
    double coded_crf;     /* of group->coded as it stands */
    double rms,
        load; /* of it, on the frames measured last: load is the RMS of error / error asked for */
    double limit; /* load at which a quantiser holds in the search */
} search;

/* RMS over `probes` frames, and as a multiple of what was asked for. */
static gvc_result measure(search *s, size_t probes, gvc_error *error) {
    measure_context context = {.group = s->group,
                               .source = s->source,
                               .from = s->from,
                               .weld = s->options->weld,
                               .probes = probes};
    context.relative = gvc_alloc(probes, sizeof *context.relative);
    context.diagonal = gvc_alloc(probes, sizeof *context.diagonal);
    gvc_result result = context.relative && context.diagonal ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) {
        result = gvc_parallel_for(s->options->threads, probes, measure_one, &context, error);
    }
    double sum = 0, load_sum = 0;
    for (size_t i = 0; result == GVC_OK && i < probes; i++) {
        double asked = gvc_rms_asked(s->options, context.diagonal[i]);
        double relative = context.relative[i];
        sum += relative * relative;
        load_sum += relative * relative / (asked * asked);
    }
    s->rms = sqrt(sum / (double)probes);
    s->load = sqrt(load_sum / (double)probes);
    free(context.relative);
    free(context.diagonal);
    return result;
}

/* -------------------------------------------------------------------------------------- search */

static size_t probe_count(const search *s) {
    return s->group->count < PROBES ? s->group->count : PROBES;
}

static gvc_result evaluate(search *s, double crf, gvc_error *error) {
    GVC_TRY(gvc_group_code(s->group, s->options, crf, error));
    s->coded_crf = crf;
    return measure(s, probe_count(s), error);
}

/* A quantiser and what it gives; crf is NaN while there is none. */
typedef struct trial {
    double crf, load;
} trial;

/* Where the load should meet the limit: its logarithm is nearly linear in crf. Kept off the ends,
 * so that the interval shrinks in any case. */
static double between(trial holds, trial fails, double limit) {
    double aim = limit * (1 - LOAD_TOLERANCE / 2);
    double share = log(aim / holds.load) / log(fails.load / holds.load);
    if (!(share > 0.1)) share = 0.1;
    if (!(share < 0.9)) share = 0.9;
    return holds.crf + share * (fails.crf - holds.crf);
}

/* Greatest rate factor that holds: bracket from the guess with growing steps, then narrow. */
static gvc_result find_crf(search *s, double guess, double step, double *found, gvc_error *error) {
    trial holds = {NAN, 0}, fails = {NAN, 0};
    double crf = guess;
    for (;;) {
        GVC_TRY(evaluate(s, crf, error));
        trial now = {crf, s->load};
        if (s->load <= s->limit) {
            holds = now;
            if (crf >= CRF_MOST || s->load >= s->limit * (1 - LOAD_TOLERANCE)) break;
        } else {
            fails = now;
            if (crf <= CRF_LEAST) break;
        }
        if (isnan(holds.crf)) {
            crf = fmax(crf - step, CRF_LEAST);
        } else if (isnan(fails.crf)) {
            crf = fmin(crf + step, CRF_MOST);
        } else if (fails.crf - holds.crf > CRF_TOLERANCE) {
            crf = between(holds, fails, s->limit);
        } else {
            break;
        }
        step *= 1.5;
    }
    *found = isnan(holds.crf) ? CRF_LEAST : holds.crf;
    return s->coded_crf == *found ? GVC_OK : evaluate(s, *found, error);
}

/* The search looks at some frames only; here all are measured, and the search is set right by what
 * it was off. */
static gvc_result find_and_confirm(search *s, double *crf, gvc_error *error) {
    double step = CRF_STEP, before = NAN;
    for (int i = 0; i < CONFIRMATIONS; i++) {
        GVC_TRY(find_crf(s, *crf, step, crf, error));
        if (probe_count(s) == s->group->count) return GVC_OK;
        double seen = s->load;
        GVC_TRY(measure(s, s->group->count, error));
        bool holds = s->load <= 1;
        bool at_end = *crf <= CRF_LEAST || *crf >= CRF_MOST;
        if (holds && (at_end || s->load > 1 - 2 * LOAD_TOLERANCE)) return GVC_OK;
        if ((at_end && !holds) || (holds && *crf == before)) return GVC_OK;
        before = *crf;
        s->limit = seen / s->load;
        step = 0.5;
    }
    /* not settled: a little finer than the last is safe enough, and measured as it is */
    for (int i = 0; s->load > 1 && *crf > CRF_LEAST && i < CONFIRMATIONS; i++) {
        *crf = fmax(*crf - CRF_TOLERANCE * (1 << i), CRF_LEAST);
        GVC_TRY(evaluate(s, *crf, error));
        GVC_TRY(measure(s, s->group->count, error));
    }
    return GVC_OK;
}

/* The error asked for is out of reach, because sampling alone exceeds it: the finest quantiser
 * would spend a multiple of the bytes on next to nothing. */
static gvc_result settle_for_less(search *s, double *crf, gvc_error *error) {
    if (s->coded_crf != CRF_LEAST) GVC_TRY(evaluate(s, CRF_LEAST, error));
    GVC_TRY(measure(s, probe_count(s), error));
    s->limit = s->load * (1 + SETTLED_EXCESS);
    GVC_TRY(find_crf(s, 0, CRF_STEP, crf, error));
    return measure(s, s->group->count, error);
}

gvc_result gvc_rate_code(gvc_group *group, const gvc_source *source,
                         const gvc_encode_options *options, double *crf, double *rms, bool *held,
                         gvc_error *error) {
    search s = {.group = group, .source = source, .options = options, .coded_crf = NAN, .limit = 1};
    if (isnan(options->crf)) {
        GVC_TRY(find_and_confirm(&s, crf, error));
        if (s.load > 1) GVC_TRY(settle_for_less(&s, crf, error));
    } else {
        *crf = options->crf;
        GVC_TRY(gvc_group_code(group, options, *crf, error));
        GVC_TRY(measure(&s, group->count, error));
    }
    *rms = s.rms;
    *held = s.load <= 1;
    return GVC_OK;
}

gvc_result gvc_rate_measure_exact(gvc_group *group, const gvc_source *source,
                                  const gvc_encode_options *options, double *rms, bool *held,
                                  gvc_error *error) {
    search s = {.group = group, .source = source, .options = options, .from = GVC_CODES_EXACT};
    GVC_TRY(measure(&s, group->count, error));
    *rms = s.rms;
    *held = s.load <= 1;
    return GVC_OK;
}
