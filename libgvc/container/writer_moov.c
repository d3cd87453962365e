/* SPDX-License-Identifier: MIT */
/** @file writer_moov.c  The head of a file: ftyp and moov. */
#include "container/writer_moov.h"

#include "container/box.h"

static void write_zeros(gvc_buffer *buffer, size_t count) {
    for (size_t i = 0; i < count; i++) gvc_write_u8(buffer, 0);
}

/** The unity matrix of mvhd and tkhd (8.2.2): 16.16 fixed point, the last column 2.30. */
static void write_matrix(gvc_buffer *buffer) {
    static const uint32_t unity[9] = {0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000};
    for (unsigned i = 0; i < 9; i++) gvc_write_u32(buffer, unity[i]);
}

static void write_ftyp(gvc_buffer *buffer) {
    size_t box = gvc_box_begin(buffer, GVC_BOX_FTYP);
    gvc_write_u32(buffer, GVC_BRAND);
    gvc_write_u32(buffer, 0);
    gvc_write_u32(buffer, GVC_BRAND);
    gvc_write_u32(buffer, GVC_BRAND_ISO6); /* the first brand with default-base-is-moof and tfdt */
    gvc_write_u32(buffer, GVC_BRAND_MP41);
    gvc_box_end(buffer, box);
}

/* Times of creation stay 0 everywhere: the same input must give the same bytes. Durations are 0
 * too, because all samples are in fragments; mehd tells the whole one where it is known. */

/** The last track's number. */
static uint32_t last_track(const gvc_config *config) {
    return config->features & GVC_FEATURE_EXACT ? GVC_EXACT_TRACK : GVC_SHAPE_TRACK;
}

static void write_mvhd(const gvc_config *config, gvc_buffer *buffer) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_MVHD, 0, 0);
    write_zeros(buffer, 8); /* creation, modification */
    gvc_write_u32(buffer, config->frame_rate_num);
    gvc_write_u32(buffer, 0);       /* duration */
    gvc_write_u32(buffer, 0x10000); /* rate 1 */
    gvc_write_u16(buffer, 0x100);   /* volume 1 */
    write_zeros(buffer, 10);
    write_matrix(buffer);
    write_zeros(buffer, 24);
    gvc_write_u32(buffer, last_track(config) + 1); /* next free track number */
    gvc_box_end(buffer, box);
}

static void write_tkhd(uint32_t track, uint32_t width, uint32_t height, gvc_buffer *buffer) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_TKHD, 0, 3); /* enabled, in the movie */
    write_zeros(buffer, 8);
    gvc_write_u32(buffer, track);
    write_zeros(buffer, 4 + 4 + 8);     /* reserved, duration, reserved */
    write_zeros(buffer, 2 + 2 + 2 + 2); /* layer, group, volume, reserved */
    write_matrix(buffer);
    gvc_write_u32(buffer, width << 16);
    gvc_write_u32(buffer, height << 16);
    gvc_box_end(buffer, box);
}

/** One edit: the movie begins where the first picture is shown. */
static void write_edts(const gvc_config *config, gvc_buffer *buffer) {
    size_t edts = gvc_box_begin(buffer, GVC_BOX_EDTS);
    size_t elst = gvc_box_begin_full(buffer, GVC_BOX_ELST, 1, 0);
    gvc_write_u32(buffer, 1);
    gvc_write_u64(buffer, 0); /* duration: up to the end of the fragments */
    gvc_write_u64(buffer, (uint64_t)GVC_SHOWN_LATER * config->frame_rate_den);
    gvc_write_u32(buffer, 0x10000); /* rate 1 */
    gvc_box_end(buffer, elst);
    gvc_box_end(buffer, edts);
}

static void write_mdhd(const gvc_config *config, gvc_buffer *buffer) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_MDHD, 0, 0);
    write_zeros(buffer, 8);
    gvc_write_u32(buffer, config->frame_rate_num);
    gvc_write_u32(buffer, 0);
    gvc_write_u16(buffer, 0x55c4); /* language "und", three letters of five bits */
    gvc_write_u16(buffer, 0);
    gvc_box_end(buffer, box);
}

static void write_hdlr(uint32_t handler, const char *name, size_t name_size, gvc_buffer *buffer) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_HDLR, 0, 0);
    gvc_write_u32(buffer, 0);
    gvc_write_u32(buffer, handler);
    write_zeros(buffer, 12);
    gvc_write_bytes(buffer, name, name_size);
    gvc_box_end(buffer, box);
}

static void write_dinf(gvc_buffer *buffer) {
    size_t dinf = gvc_box_begin(buffer, GVC_BOX_DINF);
    size_t dref = gvc_box_begin_full(buffer, GVC_BOX_DREF, 0, 0);
    gvc_write_u32(buffer, 1);
    size_t url = gvc_box_begin_full(buffer, GVC_BOX_URL, 0, 1); /* 1: data in this file */
    gvc_box_end(buffer, url);
    gvc_box_end(buffer, dref);
    gvc_box_end(buffer, dinf);
}

/** Colours that are none, full range: a player must not squeeze codes into "studio" range. */
static void write_colr(gvc_buffer *buffer) {
    size_t box = gvc_box_begin(buffer, GVC_BOX_COLR);
    gvc_write_u32(buffer, GVC_COLR_NCLX);
    for (unsigned i = 0; i < 3; i++) gvc_write_u16(buffer, 2); /* unspecified */
    gvc_write_u8(buffer, 0x80);                                /* full range */
    gvc_box_end(buffer, box);
}

static void write_gvcc(const gvc_config *config, gvc_buffer *buffer) {
    size_t gvcc = gvc_box_begin(buffer, GVC_BOX_GVCC);
    gvc_config_write(config, buffer);
    gvc_box_end(buffer, gvcc);
}

static void write_avc1(const gvc_config *config, const uint8_t *avc_config, size_t avc_config_size,
                       gvc_buffer *buffer) {
    static const char compressor[32] = "\003gvc"; /* a Pascal string */
    size_t avc1 = gvc_box_begin(buffer, GVC_BOX_AVC1);
    write_zeros(buffer, 6);
    gvc_write_u16(buffer, 1); /* data reference */
    write_zeros(buffer, 16);
    gvc_write_u16(buffer, (uint16_t)config->picture_width);
    gvc_write_u16(buffer, (uint16_t)(3 * config->plane_height));
    gvc_write_u32(buffer, 0x00480000); /* 72 dots per inch, as every file says */
    gvc_write_u32(buffer, 0x00480000);
    gvc_write_u32(buffer, 0);
    gvc_write_u16(buffer, 1); /* pictures per sample */
    gvc_write_bytes(buffer, compressor, sizeof compressor);
    gvc_write_u16(buffer, 0x18); /* depth: colour without alpha */
    gvc_write_u16(buffer, 0xffff);
    size_t avcc = gvc_box_begin(buffer, GVC_BOX_AVCC);
    gvc_write_bytes(buffer, avc_config, avc_config_size);
    gvc_box_end(buffer, avcc);
    write_colr(buffer);
    write_gvcc(config, buffer);
    gvc_box_end(buffer, avc1);
}

/** `uri` with its NUL takes `uri_size` bytes; `config` is NULL where gvcC stands elsewhere. */
static void write_urim(const char *uri, size_t uri_size, const gvc_config *config,
                       gvc_buffer *buffer) {
    size_t urim = gvc_box_begin(buffer, GVC_BOX_URIM);
    write_zeros(buffer, 6);
    gvc_write_u16(buffer, 1);
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_URI, 0, 0);
    gvc_write_bytes(buffer, uri, uri_size);
    gvc_box_end(buffer, box);
    if (config) write_gvcc(config, buffer);
    gvc_box_end(buffer, urim);
}

/** The tables that stay empty because all samples are in fragments. */
static void write_empty_tables(gvc_buffer *buffer) {
    static const uint32_t counted[3] = {GVC_BOX_STTS, GVC_BOX_STSC, GVC_BOX_STCO};
    for (unsigned i = 0; i < 3; i++) {
        size_t box = gvc_box_begin_full(buffer, counted[i], 0, 0);
        gvc_write_u32(buffer, 0);
        gvc_box_end(buffer, box);
    }
    size_t stsz = gvc_box_begin_full(buffer, GVC_BOX_STSZ, 0, 0);
    write_zeros(buffer, 8);
    gvc_box_end(buffer, stsz);
}

static void write_geometry_trak(const gvc_config *config, const uint8_t *avc_config,
                                size_t avc_config_size, gvc_buffer *buffer) {
    static const char name[] = "gvc geometry images";
    size_t trak = gvc_box_begin(buffer, GVC_BOX_TRAK);
    write_tkhd(GVC_GEOMETRY_TRACK, config->picture_width, 3 * config->plane_height, buffer);
    write_edts(config, buffer);
    size_t mdia = gvc_box_begin(buffer, GVC_BOX_MDIA);
    write_mdhd(config, buffer);
    write_hdlr(GVC_HANDLER_VIDEO, name, sizeof name, buffer);
    size_t minf = gvc_box_begin(buffer, GVC_BOX_MINF);
    size_t vmhd = gvc_box_begin_full(buffer, GVC_BOX_VMHD, 0, 1);
    write_zeros(buffer, 8);
    gvc_box_end(buffer, vmhd);
    write_dinf(buffer);
    size_t stbl = gvc_box_begin(buffer, GVC_BOX_STBL);
    size_t stsd = gvc_box_begin_full(buffer, GVC_BOX_STSD, 0, 0);
    gvc_write_u32(buffer, 1);
    write_avc1(config, avc_config, avc_config_size, buffer);
    gvc_box_end(buffer, stsd);
    write_empty_tables(buffer);
    gvc_box_end(buffer, stbl);
    gvc_box_end(buffer, minf);
    gvc_box_end(buffer, mdia);
    gvc_box_end(buffer, trak);
}

/** From mdia on, of a track of timed metadata. */
static void write_meta_mdia(const gvc_config *config, const char *name, size_t name_size,
                            const char *uri, size_t uri_size, bool holds_config,
                            gvc_buffer *buffer) {
    size_t mdia = gvc_box_begin(buffer, GVC_BOX_MDIA);
    write_mdhd(config, buffer);
    write_hdlr(GVC_HANDLER_META, name, name_size, buffer);
    size_t minf = gvc_box_begin(buffer, GVC_BOX_MINF);
    size_t nmhd = gvc_box_begin_full(buffer, GVC_BOX_NMHD, 0, 0);
    gvc_box_end(buffer, nmhd);
    write_dinf(buffer);
    size_t stbl = gvc_box_begin(buffer, GVC_BOX_STBL);
    size_t stsd = gvc_box_begin_full(buffer, GVC_BOX_STSD, 0, 0);
    gvc_write_u32(buffer, 1);
    write_urim(uri, uri_size, holds_config ? config : NULL, buffer);
    gvc_box_end(buffer, stsd);
    write_empty_tables(buffer);
    gvc_box_end(buffer, stbl);
    gvc_box_end(buffer, minf);
    gvc_box_end(buffer, mdia);
}

static void write_shape_trak(const gvc_config *config, uint32_t described, gvc_buffer *buffer) {
    static const char name[] = "gvc shape records";
    size_t trak = gvc_box_begin(buffer, GVC_BOX_TRAK);
    write_tkhd(GVC_SHAPE_TRACK, 0, 0, buffer);
    size_t tref = gvc_box_begin(buffer, GVC_BOX_TREF);
    size_t cdsc = gvc_box_begin(buffer, GVC_BOX_CDSC);
    gvc_write_u32(buffer, described);
    gvc_box_end(buffer, cdsc);
    gvc_box_end(buffer, tref);
    write_meta_mdia(config, name, sizeof name, GVC_SHAPE_URI, sizeof GVC_SHAPE_URI, false, buffer);
    gvc_box_end(buffer, trak);
}

static void write_exact_trak(const gvc_config *config, bool is_main, gvc_buffer *buffer) {
    static const char name[] = "gvc exact images";
    size_t trak = gvc_box_begin(buffer, GVC_BOX_TRAK);
    write_tkhd(GVC_EXACT_TRACK, 0, 0, buffer);
    write_meta_mdia(config, name, sizeof name, GVC_EXACT_URI, sizeof GVC_EXACT_URI, is_main,
                    buffer);
    gvc_box_end(buffer, trak);
}

/** Defaults of all fragments. A fragment then says only what differs, which at a few hundred bytes
 * per frame counts. */
static void write_trex(uint32_t track, const gvc_config *config, gvc_buffer *buffer) {
    size_t box = gvc_box_begin_full(buffer, GVC_BOX_TREX, 0, 0);
    gvc_write_u32(buffer, track);
    gvc_write_u32(buffer, 1); /* sample description */
    gvc_write_u32(buffer, config->frame_rate_den);
    gvc_write_u32(buffer, 0); /* sample size */
    gvc_write_u32(buffer, GVC_FLAGS_NON_SYNC);
    gvc_box_end(buffer, box);
}

static void write_mvex(const gvc_config *config, bool has_geometry, gvc_buffer *buffer) {
    size_t mvex = gvc_box_begin(buffer, GVC_BOX_MVEX);
    if (config->declared_frames) {
        size_t mehd = gvc_box_begin_full(buffer, GVC_BOX_MEHD, 1, 0);
        gvc_write_u64(buffer, config->declared_frames * config->frame_rate_den);
        gvc_box_end(buffer, mehd);
    }
    if (has_geometry) write_trex(GVC_GEOMETRY_TRACK, config, buffer);
    write_trex(GVC_SHAPE_TRACK, config, buffer);
    if (config->features & GVC_FEATURE_EXACT) write_trex(GVC_EXACT_TRACK, config, buffer);
    gvc_box_end(buffer, mvex);
}

void gvc_write_head(const gvc_config *config, const uint8_t *avc_config, size_t avc_config_size,
                    gvc_buffer *buffer) {
    write_ftyp(buffer);
    size_t moov = gvc_box_begin(buffer, GVC_BOX_MOOV);
    write_mvhd(config, buffer);
    if (avc_config) write_geometry_trak(config, avc_config, avc_config_size, buffer);
    write_shape_trak(config, avc_config ? GVC_GEOMETRY_TRACK : GVC_EXACT_TRACK, buffer);
    if (config->features & GVC_FEATURE_EXACT) write_exact_trak(config, !avc_config, buffer);
    write_mvex(config, avc_config != NULL, buffer);
    /* The checksum is the last child and covers moov's own size, so its bytes are counted before
     * they are there. */
    if (!buffer->failed) {
        gvc_patch_u32(buffer, moov, (uint32_t)(buffer->size - moov + GVC_GCRC_SIZE));
    }
    gvc_box_write_crc(buffer, 0, 0);
}
