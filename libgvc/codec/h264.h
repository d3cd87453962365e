/* SPDX-License-Identifier: MIT */
/**
 * @file h264.h
 * Pictures of one 10-bit luma plane to H.264 and back, through libavcodec. The profile is High 10,
 * 4:2:0 with chroma constant 512 (cheaper than 4:4:4 and decodable in more places).
 *
 * Encoder and decoder live in separate files: the decoder build has no libx264.
 */
#ifndef GVC_CODEC_H264_H
#define GVC_CODEC_H264_H

#include "base/bytes.h"
#include "base/result.h"

/** One coded picture in decoding order. */
typedef struct gvc_packet {
    uint8_t *data; /**< AVC sample: NAL units with 4-byte big-endian lengths, no parameter sets, no
                      SEI */
    size_t size;
    uint32_t presentation; /**< index in presentation order within the group, 0-based */
    bool keyframe;
} gvc_packet;

/** A coded group of pictures: closed, begins with an IDR picture. */
typedef struct gvc_coded_group {
    gvc_packet *packet;
    size_t packet_count;
    uint8_t *config; /**< AVCDecoderConfigurationRecord (ISO/IEC 14496-15 5.3.3.1), the content of
                        avcC */
    size_t config_size;
} gvc_coded_group;

void gvc_coded_group_free(gvc_coded_group *group);

typedef struct gvc_h264_options {
    uint32_t width, height; /**< even */
    uint32_t frame_rate_num, frame_rate_den;
    double crf;      /**< -12 .. 51 at 10 bits; -12: at most one off per sample (High 10 has no
                        lossless mode) */
    unsigned effort; /**< 0: fast trial encode (same syntax, cheaper search); 1: final */
} gvc_h264_options;

/** Encodes `count` pictures; `luma[i]` points at width * height samples of 0 .. 1023. One thread,
 * always the same bytes for the same input; parameter sets do not depend on crf or content.
 * (Encoder builds only.) */
gvc_result gvc_h264_encode(const gvc_h264_options *options, const uint16_t *const *luma,
                           size_t count, gvc_coded_group *group, gvc_error *error);

typedef struct gvc_h264_decoder gvc_h264_decoder;

/** `config` is the content of avcC and is validated: High 10, 4:2:0, 10 bits. `width` and `height`
 * are what every picture must have after cropping, else GVC_ERROR_CORRUPT. `max_memory` bounds what
 * the decoder holds: no more pictures are kept than fit, and a packet that does not fit is refused
 * (GVC_ERROR_LIMIT). At least as many as the stream says it refers to must fit. */
gvc_result gvc_h264_decoder_create(const uint8_t *config, size_t config_size, uint32_t width,
                                   uint32_t height, uint64_t max_memory, gvc_h264_decoder **decoder,
                                   gvc_error *error);
void gvc_h264_decoder_destroy(gvc_h264_decoder **decoder);
/** Forgets everything; the next packet must be a keyframe. */
void gvc_h264_decoder_reset(gvc_h264_decoder *decoder);
/** Feeds one packet with its presentation number (any increasing-by-time number; comes back with
 * the picture). Bytes are copied as the decoder needs padding. Take all available pictures before
 * the next call. After GVC_ERROR_CORRUPT no more packets are taken until a reset; pictures
 * not received yet may come after a flush, or be lost. After other errors every call fails until a
 * reset. */
gvc_result gvc_h264_decoder_send(gvc_h264_decoder *decoder, const uint8_t *data, size_t size,
                                 int64_t presentation, gvc_error *error);
/** Tells that no packet follows, so that delayed pictures come out; call reset before sending
 * again. */
gvc_result gvc_h264_decoder_flush(gvc_h264_decoder *decoder, gvc_error *error);
/** Takes the next picture in presentation order if there is one: copies its luma to `luma` (width *
 * height) and sets *available. GVC_ERROR_CORRUPT: a picture is lost, or some are missing at the
 * end; others may follow. Once nothing is left, that is GVC_OK without a picture. */
gvc_result gvc_h264_decoder_receive(gvc_h264_decoder *decoder, uint16_t *luma,
                                    int64_t *presentation, bool *available, gvc_error *error);

#endif
