/* SPDX-License-Identifier: MIT */
/** @file h264_encode.c  One group of 10-bit luma pictures to H.264 High 10, with libx264 through
 * libavcodec. */
#include "codec/h264.h"

#include "base/memory.h"

#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
#include <limits.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_LUMA 1023
#define CHROMA 512
/* x264 turns rate factors below this (QP 0 after its bit depth offset) into the transform bypass of
 * the High 4:4:4 Predictive profile, which is another profile than the file promises. */
#define LEAST_RATE_FACTOR (-11.0)

/* Added to the level of every message of a context: more than the least important level of libav's
 * log, so none is shown, without touching the process-wide log level. (Only eight bits are the
 * level.)
 */
#define QUIET 128

/* Table 7-1 of ISO/IEC 14496-10. */
enum { NAL_SLICE = 1, NAL_IDR = 5, NAL_SPS = 7, NAL_PPS = 8 };

/* Settings that reach the parameter sets or shape the group, the same for every effort. The
 * psychovisual tools spend bits for the eye; here only the squared error counts. `stitchable` and
 * an infinite `keyint` keep crf and the number of pictures out of the parameter sets;
 * macroblock-tree would make results depend on the processor. Coarser quantisers in B pictures
 * (`pbratio`), a stronger deblocking filter and few references suit small smooth pictures: measured
 * on geometry images. */
#define COMMON_SETTINGS                                                                            \
    "psy=0:chroma-qp-offset=0:mbtree=0:qcomp=1:pbratio=1.6:scenecut=0:bframes=8:"                  \
    "b-pyramid=normal:ref=4:weightp=0:weightb=1:8x8dct=1:cabac=1:deblock=2,2:"                     \
    "keyint=infinite:min-keyint=1:open-gop=0:direct=spatial:partitions=i4x4,i8x8,b8x8:"            \
    "dct-decimate=0:threads=1:lookahead_threads=1:sliced-threads=0:stitchable=1:force-cfr=1:"      \
    "cpu-independent=1:log=-1:"
/* Adaptive quantisation of no strength to speak of: x264 searches the quantiser of every macroblock
 * for the least cost (subme above 9) only where adaptive quantisation is on. */
#define FINAL_SETTINGS                                                                             \
    "aq-mode=1:aq-strength=0.01:b-adapt=2:me=umh:merange=16:subme=11:trellis=2:rc-lookahead=60:"   \
    "fast-pskip=0"
#define TRIAL_SETTINGS "aq-mode=0:b-adapt=1:me=hex:merange=16:subme=7:trellis=1:rc-lookahead=20"

typedef struct encoder {
    AVCodecContext *context;
    AVFrame *frame;
    AVPacket *packet;
    size_t packet_capacity;
} encoder;

static gvc_result fail_av(gvc_error *error, int status, const char *what) {
    if (status == AVERROR(ENOMEM)) return gvc_fail_memory(error);
    char text[AV_ERROR_MAX_STRING_SIZE] = "";
    av_strerror(status, text, sizeof text);
    return gvc_fail(error, GVC_ERROR_INTERNAL, "%s: %s", what, text);
}

void gvc_coded_group_free(gvc_coded_group *group) {
    if (!group) return;
    for (size_t i = 0; i < group->packet_count; i++) free(group->packet[i].data);
    free(group->packet);
    free(group->config);
    *group = (gvc_coded_group){0};
}

static gvc_result check_arguments(const gvc_h264_options *options, size_t count, gvc_error *error) {
    if (!options->width || !options->height || options->width % 2 || options->height % 2 ||
        options->width > INT16_MAX || options->height > INT16_MAX) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a picture of %u x %u cannot be coded",
                        (unsigned)options->width, (unsigned)options->height);
    }
    if (!options->frame_rate_num || !options->frame_rate_den ||
        options->frame_rate_num > INT32_MAX || options->frame_rate_den > INT32_MAX) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "frame rate %u/%u is not positive and finite",
                        (unsigned)options->frame_rate_num, (unsigned)options->frame_rate_den);
    }
    if (!(options->crf >= -12 && options->crf <= 51)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "rate factor %g is not within -12 and 51",
                        options->crf);
    }
    if (count == 0 || count > INT32_MAX) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "a group of %zu pictures cannot be coded",
                        count);
    }
    return GVC_OK;
}

static void append_text(gvc_buffer *text, const char *more) {
    gvc_write_bytes(text, more, strlen(more));
}

/* x264 rounds quantisers to whole numbers, and a whole step is a tenth of the bytes. So a rate
 * factor between two whole ones is that share of the group coded a step finer (`zones`: pictures
 * first,last with their bits times 2^(1/6)). */
static void append_zone(gvc_buffer *text, double share, size_t count) {
    size_t finer = (size_t)(share * (double)count + 0.5);
    char zone[64];
    if (finer == 0) return;
    snprintf(zone, sizeof zone, ":zones=0,%zu,b=1.122462", finer - 1);
    append_text(text, zone);
}

/* Settings as x264 reads them; NUL-terminated. */
static void format_settings(gvc_buffer *text, const gvc_h264_options *options, size_t count) {
    char number[32];
    append_text(text, COMMON_SETTINGS);
    append_text(text, options->effort ? FINAL_SETTINGS : TRIAL_SETTINGS);
    if (options->crf < LEAST_RATE_FACTOR) {
        /* -12 asks for the finest quantiser in every picture */
        snprintf(number, sizeof number, ":crf=%d", (int)LEAST_RATE_FACTOR);
        append_text(text, number);
        append_text(text, ":qpmax=0:trellis=0:deadzone-inter=0:deadzone-intra=0");
    } else {
        double coarser = ceil(options->crf);
        snprintf(number, sizeof number, ":crf=%d", (int)coarser);
        append_text(text, number);
        append_zone(text, coarser - options->crf, count);
    }
    gvc_write_u8(text, '\0');
}

/* x264 reads numbers with atof, which follows the locale; the calling thread's is changed meanwhile
 * (others are not touched). */
static int open_in_c_locale(AVCodecContext *context, const AVCodec *codec) {
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c_locale == (locale_t)0) return AVERROR(ENOMEM);
    locale_t callers = uselocale(c_locale);
    int status = avcodec_open2(context, codec, NULL);
    uselocale(callers);
    freelocale(c_locale);
    return status;
}

static gvc_result open_encoder(encoder *e, const gvc_h264_options *options, size_t count,
                               gvc_error *error) {
    const AVCodec *codec = avcodec_find_encoder_by_name("libx264");
    if (!codec) {
        return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "libavcodec was built without libx264");
    }
    AVCodecContext *c = e->context = avcodec_alloc_context3(codec);
    if (!c) return gvc_fail_memory(error);
    c->log_level_offset = QUIET;
    c->width = (int)options->width;
    c->height = (int)options->height;
    c->pix_fmt = AV_PIX_FMT_YUV420P10;
    c->color_range = AVCOL_RANGE_JPEG;
    c->framerate = (AVRational){(int)options->frame_rate_num, (int)options->frame_rate_den};
    c->time_base = av_inv_q(c->framerate);
    c->thread_count = 1;
    c->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_CLOSED_GOP;
    gvc_buffer settings = {0};
    format_settings(&settings, options, count);
    int status =
        settings.failed ? AVERROR(ENOMEM) : av_opt_set(c->priv_data, "profile", "high10", 0);
    if (status >= 0) {
        status = av_opt_set(c->priv_data, "x264-params", (const char *)settings.data, 0);
    }
    gvc_buffer_free(&settings);
    if (status >= 0) status = open_in_c_locale(c, codec);
    return status < 0 ? fail_av(error, status, "libx264 does not open") : GVC_OK;
}

static gvc_result make_frame(encoder *e, gvc_error *error) {
    e->frame = av_frame_alloc();
    e->packet = av_packet_alloc();
    if (!e->frame || !e->packet) return gvc_fail_memory(error);
    e->frame->format = e->context->pix_fmt;
    e->frame->width = e->context->width;
    e->frame->height = e->context->height;
    e->frame->color_range = e->context->color_range;
    int status = av_frame_get_buffer(e->frame, 0);
    return status < 0 ? fail_av(error, status, "no picture buffer") : GVC_OK;
}

static gvc_result fill_frame(encoder *e, const uint16_t *luma, size_t index, gvc_error *error) {
    AVFrame *frame = e->frame;
    int status = av_frame_make_writable(frame); /* x264 may still hold the previous picture */
    if (status < 0) return fail_av(error, status, "no picture buffer");
    size_t width = (size_t)frame->width, height = (size_t)frame->height;
    for (size_t y = 0; y < height; y++) {
        uint16_t *row = (uint16_t *)(void *)(frame->data[0] + (ptrdiff_t)y * frame->linesize[0]);
        for (size_t x = 0; x < width; x++) {
            row[x] = luma[y * width + x];
            if (row[x] > MAX_LUMA) {
                return gvc_fail(error, GVC_ERROR_ARGUMENT,
                                "sample %u at (%zu, %zu) of picture %zu has more than 10 bits",
                                (unsigned)row[x], x, y, index);
            }
        }
    }
    for (int plane = 1; plane <= 2; plane++) {
        for (size_t y = 0; y < height / 2; y++) {
            uint8_t *line = frame->data[plane] + (ptrdiff_t)y * frame->linesize[plane];
            uint16_t *row = (uint16_t *)(void *)line;
            for (size_t x = 0; x < width / 2; x++) row[x] = CHROMA;
        }
    }
    frame->pts = (int64_t)index;
    return GVC_OK;
}

/* ISO/IEC 14496-10 Annex B: NAL units stand between start codes 00 00 01; zero bytes may precede
 * one. Gives the next unit at or after *position, and moves there behind it. */
static bool next_annex_b(const uint8_t *data, size_t size, size_t *position, const uint8_t **nal,
                         size_t *nal_size) {
    size_t begin = *position;
    while (begin + 3 <= size && !(data[begin] == 0 && data[begin + 1] == 0 && data[begin + 2] == 1))
        begin++;
    if (begin + 3 >= size) return false;
    begin += 3;
    size_t end = begin;
    while (end < size &&
           !(end + 3 <= size && data[end] == 0 && data[end + 1] == 0 && data[end + 2] <= 1))
        end++;
    *position = end;
    while (end > begin && data[end - 1] == 0) end--; /* a unit never ends in a zero byte */
    *nal = data + begin;
    *nal_size = end - begin;
    return *nal_size > 0;
}

/* AVCDecoderConfigurationRecord, ISO/IEC 14496-15 5.3.3.1, with the fields for the High profiles.
 */
static gvc_result make_config(const AVCodecContext *context, gvc_coded_group *group,
                              gvc_error *error) {
    const uint8_t *sps = NULL, *pps = NULL, *nal;
    size_t sps_size = 0, pps_size = 0, nal_size, position = 0;
    size_t size = context->extradata_size > 0 ? (size_t)context->extradata_size : 0;
    while (next_annex_b(context->extradata, size, &position, &nal, &nal_size)) {
        if ((nal[0] & 31) == NAL_SPS) sps = nal, sps_size = nal_size;
        if ((nal[0] & 31) == NAL_PPS) pps = nal, pps_size = nal_size;
    }
    if (!sps || !pps || sps_size < 4 || sps_size > UINT16_MAX || pps_size > UINT16_MAX) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "libx264 gave no usable parameter sets");
    }
    gvc_buffer out = {0};
    gvc_write_u8(&out, 1);
    gvc_write_bytes(&out, sps + 1, 3); /* profile, constraints, level */
    gvc_write_u8(&out, 0xfc | 3);      /* NAL unit lengths have four bytes */
    gvc_write_u8(&out, 0xe0 | 1);
    gvc_write_u16(&out, (uint16_t)sps_size);
    gvc_write_bytes(&out, sps, sps_size);
    gvc_write_u8(&out, 1);
    gvc_write_u16(&out, (uint16_t)pps_size);
    gvc_write_bytes(&out, pps, pps_size);
    gvc_write_u8(&out, 0xfc | 1); /* chroma_format 4:2:0 */
    gvc_write_u8(&out, 0xf8 | 2); /* bit_depth_luma_minus8 */
    gvc_write_u8(&out, 0xf8 | 2); /* bit_depth_chroma_minus8 */
    gvc_write_u8(&out, 0);        /* no SPS extensions */
    if (out.failed) {
        gvc_buffer_free(&out);
        return gvc_fail_memory(error);
    }
    group->config = out.data;
    group->config_size = out.size;
    return GVC_OK;
}

/* Appends the packet's slices as an AVC sample. */
static gvc_result keep_packet(encoder *e, gvc_coded_group *group, gvc_error *error) {
    const AVPacket *packet = e->packet;
    gvc_buffer out = {0};
    const uint8_t *nal;
    size_t nal_size, position = 0;
    while (next_annex_b(packet->data, (size_t)packet->size, &position, &nal, &nal_size)) {
        unsigned type = nal[0] & 31;
        if (type != NAL_SLICE && type != NAL_IDR) continue;
        gvc_write_u32(&out, (uint32_t)nal_size);
        gvc_write_bytes(&out, nal, nal_size);
    }
    if (out.failed || !gvc_grow((void **)&group->packet, &e->packet_capacity,
                                group->packet_count + 1, sizeof *group->packet)) {
        gvc_buffer_free(&out);
        return gvc_fail_memory(error);
    }
    group->packet[group->packet_count++] = (gvc_packet){
        .data = out.data,
        .size = out.size,
        .presentation = (uint32_t)packet->pts,
        .keyframe = (packet->flags & AV_PKT_FLAG_KEY) != 0,
    };
    return GVC_OK;
}

/* Takes what the encoder has ready; at the end (after a NULL frame) everything. */
static gvc_result take_packets(encoder *e, gvc_coded_group *group, gvc_error *error) {
    for (;;) {
        int status = avcodec_receive_packet(e->context, e->packet);
        if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return GVC_OK;
        if (status < 0) return fail_av(error, status, "libx264 fails");
        gvc_result result = keep_packet(e, group, error);
        av_packet_unref(e->packet);
        if (result != GVC_OK) return result;
    }
}

static gvc_result encode_pictures(encoder *e, const uint16_t *const *luma, size_t count,
                                  gvc_coded_group *group, gvc_error *error) {
    for (size_t i = 0; i <= count; i++) {
        if (i < count) GVC_TRY(fill_frame(e, luma[i], i, error));
        int status = avcodec_send_frame(e->context, i < count ? e->frame : NULL);
        if (status < 0) return fail_av(error, status, "libx264 refuses a picture");
        GVC_TRY(take_packets(e, group, error));
    }
    if (group->packet_count != count || !group->packet[0].keyframe) {
        return gvc_fail(error, GVC_ERROR_INTERNAL, "libx264 gave %zu packets for %zu pictures",
                        group->packet_count, count);
    }
    return GVC_OK;
}

gvc_result gvc_h264_encode(const gvc_h264_options *options, const uint16_t *const *luma,
                           size_t count, gvc_coded_group *group, gvc_error *error) {
    *group = (gvc_coded_group){0};
    GVC_TRY(check_arguments(options, count, error));
    encoder e = {0};
    gvc_result result;
    GVC_CHECK(open_encoder(&e, options, count, error));
    GVC_CHECK(make_frame(&e, error));
    GVC_CHECK(make_config(e.context, group, error));
    GVC_CHECK(encode_pictures(&e, luma, count, group, error));
cleanup:
    av_frame_free(&e.frame);
    av_packet_free(&e.packet);
    avcodec_free_context(&e.context);
    if (result != GVC_OK) gvc_coded_group_free(group);
    return result;
}
