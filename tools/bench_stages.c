/* SPDX-License-Identifier: MIT */
/**
 * @file bench_stages.c
 * Where the encoder's time goes: CPU milliseconds a frame of each stage from mesh file to geometry
 * image, for figures made at growing numbers of vertices, or for frames of a capture.
 *
 *     bench_stages                        1,000 to 50,000 vertices, and how each stage grows
 *     bench_stages 0001.off 0002.off ...  consecutive frames of one capture
 */
#include "base/memory.h"
#include "chart/layout.h"
#include "chart/sample.h"
#include "compare_clock.h"
#include "descriptor/integral.h"
#include "encode/frame.h"
#include "encode/scan.h"
#include "mesh/refine.h"
#include "synth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define IMAGE_SIZE 128u
#define MADE_FRAMES 4
#define EXTREMA 5

enum {
    READ,
    HALFEDGES,
    INTEGRAL,
    EXTREMA_OF_MU,
    REGISTER,
    TRACK,
    LAYOUT,
    PARAMETERIZE,
    SAMPLE,
    FIT,
    STAGES
};

static const char *const stage_name[STAGES] = {
    "read and check", "halfedges",        "geodesic integral", "extrema",       "registration",
    "track the cut",  "open and lay out", "parameterize",      "point samples", "least squares"};

/* CPU seconds of one capture, summed over its frames. */
typedef struct bench {
    double seconds[STAGES];
    size_t frames, vertices, refined_vertices;
    gvc_tracker *tracker;
    gvc_mesh *before; /* the frame before */
    gvc_side_table sides;
    gvc_weld weld;
} bench;

/* Seconds since `*clock`, which is set to now. */
static double lap(double *clock) {
    double before = *clock;
    *clock = compare_thread_seconds();
    return *clock - before;
}

static void bench_free(bench *b) {
    gvc_tracker_destroy(&b->tracker);
    gvc_mesh_destroy(&b->before);
    gvc_side_table_free(&b->sides);
    gvc_weld_free(&b->weld);
}

/* Halfedges and features; the integral is done once more, since gvc_features_find does not tell
 * its part. */
static gvc_result analyse(bench *b, gvc_frame_work *work, gvc_error *error) {
    gvc_features_options options;
    gvc_features_options_init(&options);
    double greatest, integral, clock = compare_thread_seconds();
    GVC_TRY(gvc_frame_uncut(work, error));
    b->seconds[HALFEDGES] += lap(&clock);
    double *mu = gvc_alloc(work->halfedges.vertex_count, sizeof *mu);
    if (!mu) return gvc_fail_memory(error);
    gvc_result result =
        gvc_geodesic_integral(&work->halfedges, options.integral_samples, mu, &greatest, error);
    free(mu);
    integral = lap(&clock);
    if (result == GVC_OK)
        result = gvc_features_find(&work->halfedges, &options, &work->features, error);
    b->seconds[INTEGRAL] += integral;
    b->seconds[EXTREMA_OF_MU] += lap(&clock) - integral;
    b->vertices += work->mesh->vertex_count;
    b->refined_vertices += work->halfedges.vertex_count;
    return result;
}

/* The layout that all frames share: steps by lengths in the first one. */
static gvc_result make_layout(bench *b, const gvc_frame_work *work, const gvc_disk *disk,
                              gvc_error *error) {
    size_t count = 0;
    double *length = gvc_alloc(work->graph.edge_count, sizeof *length);
    uint32_t *start = gvc_alloc(4 * IMAGE_SIZE, sizeof *start);
    gvc_result result = length && start ? GVC_OK : gvc_fail_memory(error);
    for (size_t e = 0; result == GVC_OK && e < work->graph.edge_count; e++)
        length[e] = gvc_cut_edge_length(&work->halfedges, &work->graph.edge[e]);
    if (result == GVC_OK)
        result = gvc_layout_make(disk->run, disk->run_count, &work->graph, length, IMAGE_SIZE,
                                 &b->sides, error);
    if (result == GVC_OK) result = gvc_layout_starts(&b->sides, start, &count, error);
    if (result == GVC_OK && count == 0)
        result = gvc_fail(error, GVC_ERROR_MESH, "no layout of the cut fits the image");
    if (result == GVC_OK) {
        b->sides.start = start[0];
        result = gvc_weld_build(&b->sides, &b->weld, error);
    }
    free(length);
    free(start);
    return result;
}

/* From the cut to the image. */
static gvc_result make_image(bench *b, const gvc_frame_work *work, gvc_error *error) {
    const gvc_parameterize_options options = {.stretch_exponent = 1.0, .curvature_exponent = 0.25};
    gvc_disk disk = {0};
    double *uv = NULL, clock = compare_thread_seconds();
    double *image = gvc_alloc(IMAGE_SIZE * IMAGE_SIZE, 3 * sizeof *image);
    gvc_result result = image ? GVC_OK : gvc_fail_memory(error);
    GVC_CHECK(result);
    GVC_CHECK(gvc_disk_open(&work->halfedges, &work->graph, &disk, error));
    if (b->frames == 0) GVC_CHECK(make_layout(b, work, &disk, error));
    GVC_CHECK(gvc_layout_place(&disk, &b->sides, &uv, error));
    b->seconds[LAYOUT] += lap(&clock);
    GVC_CHECK(gvc_parameterize(&disk, IMAGE_SIZE, &options, uv, NULL, error));
    b->seconds[PARAMETERIZE] += lap(&clock);
    GVC_CHECK(gvc_sample_points(&disk, uv, &b->weld, image, error));
    b->seconds[SAMPLE] += lap(&clock);
    GVC_CHECK(gvc_sample_fit(&disk, uv, &b->weld, GVC_FIT_REGULARIZATION, image, error));
    b->seconds[FIT] += lap(&clock);
cleanup:
    gvc_disk_free(&disk);
    free(uv);
    free(image);
    return result;
}

static gvc_result measure_frame(bench *b, const gvc_source *source, uint64_t number,
                                gvc_error *error) {
    gvc_frame_work work = {.number = number, .longest_edge = GVC_LONGEST_EDGE};
    gvc_result result = GVC_OK;
    bool kept = true;
    double clock = compare_thread_seconds();
    GVC_CHECK(gvc_load_frame(source, number, true, &work.mesh, NULL, error));
    b->seconds[READ] += lap(&clock);
    GVC_CHECK(analyse(b, &work, error));
    lap(&clock);
    if (b->before) GVC_CHECK(gvc_frame_follow(&work, b->before, error));
    b->seconds[REGISTER] += lap(&clock);
    if (b->frames == 0)
        GVC_CHECK(gvc_tracker_start(b->tracker, &work.features, EXTREMA, GVC_HANDLES_SHORT,
                                    &work.halfedges, &work.graph, error));
    else
        GVC_CHECK(gvc_tracker_next(b->tracker, &work.features, work.warp, &work.halfedges,
                                   &work.graph, &kept, error));
    b->seconds[TRACK] += lap(&clock);
    if (!kept) GVC_CHECK(gvc_fail(error, GVC_ERROR_MESH, "the cut of the frame before is lost"));
    GVC_CHECK(make_image(b, &work, error));
    b->frames++;
    gvc_mesh_destroy(&b->before);
    b->before = work.mesh;
    work.mesh = NULL;
cleanup:
    gvc_frame_free(&work);
    return gvc_at_frame(error, result, (int64_t)number);
}

static gvc_result measure(const gvc_source *source, bench *b, gvc_error *error) {
    gvc_tracker_options options;
    gvc_tracker_options_init(&options);
    *b = (bench){0};
    GVC_TRY(gvc_tracker_create(&options, &b->tracker, error));
    for (uint64_t f = 0; f < source->frame_count; f++) GVC_TRY(measure_frame(b, source, f, error));
    return GVC_OK;
}

/* ------------------------------------------------------------------------------------- sources */

static gvc_result read_named(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    char *const *path = user;
    return gvc_mesh_read_file(path[frame], GVC_MESH_AUTO, mesh, error);
}

/* Meshes made when asked for: their making counts as reading. */
static gvc_result read_made(void *user, uint64_t frame, gvc_mesh **mesh, gvc_error *error) {
    return synth_frame(user, frame, mesh, error);
}

/* -------------------------------------------------------------------------------------- tables */

static double milliseconds(const bench *b, int stage) {
    return 1000 * b->seconds[stage] / (double)b->frames;
}

/* Exponent of growth from the first to the last bench, with the vertices the stage works on. */
static double growth(const bench *row, size_t count, int stage) {
    const bench *a = &row[0], *z = &row[count - 1];
    double vertices = stage <= HALFEDGES
                          ? (double)z->vertices / (double)a->vertices
                          : (double)z->refined_vertices / (double)a->refined_vertices;
    return log(z->seconds[stage] / a->seconds[stage]) / log(vertices);
}

static void print_row(const bench *row, size_t count, int first, int last, const char *name) {
    printf("%-18s", name);
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        for (int s = first; s <= last; s++) sum += milliseconds(&row[i], s);
        printf(" %10.1f", sum);
    }
    if (count > 1 && first == last) printf(" %8.2f", growth(row, count, first));
    printf("\n");
}

static void print_table(const bench *row, size_t count) {
    printf("%-18s", "vertices");
    for (size_t i = 0; i < count; i++) printf(" %10zu", row[i].vertices / row[i].frames);
    printf("%s\n%-18s", count > 1 ? "   growth" : "", "refined to");
    for (size_t i = 0; i < count; i++) printf(" %10zu", row[i].refined_vertices / row[i].frames);
    printf("\n");
    for (int s = 0; s < STAGES; s++) print_row(row, count, s, s, stage_name[s]);
    print_row(row, count, HALFEDGES, FIT, "descriptor, chart");
}

int main(int argc, char **argv) {
    static const size_t size[] = {1500, 5000, 10000, 50000};
    enum { SIZES = sizeof size / sizeof *size };
    bench made[SIZES] = {{.frames = 0}};
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = GVC_OK;
    size_t count = argc > 1 ? 1 : SIZES;
    for (size_t i = 0; result == GVC_OK && i < count; i++) {
        synth_options figure;
        synth_options_init(&figure);
        figure.vertex_count = size[i];
        gvc_source source = {.user = &figure, .frame_count = MADE_FRAMES, .read = read_made};
        if (argc > 1)
            source = (gvc_source){
                .user = argv + 1, .frame_count = (uint64_t)(argc - 1), .read = read_named};
        result = measure(&source, &made[i], &error);
    }
    if (result == GVC_OK) print_table(made, count);
    for (size_t i = 0; i < count; i++) bench_free(&made[i]);
    if (result == GVC_OK) return 0;
    fprintf(stderr, "bench_stages: frame %lld: %s\n", (long long)error.frame, error.message);
    return 1;
}
