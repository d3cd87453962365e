/* SPDX-License-Identifier: MIT */
/** @file config.c  The `gvcC` box. */
#include "container/config.h"

#include "chart/side_table.h"
#include "container/label.h"

#include <string.h>

void gvc_config_write(const gvc_config *config, gvc_buffer *buffer) {
    gvc_write_u16(buffer, config->version_major);
    gvc_write_u16(buffer, config->version_minor);
    gvc_write_u32(buffer, config->features);
    gvc_write_u32(buffer, config->picture_width);
    gvc_write_u32(buffer, config->plane_height);
    gvc_write_u32(buffer, config->image_size);
    gvc_write_u8(buffer, config->code_bits);
    gvc_write_u8(buffer, config->code_shift);
    gvc_write_u32(buffer, config->frame_rate_num);
    gvc_write_u32(buffer, config->frame_rate_den);
    gvc_write_u64(buffer, config->declared_frames);
    gvc_write_label(buffer, config->unit, sizeof config->unit);
    gvc_write_label(buffer, config->encoder, sizeof config->encoder);
    gvc_write_label(buffer, config->settings, sizeof config->settings);
}

static gvc_result check_picture(const gvc_config *config, gvc_error *error) {
    bool width_fits = config->picture_width >= GVC_MIN_IMAGE_SIZE &&
                      config->picture_width <= GVC_MAX_PICTURE_SIDE &&
                      config->picture_width % 2 == 0;
    bool height_fits = config->plane_height >= GVC_MIN_IMAGE_SIZE &&
                       config->plane_height <= GVC_MAX_PICTURE_SIDE / 3 &&
                       config->plane_height % 2 == 0;
    if (!width_fits || !height_fits) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a plane of %u x %u samples cannot be",
                        config->picture_width, config->plane_height);
    }
    if (config->image_size < GVC_MIN_IMAGE_SIZE || config->image_size > GVC_MAX_IMAGE_SIZE) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a geometry image of %u samples per side",
                        config->image_size);
    }
    if (config->code_bits != 10 || config->code_shift != 6) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "codes of %u bits shifted by %u",
                        config->code_bits, config->code_shift);
    }
    if (config->frame_rate_num == 0 || config->frame_rate_den == 0) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a frame rate of %u/%u", config->frame_rate_num,
                        config->frame_rate_den);
    }
    if (config->declared_frames > UINT64_MAX / config->frame_rate_den) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%llu frames do not fit in time",
                        (unsigned long long)config->declared_frames);
    }
    return GVC_OK;
}

gvc_result gvc_config_read(gvc_cursor *cursor, gvc_config *config, gvc_error *error) {
    memset(config, 0, sizeof *config);
    config->version_major = gvc_read_u16(cursor);
    config->version_minor = gvc_read_u16(cursor);
    config->features = gvc_read_u32(cursor);
    /* Before anything else is believed: another version may mean other fields. */
    if (!cursor->failed && config->version_major > GVC_FORMAT_MAJOR) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "format version %u.%u; known up to %d.x",
                        config->version_major, config->version_minor, GVC_FORMAT_MAJOR);
    }
    if (!cursor->failed && config->features & ~GVC_FEATURE_EXACT) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "features 0x%08x are not known here",
                        config->features & ~GVC_FEATURE_EXACT);
    }
    config->picture_width = gvc_read_u32(cursor);
    config->plane_height = gvc_read_u32(cursor);
    config->image_size = gvc_read_u32(cursor);
    config->code_bits = gvc_read_u8(cursor);
    config->code_shift = gvc_read_u8(cursor);
    config->frame_rate_num = gvc_read_u32(cursor);
    config->frame_rate_den = gvc_read_u32(cursor);
    config->declared_frames = gvc_read_u64(cursor);
    bool whole = gvc_read_label(cursor, config->unit, sizeof config->unit) &&
                 gvc_read_label(cursor, config->encoder, sizeof config->encoder) &&
                 gvc_read_label(cursor, config->settings, sizeof config->settings);
    if (cursor->failed) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "%zu bytes are too few for a configuration",
                        cursor->size);
    }
    if (!whole) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a text is too long or not plain UTF-8");
    }
    return check_picture(config, error);
}

gvc_result gvc_config_equal(const gvc_config *a, const gvc_config *b, bool *equal,
                            gvc_error *error) {
    gvc_buffer one = {0}, other = {0};
    gvc_config_write(a, &one);
    gvc_config_write(b, &other);
    bool failed = one.failed || other.failed;
    *equal = !failed && one.size == other.size && memcmp(one.data, other.data, one.size) == 0;
    gvc_buffer_free(&one);
    gvc_buffer_free(&other);
    return failed ? gvc_fail_memory(error) : GVC_OK;
}
