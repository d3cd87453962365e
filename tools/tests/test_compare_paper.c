/* SPDX-License-Identifier: MIT */
/** @file test_compare_paper.c  What `gvc compare --paper` measures and prints: images, simplified
 *  meshes, the paper's rows, plots. */
#include "capture_maker.h"

#include "compare_paper.h"
#include "mesh/mesh.h"
#include "plot.h"
#include "simplify.h"

/* --------------------------------------------------------------------------------------- images */

static const paper_cube unit_cube = {{0, 0, 0}, 1};

static void differences_are_squared_and_summed(void **state) {
    (void)state;
    enum { SIZE = 4, SAMPLES = SIZE * SIZE };
    paper_images images;
    double flat[3 * SAMPLES], moved[3 * SAMPLES];
    for (int i = 0; i < 3 * SAMPLES; i++) moved[i] = flat[i] = 100 / 255.0;
    assert_int_equal(paper_images_create(3, SIZE, &unit_cube, &images, NULL), GVC_OK);
    paper_images_set(&images, 0, flat);
    paper_images_set(&images, 1, flat);
    /* x by 2, y by -3, z by 1 in half of the samples: 4 + 9 + 1/2 */
    for (int i = 0; i < SAMPLES; i++) {
        moved[i] += 2 / 255.0;
        moved[SAMPLES + i] -= 3 / 255.0;
        if (i % 2) moved[2 * SAMPLES + i] += 1 / 255.0;
    }
    paper_images_set(&images, 2, moved);
    assert_float_equal(paper_images_mse(&images, 0), 0, 0);
    assert_float_equal(paper_images_mse(&images, 1), 13.5, 0);
    paper_result result = {0};
    assert_int_equal(paper_result_set_mse(&result, &images, NULL), GVC_OK);
    assert_int_equal(result.frame_count, 3);
    assert_float_equal(result.mse_mean, 6.75, 0);
    paper_result_free(&result);
    paper_images_free(&images);
}

static void coordinates_beyond_the_cube_stay_in_range(void **state) {
    (void)state;
    paper_images images;
    const double out[3] = {-0.5, 0.5, 1.5};
    assert_int_equal(paper_images_create(1, 1, &unit_cube, &images, NULL), GVC_OK);
    paper_images_set(&images, 0, out);
    assert_int_equal(images.code[0], 0);
    assert_int_equal(images.code[1], 128);
    assert_int_equal(images.code[2], 255);
    paper_result result = {0};
    assert_int_equal(paper_result_set_mse(&result, &images, NULL), GVC_OK);
    assert_true(isnan(result.mse_mean)); /* a single frame has none before it */
    paper_result_free(&result);
    paper_images_free(&images);
}

static void the_cube_holds_all_frames(void **state) {
    (void)state;
    capture frames = {0};
    frames.mesh[frames.count++] = mesh_ellipsoid(1, 2, 1, 16, 12, 0);
    frames.mesh[frames.count++] = mesh_ellipsoid(3, 1, 1, 16, 12, 0);
    const gvc_source source = capture_source(&frames);
    const paper_options options = {.threads = 1};
    paper_cube cube;
    assert_int_equal(paper_find_cube(&source, &options, &cube, NULL), GVC_OK);
    for (size_t f = 0; f < frames.count; f++) {
        double low[3], high[3];
        gvc_mesh_bounds(frames.mesh[f], low, high);
        for (int k = 0; k < 3; k++) {
            assert_true(low[k] >= cube.origin[k] - 1e-12);
            assert_true(high[k] <= cube.origin[k] + cube.side + 1e-12);
        }
    }
    assert_true(cube.side > 5.5 && cube.side <= 6);
    capture_free(&frames);
}

/* -------------------------------------------------------------------------------------- methods */

static bool never_stop(void *user, const char *what, uint64_t done, uint64_t total) {
    assert_true(what && done <= total);
    ++*(unsigned *)user;
    return true;
}

static bool stop(void *user, const char *what, uint64_t done, uint64_t total) {
    (void)user, (void)done, (void)total;
    return strcmp(what, "gis") != 0;
}

static const paper_request everything = {
    .method = {true, true, true}, .reference = true, .zip = true};

static void all_methods_are_measured(void **state) {
    (void)state;
    capture frames = {0}, mixed = {0};
    capture_add_figure(&frames, 0, 1, 0, 4);
    capture_add_figure(&mixed, 0, 1, 0, 4);
    const gvc_source source = capture_source(&frames), other = capture_source(&mixed);
    unsigned told = 0;
    const paper_options options = {.size = 32,
                                   .crf = 12,
                                   .gop = 3, /* groups of three and one */
                                   .threads = 2,
                                   .samples = 500,
                                   .table = {true, true, true},
                                   .progress = never_stop,
                                   .user = &told};
    paper_request request = everything;
    paper_capture made = {.name = "dance"};
    request.source = &source;
    request.mixed = &other;
    assert_int_equal(paper_measure(&request, &options, &made, NULL), GVC_OK);
    const paper_result *gis = &made.result[PAPER_GIS], *fixed = &made.result[PAPER_FIXED];
    assert_true(told > 4);
    for (int m = 0; m < PAPER_METHODS; m++) {
        const paper_result *r = &made.result[m];
        assert_true(r->measured);
        assert_int_equal(r->frame_count, 4);
        assert_true(r->mse_mean > 0 && r->bytes > 100 && r->hausdorff > 0 && r->hausdorff < 0.1);
    }
    assert_int_equal(gis->segment_count, 4);
    assert_true(gis->mse_mean > 5 * fixed->mse_mean);
    /* the same frames, in the same cube */
    assert_float_equal(fixed->mse_mean, made.result[PAPER_MIXED].mse_mean, 0);
    assert_float_equal(fixed->bytes, made.result[PAPER_MIXED].bytes, 0);
    assert_true(made.hausdorff_reference > 0 && made.hausdorff_reference < 0.1);
    assert_true(made.zip_bytes > 10 * fixed->bytes);
    paper_capture_free(&made);
    capture_free(&frames);
    capture_free(&mixed);
}

static void one_table_alone_measures_no_bytes(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    const gvc_source source = capture_source(&frames);
    const paper_options options = {.size = 32, .crf = 12, .gop = 250};
    paper_request request = everything;
    paper_capture made = {.name = "dance"};
    request.source = &source;
    assert_int_equal(paper_measure(&request, &options, &made, NULL), GVC_OK);
    assert_true(made.result[PAPER_GIS].mse_mean > 0);
    assert_true(isnan(made.result[PAPER_GIS].bytes) && isnan(made.result[PAPER_FIXED].bytes));
    assert_true(isnan(made.zip_bytes) && isnan(made.hausdorff_reference));
    assert_false(made.result[PAPER_MIXED].measured);
    paper_capture_free(&made);
    capture_free(&frames);
}

static void measuring_can_be_stopped(void **state) {
    (void)state;
    capture frames = {0};
    capture_add_figure(&frames, 0, 1, 0, 2);
    const gvc_source source = capture_source(&frames);
    const paper_options options = {.size = 32, .crf = 12, .gop = 250, .progress = stop};
    paper_request request = everything;
    paper_capture made = {.name = "dance"};
    request.source = &source;
    assert_int_equal(paper_measure(&request, &options, &made, NULL), GVC_ERROR_CANCELLED);
    paper_capture_free(&made);
    capture_free(&frames);
}

/* ----------------------------------------------------------------------------------- simplifying
 */

static void check_simple(const gvc_mesh *mesh, size_t vertices, int64_t genus, double bound) {
    gvc_mesh *simple;
    gvc_topology topology;
    gvc_distance d;
    assert_int_equal(simplify_mesh(mesh, vertices, &simple, NULL), GVC_OK);
    assert_int_equal(gvc_mesh_vertex_count(simple), vertices);
    assert_int_equal(gvc_mesh_topology(simple, &topology, NULL), GVC_OK);
    assert_true(topology.closed_manifold);
    assert_int_equal(topology.genus, genus);
    assert_int_equal(topology.degenerate_face_count, 0);
    assert_int_equal(gvc_mesh_distance(mesh, simple, 2000, &d, NULL), GVC_OK);
    double hausdorff = fmax(d.maximum[0], d.maximum[1]) / d.diagonal;
    if (!(hausdorff < bound)) fail_msg("%zu vertices: Hausdorff %g", vertices, hausdorff);
    gvc_mesh_destroy(&simple);
}

static void simple_meshes_keep_shape_and_genus(void **state) {
    (void)state;
    gvc_mesh *ball = mesh_ellipsoid(1, 1, 1, 48, 36, 0), *ring = mesh_torus(0.4, 60, 30, 0);
    check_simple(ball, 500, 0, 0.005);
    check_simple(ball, 125, 0, 0.02);
    check_simple(ball, 4, 0, 0.5);
    check_simple(ring, 125, 1, 0.03);
    gvc_mesh_destroy(&ball);
    gvc_mesh_destroy(&ring);
}

/* What lies in planes goes without a trace: a box is left with its eight corners. */
static void flat_parts_cost_nothing(void **state) {
    (void)state;
    gvc_mesh *box = mesh_box(1, 2, 3, 6);
    check_simple(box, 8, 0, 1e-6);
    gvc_mesh_destroy(&box);
}

static void small_meshes_are_left_alone(void **state) {
    (void)state;
    const double p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const uint32_t f[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    gvc_mesh *tetrahedron, *simple;
    assert_int_equal(gvc_mesh_create(p, 4, f, 4, &tetrahedron, NULL), GVC_OK);
    for (size_t wanted = 0; wanted < 200; wanted += 125) {
        assert_int_equal(simplify_mesh(tetrahedron, wanted, &simple, NULL), GVC_OK);
        assert_same_mesh(tetrahedron, simple);
        gvc_mesh_destroy(&simple);
    }
    gvc_mesh_destroy(&tetrahedron);
}

/* -------------------------------------------------------------------------------------- printing
 */

static bool holds(const gvc_buffer *text, const char *piece) {
    size_t length = strlen(piece);
    for (size_t i = 0; i + length <= text->size; i++) {
        if (memcmp(text->data + i, piece, length) == 0) return true;
    }
    return false;
}

static void rows_of_the_paper_go_by_name(void **state) {
    (void)state;
    assert_string_equal(paper_row_named("samba")->name, "Samba");
    assert_null(paper_row_named("samba_v1000"));
    assert_string_equal(paper_row_of_capture("samba_v1000")->name, "Samba");
    assert_string_equal(paper_row_of_capture("Crane")->name, "Crane");
    assert_null(paper_row_of_capture("locker"));
    assert_null(paper_row_of_capture("dance"));
}

static void figures_appear_in_all_formats(void **state) {
    (void)state;
    double gis[] = {100, 300}, fixed[] = {1, 3};
    const paper_options options = {.size = 128, .crf = 8, .gop = 250, .table = {true, true, true}};
    paper_capture dance = {.name = "a \"b\", c",
                           .row = paper_row_named("Samba"),
                           .frame_count = 3,
                           .cube = unit_cube,
                           .hausdorff_reference = 0.0625,
                           .zip_bytes = 50000};
    dance.result[PAPER_GIS] = (paper_result){true, 3, gis, 200, 0.01, 0.001, 4000, 3};
    dance.result[PAPER_FIXED] = (paper_result){true, 3, fixed, 2, 0.02, 0.002, 1000, 1};
    gvc_buffer table = {0}, json = {0}, csv = {0}, plot = {0};
    paper_print_tables(&dance, 1, &options, &table);
    paper_print_json(&dance, 1, &options, &json);
    paper_print_csv(&dance, 1, &csv);
    paper_print_plot(&dance, 1, &plot);
    assert_false(table.failed || json.failed || csv.failed || plot.failed);
    const char *in_table[] = {"200.00", "66.67", "100.00", "0.0200", "0.0625",
                              "50.0",   "0.250", "35302",  "0.0913", "22200.0"};
    for (size_t i = 0; i < sizeof in_table / sizeof *in_table; i++) {
        if (!holds(&table, in_table[i])) fail_msg("no %s in the tables", in_table[i]);
    }
    assert_true(holds(&json, "\"a \\\"b\\\", c\""));
    assert_true(holds(&json, "\"mse_summed_of_pairs\": [100, 300]"));
    assert_true(holds(&json, "\"mixed\": null"));
    assert_true(holds(&csv, "\"a \"\"b\"\", c\",fixed,3,1,2,"));
    assert_true(holds(&csv, "paper gis,174,,,,35302,0.0223,,304000\n"));
    assert_true(holds(&plot, ">gis</text>") && holds(&plot, ">fixed</text>"));
    assert_false(holds(&plot, ">mixed</text>"));
    gvc_buffer_free(&table);
    gvc_buffer_free(&json);
    gvc_buffer_free(&csv);
    gvc_buffer_free(&plot);
}

/* Scales are chosen round the values; zeros lie on the axis; markup in words is no markup. */
static void plots_take_any_values(void **state) {
    (void)state;
    const double mixed[] = {0, 1e-9, 5, 2e7, 0}, zero[] = {0}, one[] = {42};
    const plot_panel panels[] = {
        {"<&>", "x", "y", {{"a", "#000", mixed, 5}, {"b", "#111", zero, 1}}, 2},
        {"one", "x", "y", {{"a", "#000", one, 1}}, 1},
        {"none", "x", "y", {{0}}, 0}};
    gvc_buffer text = {0};
    plot_svg(panels, 3, &text);
    assert_false(text.failed);
    assert_true(holds(&text, "&lt;&amp;>"));
    assert_true(holds(&text, ">1e-9</text>") && holds(&text, ">1e8</text>"));
    assert_true(holds(&text, ">10</text>") && holds(&text, ">100</text>"));
    assert_false(holds(&text, "nan") || holds(&text, "inf") || holds(&text, "\"-\""));
    assert_true(holds(&text, "</svg>\n"));
    gvc_buffer_free(&text);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(differences_are_squared_and_summed),
        cmocka_unit_test(coordinates_beyond_the_cube_stay_in_range),
        cmocka_unit_test(the_cube_holds_all_frames),
        cmocka_unit_test(all_methods_are_measured),
        cmocka_unit_test(one_table_alone_measures_no_bytes),
        cmocka_unit_test(measuring_can_be_stopped),
        cmocka_unit_test(simple_meshes_keep_shape_and_genus),
        cmocka_unit_test(flat_parts_cost_nothing),
        cmocka_unit_test(small_meshes_are_left_alone),
        cmocka_unit_test(rows_of_the_paper_go_by_name),
        cmocka_unit_test(figures_appear_in_all_formats),
        cmocka_unit_test(plots_take_any_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
