/* SPDX-License-Identifier: MIT */
/** @file nal_bits.c  Bits of the headers in H.264 NAL units. */
#include "codec/nal_bits.h"

uint32_t gvc_nal_bit(gvc_nal_bits *bits) {
    if (bits->position >= bits->bit_count) {
        bits->failed = true;
        return 0;
    }
    uint32_t bit = (uint32_t)bits->data[bits->position / 8] >> (7 - bits->position % 8) & 1;
    bits->position++;
    return bit;
}

uint32_t gvc_nal_bits_read(gvc_nal_bits *bits, unsigned count) {
    uint32_t value = 0;
    while (count--) value = value << 1 | gvc_nal_bit(bits);
    return value;
}

uint32_t gvc_nal_ue(gvc_nal_bits *bits) {
    unsigned zeros = 0;
    while (!bits->failed && gvc_nal_bit(bits) == 0) {
        if (++zeros > 31) bits->failed = true;
    }
    return bits->failed ? 0 : (UINT32_C(1) << zeros) - 1 + gvc_nal_bits_read(bits, zeros);
}

int64_t gvc_nal_se(gvc_nal_bits *bits) {
    uint32_t code = gvc_nal_ue(bits);
    return code % 2 ? ((int64_t)code + 1) / 2 : -((int64_t)code / 2);
}

size_t gvc_nal_unescape(const uint8_t *nal, size_t size, uint8_t *payload) {
    size_t length = 0;
    unsigned zeros = 0;
    for (size_t i = 0; i < size; i++) {
        if (zeros >= 2 && nal[i] == 3) {
            zeros = 0;
            continue;
        }
        zeros = nal[i] ? 0 : zeros + 1;
        payload[length++] = nal[i];
    }
    return length;
}
