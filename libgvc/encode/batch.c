/* SPDX-License-Identifier: MIT */
/** @file batch.c  Frames analysed together, in parallel. */
#include "encode/batch.h"

#include "base/parallel.h"

typedef struct analysis {
    gvc_batch *batch;
    const gvc_source *source;
    bool weld;
} analysis;

static gvc_result analyse_one(void *user, size_t index, gvc_error *error) {
    analysis *a = user;
    return gvc_frame_analyse(&a->batch->work[index], a->source, a->weld, error);
}

static gvc_result follow_one(void *user, size_t index, gvc_error *error) {
    gvc_batch *batch = ((analysis *)user)->batch;
    const gvc_mesh *before = index > 0 ? batch->work[index - 1].mesh : batch->before;
    return before ? gvc_frame_follow(&batch->work[index], before, error) : GVC_OK;
}

static void free_frames(gvc_batch *batch) {
    for (size_t i = 0; i < batch->count; i++) {
        gvc_frame_free(&batch->work[i]);
        batch->work[i] = (gvc_frame_work){0};
    }
    batch->count = 0;
}

gvc_result gvc_batch_analyse(gvc_batch *batch, const gvc_source *source,
                             const gvc_encode_options *options, uint64_t first, size_t count,
                             gvc_error *error) {
    analysis a = {batch, source, options->weld};
    free_frames(batch);
    batch->first = first;
    batch->count = count;
    for (size_t i = 0; i < count; i++) {
        batch->work[i] =
            (gvc_frame_work){.number = first + i, .longest_edge = options->longest_edge};
    }
    GVC_TRY(gvc_parallel_for(options->threads, count, analyse_one, &a, error));
    if (options->registration)
        GVC_TRY(gvc_parallel_for(options->threads, count, follow_one, &a, error));
    const gvc_mesh *last = batch->work[count - 1].mesh;
    gvc_mesh_destroy(&batch->before);
    return gvc_mesh_create(last->position, last->vertex_count, last->face, last->face_count,
                           &batch->before, error);
}

void gvc_batch_free(gvc_batch *batch) {
    free_frames(batch);
    gvc_mesh_destroy(&batch->before);
}
