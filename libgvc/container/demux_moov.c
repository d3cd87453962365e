/* SPDX-License-Identifier: MIT */
/** @file demux_moov.c  Reads the moov box: which tracks there are and what holds for all frames. */
#include "base/digest.h"
#include "container/parser.h"

#include <string.h>

/** What matters of a track. */
typedef struct track_facts {
    gvc_track_kind kind; /**< GVC_TRACK_KINDS: not ours */
    bool is_avc;         /**< avc1, whether or not it is ours */
    uint32_t track_id, timescale, described_track;
    uint64_t media_time; /**< composition time at which the edit list lets the movie begin */
    gvc_box avcc, gvcc;
} track_facts;

/** A FullBox whose version 1 has 64-bit times: skips the times and reads the field after them. */
static gvc_result read_after_times(const gvc_box *parent, uint32_t type, uint32_t *value,
                                   gvc_error *error) {
    gvc_box box;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(parent, type, true, &box, error));
    GVC_TRY(gvc_box_version(&box, 1, &version, &flags, error));
    gvc_skip(&box.content, version == 1 ? 16 : 8); /* creation, modification */
    *value = gvc_read_u32(&box.content);
    return gvc_box_check(&box, error);
}

static gvc_result read_handler(const gvc_box *mdia, uint32_t *handler, gvc_error *error) {
    gvc_box hdlr;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(mdia, GVC_BOX_HDLR, true, &hdlr, error));
    GVC_TRY(gvc_box_version(&hdlr, 0, &version, &flags, error));
    gvc_skip(&hdlr.content, 4);
    *handler = gvc_read_u32(&hdlr.content);
    return gvc_box_check(&hdlr, error);
}

/** Tracks known by the URI of their sample entry. */
static const struct {
    gvc_track_kind kind;
    const char *stem, *uri, *what;
} known_uri[] = {
    {GVC_TRACK_SHAPE, GVC_SHAPE_URI_STEM, GVC_SHAPE_URI, "shape records"},
    {GVC_TRACK_EXACT, GVC_EXACT_URI_STEM, GVC_EXACT_URI, "exact images"},
};

/** Finds out from the `uri ` box which track this is. */
static gvc_result read_uri(const gvc_box *urim, gvc_track_kind *kind, gvc_error *error) {
    gvc_box uri;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(urim, GVC_BOX_URI, false, &uri, error));
    if (!uri.type) return GVC_OK;
    GVC_TRY(gvc_box_version(&uri, 0, &version, &flags, error));
    size_t size = gvc_cursor_left(&uri.content);
    const char *text = (const char *)gvc_read_bytes(&uri.content, size);
    for (size_t i = 0; i < sizeof known_uri / sizeof *known_uri; i++) {
        size_t stem = strlen(known_uri[i].stem), whole = strlen(known_uri[i].uri) + 1;
        if (size <= stem || memcmp(text, known_uri[i].stem, stem) != 0) continue;
        if (size != whole || memcmp(text, known_uri[i].uri, whole) != 0) {
            return gvc_box_fail(&uri, error, GVC_ERROR_UNSUPPORTED,
                                "%s of another version than \"%s\"", known_uri[i].what,
                                known_uri[i].uri);
        }
        *kind = known_uri[i].kind;
    }
    return GVC_OK;
}

/** A track is ours if its only sample entry is avc1 with gvcC, or urim with a URI of ours. */
static gvc_result read_sample_entry(const gvc_box *stbl, uint32_t handler, track_facts *facts,
                                    gvc_error *error) {
    gvc_box stsd, entry;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(stbl, GVC_BOX_STSD, true, &stsd, error));
    GVC_TRY(gvc_box_version(&stsd, 0, &version, &flags, error));
    if (gvc_read_u32(&stsd.content) != 1) return gvc_box_check(&stsd, error);
    GVC_TRY(gvc_box_next(&stsd, &entry, error));
    if (handler == GVC_HANDLER_VIDEO && entry.type == GVC_BOX_AVC1) {
        gvc_skip(&entry.content, GVC_AVC1_FIELDS);
        GVC_TRY(gvc_box_check(&entry, error));
        facts->is_avc = true;
        GVC_TRY(gvc_box_find(&entry, GVC_BOX_GVCC, false, &facts->gvcc, error));
        if (facts->gvcc.type == 0) return GVC_OK;
        facts->kind = GVC_TRACK_GEOMETRY;
        return gvc_box_find(&entry, GVC_BOX_AVCC, true, &facts->avcc, error);
    }
    if (handler == GVC_HANDLER_META && entry.type == GVC_BOX_URIM) {
        gvc_skip(&entry.content, GVC_URIM_FIELDS);
        GVC_TRY(gvc_box_check(&entry, error));
        GVC_TRY(read_uri(&entry, &facts->kind, error));
        if (facts->kind != GVC_TRACK_EXACT) return GVC_OK;
        return gvc_box_find(&entry, GVC_BOX_GVCC, false, &facts->gvcc, error);
    }
    return GVC_OK;
}

/** Samples outside fragments would have no checksum and no place in the index. */
static gvc_result refuse_plain_samples(const gvc_box *stbl, gvc_error *error) {
    gvc_box stsz;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(stbl, GVC_BOX_STSZ, true, &stsz, error));
    GVC_TRY(gvc_box_version(&stsz, 0, &version, &flags, error));
    gvc_skip(&stsz.content, 4);
    uint32_t count = gvc_read_u32(&stsz.content);
    GVC_TRY(gvc_box_check(&stsz, error));
    if (count == 0) return GVC_OK;
    return gvc_box_fail(&stsz, error, GVC_ERROR_CORRUPT, "%u samples lie outside of fragments",
                        count);
}

/** The edit list, if there is one, may only shift the beginning: frames are numbered by it. */
static gvc_result read_edit(const gvc_box *trak, uint64_t *media_time, gvc_error *error) {
    gvc_box edts, elst;
    uint8_t version;
    uint32_t flags;
    GVC_TRY(gvc_box_find(trak, GVC_BOX_EDTS, false, &edts, error));
    if (!edts.type) return GVC_OK;
    GVC_TRY(gvc_box_find(&edts, GVC_BOX_ELST, false, &elst, error));
    if (!elst.type) return GVC_OK;
    GVC_TRY(gvc_box_version(&elst, 1, &version, &flags, error));
    uint32_t count = gvc_read_u32(&elst.content);
    gvc_skip(&elst.content, version == 1 ? 8 : 4); /* duration */
    *media_time = version == 1 ? gvc_read_u64(&elst.content) : gvc_read_u32(&elst.content);
    uint64_t empty = version == 1 ? UINT64_MAX : UINT32_MAX;
    uint32_t rate = gvc_read_u32(&elst.content);
    if (count == 1) GVC_TRY(gvc_box_check(&elst, error));
    if (count == 1 && *media_time != empty && rate == 0x10000) return GVC_OK;
    return gvc_box_fail(&elst, error, GVC_ERROR_UNSUPPORTED,
                        "an edit list that does more than shift the beginning");
}

static gvc_result read_track(const gvc_box *trak, track_facts *facts, gvc_error *error) {
    gvc_box mdia, minf, stbl, tref, cdsc;
    uint32_t handler;
    *facts = (track_facts){.kind = GVC_TRACK_KINDS};
    GVC_TRY(gvc_box_find(trak, GVC_BOX_MDIA, true, &mdia, error));
    GVC_TRY(read_handler(&mdia, &handler, error));
    GVC_TRY(gvc_box_find(&mdia, GVC_BOX_MINF, true, &minf, error));
    GVC_TRY(gvc_box_find(&minf, GVC_BOX_STBL, true, &stbl, error));
    GVC_TRY(read_sample_entry(&stbl, handler, facts, error));
    if (facts->kind == GVC_TRACK_KINDS) return GVC_OK;
    GVC_TRY(read_after_times(trak, GVC_BOX_TKHD, &facts->track_id, error));
    GVC_TRY(read_after_times(&mdia, GVC_BOX_MDHD, &facts->timescale, error));
    GVC_TRY(read_edit(trak, &facts->media_time, error));
    GVC_TRY(refuse_plain_samples(&stbl, error));
    if (facts->track_id == 0) {
        return gvc_box_fail(trak, error, GVC_ERROR_CORRUPT, "a track has the number 0");
    }
    if (facts->kind != GVC_TRACK_SHAPE) return GVC_OK;
    GVC_TRY(gvc_box_find(trak, GVC_BOX_TREF, true, &tref, error));
    GVC_TRY(gvc_box_find(&tref, GVC_BOX_CDSC, true, &cdsc, error));
    facts->described_track = gvc_read_u32(&cdsc.content);
    return gvc_box_check(&cdsc, error);
}

static gvc_result read_tracks(const gvc_box *moov, track_facts track[GVC_TRACK_KINDS],
                              bool *has_avc, gvc_error *error) {
    static const char *const name[GVC_TRACK_KINDS] = {"geometry", "shape", "exact"};
    gvc_box rest = *moov, trak;
    *has_avc = false;
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) track[kind] = (track_facts){0};
    while (gvc_cursor_left(&rest.content)) {
        track_facts facts;
        GVC_TRY(gvc_box_next(&rest, &trak, error));
        if (trak.type != GVC_BOX_TRAK) continue;
        GVC_TRY(read_track(&trak, &facts, error));
        if (facts.is_avc) *has_avc = true;
        if (facts.kind == GVC_TRACK_KINDS) continue;
        if (track[facts.kind].track_id) {
            return gvc_box_fail(&trak, error, GVC_ERROR_CORRUPT, "a second %s track",
                                name[facts.kind]);
        }
        track[facts.kind] = facts;
    }
    return GVC_OK;
}

/** Number 0 of a track: it is missing. */
static gvc_result check_tracks(const gvc_box *moov, const track_facts track[GVC_TRACK_KINDS],
                               bool has_avc, bool has_brand, gvc_error *error) {
    const track_facts *shape = &track[GVC_TRACK_SHAPE], *exact = &track[GVC_TRACK_EXACT];
    const track_facts *geometry = &track[GVC_TRACK_GEOMETRY];
    const track_facts *described = geometry->track_id ? geometry : exact;
    /* Tools that drop the shape track may drop gvcC as well, or the brand, but hardly both. */
    if (!shape->track_id && (described->track_id || (has_avc && has_brand))) {
        return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                            "the shape track is missing; a tool that copied only the video "
                            "dropped it");
    }
    if (!has_brand) {
        return gvc_box_fail(moov, error, GVC_ERROR_UNSUPPORTED, GVC_NO_BRAND_MESSAGE);
    }
    if (!described->track_id || !described->gvcc.type) {
        return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                            "there is no geometry track (avc1 with gvcC) and no exact track with "
                            "gvcC");
    }
    for (unsigned a = 0; a < GVC_TRACK_KINDS; a++) {
        for (unsigned b = 0; b < a; b++) {
            if (!track[a].track_id || track[a].track_id != track[b].track_id) continue;
            return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT, "two tracks have the number %u",
                                track[a].track_id);
        }
    }
    if (shape->described_track != described->track_id) {
        return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                            "shape track %u describes track %u, the %s track is %u",
                            shape->track_id, shape->described_track,
                            geometry->track_id ? "geometry" : "exact", described->track_id);
    }
    return GVC_OK;
}

/** Reads the trex of a track. */
static gvc_result read_defaults(const gvc_box *mvex, gvc_track_defaults *track, gvc_error *error) {
    gvc_box rest = *mvex, trex;
    bool found = false;
    while (gvc_cursor_left(&rest.content)) {
        uint8_t version;
        uint32_t flags;
        GVC_TRY(gvc_box_next(&rest, &trex, error));
        if (trex.type != GVC_BOX_TREX) continue;
        GVC_TRY(gvc_box_version(&trex, 0, &version, &flags, error));
        uint32_t track_id = gvc_read_u32(&trex.content);
        uint32_t description = gvc_read_u32(&trex.content);
        uint32_t duration = gvc_read_u32(&trex.content);
        uint32_t size = gvc_read_u32(&trex.content);
        uint32_t sample_flags = gvc_read_u32(&trex.content);
        GVC_TRY(gvc_box_check(&trex, error));
        if (track_id != track->track_id) continue;
        if (found || description != 1) {
            return gvc_box_fail(&trex, error, GVC_ERROR_CORRUPT,
                                "track %u has two trex boxes or sample description %u", track_id,
                                description);
        }
        found = true;
        track->duration = duration;
        track->size = size;
        track->flags = sample_flags;
    }
    if (found) return GVC_OK;
    return gvc_box_fail(mvex, error, GVC_ERROR_CORRUPT, "track %u has no trex box",
                        track->track_id);
}

/** A bit says what tracks there must be, so that one dropped is missed. */
static gvc_result check_features(const gvc_demux *demux, gvc_box *gvcc, gvc_error *error) {
    bool wanted = demux->config.features & GVC_FEATURE_EXACT;
    if (wanted == demux->has_track[GVC_TRACK_EXACT]) return GVC_OK;
    return gvc_box_fail(gvcc, error, GVC_ERROR_CORRUPT,
                        wanted ? "the exact track is missing; a tool that copied only the video "
                                 "dropped it"
                               : "an exact track that gvcC does not tell of");
}

/** Reads gvcC, which stands in the main track, and avcC if that is the geometry track. */
static gvc_result read_config(gvc_parser *parser, const track_facts *described, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    gvc_box gvcc = described->gvcc, avcc = described->avcc;
    gvc_error defect;
    gvc_error_init(&defect);
    gvc_result result = gvc_config_read(&gvcc.content, &demux->config, &defect);
    if (result != GVC_OK) return gvc_box_fail(&gvcc, error, result, "%s", defect.message);
    GVC_TRY(check_features(demux, &gvcc, error));
    const gvc_config *config = &demux->config;
    if (config->image_size > parser->options->max_image_size) {
        return gvc_box_fail(&gvcc, error, GVC_ERROR_LIMIT,
                            "geometry images of %u samples per side; the limit is %u",
                            config->image_size, parser->options->max_image_size);
    }
    uint64_t picture_bytes = 3 * (uint64_t)config->plane_height * config->picture_width * 2;
    if (picture_bytes > parser->options->max_memory) {
        return gvc_box_fail(
            &gvcc, error, GVC_ERROR_LIMIT, "a picture takes %llu bytes; the limit is %llu",
            (unsigned long long)picture_bytes, (unsigned long long)parser->options->max_memory);
    }
    if (config->declared_frames > parser->options->max_frames) {
        return gvc_box_fail(&gvcc, error, GVC_ERROR_LIMIT, "%llu frames; the limit is %llu",
                            (unsigned long long)config->declared_frames,
                            (unsigned long long)parser->options->max_frames);
    }
    if (!demux->has_track[GVC_TRACK_GEOMETRY]) return GVC_OK;
    size_t size = gvc_cursor_left(&avcc.content), capacity = 0;
    GVC_TRY(gvc_parser_grow(parser, (void **)&demux->avc_config, &capacity, size, 1, error));
    if (size) memcpy(demux->avc_config, gvc_read_bytes(&avcc.content, size), size);
    demux->avc_config_size = size;
    return GVC_OK;
}

/** Notes number and shift of a track. */
static gvc_result keep_track(gvc_parser *parser, const gvc_box *moov, const track_facts *facts,
                             gvc_track_kind kind, gvc_error *error) {
    gvc_demux *demux = parser->demux;
    uint32_t duration = demux->config.frame_rate_den;
    uint64_t frames = facts->media_time / duration;
    if (facts->media_time % duration != 0 || frames > INT32_MAX) {
        return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                            "track %u begins at time %llu, which is no frame", facts->track_id,
                            (unsigned long long)facts->media_time);
    }
    demux->track[kind].track_id = facts->track_id;
    demux->track[kind].shown_later = (uint32_t)frames;
    return GVC_OK;
}

static gvc_result read_content(gvc_parser *parser, const gvc_box *moov, bool has_brand,
                               gvc_error *error) {
    track_facts track[GVC_TRACK_KINDS];
    gvc_demux *demux = parser->demux;
    gvc_box mvex;
    bool has_avc;
    GVC_TRY(read_tracks(moov, track, &has_avc, error));
    GVC_TRY(check_tracks(moov, track, has_avc, has_brand, error));
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        demux->has_track[kind] = track[kind].track_id != 0;
    }
    GVC_TRY(read_config(parser, &track[gvc_demux_main(demux)], error));
    GVC_TRY(gvc_box_find(moov, GVC_BOX_MVEX, true, &mvex, error));
    for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
        if (!demux->has_track[kind]) continue;
        if (track[kind].timescale != demux->config.frame_rate_num) {
            return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                                "track %u has timescale %u; the frame rate asks for %u",
                                track[kind].track_id, track[kind].timescale,
                                demux->config.frame_rate_num);
        }
        GVC_TRY(keep_track(parser, moov, &track[kind], (gvc_track_kind)kind, error));
        GVC_TRY(read_defaults(&mvex, &demux->track[kind], error));
    }
    return GVC_OK;
}

gvc_result gvc_parse_moov(gvc_parser *parser, gvc_box *moov, bool has_brand, gvc_error *error) {
    GVC_TRY(gvc_parser_load(parser, moov, error));
    gvc_crc_state state = GVC_CRC_ABSENT;
    if (moov->size >= moov->header_size + GVC_GCRC_SIZE) {
        uint64_t tail = moov->size - GVC_GCRC_SIZE;
        uint32_t crc;
        GVC_TRY(gvc_parser_crc(parser, 0, moov->offset + tail, &crc, error));
        state = gvc_box_check_crc(crc, parser->scratch + tail);
    }
    if (state == GVC_CRC_WRONG) {
        return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                            "the checksum of the head of the file is wrong");
    }
    /* A tool that rewrote moov also lost its checksum; what else it lost is the better message. */
    GVC_TRY(read_content(parser, moov, has_brand, error));
    if (state == GVC_CRC_RIGHT) return GVC_OK;
    return gvc_box_fail(moov, error, GVC_ERROR_CORRUPT,
                        "moov does not end with its checksum (gcrc)");
}
