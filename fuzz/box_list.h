/* SPDX-License-Identifier: MIT */
/** @file box_list.h  The boxes of a file, however damaged, as a list in which parents come first.
 */
#ifndef GVC_FUZZ_BOX_LIST_H
#define GVC_FUZZ_BOX_LIST_H

#include <stddef.h>
#include <stdint.h>

#define BOX_LIST_ROOM 512u
#define NO_PARENT SIZE_MAX

typedef struct listed_box {
    uint32_t type, header; /**< 8, or 16 with a 64-bit size */
    size_t offset, size;   /**< in the file; header and content */
    size_t parent;         /**< place in the list, or NO_PARENT */
} listed_box;

typedef struct box_list {
    size_t count;
    listed_box box[BOX_LIST_ROOM];
} box_list;

/** Boxes up to the first at each level that does not fit; at most BOX_LIST_ROOM of them. */
void box_list_make(const uint8_t *data, size_t size, box_list *list);
/** The next child of `parent` of a type (0: any) behind place `after` (NO_PARENT: from the first
 * on); NULL if there is none. */
const listed_box *box_list_child(const box_list *list, size_t parent, uint32_t type, size_t after);

uint32_t bytes_get_u32(const uint8_t *data);
void bytes_put_u32(uint8_t *data, uint32_t value);

#endif
