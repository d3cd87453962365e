/* SPDX-License-Identifier: MIT */
/** @file compare_paper_data.c  The paper's measurements as JSON and CSV. */
#include "compare_paper.h"
#include "compare_text.h"

#include <math.h>

/* -------------------------------------------------------------------------------------- JSON */

static void json_number(gvc_buffer *text, const char *before, double value) {
    text_append(text, before);
    text_number(text, value, "null");
}

static void json_result(const paper_result *result, gvc_buffer *text) {
    if (!result->measured) {
        text_append(text, "null");
        return;
    }
    json_number(text, "{\"frames\": ", (double)result->frame_count);
    json_number(text, ", \"layouts\": ", (double)result->segment_count);
    json_number(text, ", \"mse_summed\": ", result->mse_mean);
    json_number(text, ", \"mse_per_component\": ", result->mse_mean / PAPER_COMPONENTS);
    json_number(text, ", \"hausdorff_mean\": ", result->hausdorff);
    json_number(text, ", \"rms\": ", result->rms);
    json_number(text, ", \"bytes\": ", result->bytes);
    text_append(text, ",\n      \"mse_summed_of_pairs\": [");
    for (uint64_t f = 0; f + 1 < result->frame_count; f++) {
        json_number(text, f ? ", " : "", result->mse[f]);
    }
    text_append(text, "]}");
}

static void json_row(const paper_row *row, gvc_buffer *text) {
    if (!row) {
        text_append(text, "null");
        return;
    }
    text_append(text, "{\"name\": ");
    text_json_string(text, row->name);
    json_number(text, ", \"frames\": ", row->frame_count);
    for (int m = 0; m < PAPER_METHODS; m++) {
        text_format(text, ", \"mse_%s\": ", paper_method_name((paper_method)m));
        json_number(text, "", row->mse[m]);
    }
    json_number(text, ", \"hausdorff_gis\": ", row->hausdorff_gis);
    json_number(text, ", \"hausdorff_ours\": ", row->hausdorff_ours);
    json_number(text, ", \"hausdorff_ref\": ", row->hausdorff_reference);
    json_number(text, ", \"kb_zip\": ", row->kb_zip);
    json_number(text, ", \"kb_gis\": ", row->kb_gis);
    json_number(text, ", \"kb_ours\": ", row->kb_ours);
    text_append(text, "}");
}

static void json_capture(const paper_capture *c, gvc_buffer *text) {
    text_append(text, "{\"name\": ");
    text_json_string(text, c->name);
    json_number(text, ", \"frames\": ", (double)c->frame_count);
    for (int k = 0; k < 3; k++) {
        json_number(text, k ? ", " : ", \"cube_origin\": [", c->cube.origin[k]);
    }
    json_number(text, "], \"cube_side\": ", c->cube.side);
    for (int m = 0; m < PAPER_METHODS; m++) {
        text_format(text, ",\n     \"%s\": ", paper_method_name((paper_method)m));
        json_result(&c->result[m], text);
    }
    json_number(text, ",\n     \"ref_hausdorff_mean\": ", c->hausdorff_reference);
    json_number(text, ", \"zip_bytes\": ", c->zip_bytes);
    text_append(text, ",\n     \"paper\": ");
    json_row(c->row, text);
    text_append(text, "}");
}

void paper_print_json(const paper_capture *captures, size_t count, const paper_options *options,
                      gvc_buffer *text) {
    json_number(text, "{\"size\": ", options->size);
    json_number(text, ", \"crf\": ", paper_codes(options) ? options->crf : NAN);
    json_number(text, ", \"gop\": ", paper_codes(options) ? options->gop : NAN);
    json_number(text, ", \"ref_vertices\": ", PAPER_REFERENCE_VERTICES);
    text_append(text, ",\n \"captures\": [");
    for (size_t i = 0; i < count; i++) {
        text_append(text, i ? ",\n    " : "\n    ");
        json_capture(&captures[i], text);
    }
    text_append(text, "\n ]}\n");
}

/* --------------------------------------------------------------------------------------- CSV */

typedef struct csv_line {
    const char *capture, *prefix, *method;
    double frames, layouts, mse, mse_printed, hausdorff, rms, bytes;
} csv_line;

static const csv_line empty_line = {.prefix = "",
                                    .layouts = NAN,
                                    .mse = NAN,
                                    .mse_printed = NAN,
                                    .hausdorff = NAN,
                                    .rms = NAN,
                                    .bytes = NAN};

static void csv_print(const csv_line *line, gvc_buffer *text) {
    const double value[] = {
        line->frames,      line->layouts,   line->mse, line->mse / PAPER_COMPONENTS,
        line->mse_printed, line->hausdorff, line->rms, line->bytes};
    text_csv_string(text, line->capture);
    text_append(text, ",");
    text_append(text, line->prefix);
    text_append(text, line->method);
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        text_append(text, ",");
        text_number(text, value[i], "");
    }
    text_append(text, "\n");
}

static csv_line csv_begin(const char *capture, double frames, const char *method) {
    csv_line line = empty_line;
    line.capture = capture;
    line.frames = frames;
    line.method = method;
    return line;
}

static void csv_capture(const paper_capture *c, gvc_buffer *text) {
    csv_line line;
    for (int m = 0; m < PAPER_METHODS; m++) {
        const paper_result *r = &c->result[m];
        if (!r->measured) continue;
        line = csv_begin(c->name, (double)r->frame_count, paper_method_name((paper_method)m));
        line.layouts = (double)r->segment_count;
        line.mse = r->mse_mean;
        line.hausdorff = r->hausdorff;
        line.rms = r->rms;
        line.bytes = r->bytes;
        csv_print(&line, text);
    }
    if (!isnan(c->hausdorff_reference)) {
        line = csv_begin(c->name, (double)c->frame_count, "ref");
        line.hausdorff = c->hausdorff_reference;
        csv_print(&line, text);
    }
    if (!isnan(c->zip_bytes)) {
        line = csv_begin(c->name, (double)c->frame_count, "zip");
        line.bytes = c->zip_bytes;
        csv_print(&line, text);
    }
}

static void csv_row(const paper_capture *c, gvc_buffer *text) {
    const paper_row *row = c->row;
    const double hausdorff[PAPER_METHODS] = {row->hausdorff_gis, row->hausdorff_ours, NAN};
    const double kb[PAPER_METHODS] = {row->kb_gis, row->kb_ours, NAN};
    csv_line line;
    for (int m = 0; m < PAPER_METHODS; m++) {
        line = csv_begin(c->name, row->frame_count, paper_method_name((paper_method)m));
        line.prefix = "paper ";
        line.mse_printed = row->mse[m];
        line.hausdorff = hausdorff[m];
        line.bytes = kb[m] * PAPER_KB;
        csv_print(&line, text);
    }
    line = csv_begin(c->name, row->frame_count, "ref");
    line.prefix = "paper ";
    line.hausdorff = row->hausdorff_reference;
    csv_print(&line, text);
    line = csv_begin(c->name, row->frame_count, "zip");
    line.prefix = "paper ";
    line.bytes = row->kb_zip * PAPER_KB;
    csv_print(&line, text);
}

void paper_print_csv(const paper_capture *captures, size_t count, gvc_buffer *text) {
    text_append(text, "capture,method,frames,layouts,mse_summed,mse_per_component,mse_as_printed,"
                      "hausdorff_mean,rms,bytes\n");
    for (size_t i = 0; i < count; i++) {
        csv_capture(&captures[i], text);
        if (captures[i].row) csv_row(&captures[i], text);
    }
}
