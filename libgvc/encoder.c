/* SPDX-License-Identifier: MIT */
/**
 * @file encoder.c
 * From meshes to a file. Frames are taken in batches: features of each frame by itself in parallel;
 * the cut graph from frame to frame in order; the geometry images in parallel again. A group of
 * frames is coded, measured and written as soon as it is full or its segment ends, so memory is
 * bounded by one batch and the pictures of one group.
 */
#include "base/memory.h"
#include "base/parallel.h"
#include "chart/sample.h"
#include "checkpoint.h"
#include "encode/batch.h"
#include "encode/cut.h"
#include "encode/exact.h"
#include "encode/group.h"
#include "encode/rate.h"
#include "encode/tap.h"
#include "resume.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 16 /* pictures are padded to whole macroblocks, so that no block spans two planes */
#define FIRST_CRF 8.0
#define SIZE_FRAMES 3
/* A new layout must lower the sampling error at least to this share to begin a segment. */
#define WORTH_A_LAYOUT 0.9
#define SIZE_SAMPLES 10000
/* Of the squared error asked for, what sampling may take where a preview is to hold it, too. */
#define PREVIEW_SHARE 0.7

typedef struct encoder {
    const gvc_source *source;
    const gvc_sink *sink;
    const gvc_image_tap *tap; /* NULL: nobody looks on */
    gvc_encode_options options;
    gvc_scan_frame *facts;
    gvc_encode_report report;

    gvc_batch batch;
    gvc_tracker *tracker;
    gvc_segment segment;
    double *followed; /* point samples of the last frame of the layout; NULL: there is none yet */
    uint32_t size;    /* of all images; 0 until chosen */
    gvc_group group;
    gvc_writer *writer;         /* NULL until the first group is coded */
    double crf;                 /* of the last group: guess for the next */
    const gvc_partial *partial; /* what to go on from; NULL: from the beginning */
    gvc_resume resume;
} encoder;

static gvc_result check_options(const gvc_encode_options *o, const gvc_source *source,
                                gvc_error *error) {
    const char *wrong = NULL;
    if (o->struct_size != sizeof *o) wrong = "encode options of another library version";
    if (source->frame_count == 0) wrong = "there are no frames to encode";
    if (o->image_size != 0 &&
        (o->image_size < GVC_MIN_IMAGE_SIZE || o->image_size > GVC_MAX_IMAGE_SIZE)) {
        wrong = "the image size must be from 16 to 2049";
    }
    if (!(o->max_rms > 0 && o->max_rms < 1) && !(o->max_rms_length > 0)) {
        wrong = "the RMS error must be greater than 0 and less than the diagonal";
    }
    if (!isnan(o->crf) && !(o->crf >= -12 && o->crf <= 51)) wrong = "crf must be from -12 to 51";
    if (o->gop == 0 || o->gop > 10000) wrong = "a group must have 1 to 10000 frames";
    if (o->frame_rate_num == 0 || o->frame_rate_den == 0) wrong = "the frame rate must be positive";
    if (!(o->persistence > 0 && o->persistence < 1)) wrong = "persistence must be between 0 and 1";
    if (o->with_preview && !o->lossless) wrong = "only a lossless file has a preview";
    if (!(o->prior_weight >= 0)) wrong = "the prior's weight must not be negative";
    if (!(o->shortest_weight >= 0)) wrong = "the shortest path's weight must not be negative";
    if (!(o->lambda >= 0 && o->lambda <= 1)) wrong = "lambda must be between 0 and 1";
    if (!(o->interior_share >= 0 && o->interior_share <= 1))
        wrong = "the interior's share must be between 0 and 1";
    if (!(o->longest_edge > 0)) wrong = "the longest edge must be positive";
    return wrong ? gvc_fail(error, GVC_ERROR_ARGUMENT, "%s", wrong) : GVC_OK;
}

static void warn(const encoder *e, int64_t frame, const char *message) {
    if (e->options.warn) e->options.warn(e->options.user, frame, message);
}

static gvc_result report_progress(const encoder *e, uint64_t done, gvc_error *error) {
    if (e->options.progress &&
        !e->options.progress(e->options.user, GVC_STAGE_ENCODE, done, e->source->frame_count)) {
        return gvc_fail(error, GVC_ERROR_CANCELLED, "cancelled");
    }
    return GVC_OK;
}

/* -------------------------------------------------------------------------------------- output */

static bool has_video(const gvc_encode_options *options) {
    return !options->lossless || options->with_preview;
}

static void describe(const encoder *e, gvc_config *config) {
    const gvc_encode_options *o = &e->options;
    *config = (gvc_config){.version_major = GVC_FORMAT_MAJOR,
                           .version_minor = GVC_FORMAT_MINOR,
                           .features = o->lossless ? GVC_FEATURE_EXACT : 0,
                           .picture_width = e->group.layout.width,
                           .plane_height = e->group.layout.plane_height,
                           .image_size = e->size,
                           .code_bits = GVC_LUMA_BITS,
                           .code_shift = GVC_CODE_SHIFT,
                           .frame_rate_num = o->frame_rate_num,
                           .frame_rate_den = o->frame_rate_den,
                           .declared_frames = e->source->frame_count};
    memcpy(config->unit, o->unit, sizeof config->unit);
    config->unit[sizeof config->unit - 1] = '\0';
    snprintf(config->encoder, sizeof config->encoder, "libgvc %s", gvc_version());
    const char *mode = o->with_preview ? "lossless with preview, "
                       : o->lossless   ? "lossless, "
                                       : "";
    if (isnan(o->crf) || !has_video(o)) {
        snprintf(config->settings, sizeof config->settings,
                 "%ssize %u, max-rms %.6g%s, gop %u, persistence %.3g", mode, e->size,
                 o->max_rms_length > 0 ? o->max_rms_length : o->max_rms,
                 o->max_rms_length > 0 ? " (length)" : "", o->gop, o->persistence);
    } else {
        snprintf(config->settings, sizeof config->settings,
                 "%ssize %u, crf %.4g, gop %u, persistence %.3g", mode, e->size, o->crf, o->gop,
                 o->persistence);
    }
}

/* What to do with a group whose error exceeds the one asked for. */
static gvc_result miss_error(const encoder *e, const char *what, double rms, gvc_error *error) {
    char message[160];
    const gvc_group *group = &e->group;
    snprintf(message, sizeof message,
             "%s from %llu on reach an RMS error of %.3g of the diagonal at best, at %u "
             "samples a side",
             what, (unsigned long long)group->first_frame, rms, e->size);
    if (!e->options.best_effort) {
        gvc_result result = gvc_fail(error, GVC_ERROR_QUALITY, "%s", message);
        return gvc_at_frame(error, result, (int64_t)group->first_frame);
    }
    warn(e, (int64_t)group->first_frame, message);
    return GVC_OK;
}

/* Codes the group and measures what comes out. */
static gvc_result code_images(encoder *e, gvc_finished_group *done, gvc_error *error) {
    gvc_group *group = &e->group;
    bool held = true, exact_held = true;
    if (group->exact) {
        GVC_TRY(gvc_exact_code(group, &e->options, error));
        GVC_TRY(
            gvc_rate_measure_exact(group, e->source, &e->options, &done->rms, &exact_held, error));
        if (!exact_held) GVC_TRY(miss_error(e, "frames", done->rms, error));
    }
    if (!group->video) return GVC_OK;
    double *rms = group->exact ? &done->preview_rms : &done->rms;
    GVC_TRY(gvc_rate_code(group, e->source, &e->options, &e->crf, rms, &held, error));
    if (!isnan(e->options.crf) || held || !exact_held) return GVC_OK;
    return miss_error(e, group->exact ? "previews" : "frames", *rms, error);
}

/* Codes, measures and writes the group; begins the file with the first one. */
static gvc_result code_group(encoder *e, gvc_finished_group *done, gvc_error *error) {
    gvc_group *group = &e->group;
    GVC_TRY(code_images(e, done, error));
    GVC_TRY(gvc_resume_check_coded(&e->resume, &group->coded, error));
    if (!e->writer) {
        gvc_config config;
        describe(e, &config);
        GVC_TRY(gvc_writer_create(e->sink, &config, group->coded.config, group->coded.config_size,
                                  &e->writer, error));
    }
    return gvc_group_write(group, e->source, e->writer, error);
}

/* Takes over a group that an earlier run has finished. */
static gvc_result take_group(encoder *e, gvc_finished_group *done, gvc_error *error) {
    gvc_config config;
    describe(e, &config);
    GVC_TRY(gvc_resume_take(&e->resume, &e->group, &config, e->sink, &e->writer, done, error));
    e->crf = done->crf;
    return GVC_OK;
}

static gvc_result flush_group(encoder *e, gvc_error *error) {
    gvc_group *group = &e->group;
    if (group->count == 0) return GVC_OK;
    gvc_finished_group done = {.first_frame = group->first_frame, .frame_count = group->count};
    bool finished = gvc_resume_holds(&e->resume, group->first_frame);
    GVC_TRY(finished ? take_group(e, &done, error) : code_group(e, &done, error));
    done.end = gvc_writer_byte_count(e->writer);
    done.crf = e->crf;
    GVC_TRY(gvc_resume_note(&e->options, &done, error));
    e->report.worst_rms = fmax(e->report.worst_rms, done.rms);
    e->report.preview_rms = fmax(e->report.preview_rms, done.preview_rms);
    if (group->video) e->report.mean_crf += e->crf * (double)group->count;
    e->report.gop_count++;
    e->report.frame_count += group->count;
    gvc_group_clear(group);
    return report_progress(e, done.first_frame + done.frame_count, error);
}

/* ------------------------------------------------------------------------------------ segments */

typedef struct size_context {
    const encoder *e;
    const gvc_frame_work *frame[SIZE_FRAMES];
    uint32_t size;
    double square[SIZE_FRAMES]; /* of sampling error / error asked for */
} size_context;

static gvc_result try_size(void *user, size_t index, gvc_error *error) {
    size_context *context = user;
    const gvc_frame_work *work = context->frame[index];
    double rms;
    GVC_TRY(gvc_segment_sampling_rms(&context->e->segment, work, context->size, SIZE_SAMPLES, &rms,
                                     error));
    double share = rms / gvc_rms_asked(&context->e->options, work->diagonal);
    context->square[index] = share * share;
    return GVC_OK;
}

/* What an image size will cost, as a logarithm: bytes grow with the number of samples a side, and
 * with what the quantiser has to make good for the sampling error. Exponents fitted to trial
 * encodes (docs/adr/0007). */
static gvc_result predict_cost(size_context *context, size_t frames, double *cost,
                               gvc_error *error) {
    double square = 0;
    gvc_result result =
        gvc_parallel_for(context->e->options.threads, frames, try_size, context, error);
    for (size_t i = 0; i < frames; i++) square += context->square[i] / (double)frames;
    const gvc_encode_options *options = &context->e->options;
    if (options->lossless) {
        /* bytes grow with the samples, and nothing else has to be made good for */
        *cost = square <= 1 ? 2 * log(context->size) : INFINITY;
        if (has_video(options) && isnan(options->crf) && square > PREVIEW_SHARE) *cost = INFINITY;
    } else {
        *cost = square < 1 ? 0.8 * log(context->size) - 0.7 * log(1 - square) : INFINITY;
    }
    return result;
}

/* The cheapest image size for the error asked for, judged by frames of the first batch whose cut is
 * known. Sizes are whole macroblocks: a larger image up to the next multiple costs nothing. */
static gvc_result choose_size(encoder *e, size_t first, size_t end, gvc_error *error) {
    static const uint32_t candidate[] = {48,  64,  80,  96,  112, 128, 144, 160,
                                         192, 224, 256, 320, 384, 448, 512, 640};
    size_context context = {.e = e};
    size_t frames = end - first < SIZE_FRAMES ? end - first : SIZE_FRAMES;
    for (size_t i = 0; i < frames; i++) {
        context.frame[i] =
            &e->batch.work[first + (end - 1 - first) * i / (frames > 1 ? frames - 1 : 1)];
    }
    double best = INFINITY;
    for (size_t i = 0; i < sizeof candidate / sizeof *candidate; i++) {
        double cost;
        context.size = candidate[i];
        GVC_TRY(predict_cost(&context, frames, &cost, error));
        if (cost > best) break; /* one minimum: sampling errors fall steeply first */
        if (cost < best || isinf(best)) e->size = candidate[i];
        best = cost;
    }
    return GVC_OK;
}

static gvc_cutter cutter_of(const encoder *e) {
    return (gvc_cutter){.source = e->source,
                        .options = &e->options,
                        .facts = e->facts,
                        .tracker = e->tracker,
                        .size = e->size ? e->size : e->options.image_size};
}

static gvc_result begin_group(encoder *e, gvc_error *error) {
    uint32_t padded = (e->size + BLOCK - 1) / BLOCK * BLOCK;
    gvc_picture_layout layout = {padded, padded};
    GVC_TRY(gvc_group_create(e->options.gop, layout, &e->group, error));
    e->group.video = has_video(&e->options);
    e->group.exact = e->options.lossless;
    return GVC_OK;
}

/* Settles the image size with the first frames cut, and with it what depends on it. */
static gvc_result settle_size(encoder *e, size_t first, size_t end, gvc_error *error) {
    e->size = e->options.image_size;
    if (e->size == 0) GVC_TRY(choose_size(e, first, end, error));
    GVC_TRY(begin_group(e, error));
    return gvc_segment_resize(&e->segment, &e->batch.work[first], e->size, error);
}

/* Another layout shows the surface elsewhere. */
static void follow_no_more(encoder *e) {
    free(e->followed);
    e->followed = NULL;
}

/* A group begins with a keyframe anyway, so a better layout costs nothing there: lengths have
 * changed since the segment began, and what was a good place for the corners need not be one still.
 * The cut graph goes on as it is. */
static gvc_result refresh_layout(encoder *e, const gvc_frame_work *work, gvc_error *error) {
    double now, fresh;
    gvc_segment next = e->segment;
    next.run = NULL;
    next.sides = (gvc_side_table){0};
    next.weld = (gvc_weld){0};
    GVC_TRY(gvc_segment_sampling_rms(&e->segment, work, e->size, SIZE_SAMPLES, &now, error));
    gvc_error trouble;
    gvc_error_init(&trouble);
    gvc_result result = gvc_segment_layout(&next, work, e->size, e->options.threads, &trouble);
    if (result == GVC_OK) {
        result = gvc_segment_sampling_rms(&next, work, e->size, SIZE_SAMPLES, &fresh, &trouble);
    }
    if (result == GVC_ERROR_MESH) result = GVC_OK, fresh = INFINITY; /* none is to be had */
    if (result == GVC_OK && fresh < WORTH_A_LAYOUT * now) {
        gvc_segment old = e->segment;
        next.number = e->report.segment_count++;
        e->segment = next;
        next = old;
        follow_no_more(e);
    }
    gvc_segment_free(&next);
    return gvc_hand_on(error, result, &trouble);
}

/* -------------------------------------------------------------------------------------- batches */

typedef struct image_context {
    encoder *e;
    const gvc_frame_work *work; /* the first of them */
    size_t count;
    gvc_chart chart[GVC_BATCH];
    double *image[GVC_BATCH];
    bool unfit[GVC_BATCH];      /* no chart without folds was found */
    gvc_error error[GVC_BATCH]; /* why */
} image_context;

static void free_images(image_context *c) {
    for (size_t i = 0; i < c->count; i++) {
        gvc_chart_free(&c->chart[i]);
        free(c->image[i]);
    }
}

static gvc_result chart_one(void *user, size_t index, gvc_error *error) {
    image_context *c = user;
    const gvc_segment *segment = &c->e->segment;
    gvc_result result = gvc_chart_make(&c->work[index], &segment->sides, &segment->image_options,
                                       &c->chart[index], &c->error[index]);
    c->unfit[index] = result == GVC_ERROR_MESH;
    return c->unfit[index] ? GVC_OK : gvc_hand_on(error, result, &c->error[index]);
}

/* Point samples, in the order of the frames: each chart follows the one before. */
static gvc_result sample_charts(image_context *c, size_t count, gvc_error *error) {
    encoder *e = c->e;
    const gvc_segment *segment = &e->segment;
    size_t samples = (size_t)3 * e->size * e->size;
    for (size_t i = 0; i < count; i++) {
        c->image[i] = gvc_alloc(samples, sizeof *c->image[i]);
        if (!c->image[i]) return gvc_fail_memory(error);
        if (e->followed) {
            GVC_TRY(gvc_chart_follow(&c->work[i], e->size, e->followed, &segment->image_options,
                                     &c->chart[i], error));
        } else {
            e->followed = gvc_alloc(samples, sizeof *e->followed);
            if (!e->followed) return gvc_fail_memory(error);
        }
        gvc_result result = gvc_sample_points(&c->chart[i].disk, c->chart[i].uv, &segment->weld,
                                              c->image[i], error);
        GVC_TRY(gvc_at_frame(error, result, (int64_t)c->work[i].number));
        memcpy(e->followed, c->image[i], samples * sizeof *e->followed);
    }
    return GVC_OK;
}

/* What the group will code of a frame. */
static gvc_result quantise(const gvc_group *group, const gvc_segment *segment, const double *image,
                           gvc_group_frame *frame, gvc_error *error) {
    size_t picture = (size_t)3 * group->layout.width * group->layout.plane_height;
    size_t samples = (size_t)3 * segment->sides.size * segment->sides.size;
    if (group->video) {
        frame->luma = gvc_alloc(picture, sizeof *frame->luma);
        if (!frame->luma) return gvc_fail_memory(error);
        gvc_segment_quantise(segment, image, group->layout, frame->luma);
    }
    if (group->exact) {
        frame->codes = gvc_alloc(samples, sizeof *frame->codes);
        if (!frame->codes) return gvc_fail_memory(error);
        gvc_exact_quantise(segment, image, frame->codes);
    }
    return GVC_OK;
}

static gvc_result fit_one(void *user, size_t index, gvc_error *error) {
    image_context *c = user;
    encoder *e = c->e;
    const gvc_segment *segment = &e->segment;
    GVC_TRY(gvc_chart_fit(&c->work[index], &c->chart[index], &segment->weld,
                          &segment->image_options, c->image[index], error));
    if (e->tap) {
        GVC_TRY(
            e->tap->image(e->tap->user, c->work[index].number, c->image[index], e->size, error));
    }
    return quantise(&e->group, segment, c->image[index], &e->group.frame[e->group.count + index],
                    error);
}

static void drop_images(gvc_group *group, size_t from, size_t end) {
    for (size_t i = from; i < end; i++) {
        free(group->frame[i].luma);
        free(group->frame[i].codes);
        group->frame[i] = (gvc_group_frame){0};
    }
}

/* Turns frames first ... *end - 1 of the batch, which have their cut, into pictures of the group.
 * Stops before the first that has no chart without folds, and sets *end to it. */
static gvc_result add_images(encoder *e, size_t first, size_t *end, gvc_error *error) {
    gvc_group *group = &e->group;
    size_t count = *end - first, good = 0;
    image_context context = {.e = e, .work = &e->batch.work[first], .count = count};
    if (group->count == 0) {
        group->segment = &e->segment;
        group->first_frame = e->batch.work[first].number;
        GVC_TRY(gvc_segment_shape(&e->segment, &e->batch.work[first].graph, &group->shape, error));
    }
    gvc_result result = gvc_parallel_for(e->options.threads, count, chart_one, &context, error);
    while (result == GVC_OK && good < count && !context.unfit[good]) good++;
    if (result == GVC_OK) result = sample_charts(&context, good, error);
    if (result == GVC_OK && !gvc_resume_holds(&e->resume, group->first_frame)) {
        result = gvc_parallel_for(e->options.threads, good, fit_one, &context, error);
    }
    free_images(&context);
    if (result != GVC_OK) {
        drop_images(group, group->count, group->count + good);
        return result;
    }
    if (good == 0 && e->segment.first_frame == e->batch.work[first].number) {
        /* a new segment is all that could help, and this is one */
        return gvc_hand_on(error, GVC_ERROR_MESH, &context.error[0]);
    }
    group->count += good;
    for (size_t i = first; i < first + good; i++) gvc_frame_free(&e->batch.work[i]);
    *end = first + good;
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------- checkpoints */

static gvc_checkpoint checkpoint_of(encoder *e, uint64_t *next_frame) {
    return (gvc_checkpoint){.next_frame = next_frame,
                            .size = &e->size,
                            .crf = &e->crf,
                            .followed = &e->followed,
                            .report = &e->report,
                            .segment = &e->segment,
                            .tracker = e->tracker};
}

static gvc_result save_checkpoint(encoder *e, uint64_t next_frame, gvc_error *error) {
    const gvc_checkpoint checkpoint = checkpoint_of(e, &next_frame);
    return gvc_checkpoint_save(&checkpoint, &e->options, error);
}

/* Begins behind the last checkpoint of an encode that ended early, if there is one whose groups are
 * all there. `*first` is the frame to go on with. */
static gvc_result load_checkpoint(encoder *e, uint64_t *first, gvc_error *error) {
    const gvc_partial *partial = e->partial;
    const gvc_checkpoint checkpoint = checkpoint_of(e, first);
    uint64_t frame;
    bool loaded;
    if (!partial || !partial->checkpoint ||
        !gvc_checkpoint_frame(partial->checkpoint, partial->checkpoint_size, &frame) ||
        !gvc_resume_can_skip(&e->resume, frame)) {
        return GVC_OK;
    }
    GVC_TRY(gvc_checkpoint_load(&checkpoint, partial->checkpoint, partial->checkpoint_size, &loaded,
                                error));
    if (!loaded) return GVC_OK;
    GVC_TRY(begin_group(e, error));
    GVC_TRY(gvc_load_frame(e->source, frame - 1, e->options.weld, &e->batch.before, NULL, error));
    gvc_config config;
    describe(e, &config);
    GVC_TRY(gvc_resume_skip(&e->resume, frame, &config, &e->options, e->sink, &e->writer, error));
    return report_progress(e, frame, error);
}

/* Cuts as many frames of the batch from `first` on as the segment and the group take, then makes
 * their images. */
static gvc_result encode_run(encoder *e, size_t first, size_t *end, gvc_error *error) {
    const gvc_cutter cutter = cutter_of(e);
    bool continues;
    GVC_TRY(gvc_cut_follow(&cutter, &e->segment, &e->batch.work[first], &continues, error));
    if (!continues) {
        GVC_TRY(flush_group(e, error));
        follow_no_more(e);
        GVC_TRY(gvc_cut_begin(&cutter, e->report.segment_count, &e->batch.work[first], &e->segment,
                              error));
        e->report.segment_count++;
    } else if (e->group.count == 0) {
        GVC_TRY(refresh_layout(e, &e->batch.work[first], error));
    }
    size_t room = e->options.gop - e->group.count, cut = first + 1;
    while (cut < e->batch.count && cut - first < room) {
        GVC_TRY(gvc_cut_follow(&cutter, &e->segment, &e->batch.work[cut], &continues, error));
        if (!continues) break;
        cut++;
    }
    bool broken = cut < e->batch.count && cut - first < room;
    *end = cut;
    if (e->size == 0) GVC_TRY(settle_size(e, first, cut, error));
    GVC_TRY(add_images(e, first, end, error));
    for (size_t i = *end; i < cut; i++) GVC_TRY(gvc_frame_uncut(&e->batch.work[i], error));
    if (broken || *end < cut) {
        GVC_TRY(flush_group(e, error));
        e->segment.end_frame = e->batch.work[*end].number; /* it starts a segment */
    }
    if (e->group.count == e->options.gop) GVC_TRY(flush_group(e, error));
    return e->group.count == 0 ? save_checkpoint(e, e->batch.first + *end, error) : GVC_OK;
}

static gvc_result encode_batch(encoder *e, uint64_t first, size_t count, gvc_error *error) {
    size_t next = 0;
    GVC_TRY(gvc_batch_analyse(&e->batch, e->source, &e->options, first, count, error));
    while (next < e->batch.count) {
        /* nothing new is done, but this is where a long group can be cancelled */
        GVC_TRY(report_progress(e, e->report.frame_count, error));
        GVC_TRY(encode_run(e, next, &next, error));
    }
    return GVC_OK;
}

static gvc_result encode_all(encoder *e, gvc_error *error) {
    uint64_t total = e->source->frame_count;
    GVC_TRY(gvc_scan(e->source, &e->options, e->facts, error));
    GVC_TRY(gvc_resume_begin(&e->resume, e->partial, e->source, e->facts, &e->options, error));
    GVC_TRY(report_progress(e, 0, error));
    uint64_t first = 0;
    GVC_TRY(load_checkpoint(e, &first, error));
    while (first < total) { /* batches end where they would without a checkpoint */
        uint64_t end = first - first % GVC_BATCH + GVC_BATCH;
        if (end > total) end = total;
        GVC_TRY(encode_batch(e, first, (size_t)(end - first), error));
        first = end;
    }
    GVC_TRY(flush_group(e, error));
    return gvc_writer_finish(e->writer, error);
}

static gvc_result encode(const gvc_source *source, const gvc_sink *sink,
                         const gvc_encode_options *options, const gvc_image_tap *tap,
                         const gvc_partial *partial, gvc_encode_report *report, gvc_error *error) {
    GVC_TRY(check_options(options, source, error));
    encoder *e = gvc_alloc(1, sizeof *e);
    if (!e) return gvc_fail_memory(error);
    *e = (encoder){.source = source,
                   .sink = sink,
                   .tap = tap,
                   .options = *options,
                   .crf = FIRST_CRF,
                   .partial = partial};
    e->facts = gvc_alloc((size_t)source->frame_count, sizeof *e->facts);
    gvc_result result = e->facts ? GVC_OK : gvc_fail_memory(error);
    if (result == GVC_OK) result = gvc_cut_tracker(options, &e->tracker, error);
    if (result == GVC_OK) result = encode_all(e, error);
    if (result == GVC_OK && report) {
        *report = e->report;
        report->byte_count = gvc_writer_byte_count(e->writer);
        report->image_size = e->size;
        report->mean_crf /= (double)report->frame_count;
    }
    gvc_writer_destroy(&e->writer);
    gvc_resume_free(&e->resume);
    gvc_batch_free(&e->batch);
    follow_no_more(e);
    gvc_group_free(&e->group);
    gvc_segment_free(&e->segment);
    gvc_tracker_destroy(&e->tracker);
    free(e->facts);
    free(e);
    return gvc_explain(error, result);
}

gvc_result gvc_encode_tapped(const gvc_source *source, const gvc_sink *sink,
                             const gvc_encode_options *options, const gvc_image_tap *tap,
                             gvc_encode_report *report, gvc_error *error) {
    return encode(source, sink, options, tap, NULL, report, error);
}

gvc_result gvc_encode(const gvc_source *source, const gvc_sink *sink,
                      const gvc_encode_options *options, gvc_encode_report *report,
                      gvc_error *error) {
    return encode(source, sink, options, NULL, NULL, report, error);
}

gvc_result gvc_encode_resume(const gvc_source *source, const gvc_sink *sink,
                             const gvc_encode_options *options, const gvc_partial *partial,
                             gvc_encode_report *report, gvc_error *error) {
    return encode(source, sink, options, NULL, partial, report, error);
}
