/* SPDX-License-Identifier: MIT */
/** @file render_png.c  Writes PNG files through libpng. */
#include "render_image.h"

#include "base/memory.h"
#include "base/result.h"

#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void on_error(png_structp png, png_const_charp message) {
    (void)message;
    longjmp(png_jmpbuf(png), 1);
}
static void on_warning(png_structp png, png_const_charp message) {
    (void)png;
    (void)message;
}

/* Everything that must survive the longjmp is a parameter and never assigned. */
static bool write_rows(png_structp png, png_infop info, const render_image *image, FILE *file) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
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

_Static_assert(sizeof(render_color) == 3, "pixels are rows of libpng as they are");

gvc_result render_image_write_stream(const render_image *image, FILE *file, const char *path,
                                     gvc_error *error) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        return gvc_fail_memory(error);
    }
    bool whole = write_rows(png, info, image, file);
    png_destroy_write_struct(&png, &info);
    if (!whole || fflush(file) != 0) {
        return gvc_fail(error, GVC_ERROR_IO, "cannot write %s: %s", path, strerror(errno));
    }
    return GVC_OK;
}

/* mkstemp makes files that only the owner may read; pictures get what the umask allows. The mask
 * can only be read by setting it, so a plain 0644 is used. */
static gvc_result write_beside(const render_image *image, const char *path, char *temporary,
                               gvc_error *error) {
    int descriptor = mkstemp(temporary);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (!file) {
        gvc_result result =
            gvc_fail(error, GVC_ERROR_IO, "cannot write %s: %s", path, strerror(errno));
        if (descriptor >= 0) {
            close(descriptor);
            unlink(temporary);
        }
        return result;
    }
    gvc_result result = render_image_write_stream(image, file, path, error);
    if (result == GVC_OK) fchmod(descriptor, 0644);
    if (fclose(file) != 0 && result == GVC_OK) {
        result = gvc_fail(error, GVC_ERROR_IO, "cannot write %s: %s", path, strerror(errno));
    }
    if (result == GVC_OK && rename(temporary, path) != 0) {
        result = gvc_fail(error, GVC_ERROR_IO, "cannot write %s: %s", path, strerror(errno));
    }
    if (result != GVC_OK) unlink(temporary);
    return result;
}

gvc_result render_image_write(const render_image *image, const char *path, gvc_error *error) {
    if (strcmp(path, "-") == 0)
        return render_image_write_stream(image, stdout, "standard output", error);
    static const char suffix[] = ".XXXXXX";
    size_t length = strlen(path);
    char *temporary = gvc_alloc(length + sizeof suffix, 1);
    if (!temporary) return gvc_fail_memory(error);
    memcpy(temporary, path, length);
    memcpy(temporary + length, suffix, sizeof suffix);
    gvc_result result = write_beside(image, path, temporary, error);
    free(temporary);
    return result;
}
