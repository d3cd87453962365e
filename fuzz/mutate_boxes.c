/* SPDX-License-Identifier: MIT */
/** @file mutate_boxes.c  Changes the tree of boxes. */
#include "mutate.h"

#include "box_list.h"
#include "random.h"

#include <stdlib.h>
#include <string.h>

#define ROOM_TO_GROW 64u

/* Adds `delta` to the sizes of a box and all around it. Sizes of 32 bits wrap around, as hostile
 * ones do. */
static void resize(uint8_t *data, const box_list *list, size_t box, size_t delta) {
    for (; box != NO_PARENT; box = list->box[box].parent) {
        uint8_t *at = data + list->box[box].offset;
        if (list->box[box].header == 16) at += 12;
        bytes_put_u32(at, bytes_get_u32(at) + (uint32_t)delta);
    }
}

/* Replaces `old` bytes at `at` by `count` others; `inside` is the box whose size changes. */
static size_t replace(uint8_t *data, size_t size, size_t max_size, const box_list *list,
                      size_t inside, size_t at, size_t old, const uint8_t *bytes, size_t count) {
    if (size - old > max_size || count > max_size - (size - old)) return 0;
    resize(data, list, inside, count - old); /* headers lie before `at` */
    memmove(data + at + count, data + at + old, size - at - old);
    memcpy(data + at, bytes, count);
    return size - old + count;
}

static size_t change_content(uint8_t *data, size_t size, size_t max_size, const box_list *list,
                             size_t box) {
    const listed_box *b = &list->box[box];
    size_t content = b->size - b->header, at = b->offset + b->header;
    uint8_t *bytes = malloc(content + ROOM_TO_GROW);
    if (!bytes) return 0;
    memcpy(bytes, data + at, content);
    size_t count = LLVMFuzzerMutate(bytes, content, content + ROOM_TO_GROW);
    size = replace(data, size, max_size, list, box, at, content, bytes, count);
    free(bytes);
    return size;
}

static size_t repeat(uint8_t *data, size_t size, size_t max_size, const box_list *list,
                     const listed_box *box) {
    uint8_t *bytes = malloc(box->size);
    if (!bytes) return 0;
    memcpy(bytes, data + box->offset, box->size);
    size = replace(data, size, max_size, list, box->parent, box->offset + box->size, 0, bytes,
                   box->size);
    free(bytes);
    return size;
}

/* Swaps a box with the one behind it. */
static size_t swap_with_next(uint8_t *data, size_t size, const box_list *list, size_t box) {
    const listed_box *first = &list->box[box];
    const listed_box *second = box_list_child(list, first->parent, 0, box);
    if (!second || second->offset != first->offset + first->size) return 0;
    uint8_t *bytes = malloc(first->size);
    if (!bytes) return 0;
    memcpy(bytes, data + first->offset, first->size);
    memmove(data + first->offset, data + second->offset, second->size);
    memcpy(data + first->offset + second->size, bytes, first->size);
    free(bytes);
    return size;
}

size_t mutate_boxes(uint8_t *data, size_t size, size_t max_size, uint64_t *random) {
    box_list list;
    box_list_make(data, size, &list);
    if (list.count == 0) return 0;
    size_t box = random_below(random, list.count);
    const listed_box *b = &list.box[box];
    switch (random_below(random, 8)) {
    case 0:
        return replace(data, size, max_size, &list, b->parent, b->offset, b->size, data, 0);
    case 1:
        return repeat(data, size, max_size, &list, b);
    case 2:
        return swap_with_next(data, size, &list, box);
    default:
        return change_content(data, size, max_size, &list, box);
    }
}
