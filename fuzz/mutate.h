/* SPDX-License-Identifier: MIT */
/** @file mutate.h  Changes to whole files that leave most of their structure right. Each returns
 * the new size, or 0 (and changes nothing) if the input does not allow it. `max_size` is the room
 * of `data`. */
#ifndef GVC_FUZZ_MUTATE_H
#define GVC_FUZZ_MUTATE_H

#include <stddef.h>
#include <stdint.h>

/** libFuzzer's own mutations. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

/** Deletes, repeats or swaps boxes, or changes the content of one; sizes of parents follow. */
size_t mutate_boxes(uint8_t *data, size_t size, size_t max_size, uint64_t *random);
/** Changes, swaps or copies samples (shape records unpacked before) and writes the file anew. */
size_t mutate_samples(uint8_t *data, size_t size, size_t max_size, uint64_t *random);

#endif
