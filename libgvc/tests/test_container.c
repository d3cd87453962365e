/* SPDX-License-Identifier: MIT */
/** @file test_container.c  Writer and demuxer: round trip, cuts, flipped bytes, recovery, hostile
 * files. */
#include "file_maker.h"

#include "base/digest.h"
#include "container/box.h"

static const size_t small_file[] = {4, 1, 2, 0};
#define SMALL_FRAMES 7u

static void test_round_trip(void **state) {
    (void)state;
    for (unsigned declare = 0; declare < 2; declare++) {
        gvc_buffer file = file_make(small_file, declare);
        gvc_io io = io_of(file.data, file.size);
        gvc_read_options options = options_make(false);
        gvc_demux demux;
        assert_int_equal(gvc_demux_open(&io, &options, &demux, NULL), GVC_OK);
        assert_true(demux.complete);
        assert_int_equal(demux.damage_count, 0);
        assert_int_equal(demux.config.declared_frames, declare ? SMALL_FRAMES : 0);
        assert_int_equal(demux.config.picture_width, 64);
        assert_string_equal(demux.config.unit, "m");
        assert_int_equal(demux.avc_config_size, sizeof MADE_AVC_CONFIG - 1);
        assert_memory_equal(demux.avc_config, MADE_AVC_CONFIG, demux.avc_config_size);
        assert_int_equal(demux.fragment_count, 3);
        uint64_t frame = 0;
        gvc_buffer sample = {0};
        uint8_t expected[64];
        for (size_t f = 0; f < 3; f++) {
            const gvc_fragment_entry *fragment = &demux.fragment[f];
            assert_int_equal(fragment->frame_count, small_file[f]);
            assert_int_equal(fragment->first_frame, frame);
            for (size_t i = 0; i < fragment->frame_count; i++, frame++) {
                for (unsigned kind = 0; kind < 2; kind++) {
                    size_t index = fragment->first_sample[kind] + i;
                    const gvc_sample_entry *entry = &demux.sample[kind][index];
                    uint64_t shown = frame;
                    if (kind == 0) shown += (uint64_t)(int64_t)made_order(small_file[f], i);
                    assert_int_equal(entry->presentation, shown);
                    assert_int_equal(
                        gvc_demux_sample_of(&demux, fragment, (gvc_track_kind)kind, shown), index);
                    assert_int_equal(gvc_demux_read(&demux, &io, (gvc_track_kind)kind, index,
                                                    UINT64_MAX, &sample, NULL),
                                     GVC_OK);
                    assert_int_equal(sample.size, sample_bytes(kind, shown, i == 0, expected));
                    assert_memory_equal(sample.data, expected, sample.size);
                }
            }
        }
        assert_int_equal(frame, SMALL_FRAMES);
        assert_int_equal(gvc_demux_read(&demux, &io, GVC_TRACK_SHAPE, 7, UINT64_MAX, &sample, NULL),
                         GVC_ERROR_ARGUMENT);
        gvc_buffer_free(&sample);
        gvc_demux_free(&demux);
        gvc_buffer_free(&file);
    }
}

/** End of moov and of each fragment. */
static void find_ends(const gvc_buffer *file, size_t *end) {
    gvc_io io = io_of(file->data, file->size);
    gvc_read_options options = options_make(false);
    gvc_demux demux;
    assert_int_equal(gvc_demux_open(&io, &options, &demux, NULL), GVC_OK);
    end[0] = (size_t)demux.fragment[0].offset;
    for (size_t i = 0; i < demux.fragment_count; i++) {
        end[i + 1] = (size_t)(demux.fragment[i].offset + demux.fragment[i].size);
    }
    gvc_demux_free(&demux);
}

/** How many frames have both their samples good. */
static size_t count_good(const gvc_demux *demux, const gvc_io *io) {
    gvc_buffer sample = {0};
    size_t good = 0;
    for (size_t i = 0; i < demux->fragment_count; i++) {
        const gvc_fragment_entry *fragment = &demux->fragment[i];
        for (uint64_t f = 0; f < fragment->frame_count; f++) {
            bool both = true;
            for (unsigned kind = 0; kind < GVC_TRACK_KINDS; kind++) {
                if (!demux->has_track[kind]) continue;
                size_t index = gvc_demux_sample_of(demux, fragment, (gvc_track_kind)kind,
                                                   fragment->first_frame + f);
                gvc_result result = gvc_demux_read(demux, io, (gvc_track_kind)kind, index,
                                                   UINT64_MAX, &sample, NULL);
                assert_true(result == GVC_OK || result == GVC_ERROR_CORRUPT);
                both = both && result == GVC_OK;
            }
            good += both;
        }
    }
    gvc_buffer_free(&sample);
    return good;
}

/** Opens `size` bytes with keep_going and tells how many frames are good, whether the file is
 * complete, and what places are damaged. */
static gvc_result open_damaged(const uint8_t *data, size_t size, size_t *good, bool *complete,
                               gvc_damage *first, size_t *damages) {
    uint8_t *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, data, size);
    gvc_io io = io_of(exact, size);
    gvc_read_options options = options_make(true);
    gvc_demux demux;
    gvc_result result = gvc_demux_open(&io, &options, &demux, NULL);
    if (result == GVC_OK) {
        *good = count_good(&demux, &io);
        *complete = demux.complete;
        *damages = demux.damage_count;
        if (demux.damage_count) *first = demux.damage[0];
    }
    gvc_demux_free(&demux);
    free(exact);
    return result;
}

/** A cut-off file is refused, or keeps every whole fragment, and of the last the whole samples. */
static void test_every_prefix(void **state) {
    (void)state;
    for (unsigned declare = 0; declare < 2; declare++) {
        gvc_buffer file = file_make(small_file, declare);
        size_t end[4];
        find_ends(&file, end);
        for (size_t size = 0; size < file.size; size++) {
            gvc_error error;
            gvc_error_init(&error);
            assert_int_equal(read_all(file.data, size, false, NULL, NULL, &error),
                             GVC_ERROR_TRUNCATED);
            assert_true(error.offset <= size);
            size_t good = 0, least = 0, most = 0, damages = 0;
            bool complete = true;
            gvc_damage damage;
            gvc_result result = open_damaged(file.data, size, &good, &complete, &damage, &damages);
            if (size < end[0]) {
                assert_int_equal(result, GVC_ERROR_TRUNCATED);
                continue;
            }
            for (size_t i = 0; i < 3 && end[i] <= size; i++) {
                most += small_file[i];
                if (end[i + 1] <= size) least += small_file[i];
            }
            assert_int_equal(result, GVC_OK);
            assert_true(good >= least && good <= most);
            if (good == most) assert_true(least == most); /* the last picture ends its fragment */
            assert_true(damages > 0);
            assert_int_equal(damage.offset + damage.size, size);
            assert_false(complete);
        }
        gvc_buffer_free(&file);
    }
}

/** Every byte is covered by a checksum or an exact check. */
static void test_every_flip_is_detected(void **state) {
    (void)state;
    static const uint8_t change[] = {0x01, 0x80, 0xff};
    gvc_buffer file = file_make(small_file, true);
    size_t end[4];
    find_ends(&file, end);
    for (size_t i = 0; i < file.size; i++) {
        for (size_t k = 0; k < sizeof change; k++) {
            file.data[i] ^= change[k];
            gvc_error error;
            gvc_error_init(&error);
            gvc_result result = read_all(file.data, file.size, false, NULL, NULL, &error);
            if (result != GVC_ERROR_CORRUPT && result != GVC_ERROR_TRUNCATED &&
                result != GVC_ERROR_UNSUPPORTED) {
                fail_msg("byte %zu ^ %02x: result %d", i, change[k], result);
            }
            assert_int_equal(error.code, result);
            assert_true(error.message[0] != '\0');
            assert_true(error.offset != GVC_NO_OFFSET);
            file.data[i] ^= change[k];
        }
    }
    gvc_buffer_free(&file);
}

/** With keep_going damage in a moof loses its fragment, in a sample that, in a header of mdat and
 * in the index nothing; and it is known where it is. */
static void test_flips_keep_other_fragments(void **state) {
    (void)state;
    gvc_buffer file = file_make(small_file, true);
    size_t end[4];
    find_ends(&file, end);
    for (size_t i = 0; i < file.size; i++) {
        file.data[i] ^= 0x10;
        size_t good = 0, damages = 0, hit = 0;
        bool complete = false;
        gvc_damage damage;
        assert_int_equal(open_damaged(file.data, file.size, &good, &complete, &damage, &damages),
                         GVC_OK);
        file.data[i] ^= 0x10;
        while (hit < 4 && end[hit] <= i) hit++; /* 0: head, 4: index */
        if (damages) {
            assert_int_equal(damages, 1);
            assert_false(complete);
            assert_true(damage.offset <= i && i - damage.offset < damage.size);
            assert_true(damage.error.code != GVC_OK);
            bool whole_fragment = hit > 0 && hit < 4 && damage.size > 8;
            if (whole_fragment) {
                assert_int_equal(damage.offset, end[hit - 1]);
                assert_int_equal(damage.offset + damage.size, end[hit]);
            }
            assert_int_equal(good, SMALL_FRAMES - (whole_fragment ? small_file[hit - 1] : 0));
        } else { /* the byte is part of a sample */
            assert_true(hit > 0 && hit < 4);
            assert_int_equal(good, SMALL_FRAMES - 1);
        }
    }
    gvc_buffer_free(&file);
}

/** Copies a file, leaving out one byte range and putting other bytes in its place. */
static gvc_buffer splice(const gvc_buffer *file, size_t from, size_t to, const void *bytes,
                         size_t size) {
    gvc_buffer out = {0};
    gvc_write_bytes(&out, file->data, from);
    gvc_write_bytes(&out, bytes, size);
    gvc_write_bytes(&out, file->data + to, file->size - to);
    return out;
}

static gvc_result open_spliced(const gvc_buffer *file, size_t from, size_t to, const void *bytes,
                               size_t size, bool keep_going, size_t *frames) {
    gvc_buffer changed = splice(file, from, to, bytes, size);
    gvc_result result = read_all(changed.data, changed.size, keep_going, frames, NULL, NULL);
    gvc_buffer_free(&changed);
    return result;
}

static void test_lost_and_foreign_parts(void **state) {
    (void)state;
    gvc_buffer file = file_make(small_file, true);
    size_t end[4], frames = 0;
    find_ends(&file, end);
    /* A fragment cut out cleanly: frames are missing. */
    assert_int_equal(open_spliced(&file, end[1], end[2], NULL, 0, false, NULL), GVC_ERROR_CORRUPT);
    assert_int_equal(open_spliced(&file, end[1], end[2], NULL, 0, true, &frames), GVC_OK);
    assert_int_equal(frames, SMALL_FRAMES - 1);
    /* A fragment twice: the second one is refused. */
    assert_int_equal(
        open_spliced(&file, end[1], end[1], file.data + end[0], end[1] - end[0], true, &frames),
        GVC_OK);
    assert_int_equal(frames, SMALL_FRAMES);
    /* Boxes not known are skipped (before the index shifts nothing), bytes at the end are not. */
    static const uint8_t box[] = {0, 0, 0, 12, 'f', 'r', 'e', 'e', 1, 2, 3, 4};
    static const uint8_t large[] = {0, 0, 0, 1, 'u', 'u', 'i', 'd', 0, 0, 0, 0, 0, 0, 0, 16};
    assert_int_equal(open_spliced(&file, end[3], end[3], box, sizeof box, false, NULL), GVC_OK);
    assert_int_equal(open_spliced(&file, end[3], end[3], large, sizeof large, false, NULL), GVC_OK);
    assert_int_equal(open_spliced(&file, file.size, file.size, box, sizeof box, false, NULL),
                     GVC_ERROR_CORRUPT);
    /* Size 0, a size below the header, sizes of up to 2^64. */
    static const uint8_t zero[] = {0, 0, 0, 0, 'f', 'r', 'e', 'e'};
    static const uint8_t seven[] = {0, 0, 0, 7, 'f', 'r', 'e', 'e'};
    uint8_t huge[] = {0, 0, 0, 1, 'm', 'o', 'o', 'f', 255, 255, 255, 255, 255, 255, 255, 255};
    assert_int_equal(open_spliced(&file, end[3], end[3], zero, 8, false, NULL), GVC_ERROR_CORRUPT);
    assert_int_equal(open_spliced(&file, end[3], end[3], seven, 8, false, NULL), GVC_ERROR_CORRUPT);
    assert_int_equal(open_spliced(&file, end[3], end[3], huge, 16, false, NULL),
                     GVC_ERROR_TRUNCATED);
    huge[15] = 15;
    memset(huge + 8, 0, 7);
    assert_int_equal(open_spliced(&file, end[3], end[3], huge, 16, false, NULL), GVC_ERROR_CORRUPT);
    /* Noise between fragments is skipped with keep_going, also with a decoy in it. */
    uint8_t noise[5000];
    for (size_t i = 0; i < sizeof noise; i++) noise[i] = (uint8_t)(i * 2654435761u >> 13);
    memcpy(noise + 77, "\0\0\0\100moof", 8);
    memcpy(noise + 4090, "\0\0\0\040moof", 8);
    assert_int_equal(open_spliced(&file, end[1], end[1], noise, sizeof noise, true, &frames),
                     GVC_OK);
    assert_int_equal(frames, SMALL_FRAMES);
    gvc_buffer_free(&file);
}

/** mdat with a 64-bit size, as a fragment beyond 4 GiB would have: built from a small one. */
static void test_64_bit_sizes(void **state) {
    (void)state;
    static const size_t one[] = {1, 0};
    gvc_buffer file = file_make(one, true);
    size_t end[2];
    find_ends(&file, end);
    gvc_buffer out = {0};
    gvc_write_bytes(&out, file.data, end[0]);
    gvc_cursor cursor = gvc_cursor_make(file.data, file.size);
    gvc_skip(&cursor, end[0]);
    uint32_t moof_size = gvc_read_u32(&cursor);
    /* moof gets a 16-byte header and so does mdat: data offsets grow by 16. */
    gvc_write_u32(&out, 1);
    gvc_write_u32(&out, GVC_BOX_MOOF);
    gvc_write_u64(&out, moof_size + 8);
    gvc_write_bytes(&out, file.data + end[0] + 8, moof_size - 8 - GVC_GCRC_SIZE);
    for (size_t i = end[0]; i + 16 < out.size; i++) {
        gvc_cursor at = gvc_cursor_make(out.data + i, 16);
        if (gvc_read_u32(&at) != GVC_BOX_TRUN) continue;
        gvc_skip(&at, 8);
        gvc_patch_u32(&out, i + 12, gvc_read_u32(&at) + 16);
    }
    gvc_box_write_crc(&out, end[0], 0);
    size_t mdat = end[0] + moof_size, payload = end[1] - mdat - 8;
    gvc_write_u32(&out, 1);
    gvc_write_u32(&out, GVC_BOX_MDAT);
    gvc_write_u64(&out, payload + 16);
    gvc_write_bytes(&out, file.data + mdat + 8, payload);
    gvc_write_bytes(&out, file.data + end[1], file.size - end[1]);
    bool complete = false;
    assert_int_equal(read_all(out.data, out.size, false, NULL, &complete, NULL), GVC_OK);
    assert_true(complete);
    gvc_buffer_free(&out);
    gvc_buffer_free(&file);
}

/** Changes a 32-bit field a number of bytes behind the first such type after `from`, and makes the
 * checksum of the box [begin, begin + size) right again (`crc_from` is where it counts from). */
static void forge(gvc_buffer *file, uint32_t type, size_t skip, uint32_t value, size_t crc_from,
                  size_t begin) {
    gvc_cursor cursor = gvc_cursor_make(file->data + begin, 4);
    size_t size = gvc_read_u32(&cursor), found = begin;
    while (true) {
        assert_true(found < begin + size);
        gvc_cursor at = gvc_cursor_make(file->data + found, 4);
        if (gvc_read_u32(&at) == type) break;
        found++;
    }
    gvc_patch_u32(file, found + 4 + skip, value);
    size_t crc = begin + size - 4;
    gvc_patch_u32(file, crc, gvc_crc32(0, file->data + crc_from, crc - crc_from));
}

static gvc_result read_forged(uint32_t type, size_t skip, uint32_t value, bool in_moov) {
    gvc_buffer file = file_make(small_file, true);
    size_t end[4], moov = 28;
    find_ends(&file, end);
    forge(&file, type, skip, value, in_moov ? 0 : end[0], in_moov ? moov : end[0]);
    gvc_result result = read_all(file.data, file.size, false, NULL, NULL, NULL);
    gvc_buffer_free(&file);
    return result;
}

/** Hostile fields behind right checksums. */
static void test_forged_fields(void **state) {
    (void)state;
    const bool in_moov = true, in_moof = false;
    /* The forge itself is sound: writing what is there already changes nothing. */
    assert_int_equal(read_forged(GVC_BOX_TRUN, 4, 4, in_moof), GVC_OK);
    assert_int_equal(read_forged(GVC_BOX_MVHD, 12, 30000, in_moov), GVC_OK);

    assert_int_equal(read_forged(GVC_BOX_TRUN, 4, 0, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 4, UINT32_MAX, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 4, 3, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 0, 0x01000000, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 0, 0x01ffffff, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 0, 0x02000a05, in_moof), GVC_ERROR_UNSUPPORTED);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 8, 0, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 8, UINT32_MAX, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 12, GVC_FLAGS_NON_SYNC, in_moof), GVC_ERROR_CORRUPT);
    /* Sync samples after the first. */
    assert_int_equal(read_forged(GVC_BOX_TREX, 20, 0x02000000, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 16, 0, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 16, UINT32_MAX, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 20, 1, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 20, 1001, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 20, 0x80000000, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TRUN, 20, 2 * 1001, in_moof), GVC_OK);
    assert_int_equal(read_forged(GVC_BOX_ELST, 20, 1001, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_ELST, 20, 2003, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_ELST, 4, 2, in_moov), GVC_ERROR_UNSUPPORTED);
    assert_int_equal(read_forged(GVC_BOX_ELST, 16, UINT32_MAX, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFDT, 4, 0x7fffffff, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFDT, 8, 1000, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFDT, 8, 1001, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFHD, 0, 0, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFHD, 0, 0x00020001, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFHD, 4, 2, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TFHD, 4, 3, in_moof), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_GCKS, 0, 1, in_moof), GVC_OK); /* flags say nothing */

    assert_int_equal(read_forged(GVC_BOX_TREX, 4, 9, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TREX, 12, 1000, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TKHD, 12, 0, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_TKHD, 12, 2, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_MDHD, 12, 25, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_CDSC, 0, 2, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_STSZ, 8, 1, in_moov), GVC_ERROR_CORRUPT);
    assert_int_equal(read_forged(GVC_BOX_GVCC, 0, 0x00010000, in_moov), GVC_ERROR_UNSUPPORTED);
    assert_int_equal(read_forged(GVC_BOX_URI, 18, '9' << 24, in_moov), GVC_ERROR_UNSUPPORTED);
}

/** Goes on behind a head whose trex has one field changed, as a repair does: the samples are right
 * whatever trex says. */
static void write_behind_forged_head(size_t skip, uint32_t value) {
    gvc_buffer forged = file_make(small_file, false), file = {0};
    forge(&forged, GVC_BOX_TREX, skip, value, 0, 28);
    gvc_io io = io_of(forged.data, forged.size);
    gvc_read_options options = options_make(true);
    gvc_sink sink = {&file, sink_write};
    gvc_demux demux;
    gvc_writer *writer;
    size_t frames = 0;
    assert_int_equal(gvc_demux_open(&io, &options, &demux, NULL), GVC_OK);
    assert_int_equal(gvc_writer_create_from(&sink, &demux, &io, &writer, NULL), GVC_OK);
    assert_int_equal(write_group(writer, 0, MADE_GROUP, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    assert_memory_equal(file.data, forged.data, demux.head_size);
    assert_int_equal(read_all(file.data, file.size, false, &frames, NULL, NULL), GVC_OK);
    assert_int_equal(frames, MADE_GROUP);
    gvc_writer_destroy(&writer);
    gvc_demux_free(&demux);
    gvc_buffer_free(&file);
    gvc_buffer_free(&forged);
}

static void test_other_defaults(void **state) {
    (void)state;
    write_behind_forged_head(12, 1001);       /* as it was: the forge is sound */
    write_behind_forged_head(12, 1000);       /* duration */
    write_behind_forged_head(16, 7);          /* size */
    write_behind_forged_head(20, 0x02000000); /* flags */
}

/** A copy without its shape track, with or without its checksum, is told from a damaged file. */
static void test_missing_shape_track(void **state) {
    (void)state;
    for (unsigned drop_crc = 0; drop_crc < 2; drop_crc++) {
        gvc_buffer file = file_make(small_file, true);
        size_t moov = 28, crc_begin = 0, end[4];
        find_ends(&file, end);
        forge(&file, GVC_BOX_URIM, 0, 0, 0, moov); /* reserved bytes: no change */
        for (size_t i = moov; i < end[0]; i++) {
            if (memcmp(file.data + i, "urim", 4) == 0) memcpy(file.data + i, "mett", 4);
        }
        crc_begin = end[0] - GVC_GCRC_SIZE;
        gvc_patch_u32(&file, end[0] - 4, gvc_crc32(0, file.data, end[0] - 4));
        if (drop_crc) memcpy(file.data + crc_begin + 4, "free", 4);
        gvc_error error;
        assert_int_equal(read_all(file.data, file.size, false, NULL, NULL, &error),
                         GVC_ERROR_CORRUPT);
        assert_non_null(strstr(error.message, "the shape track is missing"));
        gvc_buffer_free(&file);
    }
}

/** Opens a good file under options that one line changes. */
static void test_limits(void **state) {
    (void)state;
    gvc_buffer file = file_make(small_file, false);
    gvc_io io = io_of(file.data, file.size);
    for (unsigned i = 0; i < 4; i++) {
        gvc_read_options options = options_make(true);
        if (i == 0) options.max_frames = SMALL_FRAMES - 1;
        if (i == 1) options.max_image_size = 32;
        if (i == 2) options.max_memory = 3 * 48 * 64 * 2 - 1;
        if (i == 3) options.max_memory = 500;
        gvc_demux demux;
        gvc_error error;
        assert_int_equal(gvc_demux_open(&io, &options, &demux, &error), GVC_ERROR_LIMIT);
        assert_null(demux.sample[0]);
    }
    gvc_buffer_free(&file);
}

static void test_not_gvc(void **state) {
    (void)state;
    gvc_error error;
    assert_int_equal(read_all((const uint8_t *)"", 0, true, NULL, NULL, &error),
                     GVC_ERROR_TRUNCATED);
    assert_int_equal(
        read_all((const uint8_t *)"\x89PNG\r\n\x1a\n????????", 16, true, NULL, NULL, &error),
        GVC_ERROR_CORRUPT);
    assert_non_null(strstr(error.message, "not a .gvc file"));
    static const uint8_t mp4[] = "\0\0\0\024ftypisom\0\0\0\0iso2\0\0\0\010mdat";
    assert_int_equal(read_all(mp4, sizeof mp4 - 1, false, NULL, NULL, &error),
                     GVC_ERROR_UNSUPPORTED);
}

static gvc_result failing_write(void *user, const void *data, size_t size, gvc_error *error) {
    (void)data;
    size_t *room = user;
    if (size > *room) return gvc_fail(error, GVC_ERROR_IO, "disk full");
    *room -= size;
    return GVC_OK;
}

static void test_writer_refusals(void **state) {
    (void)state;
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_config config = config_make(5);
    gvc_writer *writer;
    const uint8_t *avc = (const uint8_t *)MADE_AVC_CONFIG;
    config.picture_width = 63;
    assert_int_equal(gvc_writer_create(&sink, &config, avc, 5, &writer, NULL), GVC_ERROR_ARGUMENT);
    assert_null(writer);
    config.picture_width = 64;
    assert_int_equal(gvc_writer_create(&sink, &config, avc, 5, &writer, NULL), GVC_OK);
    assert_int_equal(write_group(writer, 1, 1, NULL), GVC_ERROR_ARGUMENT);
    assert_int_equal(write_group(writer, 0, 0, NULL), GVC_ERROR_ARGUMENT);
    uint8_t byte = 0, same = 1;
    gvc_sample picture[2] = {{&byte, 1, 0, true}, {&byte, 1, 0, false}};
    gvc_sample shape[2] = {{&byte, 1, 0, true}, {&same, 1, 0, false}};
    gvc_sample bad[6][2] = {{{&byte, 1, 0, true}, {&byte, 1, -1, false}},
                            {{&byte, 1, 0, true}, {&byte, 1, INT32_MAX, false}},
                            {{&byte, 1, 0, true}, {&byte, 0, 0, false}},
                            {{&byte, 1, 0, false}, {&byte, 1, 0, false}},
                            {{&byte, 1, 0, true}, {&byte, 1, 0, true}},
                            {{&byte, 1, -1, true}, {&byte, 1, 0, false}}};
    for (unsigned i = 0; i < 6; i++) {
        gvc_fragment fragment = {0, 2, bad[i], shape, NULL};
        assert_int_equal(gvc_writer_fragment(writer, &fragment, NULL), GVC_ERROR_ARGUMENT);
    }
    gvc_sample bad_shape[4][2] = {{{&same, 1, 0, true}, {&same, 1, 0, false}},
                                  {{&byte, 1, 0, true}, {&byte, 1, 0, false}},
                                  {{&byte, 1, 1, true}, {&same, 1, -1, false}},
                                  {{&byte, 1, 0, true}, {&same, 1, 0, true}}};
    for (unsigned i = 0; i < 4; i++) {
        gvc_fragment fragment = {0, 2, picture, bad_shape[i], NULL};
        assert_int_equal(gvc_writer_fragment(writer, &fragment, NULL), GVC_ERROR_ARGUMENT);
    }
    assert_int_equal(write_group(writer, 0, 4, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_ERROR_ARGUMENT); /* 4 of 5 frames */
    assert_int_equal(write_group(writer, 4, 1, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_OK);
    assert_int_equal(gvc_writer_finish(writer, NULL), GVC_ERROR_ARGUMENT);
    gvc_writer_destroy(&writer);
    size_t frames;
    assert_int_equal(read_all(file.data, file.size, false, &frames, NULL, NULL), GVC_OK);
    assert_int_equal(frames, 5);
    /* A disk that fills up: the error comes through, and the writer stays closed. */
    for (size_t disk = 0; disk < file.size; disk += 40) {
        size_t room = disk;
        gvc_sink full = {&room, failing_write};
        gvc_result result = gvc_writer_create(&full, &config, avc, 5, &writer, NULL);
        if (result == GVC_OK) result = write_group(writer, 0, 4, NULL);
        if (result == GVC_OK) result = write_group(writer, 4, 1, NULL);
        if (result == GVC_OK) result = gvc_writer_finish(writer, NULL);
        assert_int_equal(result, GVC_ERROR_IO);
        if (writer) assert_int_equal(gvc_writer_finish(writer, NULL), GVC_ERROR_ARGUMENT);
        gvc_writer_destroy(&writer);
    }
    gvc_buffer_free(&file);
}

/** Bytes that the container adds to each frame of a long group. */
static void test_overhead(void **state) {
    (void)state;
    size_t groups[251] = {0};
    for (size_t i = 0; i < 250; i++) groups[i] = 4;
    gvc_buffer file = file_make(groups, true);
    size_t payload = 0;
    uint8_t bytes[64];
    for (uint64_t i = 0; i < 1000; i++)
        payload += sample_bytes(0, i, true, bytes) + sample_bytes(1, i, true, bytes);
    print_message("%.1f bytes per group of 4 besides samples\n",
                  (double)(file.size - payload) / 250);
    assert_true(file.size - payload < 250 * (4 * 20 + 227) + 2100);
    assert_int_equal(read_all(file.data, file.size, false, NULL, NULL, NULL), GVC_OK);
    gvc_buffer_free(&file);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_every_prefix),
        cmocka_unit_test(test_every_flip_is_detected),
        cmocka_unit_test(test_flips_keep_other_fragments),
        cmocka_unit_test(test_lost_and_foreign_parts),
        cmocka_unit_test(test_64_bit_sizes),
        cmocka_unit_test(test_forged_fields),
        cmocka_unit_test(test_other_defaults),
        cmocka_unit_test(test_missing_shape_track),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_not_gvc),
        cmocka_unit_test(test_writer_refusals),
        cmocka_unit_test(test_overhead),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
