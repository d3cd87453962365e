/* SPDX-License-Identifier: MIT */
/** @file test_render.c  The software renderer: what hides what, and where it lands. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "render_figure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SIDE 60

static const render_color red = {220, 40, 40}, green = {40, 200, 60};

/* The square -1..1 x -1..1 at height z, facing +z. */
static gvc_mesh *square(double z) {
    const double p[] = {-1, -1, z, 1, -1, z, 1, 1, z, -1, 1, z};
    const uint32_t f[] = {0, 1, 2, 0, 2, 3};
    gvc_mesh *mesh;
    assert_int_equal(gvc_mesh_create(p, 4, f, 2, &mesh, NULL), GVC_OK);
    return mesh;
}

/* A canvas that sees both squares from straight ahead. */
static render_canvas *front_canvas(const gvc_mesh *a, const gvc_mesh *b) {
    const gvc_mesh *both[2] = {a, b};
    render_view view;
    render_view_init(&view);
    view.yaw = view.pitch = 0;
    render_camera camera;
    render_canvas *canvas;
    assert_int_equal(render_camera_fit(both, 2, &view, SIDE, SIDE, &camera, NULL), GVC_OK);
    assert_int_equal(render_canvas_create(SIDE, SIDE, &camera, &canvas, NULL), GVC_OK);
    return canvas;
}

static void draw(render_canvas *canvas, const gvc_mesh *mesh, render_color color) {
    render_style style;
    render_style_init(&style);
    style.color = color;
    assert_int_equal(render_canvas_mesh(canvas, mesh, &style, NULL), GVC_OK);
}

static render_color pixel(const render_canvas *canvas, size_t x, size_t y) {
    render_image *image;
    assert_int_equal(render_canvas_finish(canvas, &image, NULL), GVC_OK);
    assert_int_equal(image->width, SIDE);
    assert_int_equal(image->height, SIDE);
    render_color color = image->pixel[y * SIDE + x];
    render_image_destroy(&image);
    return color;
}

static void test_nearer_hides_farther(void **state) {
    (void)state;
    gvc_mesh *near = square(0.5), *far = square(-0.5);
    for (int order = 0; order < 2; order++) {
        render_canvas *canvas = front_canvas(near, far);
        render_color empty = pixel(canvas, SIDE / 2, SIDE / 2);
        if (order == 0) draw(canvas, near, red);
        draw(canvas, far, green);
        if (order == 1) draw(canvas, near, red);
        render_color seen = pixel(canvas, SIDE / 2, SIDE / 2);
        assert_true(seen.r > 2 * seen.g);
        /* Fitted: the square fills the picture but for a small margin. */
        assert_true(pixel(canvas, 5, SIDE / 2).r > 2 * pixel(canvas, 5, SIDE / 2).g);
        render_color corner = pixel(canvas, 0, SIDE / 2);
        assert_true(abs(corner.r - empty.r) < 40 && abs(corner.g - empty.g) < 40);
        render_canvas_destroy(&canvas);
    }
    gvc_mesh_destroy(&near);
    gvc_mesh_destroy(&far);
}

static void test_curves_are_hidden_by_other_surfaces_only(void **state) {
    (void)state;
    gvc_mesh *near = square(0.5), *far = square(-0.5);
    render_canvas *canvas = front_canvas(near, far);
    draw(canvas, near, red);
    const double hidden[] = {-0.9, 0.5, -0.5, 0.9, 0.5, -0.5};
    const double lying[] = {-0.9, -0.5, 0.5, 0.9, -0.5, 0.5};
    render_color above = pixel(canvas, SIDE / 2, SIDE / 4);
    render_canvas_curve(canvas, hidden, 2, green, 4);
    render_canvas_curve(canvas, lying, 2, green, 4);
    render_color still = pixel(canvas, SIDE / 2, SIDE / 4);
    assert_memory_equal(&above, &still, sizeof above);
    bool found = false;
    for (size_t y = SIDE / 2; y < SIDE; y++) {
        render_color c = pixel(canvas, SIDE / 2, y);
        found = found || memcmp(&c, &green, sizeof c) == 0;
    }
    assert_true(found);
    render_canvas_destroy(&canvas);
    gvc_mesh_destroy(&near);
    gvc_mesh_destroy(&far);
}

static void test_vertex_distance(void **state) {
    (void)state;
    gvc_mesh *a = square(0.25), *b = square(-0.5);
    double distance[4], greatest;
    assert_int_equal(render_vertex_distance(a, b, distance, &greatest, NULL), GVC_OK);
    for (int i = 0; i < 4; i++) assert_true(distance[i] == 0.75);
    assert_true(greatest == 0.75);
    gvc_mesh_destroy(&a);
    gvc_mesh_destroy(&b);
}

static void test_geometry_image_and_text(void **state) {
    (void)state;
    const uint16_t plane[12] = {0, 1023, 0, 0, 0, 0, 1023, 0, 512, 0, 0, 1023};
    render_image *image;
    assert_int_equal(render_geometry_image(plane, 2, 1023, 3, &image, NULL), GVC_OK);
    assert_int_equal(image->width, 6);
    const render_color x_only = {255, 0, 0}, z_half = {0, 0, 128};
    assert_memory_equal(&image->pixel[5], &x_only, 3);
    assert_memory_equal(&image->pixel[0], &z_half, 3);
    render_image_destroy(&image);

    assert_int_equal(render_image_create(20, 20, (render_color){255, 255, 255}, &image, NULL),
                     GVC_OK);
    /* Beyond the edges is fine; the bar of the T is where it should be. */
    render_image_text(image, 1, 1, 2, "Text beyond", red);
    assert_memory_equal(&image->pixel[20 + 1], &red, 3);
    assert_memory_equal(&image->pixel[2 * 20 + 10], &red, 3);
    assert_int_equal(image->pixel[20 + 11].g, 255);
    render_image_destroy(&image);
}

static gvc_result save(const render_image *image, const char *path) {
    gvc_output output;
    GVC_TRY(gvc_output_begin(path, true, &output, NULL));
    assert_int_equal(render_image_write(image, &output, NULL), GVC_OK);
    return gvc_output_end(&output, NULL);
}

static void test_png(void **state) {
    (void)state;
    char folder[] = "/tmp/gvc-test-render-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/picture.png", folder);
    render_image *image;
    assert_int_equal(render_image_create(33, 7, red, &image, NULL), GVC_OK);
    assert_int_equal(save(image, path), GVC_OK);
    assert_int_equal(save(image, path), GVC_OK); /* replaces */
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    uint8_t head[24];
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    assert_memory_equal(head, "\x89PNG\r\n\x1a\n", 8);
    assert_int_equal(head[19], 33);
    assert_int_equal(head[23], 7);
    unlink(path);
    assert_int_equal(rmdir(folder), 0); /* nothing else was left there */
    assert_int_equal(save(image, path), GVC_ERROR_IO);
    render_image_destroy(&image);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nearer_hides_farther),
        cmocka_unit_test(test_curves_are_hidden_by_other_surfaces_only),
        cmocka_unit_test(test_vertex_distance),
        cmocka_unit_test(test_geometry_image_and_text),
        cmocka_unit_test(test_png),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
