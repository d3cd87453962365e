/* SPDX-License-Identifier: MIT */
/** @file reseal.h  Makes the checksums of a changed file right again, so that a fuzzer gets past
 * them. */
#ifndef GVC_FUZZ_RESEAL_H
#define GVC_FUZZ_RESEAL_H

#include <stddef.h>
#include <stdint.h>

/** In place, as far as the boxes can be made out: data offsets in trun and places of moof in tfra,
 * then CRC-32 of samples (gcks) and of moof, ggap, moov and mfra (gcrc), size in mfro, SHA-256 of
 * the file (gdig). Boxes that are missing stay so; sizes of samples and boxes are believed. */
void reseal(uint8_t *data, size_t size);

#endif
