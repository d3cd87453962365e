/* SPDX-License-Identifier: MIT */
/** @file box_list.c  Lists boxes without believing any of them. */
#include "box_list.h"

#include "container/iso.h"

uint32_t bytes_get_u32(const uint8_t *data) {
    return (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
}

void bytes_put_u32(uint8_t *data, uint32_t value) {
    for (unsigned i = 0; i < 4; i++) data[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Bytes of content before the children; SIZE_MAX if a box has none. */
static size_t fields_before_children(uint32_t type) {
    switch (type) {
    case GVC_BOX_MOOV:
    case GVC_BOX_TRAK:
    case GVC_BOX_EDTS:
    case GVC_BOX_TREF:
    case GVC_BOX_MDIA:
    case GVC_BOX_MINF:
    case GVC_BOX_DINF:
    case GVC_BOX_STBL:
    case GVC_BOX_MVEX:
    case GVC_BOX_MOOF:
    case GVC_BOX_TRAF:
    case GVC_BOX_MFRA:
        return 0;
    case GVC_BOX_STSD:
    case GVC_BOX_DREF:
        return 8;
    case GVC_BOX_AVC1:
        return GVC_AVC1_FIELDS;
    case GVC_BOX_URIM:
        return GVC_URIM_FIELDS;
    default:
        return SIZE_MAX;
    }
}

static void list_run(const uint8_t *data, size_t at, size_t end, size_t parent, box_list *list) {
    while (end - at >= 8 && list->count < BOX_LIST_ROOM) {
        listed_box box = {bytes_get_u32(data + at + 4), 8, at, bytes_get_u32(data + at), parent};
        if (box.size == 1 && end - at >= 16) {
            box.header = 16;
            box.size = (size_t)bytes_get_u32(data + at + 8) << 32 | bytes_get_u32(data + at + 12);
        }
        if (box.size < box.header || box.size > end - at) return;
        list->box[list->count++] = box;
        at += box.size;
    }
}

void box_list_make(const uint8_t *data, size_t size, box_list *list) {
    list->count = 0;
    list_run(data, 0, size, NO_PARENT, list);
    for (size_t i = 0; i < list->count; i++) { /* the list grows on the way */
        const listed_box *box = &list->box[i];
        size_t fields = fields_before_children(box->type), content = box->size - box->header;
        if (fields > content) continue;
        list_run(data, box->offset + box->header + fields, box->offset + box->size, i, list);
    }
}

const listed_box *box_list_child(const box_list *list, size_t parent, uint32_t type, size_t after) {
    for (size_t i = after == NO_PARENT ? 0 : after + 1; i < list->count; i++) {
        const listed_box *box = &list->box[i];
        if (box->parent == parent && (type == 0 || box->type == type)) return box;
    }
    return NULL;
}
