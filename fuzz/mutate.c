/* SPDX-License-Identifier: MIT */
/** @file mutate.c  The mutator of the harnesses that read whole files. Without it nearly every
 * change would end at a checksum. */
#include "mutate.h"

#include "random.h"
#include "reseal.h"

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed);

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    uint64_t random = seed;
    size_t choice = random_below(&random, 16), changed = 0;
    if (choice >= 8) {
        changed = mutate_samples(data, size, max_size, &random);
    } else if (choice >= 3) {
        changed = mutate_boxes(data, size, max_size, &random);
    }
    if (!changed) changed = LLVMFuzzerMutate(data, size, max_size);
    /* Rarely not: files with wrong checksums are input, too. */
    if (random_below(&random, 16)) reseal(data, changed);
    return changed;
}
