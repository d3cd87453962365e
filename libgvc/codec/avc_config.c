/* SPDX-License-Identifier: MIT */
/** @file avc_config.c  Checks a decoder configuration record before a codec gets to see it. */
#include "codec/avc_config.h"

#include "base/bytes.h"
#include "codec/nal_bits.h"

#define PROFILE_HIGH_10 110
#define NAL_SPS 7
#define NAL_PPS 8
#define MAX_SPS_SIZE 1024

/* scaling_list() of 7.3.2.1.1.1, only to get past it. */
static void skip_scaling_list(gvc_nal_bits *bits, unsigned count) {
    int64_t last = 8, next = 8;
    for (unsigned i = 0; i < count && !bits->failed; i++) {
        if (next != 0) next = (last + gvc_nal_se(bits) + 256) & 255;
        if (next != 0) last = next;
    }
}

static void skip_picture_order(gvc_nal_bits *bits) {
    uint32_t type = gvc_nal_ue(bits);
    if (type == 0) {
        gvc_nal_ue(bits); /* log2_max_pic_order_cnt_lsb_minus4 */
    } else if (type == 1) {
        gvc_nal_bit(bits);
        gvc_nal_se(bits);
        gvc_nal_se(bits);
        uint32_t cycle = gvc_nal_ue(bits);
        if (cycle > 255) bits->failed = true;
        for (uint32_t i = 0; i < cycle && !bits->failed; i++) gvc_nal_se(bits);
    } else if (type != 2) {
        bits->failed = true;
    }
}

/* Width and height after cropping (Equations 7-13 to 7-22, 4:2:0, frames only); false if they make
 * no sense. */
static bool read_picture_size(gvc_nal_bits *bits, uint64_t *width, uint64_t *height, bool *excess) {
    *width = ((uint64_t)gvc_nal_ue(bits) + 1) * 16;
    *height = ((uint64_t)gvc_nal_ue(bits) + 1) * 16;
    *excess = false;
    if (gvc_nal_bit(bits) != 1) return false; /* frame_mbs_only_flag */
    gvc_nal_bit(bits);                        /* direct_8x8_inference_flag */
    if (gvc_nal_bit(bits)) {
        uint64_t left = gvc_nal_ue(bits), right = gvc_nal_ue(bits);
        uint64_t top = gvc_nal_ue(bits), bottom = gvc_nal_ue(bits);
        if (2 * (left + right) >= *width || 2 * (top + bottom) >= *height) return false;
        *width -= 2 * (left + right);
        *height -= 2 * (top + bottom);
        *excess = 2 * (left + right) >= 16 || 2 * (top + bottom) >= 16;
    }
    return !bits->failed;
}

/* seq_parameter_set_data(), 7.3.2.1.1, as far as the picture size. */
static gvc_result check_sps(const uint8_t *nal, size_t size, uint32_t width, uint32_t height,
                            gvc_avc_facts *facts, gvc_error *error) {
    uint8_t payload[MAX_SPS_SIZE];
    if (size < 5 || size > sizeof payload || (nal[0] & 0x9f) != NAL_SPS) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the sequence parameter set is damaged");
    }
    gvc_nal_bits bits = {.data = payload};
    bits.bit_count = 8 * gvc_nal_unescape(nal + 1, size - 1, payload);
    uint32_t profile = gvc_nal_bits_read(&bits, 8);
    gvc_nal_bits_read(&bits, 16); /* constraint flags, level */
    gvc_nal_ue(&bits);            /* seq_parameter_set_id */
    if (profile != PROFILE_HIGH_10) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "H.264 profile %u is not High 10",
                        (unsigned)profile);
    }
    uint32_t chroma = gvc_nal_ue(&bits), luma_depth = gvc_nal_ue(&bits),
             chroma_depth = gvc_nal_ue(&bits);
    uint32_t bypass = gvc_nal_bit(&bits);
    if (!bits.failed && (chroma != 1 || luma_depth != 2 || chroma_depth != 2 || bypass != 0)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the H.264 stream is not 4:2:0 with 10 bits");
    }
    if (gvc_nal_bit(&bits)) { /* seq_scaling_matrix_present_flag */
        for (unsigned i = 0; i < 8; i++) {
            if (gvc_nal_bit(&bits)) skip_scaling_list(&bits, i < 6 ? 16 : 64);
        }
    }
    uint32_t frame_num_bits = gvc_nal_ue(&bits) + 4;
    skip_picture_order(&bits);
    uint32_t references = gvc_nal_ue(&bits);
    uint32_t gaps = gvc_nal_bit(&bits); /* gaps_in_frame_num_value_allowed_flag */
    uint64_t coded_width, coded_height;
    bool excess, sized = read_picture_size(&bits, &coded_width, &coded_height, &excess);
    if (!sized || bits.failed || references > 16 || frame_num_bits > 16 || gaps) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the sequence parameter set is damaged");
    }
    if (coded_width != width || coded_height != height) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "pictures are %llu x %llu instead of %u x %u",
                        (unsigned long long)coded_width, (unsigned long long)coded_height,
                        (unsigned)width, (unsigned)height);
    }
    if (excess) {
        return gvc_fail(error, GVC_ERROR_LIMIT,
                        "pictures of %u x %u are cropped from much larger ones", (unsigned)width,
                        (unsigned)height);
    }
    *facts = (gvc_avc_facts){.frame_num_bits = frame_num_bits, .references = references};
    return GVC_OK;
}

gvc_result gvc_avc_config_check(const uint8_t *config, size_t size, uint32_t width, uint32_t height,
                                gvc_avc_facts *facts, gvc_error *error) {
    gvc_cursor in = gvc_cursor_make(config, size);
    uint8_t version = gvc_read_u8(&in);
    uint8_t profile = gvc_read_u8(&in);
    gvc_skip(&in, 2); /* constraint flags, level: as in the parameter set */
    uint8_t lengths = gvc_read_u8(&in), sps_count = gvc_read_u8(&in);
    size_t sps_size = gvc_read_u16(&in);
    const uint8_t *sps = gvc_read_bytes(&in, sps_size);
    uint8_t pps_count = gvc_read_u8(&in);
    size_t pps_size = gvc_read_u16(&in);
    const uint8_t *pps = gvc_read_bytes(&in, pps_size);
    if (in.failed || version != 1 || (lengths & 3) != 3 || (sps_count & 31) != 1 ||
        pps_count != 1 || !sps || !pps || pps_size < 2 || (pps[0] & 0x9f) != NAL_PPS) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        "the H.264 configuration record (%zu bytes) is damaged", size);
    }
    if (profile != PROFILE_HIGH_10) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "H.264 profile %u is not High 10",
                        (unsigned)profile);
    }
    /* Fields for the High profiles follow; old muxers leave them out, so they say nothing new. */
    return check_sps(sps, sps_size, width, height, facts, error);
}
