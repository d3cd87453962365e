/* SPDX-License-Identifier: MIT */
/** @file render_png.c  Writes PNG files through libpng. */
#include "render_image.h"

#include <png.h>
#include <setjmp.h>

_Static_assert(sizeof(render_color) == 3, "pixels are rows of libpng as they are");

/* Where the bytes go, and why they did not. */
typedef struct png_target {
    gvc_output *output;
    gvc_result result;
    gvc_error *error;
} png_target;

static void on_error(png_structp png, png_const_charp message) {
    (void)message;
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

static void on_data(png_structp png, png_bytep data, size_t size) {
    png_target *target = png_get_io_ptr(png);
    target->result = gvc_output_write(target->output, data, size, target->error);
    if (target->result != GVC_OK) png_error(png, "cannot write");
}

static void on_flush(png_structp png) { (void)png; }

/* Everything that must survive the longjmp is a parameter and never assigned. */
static bool write_rows(png_structp png, png_infop info, const render_image *image,
                       png_target *target) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, target, on_data, on_flush);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (size_t y = 0; y < image->height; y++) {
        png_write_row(png, (png_const_bytep)(const void *)&image->pixel[y * image->width]);
    }
    png_write_end(png, NULL);
    return true;
}

gvc_result render_image_write(const render_image *image, gvc_output *output, gvc_error *error) {
    png_target target = {.output = output, .result = GVC_OK, .error = error};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool whole = info && write_rows(png, info, image, &target);
    png_destroy_write_struct(&png, &info);
    /* What libpng fails for by itself is want of memory. */
    return whole || target.result != GVC_OK ? target.result : gvc_fail_memory(error);
}
