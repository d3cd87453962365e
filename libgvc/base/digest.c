/* SPDX-License-Identifier: MIT */
/** @file digest.c  Checksums and digests through libavutil. */
#include "base/digest.h"

#include <libavutil/crc.h>
#include <libavutil/mem.h>
#include <libavutil/sha.h>

uint32_t gvc_crc32(uint32_t crc, const void *data, size_t size) {
    const AVCRC *table = av_crc_get_table(AV_CRC_32_IEEE_LE);
    return ~av_crc(table, ~crc, data, size);
}

struct gvc_sha256 {
    struct AVSHA *context;
};

gvc_sha256 *gvc_sha256_begin(void) {
    gvc_sha256 *state = av_mallocz(sizeof *state);
    if (!state) return NULL;
    state->context = av_sha_alloc();
    if (!state->context) {
        av_free(state);
        return NULL;
    }
    av_sha_init(state->context, 256);
    return state;
}

void gvc_sha256_update(gvc_sha256 *state, const void *data, size_t size) {
    av_sha_update(state->context, data, size);
}

void gvc_sha256_end(gvc_sha256 *state, uint8_t digest[32]) {
    if (!state) return;
    if (digest) av_sha_final(state->context, digest);
    av_free(state->context);
    av_free(state);
}
