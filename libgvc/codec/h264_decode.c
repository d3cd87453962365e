/* SPDX-License-Identifier: MIT */
/** @file h264_decode.c  H.264 High 10 to 10-bit luma pictures with libavcodec's own decoder.
 * Strict: a picture is either as coded or an error, never concealed. */
#include "codec/avc_config.h"
#include "codec/h264.h"
#include "codec/nal_bits.h"

#include "base/memory.h"

#include <libavcodec/avcodec.h>
#include <libavutil/pixdesc.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Added to the level of every message of a context: more than the least important level of libav's
 * log, so none is shown, without touching the process-wide log level. (Only eight bits are the
 * level.)
 */
#define QUIET 128

/* Table 7-1 of ISO/IEC 14496-10. */
enum { NAL_SLICE = 1, NAL_IDR = 5, NAL_SEI = 6, NAL_AUD = 9, NAL_FILLER = 12 };

struct gvc_h264_decoder {
    AVCodecContext *context;
    AVFrame *frame;
    AVPacket *packet;
    size_t width, height;
    uint64_t sent, received;      /* pictures since the last reset */
    uint64_t most_pictures;       /* that may be held at a time */
    uint64_t most_bytes;          /* of a packet */
    uint64_t pictures;            /* held by the codec or by `frame` */
    bool over;                    /* one more was asked for */
    uint8_t mark;                 /* what the buffers that count pictures point at */
    unsigned frame_num_bits;      /* length of frame_num in slice headers */
    uint32_t reference_frame_num; /* frame_num of the previous reference picture */
    int reorder_depth;     /* the context's at the beginning; it grows with what is decoded */
    bool stopped;          /* nothing more is taken: a packet was bad */
    bool flushed, drained; /* the codec was told of the end; it has nothing left */
    bool failed;           /* for a reason that says nothing of the stream */
};

static gvc_result fail_av(gvc_h264_decoder *d, int status, gvc_error *error) {
    if (d->over) {
        d->failed = true;
        return gvc_fail(
            error, GVC_ERROR_LIMIT,
            "the H.264 stream needs more than %llu pictures at a time, which fit in the "
            "memory allowed",
            (unsigned long long)d->most_pictures);
    }
    d->failed = status == AVERROR(ENOMEM);
    if (d->failed) return gvc_fail_memory(error);
    return gvc_fail(error, GVC_ERROR_CORRUPT, "the H.264 data of a picture is damaged");
}

void gvc_h264_decoder_destroy(gvc_h264_decoder **decoder) {
    if (!decoder || !*decoder) return;
    av_frame_free(&(*decoder)->frame);
    av_packet_free(&(*decoder)->packet);
    avcodec_free_context(&(*decoder)->context);
    free(*decoder);
    *decoder = NULL;
}

/* --------------------------------------------------------------------------------------------
 * memory
 */

/* libavcodec keeps up to 16 pictures for reference and as many until it is their turn. A stream can
 * make it do both, whatever it declares, so pictures are counted where they are made. */

static void picture_released(void *opaque, uint8_t *data) {
    (void)data;
    ((gvc_h264_decoder *)opaque)->pictures--;
}

static int take_picture(AVCodecContext *context, AVFrame *frame, int flags) {
    gvc_h264_decoder *d = context->opaque;
    if (d->pictures >= d->most_pictures) {
        d->over = true;
        return AVERROR(ENOMEM);
    }
    int status = avcodec_default_get_buffer2(context, frame, flags);
    if (status < 0) return status;
    /* Planes are in the first three; this one is released with the last reference to them. */
    frame->buf[3] = av_buffer_create(&d->mark, sizeof d->mark, picture_released, d, 0);
    if (!frame->buf[3]) {
        av_frame_unref(frame);
        return AVERROR(ENOMEM);
    }
    d->pictures++;
    return 0;
}

/* What libavcodec 59 takes: of a picture two bytes for each sample in rows and columns that are
 * padded a little, and 141 for each macroblock (motion, references, types); once, less than 256 for
 * each macroblock; and contexts of a fixed size. Of a packet there is a copy, and one without
 * escapes that is larger by a sixteenth. */
#define MACROBLOCK_BYTES 141u
#define TABLE_BYTES 256u
#define CONTEXT_BYTES (UINT64_C(5) << 18)
#define PACKET_COPIES 3u
#define PACKET_SHARE 16u /* of the memory is for a packet */

static gvc_result share_memory(gvc_h264_decoder *d, uint64_t max_memory, unsigned references,
                               gvc_error *error) {
    uint64_t columns = (d->width + 127) / 64 * 64, rows = (d->height + 63) / 16 * 16;
    uint64_t macroblocks = columns * rows / 256;
    uint64_t picture = columns * rows * 3 + macroblocks * MACROBLOCK_BYTES + 4096;
    uint64_t once = CONTEXT_BYTES + macroblocks * TABLE_BYTES;
    uint64_t packets = max_memory / PACKET_SHARE;
    uint64_t left = max_memory - packets > once ? max_memory - packets - once : 0;
    d->most_bytes = packets / PACKET_COPIES;
    d->most_pictures = left / picture;
    /* Besides those referred to, the one being decoded and the one handed out. */
    if (d->most_pictures >= references + UINT64_C(2)) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_LIMIT,
                    "%u pictures of %zu x %zu take %llu MiB to decode, more than the limit",
                    references + 2, d->width, d->height,
                    (unsigned long long)((once + (references + 2) * picture) >> 20));
}

/* libavcodec checks its limit against padded rows. */
static size_t align_64(size_t value) { return (value + 63) / 64 * 64; }

static gvc_result open_decoder(gvc_h264_decoder *d, const uint8_t *config, size_t config_size,
                               gvc_error *error) {
    /* By name, so that no hardware decoder, which may conceal, is chosen. */
    const AVCodec *codec = avcodec_find_decoder_by_name("h264");
    if (!codec) return gvc_fail(error, GVC_ERROR_UNSUPPORTED, "libavcodec has no H.264 decoder");
    AVCodecContext *c = d->context = avcodec_alloc_context3(codec);
    d->frame = av_frame_alloc();
    d->packet = av_packet_alloc();
    if (!c || !d->frame || !d->packet) return gvc_fail_memory(error);
    c->extradata = av_mallocz(config_size + AV_INPUT_BUFFER_PADDING_SIZE);
    if (!c->extradata) return gvc_fail_memory(error);
    memcpy(c->extradata, config, config_size);
    c->extradata_size = (int)config_size;
    c->opaque = d;
    c->get_buffer2 = take_picture;
    c->log_level_offset = QUIET;
    c->thread_count = 1;
    c->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
    /* Output order by the standard even where the stream does not state its reorder depth. */
    c->strict_std_compliance = FF_COMPLIANCE_STRICT;
    c->max_pixels = (int64_t)(align_64(d->width) * align_64(d->height));
    int status = avcodec_open2(c, codec, NULL);
    d->reorder_depth = c->has_b_frames;
    return status < 0 ? fail_av(d, status, error) : GVC_OK;
}

gvc_result gvc_h264_decoder_create(const uint8_t *config, size_t config_size, uint32_t width,
                                   uint32_t height, uint64_t max_memory, gvc_h264_decoder **decoder,
                                   gvc_error *error) {
    *decoder = NULL;
    if (!width || !height || width > INT16_MAX || height > INT16_MAX) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "no picture has %u x %u samples",
                        (unsigned)width, (unsigned)height);
    }
    gvc_avc_facts facts;
    GVC_TRY(gvc_avc_config_check(config, config_size, width, height, &facts, error));
    if (config_size > INT_MAX - AV_INPUT_BUFFER_PADDING_SIZE) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "the H.264 configuration record is too large");
    }
    gvc_h264_decoder *d = gvc_alloc(1, sizeof *d);
    if (!d) return gvc_fail_memory(error);
    d->width = width;
    d->height = height;
    d->frame_num_bits = facts.frame_num_bits;
    gvc_result result = share_memory(d, max_memory, facts.references, error);
    if (result == GVC_OK) result = open_decoder(d, config, config_size, error);
    if (result != GVC_OK) gvc_h264_decoder_destroy(&d);
    *decoder = d;
    return result;
}

void gvc_h264_decoder_reset(gvc_h264_decoder *decoder) {
    avcodec_flush_buffers(decoder->context);
    /* Else a stream that needs more than it states would decode in better order the second time. */
    decoder->context->has_b_frames = decoder->reorder_depth;
    decoder->sent = decoder->received = 0;
    decoder->stopped = decoder->flushed = decoder->drained = false;
    decoder->failed = decoder->over = false;
}

/* What the head of a slice says (7.3.3) of the picture it is part of. */
typedef struct slice_head {
    uint32_t first_macroblock, frame_num;
    bool reference;
} slice_head;

/* False if the head is not whole. `nal` is a NAL unit of at least two bytes. */
static bool read_slice_head(const uint8_t *nal, size_t size, unsigned frame_num_bits,
                            slice_head *head) {
    enum { HEADER = 24 }; /* enough for three ue(v) of any legal value and frame_num */
    uint8_t payload[HEADER];
    gvc_nal_bits bits = {.data = payload};
    bits.bit_count = 8 * gvc_nal_unescape(nal + 1, size - 1 < HEADER ? size - 1 : HEADER, payload);
    head->first_macroblock = gvc_nal_ue(&bits);
    gvc_nal_ue(&bits); /* slice_type */
    gvc_nal_ue(&bits); /* pic_parameter_set_id */
    head->frame_num = gvc_nal_bits_read(&bits, frame_num_bits);
    head->reference = nal[0] & 0x60; /* nal_ref_idc */
    return !bits.failed;
}

/* All slices of a sample belong to one picture (7.4.1.2.4): they come in the order of their
 * macroblocks, from the first one of the picture on. `before` is NULL for the first slice. */
static bool slice_follows(const slice_head *before, const slice_head *head) {
    if (!before) return head->first_macroblock == 0;
    return head->first_macroblock > before->first_macroblock &&
           head->frame_num == before->frame_num && head->reference == before->reference;
}

static gvc_result check_slice_type(unsigned type, bool keyframe, gvc_error *error) {
    if (type != NAL_SLICE && type != NAL_IDR) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "NAL unit type %u does not belong in a sample",
                        type);
    }
    if (keyframe != (type == NAL_IDR)) {
        return gvc_fail(error, GVC_ERROR_CORRUPT,
                        keyframe ? "the first picture of a group is no IDR picture"
                                 : "an IDR picture stands inside a group");
    }
    return GVC_OK;
}

/* In a byte stream a NAL unit ends where a start code begins (Annex B), so what stands behind one
 * inside of a unit would be another unit there, a parameter set perhaps (7.4.1). */
static bool holds_start_code(const uint8_t *nal, size_t size) {
    for (size_t i = 2; i < size; i++) {
        if (nal[i] <= 2 && nal[i - 1] == 0 && nal[i - 2] == 0) return true;
    }
    return nal[size - 1] == 0;
}

static gvc_result fail_units(gvc_error *error) {
    return gvc_fail(error, GVC_ERROR_CORRUPT, "the NAL units of a sample do not fill it");
}

/* Measures the slices of an AVC sample, and with `out` copies them: parameter sets must not stand
 * there (they could change the size of the pictures); SEI and delimiters say nothing about samples
 * and are left out. `head` gets the head of the last slice. */
static gvc_result copy_slices(const gvc_h264_decoder *d, const uint8_t *data, size_t size,
                              uint8_t *out, size_t *copied, slice_head *head, gvc_error *error) {
    gvc_cursor in = gvc_cursor_make(data, size);
    size_t length = 0;
    while (gvc_cursor_left(&in) > 0) {
        size_t begin = in.position, nal_size = gvc_read_u32(&in);
        const uint8_t *nal = gvc_read_bytes(&in, nal_size);
        if (in.failed || !nal || nal_size < 2) return fail_units(error);
        unsigned type = nal[0] & 31;
        if (!out && holds_start_code(nal, nal_size)) {
            return gvc_fail(error, GVC_ERROR_CORRUPT, "a NAL unit with a start code inside");
        }
        if (type == NAL_SEI || type == NAL_AUD || type == NAL_FILLER) continue;
        if (nal[0] & 0x80) {
            return gvc_fail(error, GVC_ERROR_CORRUPT, "the head of a NAL unit is damaged");
        }
        GVC_TRY(check_slice_type(type, d->sent == 0, error));
        slice_head before = *head;
        if (!read_slice_head(nal, nal_size, d->frame_num_bits, head) ||
            !slice_follows(length ? &before : NULL, head)) {
            return gvc_fail(error, GVC_ERROR_CORRUPT,
                            "the slices of a sample are not those of one picture");
        }
        if (out) memcpy(out + length, data + begin, 4 + nal_size);
        length += 4 + nal_size;
    }
    if (length == 0) return fail_units(error);
    *copied = length;
    return GVC_OK;
}

/* libavcodec makes up a picture where a reference is missing. frame_num tells (7.4.3): it is one
 * more than that of the previous reference picture. */
static gvc_result check_frame_num(gvc_h264_decoder *d, const slice_head *head, gvc_error *error) {
    uint32_t mask = (UINT32_C(1) << d->frame_num_bits) - 1;
    uint32_t expected = d->sent == 0 ? 0 : (d->reference_frame_num + 1) & mask;
    if (head->frame_num != expected)
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a reference picture is missing");
    if (head->reference) d->reference_frame_num = head->frame_num;
    return GVC_OK;
}

static gvc_result send_packet(gvc_h264_decoder *d, const uint8_t *data, size_t size,
                              int64_t presentation, gvc_error *error) {
    size_t length;
    slice_head head = {0};
    GVC_TRY(copy_slices(d, data, size, NULL, &length, &head, error));
    GVC_TRY(check_frame_num(d, &head, error));
    if (length > INT_MAX - AV_INPUT_BUFFER_PADDING_SIZE || length > d->most_bytes) {
        return gvc_fail(error, GVC_ERROR_LIMIT, "a picture of %zu bytes is too large", length);
    }
    int status = av_new_packet(d->packet, (int)length); /* padded with zeros */
    if (status < 0) return fail_av(d, status, error);
    GVC_TRY(copy_slices(d, data, size, d->packet->data, &length, &head, error));
    d->packet->pts = presentation;
    if (d->sent == 0) d->packet->flags |= AV_PKT_FLAG_KEY;
    status = avcodec_send_packet(d->context, d->packet);
    av_packet_unref(d->packet);
    if (status == AVERROR(EAGAIN)) {
        return gvc_fail(error, GVC_ERROR_ARGUMENT, "decoded pictures must be taken first");
    }
    if (status < 0) return fail_av(d, status, error);
    d->sent++;
    return GVC_OK;
}

static gvc_result fail_state(gvc_error *error) {
    return gvc_fail(error, GVC_ERROR_ARGUMENT, "the H.264 decoder must be reset first");
}

gvc_result gvc_h264_decoder_send(gvc_h264_decoder *decoder, const uint8_t *data, size_t size,
                                 int64_t presentation, gvc_error *error) {
    gvc_h264_decoder *d = decoder;
    if (d->failed || d->flushed || d->stopped) return fail_state(error);
    gvc_result result = send_packet(d, data, size, presentation, error);
    if (result == GVC_ERROR_CORRUPT) d->stopped = true;
    if (result == GVC_ERROR_LIMIT || result == GVC_ERROR_MEMORY) d->failed = true;
    return result;
}

gvc_result gvc_h264_decoder_flush(gvc_h264_decoder *decoder, gvc_error *error) {
    gvc_h264_decoder *d = decoder;
    if (d->failed || d->flushed) return fail_state(error);
    d->flushed = true;
    int status = avcodec_send_packet(d->context, NULL);
    return status < 0 ? fail_av(d, status, error) : GVC_OK;
}

static gvc_result check_frame(gvc_h264_decoder *d, gvc_error *error) {
    const AVFrame *f = d->frame;
    if (f->format != AV_PIX_FMT_YUV420P10 || f->width != (int)d->width ||
        f->height != (int)d->height) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a picture decodes to %d x %d of another format",
                        f->width, f->height);
    }
    if (f->decode_error_flags || f->flags & AV_FRAME_FLAG_CORRUPT) {
        return gvc_fail(error, GVC_ERROR_CORRUPT, "a picture is coded incompletely");
    }
    return GVC_OK;
}

/* The codec says that nothing is left. */
static gvc_result end_stream(gvc_h264_decoder *d, gvc_error *error) {
    d->drained = true;
    if (d->received == d->sent) return GVC_OK;
    return gvc_fail(error, GVC_ERROR_CORRUPT, "%llu packets decode to %llu pictures",
                    (unsigned long long)d->sent, (unsigned long long)d->received);
}

gvc_result gvc_h264_decoder_receive(gvc_h264_decoder *decoder, uint16_t *luma,
                                    int64_t *presentation, bool *available, gvc_error *error) {
    gvc_h264_decoder *d = decoder;
    *available = false;
    if (d->failed) return fail_state(error);
    if (d->drained) return GVC_OK;
    int status = avcodec_receive_frame(d->context, d->frame);
    if (status == AVERROR(EAGAIN)) return GVC_OK;
    if (status == AVERROR_EOF) return end_stream(d, error);
    if (status < 0) {
        d->drained = d->flushed; /* so that a stream of errors has an end */
        return fail_av(d, status, error);
    }
    d->received++;
    gvc_result result = check_frame(d, error);
    if (result == GVC_OK) {
        for (size_t y = 0; y < d->height; y++) {
            memcpy(luma + y * d->width, d->frame->data[0] + (ptrdiff_t)y * d->frame->linesize[0],
                   d->width * sizeof *luma);
        }
        *presentation = d->frame->pts;
        *available = true;
    }
    av_frame_unref(d->frame);
    return result;
}
