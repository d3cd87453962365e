/* SPDX-License-Identifier: MIT */
/** @file fuzz_incremental.c  Fuzzes reading of a file that is still being written, and of one whose
 * reads fail.
 *
 * The input is the file. It is seen at growing sizes with keep_going: frames found once must be
 * found again, and be the same. And reads fail, the 1st, 2nd, 4th, 8th ...: that must be told as
 * such, and when reading works again nothing may be missing. */
#include "base/digest.h"
#include "container/iso.h"
#include "decoding.h"
#include "require.h"

#define STEPS 4u
#define NEVER UINT64_MAX

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef struct input {
    const uint8_t *data;
    size_t size;
    uint64_t reads, failing; /* number of reads so far, and of the one that fails */
} input;

static gvc_result read_input(void *user, uint64_t offset, void *data, size_t size,
                             gvc_error *error) {
    input *in = user;
    REQUIRE(offset <= in->size && size <= in->size - offset);
    if (in->reads++ == in->failing) {
        /* As a caller may do it: no message. */
        if (error) error->code = GVC_ERROR_IO;
        return GVC_ERROR_IO;
    }
    memcpy(data, in->data + offset, size);
    return GVC_OK;
}

static gvc_result open_input(input *in, bool keep_going, gvc_reader **reader) {
    gvc_io io = {.user = in, .size = in->size, .read = read_input};
    gvc_read_options options = decoding_options(keep_going, false);
    gvc_error error;
    gvc_error_init(&error);
    gvc_result result = gvc_reader_open_io(&io, &options, reader, &error);
    if (!succeeded(result, &error)) REQUIRE(!*reader);
    return result;
}

static decoded decode_part(const uint8_t *data, size_t size, bool keep_going) {
    input in = {data, size, 0, NEVER};
    decoded frames = {0};
    gvc_reader *reader;
    if (open_input(&in, keep_going, &reader) != GVC_OK) return frames;
    frames = decode_frames(reader);
    gvc_reader_close(&reader);
    return frames;
}

/** Whether the bytes of a moof stand where none is, and would be found by looking for one where the
 * file is cut off. */
static bool has_decoys(const uint8_t *data, size_t size, size_t fragments) {
    static const uint8_t moof[4] = {'m', 'o', 'o', 'f'};
    size_t count = 0;
    for (size_t i = 0; i + sizeof moof <= size; i++) {
        count += memcmp(data + i, moof, sizeof moof) == 0;
    }
    return count != fragments;
}

static void grow(const uint8_t *data, size_t size) {
    input in = {data, size, 0, NEVER};
    gvc_reader *reader;
    if (open_input(&in, false, &reader) != GVC_OK) return;
    bool plain = !has_decoys(data, size, reader->demux.fragment_count);
    gvc_reader_close(&reader);
    decoded before = {0};
    uint32_t random = gvc_crc32(0, data, size); /* places that differ from input to input */
    for (unsigned step = 1; step <= STEPS && plain; step++) {
        size_t part = step == STEPS ? size : size / STEPS * step - random % (size / STEPS);
        decoded now = decode_part(data, part, step < STEPS);
        require_kept(&before, &now, true);
        before = now;
    }
}

/** Opens and decodes with one read failing. Returns whether that read came to pass. */
static bool fail_once(const uint8_t *data, size_t size, uint64_t failing, bool keep_going,
                      const decoded *good) {
    input in = {data, size, 0, failing};
    gvc_reader *reader;
    gvc_result result = open_input(&in, keep_going, &reader);
    if (in.reads > failing) {
        REQUIRE(result == GVC_ERROR_IO);
        return true;
    }
    if (result != GVC_OK) return false;
    decoded frames = decode_frames(reader);
    bool failed = in.reads > failing;
    in.failing = NEVER;
    decoded again = decode_frames(reader);
    require_kept(good, &again, true);
    require_kept(&frames, good, true);
    gvc_reader_close(&reader);
    return failed;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    if (size < STEPS) return 0;
    grow(data, size);
    for (unsigned keep_going = 0; keep_going < 2; keep_going++) {
        decoded good = decode_part(data, size, keep_going);
        uint64_t failing = 0;
        while (fail_once(data, size, failing, keep_going, &good)) failing = 2 * failing + 1;
    }
    return 0;
}
