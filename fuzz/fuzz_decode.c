/* SPDX-License-Identifier: MIT */
/** @file fuzz_decode.c  Fuzzes all of reading, under limits: open, facts, frames in both
 * directions, the preview, the check of every byte, and repair.
 *
 * The input is the file. It is opened strictly and, if that fails, as far as it is undamaged. What
 * repair makes of it must be a good file with the same frames. */
#include "base/bytes.h"
#include "decoding.h"
#include "live_memory.h"
#include "memory_file.h"
#include "require.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool count_defect(void *user, const gvc_defect *defect) {
    REQUIRE(defect->error.code != GVC_OK && defect->error.message[0]);
    ++*(uint64_t *)user;
    return true;
}

static void count_lost(void *user, uint64_t first_frame, uint64_t frame_count) {
    (void)first_frame;
    *(uint64_t *)user += frame_count;
}

static gvc_reader *open_input(const uint8_t *data, size_t size, bool keep_going, bool preview) {
    gvc_read_options options = decoding_options(keep_going, preview);
    gvc_reader *reader;
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_reader_open_memory(data, size, &options, &reader, &error);
    if (!succeeded(result, &error)) REQUIRE(!reader && blames_input(result));
    return reader;
}

static void ask_facts(const gvc_reader *reader, const gvc_info *info) {
    gvc_error error;
    gvc_frame_info facts;
    gvc_error_init(&error);
    uint64_t frames = info->frame_count < DECODED_FRAMES ? info->frame_count : DECODED_FRAMES;
    for (uint64_t f = 0; f <= frames; f++) {
        (void)succeeded(gvc_reader_frame_info(reader, f, &facts, &error), &error);
    }
    REQUIRE(!succeeded(gvc_reader_frame_info(reader, UINT64_MAX, &facts, &error), &error));
}

static uint64_t defects(const gvc_reader *reader) {
    gvc_error error;
    uint64_t count = 0;
    gvc_error_init(&error);
    gvc_result result = gvc_reader_check(reader, count_defect, &count, &error);
    REQUIRE(succeeded(result, &error) || result == GVC_ERROR_LIMIT);
    return count;
}

/** What is repaired is good, says what it holds, and has frames as they were. */
static void check_repaired(const gvc_buffer *file, const gvc_repair_report *report,
                           const decoded *frames) {
    gvc_info info;
    gvc_reader *reader = open_input(file->data, file->size, false, false);
    REQUIRE(reader);
    gvc_reader_info(reader, &info);
    REQUIRE(info.frame_count == report->frame_count && info.lost_count == report->lost_count);
    REQUIRE(info.byte_count == report->byte_count && info.has_digest && info.damage_count == 0);
    REQUIRE(defects(reader) == 0);
    decoded after = decode_frames(reader);
    require_kept(frames, &after, false);
    gvc_reader_close(&reader);
}

static void repair(const gvc_reader *reader, const decoded *frames) {
    gvc_buffer file = {0};
    gvc_sink sink = {&file, sink_write};
    gvc_repair_report report;
    gvc_error error;
    gvc_error_init(&error);
    uint64_t lost = 0;
    gvc_result result = gvc_repair(reader, &sink, count_lost, &lost, &report, &error);
    if (succeeded(result, &error)) {
        REQUIRE(!file.failed && file.size == report.byte_count && lost <= report.lost_count);
        check_repaired(&file, &report, frames);
    } else {
        REQUIRE(blames_input(result));
    }
    gvc_buffer_free(&file);
}

static bool read_all(const uint8_t *data, size_t size, bool keep_going) {
    gvc_info info;
    memory_begin();
    gvc_reader *reader = open_input(data, size, keep_going, false);
    if (!reader) return false;
    gvc_reader_info(reader, &info);
    REQUIRE(keep_going || info.damage_count == 0);
    ask_facts(reader, &info);
    decoded frames = decode_frames(reader);
    REQUIRE(memory_peak() <= reader->options.max_memory + MEMORY_ALLOWANCE);
    if (info.preview) {
        gvc_reader *preview = open_input(data, size, keep_going, true);
        REQUIRE(preview);
        (void)decode_frames(preview);
        gvc_reader_close(&preview);
    }
    (void)defects(reader);
    repair(reader, &frames);
    gvc_reader_close(&reader);
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (!read_all(data, size, false)) read_all(data, size, true);
    return 0;
}
