/* SPDX-License-Identifier: MIT */
/** @file iso.h  Four-character codes and flag bits of ISO/IEC 14496-12, and those of this format.
 */
#ifndef GVC_CONTAINER_ISO_H
#define GVC_CONTAINER_ISO_H

#include <stdint.h>

#define GVC_FOURCC(a, b, c, d)                                                                     \
    ((uint32_t)(a) << 24 | (uint32_t)(b) << 16 | (uint32_t)(c) << 8 | (uint32_t)(d))

#define GVC_BRAND GVC_FOURCC('g', 'v', 'c', '1')
#define GVC_BRAND_ISO6 GVC_FOURCC('i', 's', 'o', '6')
#define GVC_BRAND_MP41 GVC_FOURCC('m', 'p', '4', '1')

/* Boxes of ISO/IEC 14496-12 and 14496-15. */
#define GVC_BOX_FTYP GVC_FOURCC('f', 't', 'y', 'p')
#define GVC_BOX_MOOV GVC_FOURCC('m', 'o', 'o', 'v')
#define GVC_BOX_MVHD GVC_FOURCC('m', 'v', 'h', 'd')
#define GVC_BOX_TRAK GVC_FOURCC('t', 'r', 'a', 'k')
#define GVC_BOX_TKHD GVC_FOURCC('t', 'k', 'h', 'd')
#define GVC_BOX_EDTS GVC_FOURCC('e', 'd', 't', 's')
#define GVC_BOX_ELST GVC_FOURCC('e', 'l', 's', 't')
#define GVC_BOX_TREF GVC_FOURCC('t', 'r', 'e', 'f')
#define GVC_BOX_CDSC GVC_FOURCC('c', 'd', 's', 'c')
#define GVC_BOX_MDIA GVC_FOURCC('m', 'd', 'i', 'a')
#define GVC_BOX_MDHD GVC_FOURCC('m', 'd', 'h', 'd')
#define GVC_BOX_HDLR GVC_FOURCC('h', 'd', 'l', 'r')
#define GVC_BOX_MINF GVC_FOURCC('m', 'i', 'n', 'f')
#define GVC_BOX_VMHD GVC_FOURCC('v', 'm', 'h', 'd')
#define GVC_BOX_NMHD GVC_FOURCC('n', 'm', 'h', 'd')
#define GVC_BOX_DINF GVC_FOURCC('d', 'i', 'n', 'f')
#define GVC_BOX_DREF GVC_FOURCC('d', 'r', 'e', 'f')
#define GVC_BOX_URL GVC_FOURCC('u', 'r', 'l', ' ')
#define GVC_BOX_STBL GVC_FOURCC('s', 't', 'b', 'l')
#define GVC_BOX_STSD GVC_FOURCC('s', 't', 's', 'd')
#define GVC_BOX_STTS GVC_FOURCC('s', 't', 't', 's')
#define GVC_BOX_STSC GVC_FOURCC('s', 't', 's', 'c')
#define GVC_BOX_STSZ GVC_FOURCC('s', 't', 's', 'z')
#define GVC_BOX_STCO GVC_FOURCC('s', 't', 'c', 'o')
#define GVC_BOX_AVC1 GVC_FOURCC('a', 'v', 'c', '1')
#define GVC_BOX_AVCC GVC_FOURCC('a', 'v', 'c', 'C')
#define GVC_BOX_COLR GVC_FOURCC('c', 'o', 'l', 'r')
#define GVC_BOX_URIM GVC_FOURCC('u', 'r', 'i', 'm')
#define GVC_BOX_URI GVC_FOURCC('u', 'r', 'i', ' ')
#define GVC_BOX_MVEX GVC_FOURCC('m', 'v', 'e', 'x')
#define GVC_BOX_MEHD GVC_FOURCC('m', 'e', 'h', 'd')
#define GVC_BOX_TREX GVC_FOURCC('t', 'r', 'e', 'x')
#define GVC_BOX_MOOF GVC_FOURCC('m', 'o', 'o', 'f')
#define GVC_BOX_MFHD GVC_FOURCC('m', 'f', 'h', 'd')
#define GVC_BOX_TRAF GVC_FOURCC('t', 'r', 'a', 'f')
#define GVC_BOX_TFHD GVC_FOURCC('t', 'f', 'h', 'd')
#define GVC_BOX_TFDT GVC_FOURCC('t', 'f', 'd', 't')
#define GVC_BOX_TRUN GVC_FOURCC('t', 'r', 'u', 'n')
#define GVC_BOX_MDAT GVC_FOURCC('m', 'd', 'a', 't')
#define GVC_BOX_MFRA GVC_FOURCC('m', 'f', 'r', 'a')
#define GVC_BOX_TFRA GVC_FOURCC('t', 'f', 'r', 'a')
#define GVC_BOX_MFRO GVC_FOURCC('m', 'f', 'r', 'o')

/* Boxes of this format. */
#define GVC_BOX_GVCC GVC_FOURCC('g', 'v', 'c', 'C') /**< facts of the whole file: config.h */
#define GVC_BOX_GCKS GVC_FOURCC('g', 'c', 'k', 's') /**< in traf: CRC-32 of each sample */
#define GVC_BOX_GCRC GVC_FOURCC('g', 'c', 'r', 'c') /**< CRC-32 of what stands before it */
#define GVC_BOX_GGAP                                                                               \
    GVC_FOURCC('g', 'g', 'a', 'p')                  /**< between fragments: frames that are lost   \
                                                     */
#define GVC_BOX_GHED GVC_FOURCC('g', 'h', 'e', 'd') /**< in mfra: a copy of ftyp and moov */
#define GVC_BOX_GDIG GVC_FOURCC('g', 'd', 'i', 'g') /**< in mfra: SHA-256 of the file before it */

#define GVC_HANDLER_VIDEO GVC_FOURCC('v', 'i', 'd', 'e')
#define GVC_HANDLER_META GVC_FOURCC('m', 'e', 't', 'a')
#define GVC_COLR_NCLX GVC_FOURCC('n', 'c', 'l', 'x')

/** What a sample of the shape track is. The number after the last colon is the major version. */
#define GVC_SHAPE_URI_STEM "urn:gvc:shape:"
#define GVC_SHAPE_URI GVC_SHAPE_URI_STEM "0"
/** And what one of the exact track is. */
#define GVC_EXACT_URI_STEM "urn:gvc:exact:"
#define GVC_EXACT_URI GVC_EXACT_URI_STEM "0"

#define GVC_GCRC_SIZE 16u /**< of a whole gcrc box: header, version and flags, CRC-32 */
#define GVC_GGAP_SIZE                                                                              \
    44u                     /**< of a whole ggap box: header, version and flags, two numbers, gcrc \
                             */
#define GVC_GDIG_SIZE 44u   /**< of a whole gdig box: header, version and flags, digest */
#define GVC_MFRO_SIZE 16u   /**< of a whole mfro box: header, version and flags, size of mfra */
#define GVC_AVC1_FIELDS 78u /**< bytes of a VisualSampleEntry before its boxes */
#define GVC_URIM_FIELDS 8u  /**< bytes of a SampleEntry before its boxes */

/* Sample flags (8.8.3.1). */
#define GVC_FLAGS_SYNC 0x02000000u     /**< depends on no other sample */
#define GVC_FLAGS_NON_SYNC 0x01010000u /**< depends on others; not a sync sample */
#define GVC_FLAG_IS_NON_SYNC 0x00010000u

/* Flags of tfhd (8.8.7). */
#define GVC_TFHD_BASE_DATA_OFFSET 0x000001u
#define GVC_TFHD_DESCRIPTION 0x000002u
#define GVC_TFHD_DURATION 0x000008u
#define GVC_TFHD_SIZE 0x000010u
#define GVC_TFHD_FLAGS 0x000020u
#define GVC_TFHD_EMPTY 0x010000u
#define GVC_TFHD_BASE_IS_MOOF 0x020000u

/* Flags of trun (8.8.8). */
#define GVC_TRUN_DATA_OFFSET 0x001u
#define GVC_TRUN_FIRST_FLAGS 0x004u
#define GVC_TRUN_DURATION 0x100u
#define GVC_TRUN_SIZE 0x200u
#define GVC_TRUN_FLAGS 0x400u
#define GVC_TRUN_COMPOSITION 0x800u

#endif
