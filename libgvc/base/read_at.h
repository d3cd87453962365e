/* SPDX-License-Identifier: MIT */
/** @file read_at.h  Reads a whole stretch of a file. */
#ifndef GVC_BASE_READ_AT_H
#define GVC_BASE_READ_AT_H

#include <stddef.h>
#include <stdint.h>

#define GVC_READ_ENDS (-1) /**< the file ends before the stretch does */

/** Reads `size` bytes at `offset` of a descriptor, whose position stays. 0, GVC_READ_ENDS, or the
 * errno of what failed. */
int gvc_read_at(int descriptor, uint64_t offset, void *data, size_t size);

#endif
