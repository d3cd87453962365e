/* SPDX-License-Identifier: MIT */
/** @file render_surfaces.c  gvc render FRAMES: surfaces from the front and the back, and their cut
 * graphs. */
#include "render_job.h"

#include "base/memory.h"
#include "base/result.h"
#include "mesh/mesh.h"
#include "render_figure.h"
#include "render_track.h"

#include <stdlib.h>

#define COLUMNS 6           /* frames side by side */
#define MOST_NAMED 12       /* edges with a colour of their own */
#define MOST_AMBIGUOUS 0.02 /* share of the surface that gets the last colour */

typedef struct surfaces {
    render_job *job;
    gvc_source source;
    gvc_mesh *mesh[RENDER_MOST_FRAMES];
    render_sight sight;
    render_image *panel[2][RENDER_MOST_FRAMES]; /* front and back */
    uint64_t segment[RENDER_MOST_FRAMES];
    size_t tip_count, edge_count; /* greatest of the graphs shown */
    bool junctions;
    bool scanning;
    cli_progress progress;
} surfaces;

static gvc_result draw(surfaces *s, size_t index, const gvc_mesh *mesh,
                       const render_tracked *tracked, gvc_error *error) {
    render_style style;
    render_style_init(&style);
    for (size_t side = 0; side < 2; side++) {
        render_canvas *canvas;
        GVC_TRY(render_canvas_create(s->sight.width, s->sight.height, &s->sight.camera[side][index],
                                     &canvas, error));
        gvc_result result =
            tracked && tracked->ambiguity
                ? render_heat_map(canvas, mesh, tracked->ambiguity, MOST_AMBIGUOUS, error)
                : render_canvas_mesh(canvas, mesh, &style, error);
        if (result == GVC_OK && tracked) {
            result = render_cut_graph(canvas, tracked->halfedges, tracked->graph, error);
        }
        if (result == GVC_OK) {
            result = render_canvas_finish(canvas, &s->panel[side][index], error);
        }
        render_canvas_destroy(&canvas);
        if (result != GVC_OK) return result;
    }
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------- cut graphs */

static gvc_result on_picture(void *user, const render_tracked *tracked, gvc_error *error) {
    surfaces *s = user;
    const gvc_cut_graph *graph = tracked->graph;
    size_t tips = 0;
    for (size_t n = 0; n < graph->node_count; n++) {
        tips += graph->node[n].kind == GVC_NODE_EXTREMUM;
        s->junctions = s->junctions || graph->node[n].kind == GVC_NODE_JUNCTION;
    }
    s->segment[tracked->index] = tracked->segment;
    if (tips > s->tip_count) s->tip_count = tips;
    if (graph->edge_count > s->edge_count) s->edge_count = graph->edge_count;
    return draw(s, tracked->index, tracked->mesh, tracked, error);
}

static void on_segment(void *user, uint64_t frame, const gvc_cut_graph *graph) {
    const surfaces *s = user;
    if (s->job->quiet) return;
    if (s->progress.enabled) fputs("\r\x1b[K", stderr);
    fprintf(stderr, "gvc render: frame %llu begins a segment: %zu nodes, %zu cut edges\n",
            (unsigned long long)frame, graph->node_count, graph->edge_count);
}

static bool on_progress(void *user, gvc_stage stage, uint64_t done, uint64_t total) {
    surfaces *s = user;
    if (s->scanning && stage == GVC_STAGE_ENCODE) {
        cli_progress_end(&s->progress);
        cli_progress_begin(&s->progress, "cutting", s->job->quiet);
        s->scanning = false;
    }
    cli_progress_show(&s->progress, done, total);
    return !cli_interrupted();
}

static gvc_result draw_graphs(surfaces *s, gvc_error *error) {
    const render_track_hooks hooks = {.user = s,
                                      .ambiguity = s->job->ambiguity,
                                      .picture = on_picture,
                                      .segment = on_segment,
                                      .progress = on_progress};
    s->scanning = true;
    cli_progress_begin(&s->progress, "scanning", s->job->quiet);
    gvc_result result = render_track(&s->source, s->job->weld, s->job->threads, s->job->frame,
                                     s->job->frame_count, &hooks, error);
    cli_progress_end(&s->progress);
    return result;
}

static gvc_result draw_plain(surfaces *s, gvc_error *error) {
    for (size_t i = 0; i < s->job->frame_count; i++) {
        if (cli_interrupted()) return gvc_fail(error, GVC_ERROR_CANCELLED, "interrupted");
        GVC_TRY(draw(s, i, s->mesh[i], NULL, error));
    }
    return GVC_OK;
}

/* ---------------------------------------------------------------------------------------- page */

static gvc_result add_keys(const surfaces *s, size_t width, render_parts *page, gvc_error *error) {
    render_key key[3 + MOST_NAMED];
    size_t count = 0;
    key[count++] = (render_key){render_node_color(GVC_NODE_ROOT), false, "root"};
    if (s->tip_count > 0) {
        key[count++] = (render_key){render_node_color(GVC_NODE_EXTREMUM), false, "tip"};
    }
    if (s->junctions) {
        key[count++] = (render_key){render_node_color(GVC_NODE_JUNCTION), false, "junction"};
    }
    if (s->edge_count > MOST_NAMED) {
        key[count] = (render_key){.color = render_edge_color(0), .stroke = true};
        snprintf(key[count++].text, sizeof key->text, "%zu cut edges", s->edge_count);
    } else {
        for (size_t e = 0; e < s->edge_count; e++) {
            key[count] = (render_key){.color = render_edge_color(e), .stroke = true};
            snprintf(key[count++].text, sizeof key->text, "edge %zu", e);
        }
    }
    return render_parts_keys(page, key, count, width, error);
}

static gvc_result add_panel(surfaces *s, size_t side, size_t i, bool alone, render_parts *row,
                            gvc_error *error) {
    char title[48], segment[48];
    snprintf(title, sizeof title, "frame %llu%s", (unsigned long long)s->job->frame[i],
             alone && side ? ", from behind" : "");
    snprintf(segment, sizeof segment, "segment %llu", (unsigned long long)s->segment[i]);
    /* Only over several segments does it matter which one a frame belongs to. */
    bool told = s->segment[0] != s->segment[s->job->frame_count - 1];
    if (alone || side == 0) {
        GVC_TRY(render_caption(&s->panel[side][i], title, told ? segment : NULL, error));
    }
    render_image *panel = s->panel[side][i];
    s->panel[side][i] = NULL;
    return render_parts_add(row, panel, error);
}

/* Frames first ... end - 1: a row of fronts under their frame numbers, and a row of backs; both in
 * one row if there is one frame only. */
static gvc_result add_rows(surfaces *s, size_t first, size_t end, render_parts *page,
                           gvc_error *error) {
    gvc_result result = GVC_OK;
    render_parts row = {0};
    bool alone = s->job->frame_count == 1;
    for (size_t side = 0; side < 2 && result == GVC_OK; side++) {
        for (size_t i = first; i < end && result == GVC_OK; i++) {
            result = add_panel(s, side, i, alone, &row, error);
        }
        if (result == GVC_OK && !(alone && side == 0)) {
            result = render_parts_move_row(&row, RENDER_GAP, page, error);
        }
    }
    render_parts_free(&row);
    return result;
}

static gvc_result lay_out(surfaces *s, render_image **image, gvc_error *error) {
    render_parts page = {0};
    gvc_result result = GVC_OK;
    size_t count = s->job->frame_count, columns = count < COLUMNS ? count : COLUMNS;
    for (size_t i = 0; i < count && result == GVC_OK; i += columns) {
        size_t end = count - i < columns ? count : i + columns;
        result = add_rows(s, i, end, &page, error);
    }
    if (result == GVC_OK && s->edge_count > 0) {
        result = add_keys(s, page.image[0]->width, &page, error);
    }
    if (result == GVC_OK && s->job->ambiguity) {
        result = render_job_legend("alike: 0 ", " 2 % of the surface", page.image[0]->width, &page,
                                   error);
    }
    if (result == GVC_OK) result = render_parts_page(&page, RENDER_GAP, image, error);
    render_parts_free(&page);
    return result;
}

static int run(surfaces *s, render_image **image) {
    gvc_error error;
    gvc_error_init(&error);
    int status = render_job_choose(s->job, s->source.frame_count, 5);
    if (status != EXIT_DONE) return status;
    gvc_result result = render_meshes_read(s->job, &s->source, s->mesh, &error);
    if (result == GVC_OK) result = render_sight_fit(s->job, s->mesh, &s->sight, &error);
    if (result == GVC_OK) {
        result = s->job->no_graph ? draw_plain(s, &error) : draw_graphs(s, &error);
    }
    if (result == GVC_OK) result = lay_out(s, image, &error);
    if (result == GVC_OK) return EXIT_DONE;
    status = cli_fail("render", NULL, &error);
    if (result == GVC_ERROR_MESH && !s->job->no_graph) {
        fputs("gvc render: --no-graph draws any surface\n", stderr);
    }
    return status;
}

int render_surfaces(render_job *job, render_image **image) {
    gvc_error error;
    frame_list list;
    gvc_error_init(&error);
    surfaces *s = gvc_alloc(1, sizeof *s);
    if (!s) {
        (void)gvc_fail_memory(&error);
        return cli_fail("render", NULL, &error);
    }
    s->job = job;
    if (frame_list_make(job->input, job->input_count, job->any_order, &list, &error) != GVC_OK) {
        free(s);
        return cli_fail("render", NULL, &error);
    }
    s->source = frame_list_source(&list);
    int status = run(s, image);
    render_meshes_free(s->mesh, RENDER_MOST_FRAMES);
    for (size_t i = 0; i < RENDER_MOST_FRAMES; i++) {
        render_image_destroy(&s->panel[0][i]);
        render_image_destroy(&s->panel[1][i]);
    }
    free(s);
    frame_list_free(&list);
    return status;
}
