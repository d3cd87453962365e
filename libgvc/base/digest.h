/* SPDX-License-Identifier: MIT */
/** @file digest.h  Checksums and digests (libavutil's implementations behind our names). */
#ifndef GVC_BASE_DIGEST_H
#define GVC_BASE_DIGEST_H

#include "base/result.h"

/** CRC-32 as in ISO 3309, zlib and PNG (reflected 0x04C11DB7). Start with crc 0; chainable. */
uint32_t gvc_crc32(uint32_t crc, const void *data, size_t size);

typedef struct gvc_sha256 gvc_sha256;
/** New running SHA-256 (FIPS 180-4), or NULL when out of memory. */
gvc_sha256 *gvc_sha256_begin(void);
void gvc_sha256_update(gvc_sha256 *state, const void *data, size_t size);
/** Writes the digest and frees the state. `digest` may be NULL to only free. */
void gvc_sha256_end(gvc_sha256 *state, uint8_t digest[32]);

#endif
